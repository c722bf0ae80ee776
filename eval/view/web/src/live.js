import { ask, askBytes, askJson } from "./data.js";
import { drawEvents, kModes } from "./event_drawing.js";
import { unpackEvents } from "./event_store.js";
import { Panel } from "./panels.js";

const kEveryMs = 500;
const kWindowUs = 20_000;

const soFar = (folder) =>
  `${folder.name} is being written (${[folder.path_s !== undefined && `its path up to ${folder.path_s.toFixed(3)} s`, folder.frames && `${folder.frames} frames`, folder.depth_maps && `${folder.depth_maps} depth maps`, folder.reached_us !== undefined && `events up to ${(folder.reached_us / 1e6).toFixed(3)} s`, `${folder.mb} MB`].filter(Boolean).join(", ")}); it is shown as a whole when it is complete.`;

/// The newest events and the newest frame of one folder or, of a run, its path in the 3-D view.
class LivePanels {
  constructor(box, index) {
    Object.assign(this, { box, index, frames: 0 });
  }

  async show(folder, page) {
    if (folder.path_s !== this.pathEnd && page.clock && folder.recording === page.index) await this.showPath(folder, page);
    if (folder.reached_us !== undefined && folder.reached_us !== this.reached) await this.showEvents(folder);
    if (folder.frames > this.frames) await this.showFrame(folder);
  }

  async showEvents({ width, height, reached_us: reached }) {
    const from = reached + 1 - kWindowUs;
    const buffer = await askBytes(`live_events?unfinished=${this.index}&start_us=${from}&end_us=${reached + 1}`);
    if (!buffer) return;
    this.events ??= new Panel(this.box, "newest events", width, height);
    Object.assign(this.events.canvas, { width, height });
    const events = unpackEvents(buffer), picture = this.events.g.createImageData(width, height);
    const count = drawEvents(kModes[0], [{ events, begin: from, from: 0, to: events.count }], picture, new Float64Array(width * height), from, reached + 1);
    this.events.g.putImageData(picture, 0, 0);
    this.events.say(`${count.toLocaleString("en")} in ${kWindowUs / 1000} ms before ${(reached / 1e6).toFixed(3)} s`);
    this.events.figure.dataset.reached = this.reached = reached;
  }

  async showPath({ path_s: end }, page) {
    const path = end !== undefined && await askJson(`live_path?unfinished=${this.index}`);
    if (!path) return;
    page.space?.setPath(this.index, path);
    // The times of a path are rounded: its camera stands at the last of them, not behind.
    page.ends.set(this.index, path.t.at(-1));
    page.clock.reach(Math.max(...page.ends.values()));
    this.pathEnd = end;
  }

  async showFrame({ frames }) {
    const answer = await ask(`live_frame?unfinished=${this.index}&id=${frames - 1}`);
    if (!answer) return;
    const { width, height } = await createImageBitmap(answer).then((bitmap) => (this.picture = bitmap));
    this.frame ??= new Panel(this.box, "newest frame", width, height);
    this.frame.g.drawImage(this.picture, 0, 0);
    this.frame.say(`number ${frames}`);
    this.frames = frames;
  }
}

/// The recordings that folders belong to, which the page shows as a whole.
const recordingsOf = (unfinished) => JSON.stringify(unfinished.map((folder) => folder.recording ?? -1));

/// Follows the folders that other programs are writing, and opens the page anew when one is complete. `page`: the index of its
/// recording and, once they are there, its clock and its 3-D view.
export function followUnfinished(box, panels, sources, page) {
  if (!sources.unfinished.length) return;
  page.ends = new Map();
  const live = sources.unfinished.map((_, i) => new LivePanels(panels, i));
  const show = async ({ unfinished }) => {
    if (recordingsOf(unfinished) !== recordingsOf(sources.unfinished)) return location.reload();
    box.textContent = unfinished.map(soFar).join(" ");
    for (const [i, folder] of unfinished.entries()) await live[i].show(folder, page);
    setTimeout(poll, kEveryMs);
  };
  const failed = (error) => {
    box.textContent = error.message;
    setTimeout(poll, 4 * kEveryMs);
  };
  const poll = () => askJson("sources").then(show).catch(failed);
  box.hidden = false;
  show(sources).catch(failed);
}
