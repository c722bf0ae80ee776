import uPlot from "uplot";
import { buttons, download, fileName } from "./download.js";
import { chartSvg } from "./chart_svg.js";
import { besidePoints } from "./labels.js";
import { drawAll, whenNear } from "./lazy.js";
import { logTicks, short } from "./number.js";
import { colour, onTheme } from "./theme.js";

// A chart is described once, for the screen (uPlot) and as a vector file (chart_svg.js):
//   {title, x: {label, log}, y: {label, log, zero, range: [low, high]}, sync, onTime(t or null), onPick(x),
//    series: [{name, colour, x: [...], y: [...], points, dash, step, label}],
//    gaps: [[from, to]], levels: [y]}
// x of a series ascends; colours are names of style.css. A series is a line, in steps with `step`, or with `points` those alone;
// `label` stands beside its last point. The legend names the series that have a name and no label.

const kHeight = 210;
// Of an axis of logarithms: an error that begins at nearly nothing leaves room for the rest.
const kMaxDecades = 1e4;

const isNamed = (one) => one.name && !one.label;

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
  ...(spec.log ? { distr: 3, range: (u, low, high) => [Math.max(low / 1.6, high / kMaxDecades), high * 1.6] }
    : spec.range ? { range: spec.range }
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
    const y = u.valToPos(level, "y", true);
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
  g.scale(devicePixelRatio, devicePixelRatio);
  g.fillStyle = colours.text;
  g.font = "12px system-ui, sans-serif";
  g.textBaseline = "middle";
  g.textAlign = "left";
  const labels = spec.series.filter((one) => one.label).map((one) => ({
    text: one.label,
    x: u.valToPos(one.x.at(-1), "x", true) / devicePixelRatio,
    y: u.valToPos(one.y.at(-1), "y", true) / devicePixelRatio,
    width: g.measureText(one.label).width,
  }));
  // A halo keeps them readable over lines.
  g.strokeStyle = colours.ground;
  g.lineWidth = 4;
  for (const { text, left, y } of besidePoints(labels, (u.bbox.left + u.bbox.width) / devicePixelRatio)) {
    g.strokeText(text, left, y);
    g.fillText(text, left, y);
  }
  g.restore();
}

function options(spec, width, colours, drawn) {
  const live = spec.series.length === 1;
  return {
    width,
    height: kHeight,
    scales: { x: scale(spec.x), y: scale(spec.y) },
    axes: [{ ...axis(spec.x, colours), size: 28 }, { ...axis(spec.y, colours), size: 54 }],
    legend: { show: spec.series.some(isNamed), live },
    // Of several lines the one that is pointed at stands out.
    focus: { alpha: live ? 1 : 0.25 },
    cursor: {
      sync: spec.sync ? { key: spec.sync } : undefined,
      drag: { x: true, y: false },
      points: { size: 7 },
      focus: { prox: live ? -1 : 16 },
    },
    series: [{ label: spec.x.label, value: (u, v) => short(v, 4) }, ...spec.series.map((one) => ({
      label: one.name,
      stroke: colour(one.colour),
      width: 1.4,
      dash: one.dash,
      spanGaps: true,
      paths: one.points ? () => null : one.step ? uPlot.paths.stepped({ align: -1 }) : uPlot.paths.linear(),
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

/// Draws what `spec()` says in the element `box` when it comes near the window, with a button for the vector file.
export class Chart {
  constructor(box, spec) {
    this.box = box;
    box.classList.add("chart");
    this.frame = document.createElement("div");
    this.frame.style.minHeight = `${kHeight}px`;
    box.replaceChildren(this.frame, buttons({ SVG: () => this.save() }));
    whenNear(box, () => this.start(spec()));
  }

  start(spec) {
    this.spec = spec;
    this.box.setAttribute("role", "img");
    this.box.setAttribute("aria-label", spec.title);
    this.draw();
    onTheme(() => this.draw());
    new ResizeObserver(() => this.fit()).observe(this.frame);
  }

  draw() {
    if (!this.frame.isConnected) return;
    this.plot?.destroy();
    const colours = Object.fromEntries(["muted", "line", "text", "gap", "ground"].map((name) => [name, colour(name)]));
    const data = uPlot.join(this.spec.series.map((one) => [one.x, one.y]));
    this.width = Math.max(200, this.frame.clientWidth);
    const drawn = () => {
      this.box.dataset.drawn = "yes";
      this.placeNow();
    };
    this.plot = new uPlot(options(this.spec, this.width, colours, drawn), data, this.frame);
    if (this.spec.onPick) this.plot.over.addEventListener("click", (event) => this.spec.onPick(this.plot.posToVal(event.offsetX, "x")));
    this.placeNow();
  }

  /// Marks an x of the chart, as the time of a page that plays; never drawn anew for it.
  showTime(x) {
    this.now = x;
    this.placeNow();
  }

  placeNow() {
    if (this.now === undefined || !this.plot) return;
    this.mark ??= Object.assign(document.createElement("i"), { className: "now" });
    if (this.mark.parentNode !== this.plot.over) this.plot.over.append(this.mark);
    const left = this.plot.valToPos(this.now, "x");
    this.mark.hidden = !(left >= 0 && left <= this.plot.over.clientWidth);
    this.mark.style.transform = `translateX(${left}px)`;
  }

  fit() {
    const width = Math.max(200, this.frame.clientWidth);
    if (width === this.width) return;
    this.width = width;
    this.plot.setSize({ width, height: kHeight });
  }

  save() {
    // Its button may be pressed before it has come near the window.
    drawAll(this.box);
    download(`${fileName(this.spec.title)}.svg`, "image/svg+xml", chartSvg(this.spec, this.plot));
  }
}
