// The studio in a browser: one Chromium, one server, below a copy of the repository's machines.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { after, before, test } from "node:test";
import * as studio from "./served.mjs";
import { LINKWRIGHT, PATIENCE, ROOT, near, shows } from "./served.mjs";

const AXE = readFileSync(`${ROOT}node_modules/axe-core/axe.min.js`, "utf8");
const RADIUS = "mechanism.cranks.A1.radius";
const PHASE = "mechanism.cranks.A2.phase";

let folder, page, address, origin, browser, context, faults, end;

before(async () => {
  ({ folder, page, address, origin, browser, context, faults, end } = await studio.served({ examples: true }));
});

after(() => end?.());

const known = () => studio.known(page);
const scalar = (name) => studio.scalar(page, name);
const handle = (point) => studio.handle(page, point);
const grip = (point) => studio.grip(page, point);
const cli = (...words) => JSON.parse(execFileSync(LINKWRIGHT, ["run", "carts.toml", "--json", ...words], { cwd: folder, encoding: "utf8", timeout: PATIENCE })).results;

test("the address loses its key in the page, and opens again until the studio ends", async () => {
  assert.ok(!page.url().includes("key="));
  const again = await studio.opened(context, address, faults);
  assert.match(await again.locator("h1").textContent(), /two carts/);
  await again.reload();
  await studio.known(again);
  await again.close();
  // A link without a key opens where the browser has it.
  const bare = await studio.opened(context, `${origin}/#open=library/v8_diesel`, faults);
  assert.match(await bare.locator("h1").textContent(), /V-8/);
  await bare.close();
});

test("another port, or another browser, has no key and learns nothing", async () => {
  assert.deepEqual(await context.cookies(), []);
  assert.equal((await fetch(`${origin}/texts/uk.json`)).status, 403);
  const other = createServer((_, answer) => answer.setHeader("content-type", "text/html").end("<title>other</title>")).listen(0, "127.0.0.1");
  await new Promise((resolve) => other.once("listening", resolve));
  const stranger = await context.newPage();
  await stranger.goto(`http://127.0.0.1:${other.address().port}/`);
  const tried = await stranger.evaluate(async (at) => {
    const socket = await new Promise((resolve) => {
      const own = new WebSocket(`${at.replace("http", "ws")}/socket`);
      own.onopen = () => resolve("open");
      own.onerror = () => resolve("refused");
    });
    const texts = await fetch(`${at}/texts/uk.json`, { credentials: "include" }).then(({ status }) => status, () => "refused");
    return { socket, texts, kept: localStorage.getItem("key") };
  }, origin);
  assert.deepEqual(tried, { socket: "refused", texts: "refused", kept: null });
  await stranger.close();
  other.close();
  const without = await (await browser.newContext()).newPage();
  await without.goto(`${origin}/#open=library/v8_diesel`);
  await without.getByRole("alert").getByText("This page has no key to the studio").waitFor();
  assert.equal(await without.locator("h1").textContent(), "Linkwright studio");
  await without.close();
});

test("nothing moves by itself where less motion is wanted; play, pause, step and scrub do", async () => {
  const time = () => page.evaluate(() => globalThis.studio.state.time.value);
  assert.equal(await page.evaluate(() => globalThis.studio.state.playing.value), false);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(() => globalThis.studio.state.time.value > 0);
  await page.getByRole("button", { name: "Pause" }).click();
  const at = await time();
  await page.getByRole("button", { name: "One step on" }).click();
  assert.notEqual(await time(), at);
  await page.locator("#scrub").fill("45");
  await shows(() => page.locator("#instant").textContent(), (words) => /φ\s+90\.0°/.test(words));
});

test("a slider changes the number as the command line does, and one undo takes the gesture back", async () => {
  const text = await page.evaluate(() => globalThis.studio.state.text.value);
  const slider = page.locator(`[data-slider="${RADIUS}"]`);
  const box = await slider.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  for (const x of [0.52, 0.55, 0.6]) await page.mouse.move(box.x + box.width * x, box.y + box.height / 2);
  await page.mouse.up();
  await known();
  const radius = /\[mechanism\.cranks\.A1\]\nradius = "([\d.]+) m"/.exec(await page.evaluate(() => globalThis.studio.state.text.value))[1];
  assert.ok(Number(radius) > 0.21);
  const wanted = cli("--set", `${RADIUS}=${radius} m`);
  near(await scalar("steady_state.unevenness"), wanted.steady_state.unevenness);
  await page.keyboard.press("Control+z");
  await known();
  assert.equal(await page.evaluate(() => globalThis.studio.state.text.value), text);
  await shows(() => page.getByRole("button", { name: "Undo" }).isDisabled(), Boolean);
});

test("a joint drags, its lengths follow, Escape gives the pose back, release outside ends it", async () => {
  const text = await page.evaluate(() => globalThis.studio.state.text.value);
  const [x, y] = await grip("A2");
  await page.mouse.move(x + 20, y - 20, { steps: 4 });
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await known();
  assert.equal(await page.evaluate(() => globalThis.studio.state.text.value), text);
  assert.deepEqual(await grip("A2"), [x, y]);
  await page.mouse.move(x + 12, y - 25, { steps: 4 });
  await page.mouse.up();
  await known();
  const changed = await page.evaluate(() => globalThis.studio.state.text.value);
  assert.notEqual(changed, text);
  await shows(() => handle("A2"), ([X, Y]) => Math.hypot(X - x - 12, Y - y + 25) < 2);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => !globalThis.studio.state.unsaved.value);
  assert.equal(readFileSync(`${folder}/carts.toml`, "utf8"), changed);
  near(await scalar("steady_state.unevenness"), cli().steady_state.unevenness);
});

test("a drag stops where the linkage no longer closes, and says why", async () => {
  await page.locator("#scrub").fill("20");
  const [x, y] = await grip("cart1");
  await page.mouse.move(x - 330, y, { steps: 3 });
  await page.waitForFunction(() => /closes only/.test(document.querySelector(".reason")?.textContent ?? ""));
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await known();
});

/** The drawing as it stands on the page. */
const drawn = () => page.evaluate(() => document.querySelector(".stage canvas").toDataURL());

test("the ghost of the pose at the limit stands with its reason where a drag stops", async () => {
  const [x, y] = await grip("cart1");
  await page.mouse.move(x - 330, y, { steps: 3 });
  await page.waitForFunction(() => globalThis.studio.state.limit.value !== null && !globalThis.studio.busy());
  const angle = await page.evaluate(() => globalThis.studio.state.limit.value);
  // The rod that is as long as the crank stands still over the frame where the crank passes the guide.
  assert.ok(Math.min(Math.abs(angle - Math.PI / 2), Math.abs(angle - 1.5 * Math.PI)) < 0.2, `${angle}`);
  const ghost = await drawn();
  await page.evaluate(() => (globalThis.studio.state.limit.value = null) ?? (globalThis.studio.state.layers.value = { ...globalThis.studio.state.layers.value }));
  await shows(drawn, (now) => now !== ghost);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await known();
});

test("any point leaves a trail", async () => {
  const before = await drawn();
  await page.locator("#trails").selectOption("A1");
  await shows(drawn, (now) => now !== before);
  await page.locator("#trails").selectOption("A1");
  await shows(drawn, (now) => now === before);
});

test("hodographs are drawn, and a click moves the machine there", async () => {
  await page.locator(".watch select").selectOption("cart1");
  const panel = page.locator('.panel:has([data-plot="hodograph.shaking_force"])');
  await panel.scrollIntoViewIfNeeded();
  const canvas = panel.locator("canvas");
  const { width } = await canvas.boundingBox();
  const time = () => page.evaluate(() => globalThis.studio.state.time.value);
  const before = await time();
  // The shaking force of two carts at a right angle runs along the guide; the weights hold it below the middle.
  await shows(async () => {
    for (const y of [113, 150]) for (const share of [0.2, 0.3, 0.4, 0.7, 0.8]) await canvas.click({ position: { x: 52 + share * (width - 52), y } });
    return time();
  }, (now) => now !== before);
  assert.equal(await page.locator('[data-plot="hodograph.velocity"]').count(), 1);
  await panel.hover();
  await panel.getByRole("button", { name: "Data" }).click();
  await shows(() => panel.locator("thead th").allTextContents(), (heads) => heads.length === 3);
});

test("the keyboard alone moves a joint and a slider", async () => {
  const before = await page.evaluate(() => globalThis.studio.state.text.value);
  await page.locator('.handle[data-point="A2"]').focus();
  await page.keyboard.press("ArrowUp");
  await known();
  const after = await page.evaluate(() => globalThis.studio.state.text.value);
  assert.notEqual(after, before);
  await page.locator(`[data-slider="${RADIUS}"]`).focus();
  await page.keyboard.press("ArrowRight");
  await known();
  assert.notEqual(await page.evaluate(() => globalThis.studio.state.text.value), after);
});

test("units hold everywhere at once, and a number may have its own", async () => {
  await page.getByRole("button", { name: "Units" }).click();
  await page.getByRole("button", { name: "Workshop" }).click();
  await page.keyboard.press("Escape");
  const field = page.locator(`input.number[data-address="${RADIUS}"]`);
  await field.fill("8 in");
  await field.press("Enter");
  await known();
  await shows(() => field.inputValue(), (number) => number === "203.2");
  assert.match(await page.evaluate(() => globalThis.studio.state.text.value), /radius = "8 in"/);
});

/** Texts of the page with English words; names, addresses and texts of the file are none. */
const english = () => page.evaluate(() => {
  const found = [];
  const nodes = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (nodes.nextNode()) {
    const { parentElement: around, textContent: words } = nodes.currentNode;
    const own = /\b\w+(\.\w+)+\b|\b(cart|rolling)\d\b|\bgravity\b|, \S+ \w+$/g;
    if (!around.closest('[translate="no"], svg, script, noscript, textarea, code') && /\b[A-Za-z]{4,}\b/.test(words.replace(own, ""))) found.push(words.trim());
  }
  return found;
});

test("in Ukrainian no English is left, numbers have a comma, and a typed comma is one", async () => {
  const choose = (code) => page.locator(".bar select").selectOption(code);
  const before = await page.evaluate(() => globalThis.studio.state.text.value);
  await choose("uk");
  await page.waitForFunction(() => document.documentElement.lang === "uk");
  await known();
  try {
    for (const tab of ["Проєктування", "Графіки"]) {
      await page.getByRole("tab", { name: tab }).click();
      await shows(english, (words) => words.length === 0);
    }
    const field = page.locator(`[data-address="${RADIUS}"]`);
    await shows(() => field.inputValue(), (value) => /^\d+,\d+$/.test(value));
    await field.fill("0,21 m");
    await field.press("Enter");
    await known();
    await shows(() => page.evaluate(() => globalThis.studio.state.text.value), (text) => /radius = "0\.21 m"/.test(text));
  } finally {
    await page.evaluate((text) => globalThis.studio.write(text), before);
    await known();
    await choose("en");
  }
  await page.waitForFunction(() => document.documentElement.lang === "en");
  await known();
  await shows(() => page.getByRole("tab", { name: "Plots" }).count(), (count) => count === 1);
});

test("a problem stands beside its entry, and the text mends it", async () => {
  const field = page.locator(`input.number[data-address="${RADIUS}"]`);
  await field.fill("-1");
  await field.press("Enter");
  await page.locator(".row .problem").first().waitFor();
  await shows(() => page.locator(".row .problem").first().textContent(), (words) => /greater than 0/.test(words));
  await page.getByRole("tab", { name: "File" }).click();
  const area = page.getByLabel("Text of the machine file");
  await area.fill((await area.inputValue()).replace('"-0.03937008 in"', '"8 in"').replace(/radius = "-.*"/, 'radius = "8 in"'));
  await page.waitForFunction(() => !globalThis.studio.state.problems.value.length);
  await page.getByRole("tab", { name: "Entries" }).click();
});

test("what was typed into the text counts when the tab is left at once, and when it is saved at once", async () => {
  const text = () => page.evaluate(() => globalThis.studio.state.text.value);
  const area = page.getByLabel("Text of the machine file");
  const before = await text();
  for (const [words, leave] of [["# left\n", () => page.getByRole("tab", { name: "Entries" }).click()], ["# saved\n", () => area.press("Control+s")]]) {
    await page.getByRole("tab", { name: "File" }).click();
    await area.fill(words + before);
    await leave();
    assert.equal(await text(), words + before);
    await page.waitForFunction(() => !globalThis.studio.busy());
  }
  assert.ok(readFileSync(`${folder}/carts.toml`, "utf8").startsWith("# saved"));
  await page.getByRole("tab", { name: "Entries" }).click();
  await page.evaluate((words) => globalThis.studio.write(words), before);
  await known();
});

test("plots have their data and their files", async () => {
  const panel = page.locator(".panel").first();
  await panel.hover();
  await panel.getByRole("button", { name: "Data" }).click();
  await shows(() => panel.locator("tbody tr").count(), (rows) => rows > 100);
  for (const kind of ["CSV", "SVG", "PNG"]) {
    const [download] = await Promise.all([page.waitForEvent("download"), panel.getByRole("button", { name: kind }).click()]);
    assert.ok(download.suggestedFilename().endsWith(kind.toLowerCase()));
    assert.ok(statSync(await download.path()).size > 1000);
  }
});

test("the report and the pose are files", async () => {
  await page.getByRole("button", { name: "Export" }).click();
  for (const label of ["Formulas", "Machine data", "Assumptions"]) await page.getByLabel(label).uncheck();
  for (const [kind, head] of [["dxf", "  0\nSECTION"], ["pdf", "%PDF"]]) {
    const [file] = await Promise.all([page.waitForEvent("download"), page.locator(`[data-make="${kind}"]`).click()]);
    assert.ok(file.suggestedFilename().endsWith(`.${kind}`));
    assert.ok(readFileSync(await file.path(), "latin1").startsWith(head));
  }
  await page.keyboard.press("Escape");
});

test("a result is pulled, and the entries that follow give it on the command line too", async () => {
  await page.evaluate((text) => globalThis.studio.write(text), readFileSync(`${ROOT}machines/roller_two_carts.toml`, "utf8"));
  await known();
  await page.getByRole("tab", { name: "Design" }).click();
  await page.locator("#goal").selectOption("steady_state.unevenness");
  await page.locator(`[data-free="${PHASE}"]`).check();
  await shows(() => page.locator(`[data-slope="${PHASE}"]`).textContent(), (words) => /δ rises by [\d.]+ % per °/.test(words));
  const before = await scalar("steady_state.unevenness");
  const box = await page.locator("#pull").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.55, box.y + box.height / 2);
  await page.waitForFunction((old) => globalThis.studio.state.results.value[0].scalars.find(({ name }) => name === "unevenness").value > 1.02 * old, before);
  await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2);
  await page.mouse.up();
  await known();
  const phase = await page.evaluate((of) => document.querySelector(`[data-slider="${of}"]`).value, PHASE);
  const found = await scalar("steady_state.unevenness");
  assert.ok(found > 1.1 * before);
  near(found, JSON.parse(execFileSync(LINKWRIGHT, ["run", `${ROOT}machines/roller_two_carts.toml`, "--json", "--set", `${PHASE}=${phase} rad`], { encoding: "utf8", timeout: PATIENCE })).results.steady_state.unevenness);
  await page.getByLabel("Wanted value").fill("0.001");
  await page.getByLabel("Wanted value").press("Enter");
  await page.locator(".design .problem").waitFor();
});

test("a pinned machine stays beside the one at hand", async () => {
  await page.locator("#pin").click();
  const pinned = await scalar("steady_state.unevenness");
  await page.keyboard.press("Control+z");
  await known();
  await shows(() => page.locator("#variants").textContent(), (words) => /%/.test(words));
  assert.equal(await page.evaluate(() => globalThis.studio.state.pins.value[0].scalars["steady_state.unevenness"]), pinned);
  await page.getByRole("button", { name: "Back to it" }).click();
  await known();
  near(await scalar("steady_state.unevenness"), pinned);
  await page.getByRole("button", { name: "Unpin Variant 1" }).click();
});

test("one entry is swept into a curve, two into a map, and a search ends where it is stopped", async () => {
  const isDone = () => page.waitForFunction(() => globalThis.studio.state.search.value?.rows && globalThis.studio.state.search.value.done === globalThis.studio.state.search.value.rows);
  await page.locator("#over-0").selectOption(PHASE);
  await page.getByLabel("Values").fill("9");
  await page.locator("#seek").click();
  await isDone();
  await page.getByRole("button", { name: "Use the minimum" }).click();
  await known();
  const values = await page.evaluate(() => Array.from(globalThis.studio.state.search.value.values).filter(Number.isFinite));
  // The file has seven digits.
  assert.ok(Math.abs((await scalar("steady_state.unevenness")) / Math.min(...values) - 1) < 1e-5);
  await page.locator("#over-1").selectOption("bodies.cart1.mass");
  await page.getByLabel("Values").fill("5");
  await page.locator("#seek").click();
  await page.locator(".heat canvas").waitFor();
  await isDone();
  await page.getByLabel("What is done").selectOption("optimise");
  await page.locator("#seek").click();
  await page.getByRole("button", { name: "Stop", exact: true }).last().click();
  await page.waitForFunction(() => globalThis.studio.state.search.value.ended);
  await page.locator("#seek").click();
  await page.waitForFunction(() => globalThis.studio.state.search.value.last);
  await page.locator("#take").click();
  await known();
  assert.ok((await scalar("steady_state.unevenness")) < Math.min(...values));
});

test("a point of a curve is pulled, and the entries that were ticked follow", async () => {
  const before = await page.evaluate(() => globalThis.studio.state.text.value);
  await page.evaluate(() => globalThis.studio.open("template", "four-bar"));
  await known();
  await page.getByRole("tab", { name: "Design" }).click();
  await page.locator("#pulled").selectOption("K");
  for (const entry of ["mechanism.cranks.A.radius", "mechanism.rockers.C.coupler", "mechanism.rigid_points.K.across"]) await page.locator(`.of-point [data-free="${entry}"]`).check();
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  const place = () => page.evaluate(() => Array.from(globalThis.studio.state.scene.value.points.K.subarray(0, 2)));
  const [u, v] = await place();
  const [x, y] = await grip("K");
  await page.mouse.move(x + 4, y - 9, { steps: 3 });
  await page.mouse.up();
  await known();
  // The drawing is fitted anew meanwhile, so that pixels are known to one alone.
  await shows(place, ([U, V]) => U > u && V > v && Math.abs(Math.atan2(U - u, V - v) - Math.atan2(4, 9)) < 0.2);
  assert.match(await page.evaluate(() => globalThis.studio.state.text.value), /rocker = "110 mm"[\s\S]*along = "60 mm"/);
  await page.keyboard.press("Control+z");
  await known();
  assert.match(await page.evaluate(() => globalThis.studio.state.text.value), /radius = "50 mm"/);
  await page.evaluate(() => globalThis.studio.open("folder", "carts.toml"));
  await known();
  await page.evaluate((text) => globalThis.studio.write(text), before);
  await known();
});

test("a joint that is dropped on another merges with it while a linkage is built", async () => {
  const before = await page.evaluate(() => globalThis.studio.state.text.value);
  await page.evaluate((text) => globalThis.studio.write(text), readFileSync(`${ROOT}machines/roller_two_carts.toml`, "utf8"));
  await known();
  await page.locator("details.build > summary").click();
  await grip("A2");
  const [X, Y] = await handle("A1");
  await page.mouse.move(X, Y, { steps: 5 });
  await page.mouse.up();
  await known();
  const text = () => page.evaluate(() => globalThis.studio.state.text.value);
  await shows(text, (now) => !now.includes("cranks.A2") && now.split('crank = "A1"').length === 3);
  await page.keyboard.press("Control+z");
  await known();
  assert.match(await text(), /cranks\.A2/);
  await page.getByLabel("Merge", { exact: true }).selectOption("A1");
  await page.getByLabel("with", { exact: true }).selectOption("cart1");
  await page.locator("#merge").click();
  await page.getByRole("alert").getByText("was not merged").waitFor();
  await page.getByRole("button", { name: "Close" }).click();
  await page.locator("details.build > summary").click();
  await page.evaluate((words) => globalThis.studio.write(words), before);
  await known();
});

test("axe finds nothing serious, in light and in dark", async () => {
  await page.evaluate(AXE);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
    const serious = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
    assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 120)).join(" | ")}`), []);
  }
  await page.emulateMedia({ colorScheme: "light", reducedMotion: "reduce" });
});

test("what was not saved is there after a crash, and a saved file opens again", async () => {
  const text = await page.evaluate(() => globalThis.studio.state.text.value);
  await page.reload();
  await known();
  assert.equal(await page.evaluate(() => globalThis.studio.state.text.value), text);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => !globalThis.studio.state.unsaved.value);
  assert.equal(readFileSync(`${folder}/carts.toml`, "utf8"), text);
});

test("a train twists in its modes, and a knife goes over the heads", async () => {
  const picture = () => page.evaluate(() => document.querySelector(".stage canvas").toDataURL());
  await page.evaluate(() => globalThis.studio.open("library", "v8_diesel"));
  await known();
  const modes = page.locator("#mode");
  await modes.waitFor();
  const { results } = JSON.parse(execFileSync(LINKWRIGHT, ["torsion", "v8_diesel", "--json", "--curves"], { encoding: "utf8", timeout: PATIENCE, maxBuffer: 1e9 }));
  const lowest = results.free.natural_frequencies.find((f) => f > 0);
  assert.match(await modes.locator("option").first().textContent(), new RegExp(`^1: ${lowest.toPrecision(5)} Hz`));
  const first = await picture();
  await modes.selectOption("2");
  await shows(picture, (now) => now !== first);
  await page.evaluate(() => globalThis.studio.open("library", "topper"));
  await known();
  await page.locator("#knife").waitFor();
  const before = await picture();
  await page.locator("#knife").fill("0.9");
  await shows(picture, (now) => now !== before);
});

test("there was no error on the console, and no request to elsewhere", () => assert.deepEqual(faults, []));

test("the page stays small", () => {
  const folderOf = `${ROOT}python/linkwright/studio/static`;
  const size = (path) => (statSync(path).isDirectory() ? readdirSync(path).reduce((sum, name) => sum + size(`${path}/${name}`), 0) : /\.(m?js|css|html|svg)$/.test(path) ? statSync(path).size : 0);
  assert.ok(size(folderOf) < 330_000, `${size(folderOf)} bytes`);
});
