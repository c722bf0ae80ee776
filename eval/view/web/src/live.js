import { askJson } from "./data.js";

const kEveryMs = 1000;

const soFar = (folder) =>
  `${folder.name} is being written (${[folder.frames && `${folder.frames} frames`, folder.depth_maps && `${folder.depth_maps} depth maps`, `${folder.mb} MB`].filter(Boolean).join(", ")} so far); it is shown as soon as it is complete.`;

/// Says how far the folders are that other programs are writing, and opens the page anew when one is complete.
export function followUnfinished(box, sources) {
  const count = sources.unfinished.length;
  if (!count) return;
  const show = ({ unfinished }) => {
    if (unfinished.length !== count) location.reload();
    box.textContent = unfinished.map(soFar).join(" ");
  };
  box.hidden = false;
  show(sources);
  setInterval(() => askJson("sources").then(show, (error) => (box.textContent = error.message)), kEveryMs);
}
