// usage: report_page.mjs CHROMIUM PAGE.html [PICTURES]
// Opens a page of `saccade report` in a real browser and fails where it is not what docs/report.md promises. With a folder
// for pictures, what was seen is left there: light, dark, on a phone and on paper.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Chromium } from "./chromium.mjs";
import { PageRecord, kCanvasColours, keepPicture as keep, kTooWide } from "./page_record.mjs";

const [program, page, pictures] = process.argv.slice(2);
const keepPicture = (browser, name, whole) => keep(browser, pictures, name, whole);

async function checkOpening(browser) {
  await browser.open(pathToFileURL(page).href);
  assert.equal(await browser.evaluate("document.documentElement.dataset.ready"), "yes", "the script did not end");
  const ms = await browser.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd");
  console.log(`opened in ${Math.round(ms)} ms`);
}

// A chart far down is drawn when it is scrolled to; of many runs the last one is only unpacked then.
async function checkScrolling(browser) {
  const drawn = await browser.evaluate(`new Promise((resolve) => {
    const end = Date.now() + 20000;
    // Runs that are laid out on the way move it.
    const look = () => {
      const open = [...document.querySelectorAll(".run [data-plot]")].filter((box) => !box.closest("details:not([open])"));
      const run = [...document.querySelectorAll(".run")].at(-1);
      const far = open.filter((box) => run.contains(box)).at(-1) ?? (run.querySelector(".packed") ? null : open.at(-1));
      (far ?? run).scrollIntoView();
      if (far?.dataset.drawn !== "yes" && Date.now() < end) return setTimeout(look, 50);
      scrollTo(0, 0);
      resolve(far ? far.dataset.drawn : "no chart");
    };
    look();
  })`);
  assert.equal(drawn, "yes", "the last run's chart is not drawn when it is scrolled to");
}

// What is left for later when the page opens is there in the end.
async function checkSettled(browser) {
  const hidden = await browser.evaluate(`new Promise((resolve) => {
    const count = () => [...document.querySelectorAll(".run")].filter((run) => getComputedStyle(run).contentVisibility !== "visible").length;
    const end = Date.now() + 20000;
    const look = () => (count() && Date.now() < end ? setTimeout(look, 50) : resolve(count()));
    look();
  })`);
  assert.equal(hidden, 0, "runs are never laid out");
}

async function checkPaper(browser) {
  const { data } = await browser.send("Page.printToPDF", { printBackground: true, preferCSSPageSize: true });
  if (pictures) writeFileSync(join(pictures, "paper.pdf"), Buffer.from(data, "base64"));
}

// Printing has drawn all; what is folded away then is drawn when it is opened.
async function checkDrawings(browser) {
  await browser.evaluate(`document.querySelectorAll("details").forEach((details) => (details.open = true))`);
  await browser.evaluate(`new Promise((resolve) => {
    const missing = () => [...document.querySelectorAll("[data-plot], [data-chart], [data-space]")].some((box) => box.offsetParent && box.dataset.drawn !== "yes");
    const end = Date.now() + 20000;
    const look = () => (missing() && Date.now() < end ? setTimeout(look, 50) : resolve());
    look();
  })`);
  const drawings = await browser.evaluate(`[...document.querySelectorAll("[data-plot], [data-chart], [data-space]")].filter((box) => box.offsetParent)
    .map((box) => ({ name: box.dataset.plot ?? box.dataset.chart ?? box.dataset.space, drawn: box.dataset.drawn,
                     colours: (${kCanvasColours})(box.querySelector("canvas")) }))`);
  for (const kind of ["plot", "chart", "space"])
    assert.ok(await browser.evaluate(`document.querySelector("[data-${kind}]")`), `the page has no [data-${kind}]`);
  for (const { name, drawn, colours } of drawings) assert.ok(drawn === "yes" && colours > 3, `${name} is not drawn (${drawn}, ${colours} colours)`);
  console.log(`${drawings.length} drawings`);
}

// A press on a column's head sorts by it, a second one the other way round; what has no number stays behind.
async function checkSorting(browser) {
  const orders = await browser.evaluate(`[...document.querySelectorAll("table.sortable")].map((table) => {
    const head = table.tHead.rows[0].cells[table.tHead.rows[0].cells.length - 1];
    const order = () => [...table.tBodies[0].rows].map((row) => row.cells[head.cellIndex].dataset.value ?? "");
    return [0, 1].map(() => (head.click(), order()));
  })`);
  assert.ok(orders.length > 0, "the page has no leaderboard");
  assert.ok(orders.some(([up]) => up.filter(Boolean).length > 1), "nothing to sort");
  for (const [up, down] of orders) {
    const numbers = up.filter(Boolean).map(Number), rest = up.slice(numbers.length);
    assert.deepEqual(rest.filter(Boolean), [], "a row without a number stands before one with");
    assert.deepEqual(numbers, numbers.toSorted((a, b) => a - b));
    assert.deepEqual(down.slice(0, numbers.length).map(Number), numbers.toReversed());
  }
  console.log(`${orders.length} tables sorted`);
}

// Every button of a kind is pressed; the files it offers are kept from being saved and looked into.
async function checkDownloads(browser) {
  const files = await browser.evaluate(`(async () => {
    const blobs = [];
    const real = URL.createObjectURL;
    URL.createObjectURL = (blob) => (blobs.push(blob), real(blob));
    HTMLAnchorElement.prototype.click = () => {};
    document.querySelectorAll(".tools button").forEach((button) => /^(SVG|CSV|LaTeX)$/.test(button.textContent) && button.offsetParent && button.click());
    URL.createObjectURL = real;
    delete HTMLAnchorElement.prototype.click;
    return Promise.all(blobs.map(async (blob) => {
      const text = await blob.text();
      const broken = blob.type.includes("svg") && new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror");
      return { type: blob.type, size: text.length, broken: Boolean(broken) || /NaN|undefined/.test(text) };
    }));
  })()`);
  assert.ok(files.length > 0, "nothing can be downloaded");
  for (const file of files) assert.ok(file.size > 40 && !file.broken, `a file of ${file.type} is broken`);
  console.log(`${files.length} files offered`);
}

async function checkPhone(browser) {
  await browser.resize(360, 740);
  const wide = await browser.evaluate(kTooWide(360));
  assert.ok(wide[0] <= 360, `on a phone the page is ${wide[0]} px wide: ${wide[1].slice(0, 3)}`);
  await keepPicture(browser, "phone", true);
  await browser.resize(1280, 900);
}

async function checkColours(browser) {
  const ground = () => browser.evaluate("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]");
  assert.ok(await ground() > 200, "light is not light");
  await keepPicture(browser, "light", true);
  await browser.colourScheme("dark");
  assert.ok(await ground() < 60, "dark is not dark");
  await keepPicture(browser, "dark", true);
  await browser.evaluate("document.getElementById('theme').click()");
  assert.ok(await ground() > 200, "the switch does nothing");
  await browser.colourScheme("light");
}

const browser = new Chromium(program);
try {
  const { errors, requests } = new PageRecord(browser);
  await browser.newPage();
  await browser.resize(1280, 900);
  await browser.colourScheme("light");
  await checkOpening(browser);
  await keepPicture(browser, "top", false);
  await checkScrolling(browser);
  await checkPaper(browser);
  await checkSettled(browser);
  await checkDrawings(browser);
  await checkSorting(browser);
  await checkDownloads(browser);
  await checkColours(browser);
  await checkPhone(browser);
  assert.deepEqual(errors, [], "the console has errors");
  assert.deepEqual(requests.filter((url) => !/^(file|data|blob|about):/.test(url)), [], "the page asks the network");
} finally {
  await browser.close();
}
