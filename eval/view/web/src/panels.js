import { ask } from "./data.js";
import { drawEvents } from "./event_drawing.js";
import { firstNotBefore } from "./event_store.js";
import { short } from "../../../report/web/src/number.js";

const kMostPictures = 80;

/// A figure with a canvas of the sensor's size and a caption.
export class Panel {
  constructor(parent, name, width, height) {
    this.name = name;
    this.figure = document.createElement("figure");
    this.figure.className = "panel";
    this.canvas = Object.assign(document.createElement("canvas"), { width, height });
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", name);
    this.caption = document.createElement("figcaption");
    this.caption.textContent = name;
    this.figure.append(this.canvas, this.caption);
    parent.append(this.figure);
    this.g = this.canvas.getContext("2d");
  }

  say(text) {
    const whole = `${this.name}: ${text}`;
    if (this.caption.textContent !== whole) this.caption.textContent = whole;
  }
}

export class EventPanel extends Panel {
  constructor(parent, recording, store) {
    super(parent, "events", recording.width, recording.height);
    this.store = store;
    this.picture = this.g.createImageData(recording.width, recording.height);
    this.scratch = new Float64Array(recording.width * recording.height);
  }

  /// The events of the last `windowUs` before `us`.
  draw(us, windowUs, mode) {
    const from = Math.round(us - windowUs), to = Math.round(us) + 1;
    const { parts, complete } = this.store.window(from, to);
    const count = drawEvents(mode, parts, this.picture, this.scratch, from, to);
    this.g.putImageData(this.picture, 0, 0);
    const stride = Math.max(1, ...parts.map((part) => part.events.stride));
    this.say(`${complete ? "" : "loading, "}${count.toLocaleString("en")} in ${windowUs / 1000} ms${stride > 1 ? `, 1 of ${stride} drawn` : ""}`);
    this.figure.dataset.complete = complete ? "yes" : "no";
    this.figure.dataset.us = to - 1;
  }
}

/// Pictures that stand at times: the latest one at the time of the page is shown. `list`: {t, id}; `target(id)` is what one is
/// asked for by.
export class PicturePanel extends Panel {
  constructor(parent, name, recording, list, target, { failed, note = "" }) {
    super(parent, name, recording.width, recording.height);
    Object.assign(this, { list, target, failed, note, pictures: new Map(), loading: new Set(), shown: -1 });
  }

  draw(us) {
    const t = us / 1e6;
    // Rounded times of pictures may lie behind the event that is as old.
    const at = Math.max(0, firstNotBefore(this.list.t, t + 1e-4) - 1);
    this.figure.dataset.wanted = at;
    if (at !== this.shown) this.show(at);
    if (at + 1 < this.list.t.length) this.load(at + 1);
  }

  show(at) {
    const picture = this.load(at);
    if (!picture) return;
    this.shown = at;
    if (this.canvas.width !== picture.width || this.canvas.height !== picture.height)
      Object.assign(this.canvas, { width: picture.width, height: picture.height });
    this.g.drawImage(picture, 0, 0);
    this.say(`${short(this.list.t[at], 4)} s${this.note}`);
    this.figure.dataset.shown = at;
  }

  load(at) {
    const picture = this.pictures.get(at);
    if (picture || this.loading.has(at) || this.loading.size > 2) return picture;
    this.loading.add(at);
    ask(this.target(this.list.id[at]))
      .then((answer) => answer && createImageBitmap(answer))
      .then((bitmap) => {
        if (bitmap) this.pictures.set(at, bitmap);
        if (this.pictures.size > kMostPictures) this.pictures.delete(this.pictures.keys().next().value);
      }, this.failed)
      .finally(() => {
        this.loading.delete(at);
        this.arrived?.();
      });
    return undefined;
  }
}
