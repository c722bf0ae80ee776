import { Chart } from "../../../report/web/src/chart.js";
import { askJson } from "./data.js";

/// The errors of all runs over time, one chart for each kind, with the time of the page in all of them.
export async function showErrors(section, { runs }, clock) {
  const scored = [];
  for (const run of runs) {
    const errors = run.recording !== undefined && await askJson(`errors?run=${run.index}`);
    if (errors) scored.push({ run, errors });
  }
  const kinds = new Map();
  for (const { run, errors } of scored)
    for (const [id, series] of Object.entries(errors.series)) {
      if (!kinds.has(id)) kinds.set(id, { series, curves: [] });
      kinds.get(id).curves.push({ name: run.is_aligned ? `${run.name} (aligned)` : run.name, colour: run.colour, x: series.t, y: series.v });
    }
  for (const { series, curves } of kinds.values()) {
    const box = document.createElement("div");
    section.append(box);
    const chart = new Chart(box, () => ({
      title: `${series.label} over time`,
      x: { label: "time [s]" },
      y: { label: `${series.label} [${series.unit}]`, zero: true },
      series: curves,
      sync: "view",
      onPick: (t) => clock.seek(t),
    }));
    clock.onChange(() => chart.showTime(clock.time));
  }
}
