// usage: view_page.mjs CHROMIUM URL [PICTURES]
// Opens the page of `saccade view`, served or exported, in a real browser and fails where it is not what docs/view.md promises.
// With a folder for pictures, what was seen is left there.
import assert from "node:assert/strict";
import { Chromium } from "./chromium.mjs";
import { press, text, until } from "./page_actions.mjs";
import { PageRecord, kCanvasColours, keepPicture, kTooWide } from "./page_record.mjs";

const [program, url, pictures] = process.argv.slice(2);

const timeOf = async (browser) => parseFloat(await text(browser, ".time"));
const eventsDrawn = `document.querySelector(".panel[data-complete]").dataset.complete === "yes"`;

async function seek(browser, fraction) {
  await browser.evaluate(`(() => {
    const slider = document.querySelector(".timeline input");
    slider.value = ${fraction};
    slider.dispatchEvent(new Event("input"));
  })()`);
}

async function checkOpening(browser) {
  await browser.open(url);
  await until(browser, `document.documentElement.dataset.ready === "yes"`, "the script did not end");
  assert.equal(await browser.evaluate(`document.getElementById("problem").hidden`), true, await text(browser, "#problem"));
  console.log(await text(browser, "#facts"));
}

async function checkPictures(browser) {
  await seek(browser, 0.5);
  await browser.evaluate("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))");
  await until(browser, eventsDrawn, "the events do not arrive");
  await until(browser, `[...document.querySelectorAll(".panel:not([data-complete])")].every((panel) => panel.dataset.shown === panel.dataset.wanted)`, "a picture does not arrive");
  const panels = await browser.evaluate(`[...document.querySelectorAll(".panel")].map((panel) => ({
    name: panel.querySelector("figcaption").textContent, colours: (${kCanvasColours})(panel.querySelector("canvas")) }))`);
  for (const { name, colours } of panels) assert.ok(colours > 2, `${name} shows ${colours} colours`);
  console.log(panels.map(({ name }) => name).join("\n"));
}

// Each way to draw events shows something else.
async function checkModes(browser) {
  const shots = new Set();
  for (const key of ["1", "2", "3"]) {
    await press(browser, key);
    await browser.evaluate("new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)))");
    shots.add(await browser.evaluate(`document.querySelector(".panel canvas").toDataURL()`));
    await keepPicture(browser, pictures, `mode_${key}`, false);
  }
  assert.equal(shots.size, 3, "modes look alike");
  await press(browser, "1");
}

async function checkKeys(browser) {
  await press(browser, "Home");
  const first = await timeOf(browser);
  await press(browser, "ArrowRight");
  const second = await timeOf(browser);
  assert.ok(second > first, "the arrow does not step");
  await press(browser, "ArrowRight", "shiftKey: true");
  assert.ok(await timeOf(browser) - second > 5 * (second - first), "Shift does not step further");
  await press(browser, ",");
  const slow = parseFloat(await text(browser, ".controls output"));
  assert.equal(slow, 0.5, "the comma does not slow down");
  // As slow as it gets, so that on a busy machine it does not come to the end before it is paused.
  for (let i = 0; i < 5; ++i) await press(browser, ",");
  const third = await timeOf(browser);
  await press(browser, " ");
  await until(browser, `parseFloat(document.querySelector(".time").textContent) > ${third}`, "it does not play");
  await press(browser, " ");
  const paused = await timeOf(browser);
  await browser.evaluate("new Promise((resolve) => setTimeout(resolve, 100))");
  assert.equal(await timeOf(browser), paused, "it does not pause");
  await press(browser, "?");
  assert.ok(await browser.evaluate(`document.getElementById("keys").open`), "? shows no keys");
  await keepPicture(browser, pictures, "keys", false);
  await press(browser, "?");
  assert.ok(!await browser.evaluate(`document.getElementById("keys").open`), "? hides no keys");
}

// The time of the page stands in every chart, and a click into one moves it.
async function checkDrawings(browser) {
  const count = await browser.evaluate(`document.querySelectorAll("#charts > div").length`);
  if (!count) return console.log("no errors over time");
  await browser.evaluate(`document.getElementById("charts").scrollIntoView({ behavior: "instant" })`);
  await until(browser, `[...document.querySelectorAll("#charts > div")].every((box) => box.dataset.drawn === "yes" && box.querySelector(".now"))`, "a chart is not drawn");
  await press(browser, "Home");
  const before = await timeOf(browser);
  await until(browser, `document.querySelector("#charts .u-over").getBoundingClientRect().top < 700`, "the charts are not scrolled to");
  const [x, y] = await browser.evaluate(`(() => {
    const box = document.querySelector("#charts .u-over").getBoundingClientRect();
    return [box.left + box.width * 0.9, box.top + 20];
  })()`);
  for (const type of ["mouseMoved", "mousePressed", "mouseReleased"])
    await browser.send("Input.dispatchMouseEvent", { type, x, y, button: type === "mouseMoved" ? "none" : "left", clickCount: 1 });
  assert.ok(await timeOf(browser) > before + 0.01, "a click into a chart does not move the time");
  await browser.evaluate('scrollTo({ top: 0, behavior: "instant" })');
  console.log(`${count} charts`);
}

async function checkSpace(browser) {
  if (await browser.evaluate(`document.getElementById("space").hidden`)) return console.log("nothing in 3-D");
  await browser.evaluate(`document.getElementById("space").scrollIntoView({ behavior: "instant" })`);
  await until(browser, `document.getElementById("space").dataset.drawn === "yes"`, "the view in 3-D is not drawn");
  const colours = await browser.evaluate(`(${kCanvasColours})(document.querySelector("#space canvas"))`);
  assert.ok(colours > 3, `the view in 3-D shows ${colours} colours`);
  await browser.evaluate('scrollTo({ top: 0, behavior: "instant" })');
}

async function checkPhone(browser) {
  await browser.resize(360, 740);
  // Charts follow with the next drawing.
  await until(browser, "document.documentElement.scrollWidth <= 360", "on a phone the page is too wide");
  const [, wide] = await browser.evaluate(kTooWide(360));
  assert.deepEqual(wide, [], "something stands out on a phone");
  await keepPicture(browser, pictures, "phone", true);
  await browser.resize(1280, 900);
}

const browser = new Chromium(program);
try {
  const { errors, requests } = new PageRecord(browser);
  await browser.newPage();
  await browser.resize(1280, 900);
  await browser.colourScheme("light");
  await checkOpening(browser);
  await checkPictures(browser);
  await keepPicture(browser, pictures, "light", true);
  await checkModes(browser);
  await checkKeys(browser);
  await checkDrawings(browser);
  await checkSpace(browser);
  await checkPhone(browser);
  await browser.colourScheme("dark");
  await keepPicture(browser, pictures, "dark", true);
  assert.deepEqual(errors, [], "the console has errors");
  const origin = new URL(url).origin;
  assert.deepEqual(requests.filter((asked) => !/^(file|data|blob|about):/.test(asked) && new URL(asked).origin !== origin), [], "the page asks elsewhere");
} finally {
  await browser.close();
}
