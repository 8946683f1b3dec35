// Servo axes and cylinders in the studio: the timing diagram with its handles, what follows them, what is added.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import * as studio from "./served.mjs";
import { near, shows } from "./served.mjs";

let page, faults, end;

before(async () => {
  ({ page, faults, end } = await studio.served());
});

after(() => end?.());

const PACKAGING = `format = 1
name = "Packaging machine"
[master]
speed = "120 rpm"
[axes.dial]
sections = [{ angle = "120 deg", swing = "60 deg", law = "cycloidal" }]
advance = "60 deg"
[axes.shaft]
driver = "pusher"
[mechanism.cranks.dial]
radius = "200 mm"
[mechanism.cams.pusher]
closure = "groove"
base_radius = "60 mm"
roller_radius = "12 mm"
phase = "120 deg"
sections = [
  { angle = "80 deg", lift = "70 mm", law = "modified_sine" },
  { angle = "20 deg" },
  { angle = "100 deg", lift = "-70 mm", law = "modified_sine" },
  { angle = "160 deg" },
]
[bodies]
dial = { inertia = "0.8 kg m^2" }
pusher = { mass = "3 kg" }
`;

const text = () => page.evaluate(() => globalThis.studio.state.text.value);
const write = async (words) => {
  await page.evaluate((given) => globalThis.studio.write(given), words);
  await studio.known(page);
};
const scalar = (name) => studio.scalar(page, name);

test("the end of an index step is dragged: its section, the torque of its motor and the diagram follow; Escape gives it back", async () => {
  await write(PACKAGING);
  await page.getByRole("button", { name: "Timing diagram" }).click();
  const handle = page.getByRole("button", { name: "End of section 1 of dial" });
  const before = await scalar("axis.dial.torque_max");
  const drag = async (by) => {
    const box = await handle.boundingBox();
    const width = await page.evaluate(() => document.querySelector(".timing").clientWidth - 88);
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + (width * by) / 720, y);
    await page.mouse.move(x + (width * by) / 360, y);
    await studio.known(page);
  };
  await drag(60);
  // Held: the file is as it was, the torque falls with the square of the time.
  assert.equal(await text(), PACKAGING);
  await shows(() => scalar("axis.dial.torque_max"), (held) => Math.abs(held / before - (120 / 180) ** 2) < 1e-6);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await studio.known(page);
  assert.equal(await text(), PACKAGING);
  await drag(60);
  await page.mouse.up();
  await studio.known(page);
  assert.match(await text(), /angle = "180 deg", swing = "60 deg"/);
  near((await scalar("axis.dial.torque_max")) / before, (120 / 180) ** 2);
  await page.keyboard.press("Control+z");
  await studio.known(page);
  assert.equal(await text(), PACKAGING);
});

test("arrow keys and an exact angle move the end of a cam's section; the next gives what it takes", async () => {
  await write(PACKAGING);
  const handle = page.getByRole("button", { name: "End of section 1 of shaft" });
  await handle.focus();
  await page.keyboard.press("ArrowRight");
  await studio.known(page);
  assert.match(await text(), /angle = "81 deg".*\n.*angle = "19 deg"/);
  // It begins at 120°.
  await page.locator("#end").fill("205.5");
  await page.locator("#end").press("Enter");
  await studio.known(page);
  assert.match(await text(), /angle = "85.5 deg".*\n.*angle = "14.5 deg"/);
  await page.getByRole("button", { name: "Start of the sections of shaft" }).focus();
  await page.keyboard.press("Shift+ArrowLeft");
  await studio.known(page);
  assert.match(await text(), /phase = "110 deg"/);
  assert.deepEqual(faults, []);
});
