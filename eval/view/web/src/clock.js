export const kSpeeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5];

/// The one time of the page [s], which everything is drawn at. With `newest`, the moment that a run in the making has come to, it
/// follows that until somebody goes back, and again from when somebody goes to the end.
export class Clock {
  constructor(start, end) {
    Object.assign(this, { start, end, time: start, speed: 1, playing: false, follows: true, newest: undefined, listeners: [] });
  }

  /// A run has come to `newest`.
  reach(newest) {
    this.newest = newest;
    if (this.follows && !this.playing) this.show(newest);
  }

  /// Calls `listener(clock)` after every change.
  onChange(listener) {
    this.listeners.push(listener);
  }

  changed() {
    for (const listener of this.listeners) listener(this);
  }

  seek(time) {
    this.follows = time >= (this.newest ?? this.end);
    this.show(this.follows ? this.newest ?? time : time);
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
