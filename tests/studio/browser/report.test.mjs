// The page of a report in a browser: figures are read and zoomed, and nothing is loaded.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { ARGS, PATIENCE, ROOT, bounded } from "./served.mjs";

let browser, page, folder;
const faults = [];

before(async () => {
  bounded();
  folder = mkdtempSync(`${tmpdir()}/report-`);
  execFileSync(`${ROOT}.venv/bin/linkwright`, ["report", "--to", "carts.html", "run", `${ROOT}machines/roller_two_carts.toml`], { cwd: folder, timeout: PATIENCE });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGS });
  page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  page.setDefaultTimeout(PATIENCE);
  const address = pathToFileURL(`${folder}/carts.html`).href;
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("request", (request) => request.url() !== address && faults.push(request.url()));
  await page.goto(address);
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test("the cursor reads the curves, dragging zooms, a double click shows all of it", async () => {
  const svg = page.locator("#figure-speed svg").first();
  await svg.scrollIntoViewIfNeeded();
  const box = await svg.boundingBox();
  const at = (u, v) => [box.x + u * box.width, box.y + v * box.height];
  const [low, high] = [/speed 1[01]\.\d+/, /crank angle φ \[°\] \d/];
  await page.mouse.move(...at(0.5, 0.25));
  const words = await page.locator("#figure-speed .readout").textContent();
  assert.match(words, low);
  assert.match(words, high);
  const whole = await svg.getAttribute("viewBox");
  await page.mouse.down();
  await page.mouse.move(...at(0.7, 0.4), { steps: 3 });
  await page.mouse.up();
  const zoomed = await svg.getAttribute("viewBox");
  assert.ok(Number(zoomed.split(" ")[2]) < 0.5 * Number(whole.split(" ")[2]));
  await svg.dblclick({ position: { x: 20, y: 20 } });
  assert.equal(await svg.getAttribute("viewBox"), whole);
});

test("a script in the name of a cam is text, and the drawing moves", async () => {
  const name = `"><img src=q onerror=with(document)title=7777>`;
  const text = readFileSync(`${ROOT}machines/roller_cam.toml`, "utf8");
  const [, cam] = /\[mechanism\.cams\.(\w+)\]/.exec(text);
  writeFileSync(`${folder}/cam.toml`, text.replaceAll(`cams.${cam}`, `cams.'${name}'`).replaceAll(new RegExp(`^${cam} =`, "gm"), `'${name}' =`).replaceAll(`"${cam}"`, `'${name}'`));
  execFileSync(`${ROOT}.venv/bin/linkwright`, ["report", "--to", "cam.html", "cam", "cam.toml"], { cwd: folder, timeout: PATIENCE });
  const other = await browser.newPage();
  await other.goto(pathToFileURL(`${folder}/cam.html`).href);
  const pose = () => other.locator("#sketch").innerHTML();
  const before = await pose();
  await other.waitForTimeout(500);
  assert.notEqual(await pose(), before);
  assert.doesNotMatch(await other.title(), /7777$/);
  assert.equal(await other.locator("img").count(), 0);
  // What gets in nevertheless does not run.
  await other.evaluate(() => document.body.insertAdjacentHTML("beforeend", "<img src=q onerror='document.title = 7777'>"));
  await other.waitForTimeout(200);
  assert.doesNotMatch(await other.title(), /7777$/);
  await other.close();
});

test("a wide page has two columns, its contents lead to every section, table and figure", async () => {
  const boxes = await page.locator("#figure-speed, #figure-torque").evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON()));
  assert.equal(boxes.length, 2);
  assert.equal(boxes[0].top, boxes[1].top);
  assert.ok(boxes[1].left > boxes[0].right);
  const width = await page.evaluate(() => document.querySelector("main").getBoundingClientRect().width);
  assert.ok(width > 1300, `${width} of 1440`);
  const links = await page.locator("nav.contents a").evaluateAll((all) => all.map((one) => [one.hash, document.getElementById(decodeURIComponent(one.hash.slice(1))) !== null]));
  assert.ok(links.length > 20);
  assert.deepEqual(links.filter(([, known]) => !known), []);
  await page.locator("nav.contents a", { hasText: "Forces" }).first().click();
  assert.ok((await page.locator("#table-forces").boundingBox()).y < 300);
  await page.locator("a.up").click();
  assert.ok((await page.locator("nav.contents").boundingBox()).y < 300);
});

test("a narrow page has one column and does not move sideways", async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  const boxes = await page.locator("#figure-speed, #figure-torque").evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON()));
  assert.ok(boxes[1].top > boxes[0].bottom - 1);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await page.setViewportSize({ width: 1440, height: 900 });
});

test("there was no error, and nothing was loaded", () => assert.deepEqual(faults, []));
