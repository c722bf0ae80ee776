import { colour } from "./theme.js";

const text = (at) => at.map((v) => v.toFixed(2)).join(" ");

/// The view of paths and map as it is turned on the screen, in light colours: a text of SVG.
export function spaceSvg(view) {
  const width = view.canvas.clientWidth, height = view.canvas.clientHeight;
  const ink = (name) => colour(name, "light");
  const { low, high } = view.bounds;
  const corner = (i) => view.project([0, 1, 2].map((k) => (i >> k & 1 ? high[k] : low[k])));
  let edges = "";
  for (let i = 0; i < 8; ++i) for (let k = 0; k < 3; ++k) if (!(i >> k & 1)) edges += `M${text(corner(i))}L${text(corner(i | 1 << k))}`;
  let svg = `<path d="${edges}" stroke="${ink("line")}" fill="none"/>`;
  if (view.map?.checked)
    svg += `<path d="${view.content.cloud.map((p) => `M${text(view.project(p))}h0`).join("")}" stroke="${ink("map")}" stroke-width="1.6" stroke-linecap="round"/>`;
  for (const line of view.lines())
    svg += `<path d="M${line.points.map((p) => text(view.project(p))).join("L")}" fill="none" stroke="${ink(line.colour)}" stroke-width="${line.width}" stroke-linejoin="round"/>`;
  for (const label of view.axisLabels())
    svg += `<text x="${label.at[0]}" y="${label.at[1]}" text-anchor="middle" fill="${ink("muted")}">${label.text}</text>`;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="sans-serif" font-size="12">${svg}</svg>\n`;
}
