import { short } from "../../../report/web/src/number.js";
import { EventStore } from "./event_store.js";
import { EventPanel, PicturePanel } from "./panels.js";

/// Everything of the recording and its runs that is a picture at the time of the page, drawn once per frame of the browser.
export function showPanels(box, { index, recording, runs }, clock, style, failed) {
  if (!recording) return;
  const panels = [];
  let due = false;
  const draw = () => {
    due = false;
    const us = clock.time * 1e6;
    for (const panel of panels) panel.draw(us, style.windowMs * 1000, style.mode);
  };
  const changed = () => {
    if (!due) requestAnimationFrame(draw);
    due = true;
  };
  const add = (name, list, target, note) => {
    if (!list) return;
    const panel = new PicturePanel(box, name, recording, list, target, { failed, note });
    panel.arrived = changed;
    panels.push(panel);
  };
  if (recording.events !== undefined)
    panels.push(new EventPanel(box, recording, new EventStore(index, recording, changed, failed)));
  add("frame", recording.frames, (id) => `frame?recording=${index}&id=${id}`);
  add("depth", recording.depth, (id) => `depth?recording=${index}&id=${id}`,
      recording.depth?.near !== undefined ? `, ${short(recording.depth.near)} to ${short(recording.depth.far)} m, near is bright` : "");
  for (const run of runs) {
    add(`depth by ${run.name}`, run.depth, (id) => `run_depth?run=${run.index}&id=${id}`);
    add(`image by ${run.name}`, run.image, (id) => `run_image?run=${run.index}&id=${id}`);
  }
  clock.onChange(changed);
  changed();
}
