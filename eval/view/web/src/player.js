import { colour, onTheme } from "../../../report/web/src/theme.js";
import { short } from "../../../report/web/src/number.js";
import { kModes } from "./event_drawing.js";

export const kWindowsMs = [1, 2, 5, 10, 20, 30, 50, 100, 200, 500, 1000];

function element(parent, tag, properties = {}) {
  const made = Object.assign(document.createElement(tag), properties);
  parent.append(made);
  return made;
}

/// What of events is drawn: a mode and a length of time before the time of the page.
export class EventStyle {
  constructor(changed) {
    Object.assign(this, { changed, mode: kModes[0], windowMs: 20 });
  }

  setMode(index) {
    this.mode = kModes[(index + kModes.length) % kModes.length];
    this.changed();
  }

  nextMode() {
    this.setMode(kModes.indexOf(this.mode) + 1);
  }

  shiftWindow(by) {
    const at = kWindowsMs.indexOf(this.windowMs) + by;
    this.windowMs = kWindowsMs[Math.min(kWindowsMs.length - 1, Math.max(0, at))];
    this.changed();
  }
}

// How many events there are at each time, below the slider.
function drawRate(canvas, rate) {
  const width = canvas.width = Math.max(1, canvas.clientWidth), height = canvas.height = Math.max(1, canvas.clientHeight);
  const g = canvas.getContext("2d"), most = Math.max(1, ...rate);
  g.fillStyle = colour("map");
  rate.forEach((count, i) => {
    const left = Math.floor(i * width / rate.length), right = Math.floor((i + 1) * width / rate.length);
    const high = Math.ceil(count / most * height);
    g.fillRect(left, height - high, Math.max(1, right - left), high);
  });
}

/// The controls below the page, which follow the clock and the style.
export class Player {
  constructor(box, clock, style, hasEvents) {
    Object.assign(this, { clock, style });
    box.hidden = false;
    const row = element(box, "div", { className: "controls" });
    const button = (text, label, action) => {
      const made = element(row, "button", { type: "button", textContent: text, title: label });
      made.setAttribute("aria-label", label);
      made.addEventListener("click", action);
      return made;
    };
    this.playing = button("Play", "Play or pause (space)", () => clock.play());
    button("−", "Slower (,)", () => clock.shift(-1));
    this.speed = element(row, "output");
    button("+", "Faster (.)", () => clock.shift(1));
    if (hasEvents) this.addStyle(row, button);
    this.time = element(row, "output", { className: "time" });
    this.line = element(box, "div", { className: "timeline" });
    this.rate = element(this.line, "canvas");
    this.slider = element(this.line, "input", { type: "range", min: 0, max: 1, step: "any", value: 0 });
    this.slider.setAttribute("aria-label", "Time");
    this.slider.addEventListener("input", () => clock.seek(clock.start + this.slider.valueAsNumber * (clock.end - clock.start)));
    clock.onChange(() => this.show());
    this.show();
  }

  addStyle(row, button) {
    this.mode = element(row, "select");
    this.mode.setAttribute("aria-label", "How events are drawn (m)");
    kModes.forEach((mode, i) => element(this.mode, "option", { value: i, textContent: mode.name }));
    this.mode.addEventListener("change", () => this.style.setMode(Number(this.mode.value)));
    button("[", "Shorter window ([)", () => this.style.shiftWindow(-1));
    this.window = element(row, "output");
    button("]", "Longer window (])", () => this.style.shiftWindow(1));
  }

  setRate(rate) {
    const draw = () => drawRate(this.rate, rate);
    onTheme(draw);
    new ResizeObserver(draw).observe(this.rate);
  }

  show() {
    const { clock, style } = this;
    this.playing.textContent = clock.playing ? "Pause" : "Play";
    this.speed.textContent = `${clock.speed}×`;
    this.time.textContent = `${clock.time.toFixed(4)} s`;
    this.slider.value = (clock.time - clock.start) / (clock.end - clock.start);
    this.slider.setAttribute("aria-valuetext", this.time.textContent);
    if (!this.mode) return;
    this.mode.value = kModes.indexOf(style.mode);
    this.window.textContent = `${style.windowMs} ms`;
  }
}
