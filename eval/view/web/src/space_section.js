import { colour, onTheme } from "../../../report/web/src/theme.js";
import { askBytes, askJson } from "./data.js";
import { PathSpace } from "./space.js";

function points(buffer) {
  const numbers = new Float32Array(buffer ?? 0), all = [];
  for (let i = 0; i + 2 < numbers.length; i += 3) all.push([numbers[i], numbers[i + 1], numbers[i + 2]]);
  return all;
}

/// Names of what is drawn with their colours, which follow the theme.
function legend(caption, traces) {
  const list = document.createElement("span");
  for (const trace of traces) {
    const swatch = Object.assign(document.createElement("i"), { className: "swatch" });
    const paint = () => (swatch.style.background = colour(trace.colour));
    onTheme(paint);
    paint();
    list.append(swatch, trace.name);
  }
  caption.append(list);
}

function fill(section, hasCloud) {
  const figure = document.createElement("figure"), canvas = document.createElement("canvas");
  canvas.tabIndex = 0;
  canvas.setAttribute("aria-label", "Paths and map in 3-D; turn by dragging");
  const label = document.createElement("label"), map = Object.assign(document.createElement("input"), { type: "checkbox", checked: hasCloud });
  label.append(map, "map");
  const caption = document.createElement("figcaption");
  figure.append(canvas, label, caption);
  section.append(figure);
  section.hidden = false;
  return caption;
}

/// Paths, map and cameras of the recording, its runs and those that are being written, whose paths go on (PathSpace::setPath).
export async function showSpace(section, { index, recording, runs, growing }, clock) {
  const traces = [];
  if (recording?.truth) traces.push({ name: "truth", colour: "truth", path: await askJson(`path?recording=${index}`) });
  for (const run of runs) traces.push({ name: run.name, colour: run.colour, path: await askJson(`run_path?run=${run.index}`) });
  for (const run of growing) traces.push({ name: run.name, colour: run.colour, unfinished: run.index, path: await askJson(`live_path?unfinished=${run.index}`) });
  const clouds = await Promise.all([...runs.map((run) => askBytes(`run_cloud?run=${run.index}`)), recording && askBytes(`cloud?recording=${index}`)]);
  // A map that was tracked before the scene as it is.
  const cloud = points(clouds.find((buffer) => buffer?.byteLength));
  const drawn = traces.filter((trace) => trace.path?.t.length);
  if (!drawn.length && !cloud.length) return undefined;
  const caption = fill(section, cloud.length > 0);
  legend(caption, drawn);
  const view = new PathSpace(section, `${recording?.name ?? runs[0].name} in 3-D`, recording, drawn, cloud);
  let due = false;
  clock.onChange(() => {
    if (!due) requestAnimationFrame(() => {
      due = false;
      view.showTime(clock.time);
    });
    due = true;
  });
  return view;
}
