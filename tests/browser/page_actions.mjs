// What a check does with a page in Chromium.
import assert from "node:assert/strict";

/// Waits until `condition` (of the page) holds.
export async function until(browser, condition, what) {
  const held = await browser.evaluate(`new Promise((resolve) => {
    const end = Date.now() + 20000;
    const look = () => ((${condition}) ? resolve(true) : Date.now() > end ? resolve(false) : setTimeout(look, 20));
    look();
  })`);
  assert.ok(held, what);
}

/// Presses a key on the page.
export const press = (browser, key, more = "") =>
  browser.evaluate(`document.body.dispatchEvent(new KeyboardEvent("keydown", { key: ${JSON.stringify(key)}, bubbles: true, cancelable: true, ${more} })), true`);
/// The text of an element, null where there is none.
export const text = (browser, selector) => browser.evaluate(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? null`);
