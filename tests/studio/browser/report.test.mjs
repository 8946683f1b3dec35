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

test("there was no error, and nothing was loaded", () => assert.deepEqual(faults, []));
