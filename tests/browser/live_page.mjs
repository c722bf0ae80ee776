// usage: live_page.mjs CHROMIUM URL FOLDER [PICTURES]
// Opens the page of `saccade view` of a run that is being written, whose path so far lies in FOLDER, writes its path on, and fails
// where the page does not follow it as docs/view.md promises.
import assert from "node:assert/strict";
import { readFileSync, readdirSync, renameSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Chromium } from "./chromium.mjs";
import { press, text, until } from "./page_actions.mjs";
import { PageRecord, keepPicture } from "./page_record.mjs";

const [program, url, folder, pictures] = process.argv.slice(2);
const kStep_s = 0.0123456;  // between the tenths of a millisecond to which times are rounded

const shown = () => readdirSync(folder).filter((name) => name.startsWith("path_so_far.")).sort().at(-1);

/// The run goes on by a pose a little further, as the program writes it; returns its time.
function goOn() {
  const last = shown(), lines = readFileSync(join(folder, last), "utf8").trimEnd().split("\n");
  const pose = lines.at(-1).split(" ").map(Number);
  pose[0] += kStep_s;
  pose[1] += 0.02;
  const next = `path_so_far.${String(Number(last.split(".")[1]) + 1).padStart(8, "0")}.txt`;
  writeFileSync(join(folder, ".path_so_far"), [...lines, pose.join(" ")].join("\n") + "\n");
  renameSync(join(folder, ".path_so_far"), join(folder, next));
  return pose[0];
}

const stands = (time) => `Math.abs(parseFloat(document.querySelector(".time")?.textContent) - ${time}) < 1.01e-4`;

// Before the first of the steps.
const kAtStart = `parseFloat(document.querySelector(".time")?.textContent) < ${kStep_s}`;

const browser = new Chromium(program);
try {
  const { errors } = new PageRecord(browser);
  await browser.newPage();
  await browser.resize(1280, 900);
  await browser.colourScheme("light");
  await browser.open(url);
  await until(browser, `document.documentElement.dataset.ready === "yes"`, "the script did not end");
  assert.match(await text(browser, "#live"), /is being written \(its path up to/);
  for (let i = 0; i < 3; ++i) await until(browser, stands(goOn()), "the page does not go on with the run");
  await until(browser, `document.getElementById("space").dataset.drawn === "yes"`, "the view in 3-D is not drawn");
  await keepPicture(browser, pictures, "live", false);
  await press(browser, "Home");
  await until(browser, kAtStart, "Home does not go to the start");
  const reached = goOn();
  await until(browser, `document.getElementById("live").textContent.includes("${reached.toFixed(3)}")`, "it does not say where the run is");
  assert.ok(await browser.evaluate(kAtStart), "the page goes on although somebody went back");
  await press(browser, "End");
  await until(browser, stands(reached), "End does not go to where the run is");
  await until(browser, stands(goOn()), "after End the page does not follow");
  assert.deepEqual(errors, [], "the console has errors");
} finally {
  await browser.close();
}
