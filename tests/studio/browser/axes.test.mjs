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
  await shows(() => scalar("axis.dial.torque_max"), (held) => Math.abs(Math.abs(held / before) - (120 / 180) ** 2) < 1e-6);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await studio.known(page);
  assert.equal(await text(), PACKAGING);
  await drag(60);
  await page.mouse.up();
  await studio.known(page);
  assert.match(await text(), /angle = "180 deg", swing = "60 deg"/);
  near(Math.abs((await scalar("axis.dial.torque_max")) / before), (120 / 180) ** 2);
  await page.keyboard.press("Control+z");
  await studio.known(page);
  assert.equal(await text(), PACKAGING);
});

test("arrow keys and an exact angle move the end of a cam's section; the next gives what it takes", async () => {
  await write(PACKAGING);
  const handle = page.getByRole("button", { name: "End of section 1 of pusher" });
  await handle.focus();
  await page.keyboard.press("ArrowRight");
  await studio.known(page);
  assert.match(await text(), /angle = "81 deg".*\n.*angle = "19 deg"/);
  // It begins at 120°.
  await page.locator("#end").fill("205.5");
  await page.locator("#end").press("Enter");
  await studio.known(page);
  assert.match(await text(), /angle = "85.5 deg".*\n.*angle = "14.5 deg"/);
  await page.getByRole("button", { name: "Start of the sections of pusher" }).focus();
  await page.keyboard.press("Shift+ArrowLeft");
  await studio.known(page);
  assert.match(await text(), /phase = "110 deg"/);
  assert.deepEqual(faults, []);
});

test("an axis and its motor are added to a crank; rms torque of the motor and peak of the bus stand at the head, the loop among the diagrams", async () => {
  await write('format = 1\nname = "Carriage"\n[mechanism.cranks.A]\nradius = "120 mm"\n[mechanism.sliders.S]\ncrank = "A"\nrod = "400 mm"\n[bodies.S]\nmass = "12 kg"\n');
  await page.getByText("Add an element").click();
  await page.locator('[data-kind="axes"]').click();
  await studio.known(page);
  await page.locator('[data-kind="servo motor"]').click();
  await studio.complete(page);
  assert.match(await text(), /\[axes\.A\.motor\]/);
  for (const name of ["Servo axes", "DC bus", "Timing diagram"]) await page.locator(".chip.ready", { hasText: name }).waitFor();
  await shows(() => page.locator(".head [data-name]").evaluateAll((all) => all.map((each) => each.dataset.name)), (names) => ["torque_rms", "torque_peak", "power_max"].every((name) => names.includes(name)));
  await page.getByRole("tab", { name: "Diagrams" }).click();
  await page.getByRole("heading", { name: "Axis A: torque over speed" }).waitFor();
  await page.getByRole("tab", { name: "Plots" }).click();
});

test("a driving cylinder is drawn with its boom, and a passive one beside it; force and pressure are told", async () => {
  await write('format = 1\nname = "Boom"\n[loads.weight]\nkind = "gravity"\n');
  await page.getByText("Add an element").waitFor();
  await page.locator("#draw-driving").click();
  const box = await page.locator(".stage canvas").boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  const draw = async (from, to) => {
    await page.mouse.move(...at(...from));
    await page.mouse.down();
    await page.mouse.move(...at(...to), { steps: 3 });
    await page.mouse.up();
    await studio.known(page);
  };
  await draw([0.6, 0.8], [0.7, 0.3]);
  await page.getByText("has one link: draw a second from it").waitFor();
  await page.locator("#draw").click();
  await draw([0.7, 0.3], [0.35, 0.7]);
  await shows(text, (now) => /\[mechanism\.cylinders\.Z1\]/.test(now) && /\[mechanism\.bars\.B1\]/.test(now));
  await page.locator("#draw-passive").click();
  await draw([0.85, 0.8], [0.7, 0.3]);
  await shows(text, (now) => /damping = "1000 N s\/m"/.test(now));
  await page.locator("#draw-passive").click();
  await studio.complete(page);
  // Its joint is dragged; the cylinder's length follows.
  const before = await text();
  const [x, y] = await studio.grip(page, "J1");
  await page.mouse.move(x + 15, y - 10, { steps: 3 });
  await page.mouse.up();
  await studio.known(page);
  const length = (words) => /start_length = "([\d.]+)/.exec(words)[1];
  assert.notEqual(length(await text()), length(before));
  await studio.complete(page);
  await page.locator(".chip.ready", { hasText: "Cylinders" }).waitFor();
  assert.ok(Number.isFinite(await scalar("cylinder.Z1.force_max")));
  assert.deepEqual(faults, []);
});
