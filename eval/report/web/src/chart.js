import uPlot from "uplot";
import { buttons, download, fileName } from "./download.js";
import { chartSvg } from "./chart_svg.js";
import { whenNear } from "./lazy.js";
import { logTicks, short } from "./number.js";
import { colour, onTheme } from "./theme.js";

// A chart is described once, for the screen (uPlot) and as a vector file (chart_svg.js):
//   {title, height, x: {label, log}, y: {label, log, zero}, sync, onTime(t or null),
//    series: [{name, colour, x: [...], y: [...], points, line, dash, width, step, label}],
//    gaps: [[from, to]], levels: [{y, label}]}
// x of a series ascends; colours are names of style.css; `label` stands beside the last point.

const axis = (spec, colours) => ({
  label: spec.label,
  labelSize: 22,
  labelFont: "12px system-ui, sans-serif",
  font: "12px system-ui, sans-serif",
  stroke: colours.muted,
  grid: { stroke: colours.line, width: 1 },
  ticks: { show: false },
  ...(spec.log && {
    splits: (u, i, low, high) => logTicks(low, high),
    filter: (u, splits) => splits,
    values: (u, splits) => splits.map((v) => short(v, 1)),
  }),
});

const scale = (spec) => ({
  time: false,
  ...(spec.log ? { distr: 3, range: (u, low, high) => [low / 1.6, high * 1.6] }
    : spec.zero && { range: (u, low, high) => [0, Math.max(high * 1.06, 1e-9)] }),
});

function drawMarks(u, spec, colours) {
  const g = u.ctx;
  const { left, top, width, height } = u.bbox;
  g.save();
  g.fillStyle = colours.gap;
  for (const [from, to] of spec.gaps || []) {
    const a = u.valToPos(from, "x", true), b = u.valToPos(to, "x", true);
    g.fillRect(a, top, Math.max(1, b - a), height);
  }
  g.strokeStyle = colours.muted;
  g.lineWidth = devicePixelRatio;
  g.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
  for (const level of spec.levels || []) {
    const y = u.valToPos(level.y, "y", true);
    g.beginPath();
    g.moveTo(left, y);
    g.lineTo(left + width, y);
    g.stroke();
  }
  g.restore();
}

function drawLabels(u, spec, colours) {
  const g = u.ctx;
  g.save();
  g.fillStyle = colours.text;
  g.font = `${12 * devicePixelRatio}px system-ui, sans-serif`;
  g.textBaseline = "middle";
  for (const one of spec.series) {
    if (!one.label || !one.x.length) continue;
    const x = u.valToPos(one.x.at(-1), "x", true), y = u.valToPos(one.y.at(-1), "y", true);
    const right = x + g.measureText(one.label).width + 12 * devicePixelRatio < u.bbox.left + u.bbox.width;
    g.textAlign = right ? "left" : "right";
    g.fillText(one.label, x + (right ? 8 : -8) * devicePixelRatio, y);
  }
  g.restore();
}

function options(spec, width, colours, drawn) {
  const live = spec.series.length === 1;
  return {
    width,
    height: spec.height || 210,
    scales: { x: scale(spec.x), y: scale(spec.y) },
    axes: [{ ...axis(spec.x, colours), size: 28 }, { ...axis(spec.y, colours), size: 54 }],
    legend: { show: !spec.noLegend, live },
    cursor: { sync: spec.sync ? { key: spec.sync } : undefined, drag: { x: true, y: false }, points: { size: 7 } },
    series: [{ label: spec.x.label, value: (u, v) => short(v, 4) }, ...spec.series.map((one) => ({
      label: one.name,
      stroke: colour(one.colour),
      fill: one.points && !one.line ? colour(one.colour) : undefined,
      width: one.line === false ? 0 : one.width || 1.4,
      dash: one.dash,
      spanGaps: true,
      paths: one.line === false ? () => null : one.step ? uPlot.paths.stepped({ align: 1 }) : uPlot.paths.linear(),
      points: { show: Boolean(one.points), size: 8, fill: colour(one.colour) },
      value: (u, v) => short(v),
    }))],
    hooks: {
      drawAxes: [(u) => drawMarks(u, spec, colours)],
      draw: [(u) => {
        drawLabels(u, spec, colours);
        drawn();
      }],
      setCursor: spec.onTime ? [(u) => spec.onTime(u.cursor.idx === null || u.cursor.left < 0 ? null : u.data[0][u.cursor.idx])] : [],
    },
  };
}

/// Draws `spec` in the element `box` when it comes near the window, with a button for the vector file.
export class Chart {
  constructor(box, spec) {
    this.box = box;
    this.spec = spec;
    box.classList.add("chart");
    box.setAttribute("role", "img");
    box.setAttribute("aria-label", spec.title);
    this.frame = document.createElement("div");
    this.frame.style.minHeight = `${spec.height || 210}px`;
    box.replaceChildren(this.frame, buttons({ SVG: () => this.save() }));
    whenNear(box, () => {
      this.draw();
      onTheme(() => this.draw());
      new ResizeObserver(() => this.fit()).observe(this.frame);
    });
  }

  draw() {
    if (!this.frame.isConnected) return;
    this.plot?.destroy();
    const colours = Object.fromEntries(["muted", "line", "text", "gap"].map((name) => [name, colour(name)]));
    const data = uPlot.join(this.spec.series.map((one) => [one.x, one.y]));
    this.width = Math.max(200, this.frame.clientWidth);
    this.plot = new uPlot(options(this.spec, this.width, colours, () => (this.box.dataset.drawn = "yes")), data, this.frame);
  }

  fit() {
    const width = Math.max(200, this.frame.clientWidth);
    if (width === this.width) return;
    this.width = width;
    this.plot.setSize({ width, height: this.spec.height || 210 });
  }

  save() {
    download(`${fileName(this.spec.title)}.svg`, "image/svg+xml", chartSvg(this.spec, this.plot));
  }
}
