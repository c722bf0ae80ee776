import "uplot/dist/uPlot.min.css";
import "../style.css";
import { Chart } from "./chart.js";
import { drawAll } from "./lazy.js";
import { showRun } from "./run_views.js";
import { startTable } from "./tables.js";
import { startTheme } from "./theme.js";

const data = JSON.parse(document.getElementById("report-data").textContent);

// Before the theme's own listener: what is drawn only now takes the light colours at once with the rest.
addEventListener("beforeprint", () => drawAll());
startTheme();
document.querySelectorAll("table.sortable").forEach(startTable);
data.runs.forEach(showRun);
for (const spec of data.charts) new Chart(document.querySelector(`[data-chart="${CSS.escape(spec.id)}"]`), spec);
document.documentElement.dataset.ready = "yes";
