import "uplot/dist/uPlot.min.css";
import "../../../report/web/style.css";
import "../view.css";
import { startTheme } from "../../../report/web/src/theme.js";
import { Clock } from "./clock.js";
import { askJson, isClip } from "./data.js";
import { showErrors } from "./errors.js";
import { showFacts, startChoice } from "./facts.js";
import { startKeys } from "./keys.js";
import { followUnfinished } from "./live.js";
import { showPanels } from "./pictures.js";
import { EventStyle, Player } from "./player.js";
import { showSpace } from "./space_section.js";

const byId = (id) => document.getElementById(id);

/// What went wrong, for the reader; the first of it stays.
function failed(error) {
  const box = byId("problem");
  if (box.hidden) box.textContent = error.message;
  box.hidden = false;
}

/// The recording that the address names, with its runs in their colours.
function chosen(sources) {
  const index = Math.min(Math.max(0, Number(new URLSearchParams(location.hash.slice(1)).get("recording")) || 0), sources.recordings.length - 1);
  const runs = sources.runs.map((run, i) => ({ ...run, index: i })).filter((run) => index < 0 || run.recording === index || run.recording === undefined)
    .map((run, i) => ({ ...run, colour: `s${i % 8}` }));
  const growing = sources.unfinished.map((run, i) => ({ ...run, index: i })).filter((run) => run.recording !== undefined && run.recording === index)
    .map((run, i) => ({ ...run, colour: `s${(runs.length + i) % 8}` }));
  return { index, recording: sources.recordings[index], runs, growing };
}

/// First and last moment [s] of the recording, or of the runs where it is gone.
async function span({ recording, runs }) {
  if (recording) return [recording.start_us / 1e6, recording.end_us / 1e6];
  const paths = await Promise.all(runs.map((run) => askJson(`run_path?run=${run.index}`)));
  const times = paths.flatMap((path) => (path?.t.length ? [path.t[0], path.t.at(-1)] : []));
  return times.length ? [Math.min(...times), Math.max(...times)] : [0, 1];
}

async function start() {
  const sources = await askJson("sources");
  const nextRecording = startChoice(byId("choose"), sources);
  const shown = chosen(sources);
  showFacts(byId("facts"), shown);
  const page = { index: shown.index };
  if (!isClip) followUnfinished(byId("live"), byId("panels"), sources, page);
  if (!shown.recording && !shown.runs.length) return;
  const clock = new Clock(...await span(shown));
  const style = new EventStyle(() => clock.changed());
  const player = new Player(byId("player"), clock, style, shown.recording?.events !== undefined);
  startKeys(byId("keys"), byId("help"), clock, style, nextRecording);
  showPanels(byId("panels"), shown, clock, style, failed);
  page.clock = clock;
  await Promise.all([
    showSpace(byId("space"), shown, clock).then((space) => (page.space = space)),
    shown.recording?.events && askJson(`rate?recording=${shown.index}`).then((rate) => rate && player.setRate(rate)),
    showErrors(byId("charts"), shown, clock),
  ].map((part) => part?.catch(failed)));
  clock.changed();
}

startTheme();
start().catch(failed).finally(() => (document.documentElement.dataset.ready = "yes"));
