import { Chart } from "./chart.js";
import { SpaceView } from "./space_view.js";

/// Positions of a map, packed by the report: 16-bit steps of `unit` [m] from `origin`, in base64.
export function unpackCloud(cloud) {
  if (!cloud) return [];
  const bytes = Uint8Array.from(atob(cloud.points), (c) => c.charCodeAt(0));
  const steps = new Uint16Array(bytes.buffer);
  const points = [];
  for (let i = 0; i + 2 < steps.length; i += 3) points.push([0, 1, 2].map((k) => cloud.origin[k] + cloud.unit[k] * steps[i + k]));
  return points;
}

/// One error of a run over time.
export const errorChart = (run, series, more) => ({
  title: `${run.name}: ${series.label} over time`,
  x: { label: "time [s]" },
  y: { label: `${series.label} [${series.unit}]`, zero: true },
  series: [{ name: `${series.label} [${series.unit}]`, colour: "error", x: series.t, y: series.v }],
  gaps: run.gaps,
  levels: [series.mean],
  ...more,
});

const spaceContent = (run) => ({ title: `${run.name} in 3-D`, times: run.times, truth: run.truth, cloud: unpackCloud(run.cloud),
  paths: [{ name: run.name, colour: "estimate", points: run.estimate }] });

/// The charts and the view in 3-D of the run whose numbers stand in `script`; pointing at an instant in a chart shows it in all.
export function showRun(script) {
  const id = script.dataset.run;
  let read;
  // A page of a hundred runs has ten megabytes of numbers: they are read when the first drawing of their run is.
  const run = () => (read ??= JSON.parse(script.textContent));
  const space = document.querySelector(`[data-space="${id}"]`);
  const view = space && new SpaceView(space, () => spaceContent(run()));
  for (const box of document.querySelectorAll(`[data-plot^="${id}/"]`))
    new Chart(box, () => errorChart(run(), run().series[box.dataset.plot.split("/")[1]], { sync: id, onTime: (t) => view?.showTime(t) }));
}
