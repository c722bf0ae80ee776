// What checks of a page share: what the browser reports, pictures of it, and what a canvas shows.
import { writeFileSync } from "node:fs";
import { join } from "node:path";

/// Errors of the page and the addresses that it asks for, as they come.
export class PageRecord {
  errors = [];
  requests = [];

  constructor(browser) {
    browser.listen((method, params) => this.take(method, params));
  }

  take(method, params) {
    if (method === "Runtime.exceptionThrown") this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type)) this.errors.push(JSON.stringify(params.args));
    if (method === "Log.entryAdded" && params.entry.level === "error") this.errors.push(params.entry.text);
    if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
  }
}

/// A picture of the window, or of the whole page, in `folder`; nothing without one.
export async function keepPicture(browser, folder, name, whole) {
  if (!folder) return;
  const { data } = await browser.send("Page.captureScreenshot", { captureBeyondViewport: whole });
  writeFileSync(join(folder, `${name}.png`), Buffer.from(data, "base64"));
}

/// What a canvas shows, in as many colours as it has: a function in the page.
export const kCanvasColours = `(canvas) => {
  const copy = document.createElement("canvas");
  Object.assign(copy, { width: canvas.width, height: canvas.height });
  const g = copy.getContext("2d", { willReadFrequently: true });
  g.drawImage(canvas, 0, 0);
  return new Set(new Uint32Array(g.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
}`;

/// Elements that stand out of a window of `width` pixels on a phone, and the page's width.
export const kTooWide = (width) => `[document.documentElement.scrollWidth, [...document.querySelectorAll("body *")]
  .filter((e) => e.offsetParent && !e.closest(".scroll, pre") && e.getBoundingClientRect().right > ${width + 1}).map((e) => e.outerHTML.slice(0, 80))]`;
