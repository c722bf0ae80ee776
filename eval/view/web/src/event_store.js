import { askBytes, clipEvery } from "./data.js";

// 8 bytes an event: about 100 MB.
const kMostHeld = 12e6;
const kAtOnce = 3;

/// What pack_events() wrote.
export function unpackEvents(buffer) {
  const [count, stride] = new Uint32Array(buffer, 0, 2);
  return {
    count,
    stride,
    times: new Uint32Array(buffer, 8, count),
    columns: new Uint16Array(buffer, 8 + 4 * count, count),
    rows: new Uint16Array(buffer, 8 + 6 * count, count),
  };
}

/// Index of the first of the ascending `times` that is not before `t`.
export function firstNotBefore(times, t) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/// The events of a recording in slots of equal time, fetched when they are drawn; those that were not drawn for longest go when
/// there are too many. `changed()` is called when one arrived, `failed(error)` when one cannot be read.
export class EventStore {
  constructor(index, recording, changed, failed) {
    Object.assign(this, { index, recording, changed, failed, slots: new Map(), held: 0, loading: new Set(), wanted: [] });
    this.last = Math.ceil((recording.end_us - recording.start_us) / recording.slot_us) - 1;
  }

  start(slot) {
    return this.recording.start_us + slot * this.recording.slot_us;
  }

  slotAt(us) {
    return Math.min(this.last, Math.max(0, Math.floor((us - this.recording.start_us) / this.recording.slot_us)));
  }

  /// The parts [{slot, from, to}] that hold the events of [from_us, to_us), as far as they are here, and whether they all are.
  /// What follows is fetched as well, `ahead` slots of it.
  window(fromUs, toUs, ahead = 1) {
    const first = this.slotAt(fromUs), last = this.slotAt(toUs), parts = [];
    this.wanted = [];
    for (let slot = last; slot >= first; --slot) this.wanted.push(slot);
    for (let slot = last + 1; slot <= Math.min(this.last, last + ahead); ++slot) this.wanted.push(slot);
    let complete = true;
    for (let slot = first; slot <= last; ++slot) {
      const events = this.slots.get(slot);
      if (!events) {
        complete = false;
        continue;
      }
      // The newest stand last in the map.
      this.slots.delete(slot);
      this.slots.set(slot, events);
      const begin = this.start(slot);
      parts.push({ events, begin, from: firstNotBefore(events.times, fromUs - begin), to: firstNotBefore(events.times, toUs - begin) });
    }
    this.load();
    return { parts, complete };
  }

  load() {
    for (const slot of this.wanted) {
      if (this.loading.size >= kAtOnce) return;
      if (!this.slots.has(slot) && !this.loading.has(slot)) this.fetch(slot);
    }
  }

  async fetch(slot) {
    this.loading.add(slot);
    const from = this.start(slot), to = Math.min(from + this.recording.slot_us, this.recording.end_us);
    try {
      const buffer = await askBytes(`events?recording=${this.index}&start_us=${from}&end_us=${to}&every=${clipEvery}`);
      const events = unpackEvents(buffer ?? new ArrayBuffer(8));
      this.slots.set(slot, events);
      this.held += events.count;
      this.forget();
    } catch (error) {
      // Not asked for again at every drawing.
      this.slots.set(slot, unpackEvents(new ArrayBuffer(8)));
      this.failed(error);
    }
    this.loading.delete(slot);
    this.load();
    this.changed();
  }

  forget() {
    for (const [slot, events] of this.slots) {
      if (this.held <= kMostHeld || this.slots.size <= 2) return;
      this.slots.delete(slot);
      this.held -= events.count;
    }
  }
}
