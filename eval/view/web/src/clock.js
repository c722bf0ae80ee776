export const kSpeeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5];

/// The one time of the page [s], which everything is drawn at. While a run is being written it follows where that is, until
/// somebody plays or goes to another moment, and again from toEnd() on.
export class Clock {
  constructor(start, end) {
    Object.assign(this, { start, end, time: start, speed: 1, playing: false, follows: true, newest: undefined, listeners: [] });
  }

  /// A run that is being written has come to `newest`.
  reach(newest) {
    this.newest = newest;
    if (this.follows) this.show(newest);
  }

  /// Calls `listener(clock)` after every change.
  onChange(listener) {
    this.listeners.push(listener);
  }

  changed() {
    for (const listener of this.listeners) listener(this);
  }

  seek(time) {
    this.follows = false;
    this.show(time);
  }

  /// To the last moment; of a run that is being written to where it is.
  toEnd() {
    this.follows = true;
    this.playing = false;
    this.show(this.newest ?? this.end);
  }

  show(time) {
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.changed();
  }

  play(playing = !this.playing) {
    if (playing === this.playing) return;
    if (playing && this.time >= this.end) this.time = this.start;
    this.playing = playing;
    this.follows = false;
    this.changed();
    if (!playing) return;
    let before = null;
    const tick = (now) => {
      if (!this.playing) return;
      // A tab that was hidden goes on where it was.
      const passed = before === null ? 0 : Math.min(0.25, (now - before) / 1000);
      before = now;
      this.time = Math.min(this.end, this.time + passed * this.speed);
      this.playing = this.time < this.end;
      this.changed();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /// The next speed of the list, up or down.
  shift(by) {
    const at = kSpeeds.indexOf(this.speed) + by;
    this.speed = kSpeeds[Math.min(kSpeeds.length - 1, Math.max(0, at))];
    this.changed();
  }
}
