// A rod string in the studio and in its report: the string under the horsehead, cards that follow an entry, a measured card.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import * as studio from "./served.mjs";
import { LINKWRIGHT, PATIENCE, ROOT } from "./served.mjs";

let page, context, folder, faults, end;

before(async () => {
  ({ page, context, folder, faults, end } = await studio.served());
  for (const name of ["measured_well.toml", "measured_well.csv"]) cpSync(`${ROOT}tests/samples/${name}`, `${folder}/${name}`);
  await page.evaluate(() => globalThis.studio.open("folder", "measured_well.toml"));
  await studio.complete(page);
});

after(() => end?.());

const plot = (key) => page.evaluate((wanted) => {
  const found = globalThis.studio.state.results.value.flatMap(({ plots }) => plots).find((each) => each.key === wanted);
  return found && found.curves.map(({ name, values }) => [name, Math.min(...values), Math.max(...values)]);
}, key);
const colours = (selector) => page.locator(selector).evaluate((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const counts = new Map();
  for (let n = 0; n < data.length; n += 4) if (data[n + 3] > 250) counts.set(`${data[n]},${data[n + 1]},${data[n + 2]}`, (counts.get(`${data[n]},${data[n + 1]},${data[n + 2]}`) ?? 0) + 1);
  return counts.size;
});

test("the string hangs under the horsehead, coloured by its stress, and moves", async () => {
  const top = () => page.evaluate(() => {
    const { scene, time } = globalThis.studio.state;
    return [scene.value.parts[0].kind, scene.value.rods.heights.length / scene.value.times.length === scene.value.parts[0].wide.length, time.value];
  });
  assert.deepEqual((await top()).slice(0, 2), ["rods", true]);
  assert.ok(await colours(".stage canvas") > 40);
  const shown = () => page.locator(".stage canvas").evaluate((canvas) => canvas.toDataURL());
  const before = await shown();
  await page.locator("#scrub").fill("60");
  await studio.shows(shown, (now) => now !== before);
});

test("cards are plots: surface, taper and pump, and the measured card over the predicted one", async () => {
  const cards = await plot("cards");
  assert.deepEqual(cards.map(([name]) => name), ["polished rod.m", "polished rod.N", "taper 1.m", "taper 1.N", "pump.m", "pump.N"]);
  const known = await studio.scalar(page, "rod_string.load_max");
  assert.ok(Math.abs(cards[1][2] / known - 1) < 0.01);
  const measured = await plot("measured_cards");
  assert.deepEqual(measured.map(([name]) => name).filter((name) => name.startsWith("predicted")).length, 4);
  for (const key of ["cards", "measured_cards"]) assert.ok(await colours(`[data-plot="${key}"] canvas`) > 3, key);
  assert.equal(await page.locator('section[aria-label="dynamometer cards"] .legend span').count(), 3);
});

test("a card follows an entry, and its picture as SVG has every curve", async () => {
  const before = (await plot("cards"))[5][2];
  const text = await page.evaluate(() => globalThis.studio.state.text.value);
  await page.evaluate((words) => globalThis.studio.write(words), text.replace('plunger = "1.5 in"', 'plunger = "1.75 in"'));
  await studio.known(page);
  // The fluid load is that of the area.
  await studio.shows(async () => (await plot("cards"))[5][2] / before, (ratio) => Math.abs(ratio / (1.75 / 1.5) ** 2 - 1) < 0.01);
  const waits = page.waitForEvent("download");
  await page.locator('section[aria-label="dynamometer cards"] button', { hasText: "SVG" }).click();
  const drawn = readFileSync(await (await waits).path(), "utf8");
  assert.equal(drawn.match(/stroke-width="2"/g).length, 3);
});

test("the report draws the string, which moves", async () => {
  execFileSync(LINKWRIGHT, ["report", "--to", "well.html", "--lang", "uk", "run", "measured_well.toml"], { cwd: folder, timeout: PATIENCE });
  const report = await context.newPage();
  report.on("pageerror", (error) => faults.push(error.message));
  await report.goto(pathToFileURL(`${folder}/well.html`).href);
  const rods = () => report.locator("#sketch .rod").evaluateAll((all) => all.map((one) => one.getAttribute("d")).join());
  const before = await rods();
  await report.locator("#angle").fill("0.4");
  assert.notEqual(await rods(), before);
  assert.match(await report.locator("#sketch").textContent(), /МПа/);
  assert.match(await report.locator("#sketch-words").textContent(), /глибину скорочено/);
  for (const name of ["rod_cards", "goodman", "rod_depth", "measured_cards"]) assert.equal(await report.locator(`#figure-${name} svg`).count(), 1, name);
  await report.close();
});

test("there was no error, and nothing was loaded", () => assert.deepEqual(faults, []));
