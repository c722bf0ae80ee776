// usage: site_page.mjs CHROMIUM SITE [PICTURES]
// Opens a site of reports as files, as a person would, and fails where it is not what docs/report.md promises: the index finds
// runs, methods have trends, a run's page draws its charts.
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Chromium } from "./chromium.mjs";
import { PageRecord, keepPicture as keep, kTooWide } from "./page_record.mjs";

const [program, site, pictures] = process.argv.slice(2);
const keepPicture = (browser, name) => keep(browser, pictures, name, true);
const open = (browser, ...path) => browser.open(pathToFileURL(join(site, ...path)).href);

const waitFor = (browser, what) => browser.evaluate(`new Promise((resolve) => {
  const end = Date.now() + 20000;
  const look = () => ((${what}) || Date.now() > end ? resolve(Boolean(${what})) : setTimeout(look, 50));
  look();
})`);

const type = (browser, text) => browser.evaluate(`(() => {
  const field = document.getElementById("search");
  field.value = ${JSON.stringify(text)};
  field.dispatchEvent(new Event("input"));
})()`);

async function checkIndex(browser) {
  await open(browser, "index.html");
  assert.ok(await waitFor(browser, `document.documentElement.dataset.ready === "yes"`), "the script did not end");
  await keepPicture(browser, "index");
  await type(browser, "seed-3 second");
  assert.ok(await waitFor(browser, `document.documentElement.dataset.searched === "seed-3 second"`), "the search did not end");
  const found = await browser.evaluate(`[...document.querySelectorAll("#found a")].map((link) => link.textContent)`);
  assert.equal(found.length, 1, `found ${found}`);
  assert.match(found[0], /seed-3.*Second/);
  const rows = await browser.evaluate(`[...document.querySelectorAll("#reports tbody tr")].filter((row) => !row.hidden).length`);
  assert.equal(rows, 0, "rows that do not hold what is searched are shown");
  await keepPicture(browser, "found");
  await type(browser, "");
  assert.ok(await waitFor(browser, `!document.querySelector("#found a") && ![...document.querySelectorAll("tbody tr")].some((row) => row.hidden)`), "an empty search hides rows");
}

const follow = async (browser, selector) => open(browser, await browser.evaluate(
  `decodeURIComponent(document.querySelector(${JSON.stringify(selector)}).href).split("/site/").at(-1)`));

async function checkCharts(browser, name, boxes) {
  assert.ok(await waitFor(browser, `document.documentElement.dataset.ready === "yes"`), `${name}: the script did not end`);
  assert.ok(await browser.evaluate(`document.querySelectorAll(${JSON.stringify(boxes)}).length`), `${name} has no ${boxes}`);
  await browser.evaluate(`[...document.querySelectorAll(${JSON.stringify(boxes)})].find((box) => !box.closest("details:not([open])")).scrollIntoView()`);
  assert.ok(await waitFor(browser, `[...document.querySelectorAll(${JSON.stringify(boxes)})].filter((box) => box.offsetParent).some((box) => box.dataset.drawn === "yes")`), `${name} draws nothing`);
  await keepPicture(browser, name);
  await browser.resize(360, 740);
  await waitFor(browser, "document.documentElement.scrollWidth <= 360");  // charts follow a moment later
  const wide = await browser.evaluate(kTooWide(360));
  assert.ok(wide[0] <= 360, `on a phone ${name} is ${wide[0]} px wide: ${wide[1].slice(0, 3)}`);
  await browser.resize(1280, 900);
}

const browser = new Chromium(program);
try {
  const { errors, requests } = new PageRecord(browser);
  await browser.newPage();
  await browser.resize(1280, 900);
  await browser.colourScheme("light");
  await checkIndex(browser);
  await follow(browser, "#methods tbody a");
  await checkCharts(browser, "method", "[data-chart]");
  await open(browser, "index.html");
  await follow(browser, "#reports tbody a");
  await checkCharts(browser, "report", "[data-chart]");
  await follow(browser, "nav a[href^='runs/']");
  await checkCharts(browser, "run", "[data-plot]");
  assert.deepEqual(errors, [], "the console has errors");
  assert.deepEqual(requests.filter((url) => !/^(file|data|blob|about):/.test(url)), [], "the site asks the network");
} finally {
  await browser.close();
}
