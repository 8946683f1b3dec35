// Elastic drivelines and trains in the studio: the cards that lead, the parts that are drawn.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import * as studio from "./served.mjs";
import { ROOT, shows } from "./served.mjs";

let page, faults, end;

before(async () => {
  ({ page, faults, end } = await studio.served());
});

after(() => end?.());

const open = async (example) => {
  await page.evaluate((given) => globalThis.studio.write(given), readFileSync(`${ROOT}examples/${example}/machine.toml`, "utf8"));
  await studio.complete(page);
};
const cards = () => page.locator(".head dt").allTextContents();
const drawn = () => page.evaluate(() => globalThis.studio.state.views.value.find(({ kind }) => kind === "train")?.discs.map(({ name }) => name));

test("the peak torque of an elastic driveline leads the cards", async () => {
  await open("elastic_coupling_of_carts");
  await shows(cards, (words) => words[0] === "crankshaft: peak torque" && words.includes("verdict"));
  assert.equal(await page.locator(".head dd b").first().textContent(), "2575");
});

test("of the equal planets of a stage one is drawn, and a pendulum hangs on its disc", async () => {
  await open("planetary_stage");
  assert.deepEqual(await drawn(), ["sun", "carrier", "ring", "4 × stage_planet_1"]);
  await open("pendulum_absorber");
  assert.deepEqual(await drawn(), ["crank", "propeller", "weights"]);
  await shows(cards, (words) => words.some((word) => word.includes("weights")));
});

test("there was no error on the console, and no request to elsewhere", () => assert.deepEqual(faults, []));
