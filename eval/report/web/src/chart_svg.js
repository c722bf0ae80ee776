import { besidePoints } from "./labels.js";
import { colour } from "./theme.js";

const escape = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

const kWidth = 640, kCharacter = 6.6, kHeight = 360, kLeft = 66, kRight = 14, kTop = 14, kBottom = 46;

// From a value to a coordinate, by the limits that the plot on the screen has.
function position(scale, from, to) {
  const along = scale.distr === 3 ? Math.log10 : (v) => v;
  const low = along(scale.min), high = along(scale.max);
  return (v) => from + (along(v) - low) / (high - low || 1) * (to - from);
}

// uPlot's ticks: [place, text] of those that carry one.
function ticks(axis) {
  return (axis._splits || []).map((v, i) => [v, axis._values?.[i]]).filter(([, text]) => text !== null && text !== undefined && text !== "");
}

function frame(spec, plot, x, y, ink) {
  const right = kWidth - kRight, bottom = kHeight - kBottom;
  let svg = "";
  for (const [from, to] of spec.gaps || [])
    svg += `<rect x="${x(from)}" y="${kTop}" width="${Math.max(1, x(to) - x(from))}" height="${bottom - kTop}" fill="${ink("estimate")}" fill-opacity="0.1"/>`;
  for (const [v, text] of ticks(plot.axes[1]))
    svg += `<path d="M${kLeft} ${y(v)}H${right}" stroke="${ink("line")}"/><text x="${kLeft - 8}" y="${y(v) + 4}" text-anchor="end">${escape(text)}</text>`;
  for (const [v, text] of ticks(plot.axes[0]))
    svg += `<path d="M${x(v)} ${kTop}V${bottom}" stroke="${ink("line")}"/><text x="${x(v)}" y="${bottom + 18}" text-anchor="middle">${escape(text)}</text>`;
  for (const level of spec.levels || [])
    svg += `<path d="M${kLeft} ${y(level)}H${right}" stroke="${ink("muted")}" stroke-dasharray="4 4"/>`;
  svg += `<text x="${(kLeft + right) / 2}" y="${kHeight - 6}" text-anchor="middle">${escape(spec.x.label)}</text>`;
  return svg + `<text transform="translate(14 ${(kTop + bottom) / 2}) rotate(-90)" text-anchor="middle">${escape(spec.y.label)}</text>`;
}

function curve(one, x, y, ink) {
  const at = one.x.map((v, i) => [x(v).toFixed(2), y(one.y[i]).toFixed(2)]);
  if (one.points) return at.map(([a, b]) => `<circle cx="${a}" cy="${b}" r="4" fill="${ink(one.colour)}"/>`).join("");
  const path = one.step ? at.map(([a, b], i) => (i ? `V${b}H${a}` : `M${a} ${b}`)).join("") : `M${at.map((p) => p.join(" ")).join("L")}`;
  return `<path d="${path}" fill="none" stroke="${ink(one.colour)}" stroke-width="1.4" stroke-linejoin="round"${one.dash ? ` stroke-dasharray="${one.dash.join(" ")}"` : ""}/>`;
}

// The width of a text is known to nobody before it is drawn.
function labels(series, x, y) {
  const points = series.filter((one) => one.label).map((one) => ({
    text: one.label, x: x(one.x.at(-1)), y: y(one.y.at(-1)), width: kCharacter * one.label.length }));
  return besidePoints(points, kWidth - kRight).map(({ text, left, y: at }) =>
    `<text class="label" x="${left.toFixed(1)}" y="${(at + 4).toFixed(1)}">${escape(text)}</text>`).join("");
}

/// The chart as it is on the screen, zoom included, in light colours: a text of SVG for papers.
export function chartSvg(spec, plot) {
  const ink = (name) => colour(name, "light");
  const x = position(plot.scales.x, kLeft, kWidth - kRight), y = position(plot.scales.y, kHeight - kBottom, kTop);
  const named = spec.series.length < 2 ? [] : spec.series.filter((one) => one.name && !one.label);
  const height = kHeight + 18 * named.length;
  let svg = frame(spec, plot, x, y, ink);
  svg += `<clipPath id="inside"><rect x="${kLeft}" y="${kTop}" width="${kWidth - kLeft - kRight}" height="${kHeight - kTop - kBottom}"/></clipPath>`;
  svg += `<g clip-path="url(#inside)">${spec.series.map((one) => curve(one, x, y, ink)).join("")}</g>${labels(spec.series, x, y)}`;
  named.forEach((one, i) => {
    const at = kHeight + 18 * i;
    svg += `<rect x="${kLeft}" y="${at}" width="12" height="12" fill="${ink(one.colour)}"/><text x="${kLeft + 20}" y="${at + 10}">${escape(one.name)}</text>`;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${kWidth} ${height}" width="${kWidth}" height="${height}" font-family="sans-serif" font-size="12" fill="${ink("muted")}">` +
    `<title>${escape(spec.title)}</title><style>.label{fill:${ink("text")};stroke:#fff;stroke-width:4;paint-order:stroke}</style>${svg}</svg>\n`;
}
