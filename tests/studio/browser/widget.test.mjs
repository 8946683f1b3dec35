// The widget of a notebook in a browser, with a model in place of Jupyter's.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";
import { ARGS, PATIENCE, ROOT, bounded } from "./served.mjs";


/** The module, and the traits of the two carts. */
const MADE = `
import base64, json, linkwright as lw
from linkwright.studio.widget import module
drawn = lw.widget(lw.read("roller_two_carts"), layers=("velocities", "forces", "centres"), height=300)
names = ("angle", "playing", "layers", "height", "words", "looks")
print(json.dumps({"module": module(), "scene": base64.b64encode(drawn.scene).decode(), "traits": {name: getattr(drawn, name) for name in names}}))
`;

let browser, page;
const faults = [];

before(async () => {
  bounded();
  const made = JSON.parse(execFileSync(`${ROOT}.venv/bin/python`, ["-c", MADE], { encoding: "utf8", timeout: PATIENCE, maxBuffer: 1e9 }));
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGS });
  page = await browser.newPage({ viewport: { width: 700, height: 420 } });
  page.setDefaultTimeout(PATIENCE);
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(error.message));
  await page.setContent('<!doctype html><html lang="en"><title>Notebook</title><body data-jp-theme-light="true"><main id="cell"></main>');
  await page.evaluate(async ({ module, scene, traits }) => {
    const bytes = Uint8Array.from(atob(scene), (letter) => letter.charCodeAt(0));
    const hearers = new Map();
    const model = {
      traits: { ...traits, scene: new DataView(bytes.buffer) },
      saved: 0,
      get: (name) => model.traits[name],
      set(name, value) {
        model.traits[name] = value;
        for (const hear of hearers.get(`change:${name}`) ?? []) hear();
      },
      save_changes: () => (model.saved += 1),
      on: (name, hear) => hearers.set(name, [...(hearers.get(name) ?? []), hear]),
      off: (name, hear) => hearers.set(name, hearers.get(name).filter((each) => each !== hear)),
    };
    const widget = (await import(URL.createObjectURL(new Blob([module], { type: "text/javascript" })))).default;
    Object.assign(globalThis, { model, hearers, end: widget.render({ model, el: document.getElementById("cell") }) });
  }, made);
});

after(() => browser?.close());

const picture = () => page.evaluate(() => document.querySelector("canvas").toDataURL());
const angle = () => page.evaluate(() => globalThis.model.traits.angle);

test("the machine is drawn, and the drawing follows the angle of Python", async () => {
  assert.match(await page.locator("output").textContent(), /φ 0\.0°/);
  const first = await picture();
  assert.ok(first.length > 5000);
  await page.evaluate(() => globalThis.model.set("angle", Math.PI / 2));
  assert.match(await page.locator("output").textContent(), /φ 90\.0°/);
  assert.notEqual(await picture(), first);
});

test("Python hears the angle of the slider, by mouse and by keys", async () => {
  const saved = await page.evaluate(() => globalThis.model.saved);
  await page.getByRole("slider", { name: "Crank angle" }).fill("90");
  assert.ok(Math.abs((await angle()) - Math.PI) < 0.02);
  await page.keyboard.press("ArrowRight");
  assert.ok((await angle()) > Math.PI);
  assert.ok((await page.evaluate(() => globalThis.model.saved)) > saved);
});

test("it plays, pauses, and says where it stopped", async () => {
  const before = await picture();
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction((old) => document.querySelector("canvas").toDataURL() !== old, before);
  await page.getByRole("button", { name: "Pause" }).click();
  const shown = await page.locator("output").textContent();
  assert.ok(Math.abs(Number(/[\d.]+/.exec(shown)[0]) - ((await angle()) * 180) / Math.PI) < 0.06);
});

test("layers and the look of the notebook change the drawing", async () => {
  const first = await picture();
  await page.evaluate(() => globalThis.model.set("layers", []));
  const plain = await picture();
  assert.notEqual(plain, first);
  await page.evaluate(() => {
    document.body.dataset.jpThemeLight = "false";
    globalThis.model.set("height", 280);
  });
  assert.notEqual(await picture(), plain);
});

test("a cell that is removed leaves nothing behind", async () => {
  await page.evaluate(() => globalThis.end());
  assert.deepEqual(await page.evaluate(() => [...globalThis.hearers.values()].flat().length), 0);
  assert.deepEqual(faults, []);
});
