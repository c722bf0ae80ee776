import { short } from "../../../report/web/src/number.js";
import { clipNote } from "./data.js";

const number = (n, what) => `${n.toLocaleString("en")} ${what}`;

function recordingText(recording) {
  const parts = [`${recording.width} × ${recording.height} px`, `${short((recording.end_us - recording.start_us) / 1e6, 4)} s`];
  parts.push(recording.events === undefined ? "no events" : number(recording.events, "events"));
  parts.push(recording.frames ? number(recording.frames.count, "frames") : "no frames");
  parts.push(recording.depth ? number(recording.depth.count, "depth maps") : "no depth");
  parts.push(recording.truth ? "true path" : "no true path");
  return `${recording.name}: ${parts.join(", ")}.`;
}

const runText = (run) =>
  `${run.name} (${run.module}, ${number(run.poses, "poses")}${run.is_aligned ? ", aligned to the truth" : ""}${run.problem ? `, ${run.problem}` : ""})`;

/// One paragraph about what the page has, and what it lacks.
export function showFacts(box, { recording, runs }) {
  const parts = [];
  if (recording) parts.push(recordingText(recording));
  else if (runs.length) parts.push("The dataset of the run is not there any more.");
  if (runs.length) parts.push(`Runs: ${runs.map(runText).join("; ")}.`);
  if (clipNote) parts.push(`A clip: ${clipNote}.`);
  box.textContent = parts.join(" ");
}

/// Chooses between recordings; returns what goes to the next one.
export function startChoice(label, { recordings }) {
  const list = label.querySelector("select");
  recordings.forEach((recording, i) => list.add(new Option(recording.name, i)));
  label.hidden = recordings.length < 2;
  const current = Number(new URLSearchParams(location.hash.slice(1)).get("recording")) || 0;
  list.value = Math.min(current, recordings.length - 1);
  const go = (index) => {
    location.hash = `recording=${index}`;
    location.reload();
  };
  list.addEventListener("change", () => go(list.value));
  return () => recordings.length > 1 && go((current + 1) % recordings.length);
}
