import "uplot/dist/uPlot.min.css";
import "../style.css";
import { Chart } from "./chart.js";
import { drawAll } from "./lazy.js";
import { unpackWhenNear } from "./packed.js";
import { showRun } from "./run_views.js";
import { startSearch } from "./search.js";
import { settle } from "./settle.js";
import { startTable } from "./tables.js";
import { startTheme } from "./theme.js";

// Before the theme's own listener: what is drawn only now takes the light colours at once with the rest.
addEventListener("beforeprint", () => drawAll());
startTheme();
function start(part) {
  part.querySelectorAll("table.sortable").forEach(startTable);
  part.querySelectorAll("script[data-run]").forEach(showRun);
}
start(document);
document.querySelectorAll("script.packed").forEach((script) => unpackWhenNear(script, start));
for (const spec of JSON.parse(document.getElementById("charts").textContent))
  new Chart(document.querySelector(`[data-chart="${CSS.escape(spec.id)}"]`), () => spec);
startSearch();
settle();
document.documentElement.dataset.ready = "yes";
