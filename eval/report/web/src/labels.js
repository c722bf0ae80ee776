// Raised a little, so that a line through the point does not cross them.
const kGap = 6, kRise = 10, kLine = 14;

/// Where the texts beside points stand: from [{text, x, y, width}] to [{text, left, y, width}], all in pixels. At the right of
/// the point, at its left where the chart ends at `end`, and lower where another text is in the way.
export function besidePoints(points, end) {
  const placed = [];
  for (const { text, x, y, width } of points.toSorted((a, b) => a.y - b.y)) {
    const left = x + kGap + width < end ? x + kGap : x - kGap - width;
    // With some room, so that rounding lets none stay in the way of a text that was put just below it.
    const inTheWay = (at) => placed.find((other) => Math.abs(other.y - at) < kLine - 0.01 && other.left < left + width && left < other.left + other.width);
    let at = y - kRise;
    for (let other = inTheWay(at); other; other = inTheWay(at)) at = other.y + kLine;
    placed.push({ text, left, y: at, width });
  }
  return placed;
}
