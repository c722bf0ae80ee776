// The pictures of events: numbers per pixel, then colours by a table. Little-endian: 0xAABBGGRR.
const rgb = (r, g, b) => (0xff000000 | b << 16 | g << 8 | r) >>> 0;
const mix = (a, b, w) => rgb(...a.map((v, i) => Math.round(v + w * (b[i] - v))));
const table = (colour) => Uint32Array.from({ length: 256 }, (_, i) => colour(i / 255));

// As in the pictures of `saccade render`: ON green, OFF red, on a dark ground.
const kGround = [12, 15, 20], kOn = [70, 225, 110], kOff = [240, 62, 52], kLight = [240, 243, 247];
const kOrdered = [[12, 15, 20], [76, 40, 130], [190, 60, 110], [245, 140, 60], [250, 235, 150]];
const kGrey = table((v) => mix(kGround, kLight, v));
const kOnTable = table((v) => mix(kGround, kOn, v));
const kOffTable = table((v) => mix(kGround, kOff, v));
const kOrderedTable = table((v) => {
  const at = Math.min(kOrdered.length - 2, Math.floor(v * (kOrdered.length - 1)));
  return mix(kOrdered[at], kOrdered[at + 1], v * (kOrdered.length - 1) - at);
});

// Three events at a pixel are two thirds of the way to full.
const kFull = 8;
const strength = Uint8Array.from({ length: kFull + 1 }, (_, n) => Math.round(255 * (1 - 0.7 ** n) / (1 - 0.7 ** kFull)));

// The most significant bit of a column marks OFF.
const kOff16 = 0x8000, kColumn = 0x7fff;

function forEachEvent(parts, width, height, use) {
  let count = 0;
  for (const { events, begin, from, to } of parts) {
    const { times, columns, rows } = events;
    for (let i = from; i < to; ++i) {
      const column = columns[i] & kColumn;
      if (column >= width || rows[i] >= height) continue;
      use(rows[i] * width + column, columns[i] & kOff16 ? -1 : 1, begin + times[i]);
    }
    count += (to - from) * events.stride;
  }
  return count;
}

function accumulated(parts, picture, scratch) {
  const count = forEachEvent(parts, picture.width, picture.height, (at) => ++scratch[at]);
  const pixels = new Uint32Array(picture.data.buffer);
  for (let i = 0; i < pixels.length; ++i) pixels[i] = kGrey[strength[Math.min(kFull, scratch[i])]];
  return count;
}

function polarity(parts, picture, scratch) {
  const count = forEachEvent(parts, picture.width, picture.height, (at, sign) => (scratch[at] += sign));
  const pixels = new Uint32Array(picture.data.buffer);
  for (let i = 0; i < pixels.length; ++i) {
    const sum = scratch[i];
    pixels[i] = sum >= 0 ? kOnTable[strength[Math.min(kFull, sum)]] : kOffTable[strength[Math.min(kFull, -sum)]];
  }
  return count;
}

// Brightness falls by e in a third of the window, in which the last event of each pixel lies.
function surface(parts, picture, scratch, fromUs, toUs) {
  const count = forEachEvent(parts, picture.width, picture.height, (at, sign, t) => (scratch[at] = t - fromUs + 1));
  const pixels = new Uint32Array(picture.data.buffer), length = toUs - fromUs;
  const fading = Float32Array.from({ length: 256 }, (_, i) => 255 * Math.exp(-3 * (1 - i / 255)));
  for (let i = 0; i < pixels.length; ++i) {
    const age = scratch[i];
    pixels[i] = kOrderedTable[age === 0 ? 0 : Math.round(fading[Math.min(255, Math.floor(255 * age / length))])];
  }
  return count;
}

export const kModes = [
  { name: "polarity", draw: polarity },
  { name: "accumulated", draw: accumulated },
  { name: "time surface", draw: surface },
];

/// Draws the events of [from_us, to_us) into an ImageData; how many there are. `scratch`: a Float64Array of its pixels.
export function drawEvents(mode, parts, picture, scratch, fromUs, toUs) {
  scratch.fill(0);
  return mode.draw(parts, picture, scratch, fromUs, toUs);
}
