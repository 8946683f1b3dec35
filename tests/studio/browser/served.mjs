// A studio with a page of Chromium for a file of tests, and what these ask it.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const ROOT = fileURLToPath(new URL("../../../", import.meta.url));
export const LINKWRIGHT = `${ROOT}.venv/bin/linkwright`;
export const ARGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
// Milliseconds for what a user waits for, on a machine that does other things too; and for a file of tests as a whole,
// so that all of them end, whatever hangs.
export const PATIENCE = Number(process.env.PATIENCE ?? 90_000);
const WHOLE = 1400_000;

/** What is open: closed at the end of the tests, and however else the process ends. @type {Set<() => unknown>} */
const open = new Set();
process.on("exit", () => open.forEach((end) => end()));

/** Ends the process if its tests do not; what they left open goes with it. */
export const bounded = () => setTimeout(() => {
  console.error(`These tests have not ended within ${WHOLE / 1000} s.`);
  process.exit(1);
}, WHOLE).unref();

/** A folder with the two carts, and the examples if wanted. */
export function folderWith({ examples = false } = {}) {
  const folder = mkdtempSync(`${tmpdir()}/studio-`);
  mkdirSync(`${folder}/examples`);
  for (const name of examples ? readdirSync(`${ROOT}examples`) : []) {
    cpSync(`${ROOT}examples/${name}`, `${folder}/examples/${name}`, { recursive: true, filter: (path) => !path.endsWith(".py") });
  }
  cpSync(`${ROOT}machines/roller_two_carts.toml`, `${folder}/carts.toml`);
  return folder;
}

/** `linkwright studio` of a folder, and the address that it prints. */
export async function studioOf(folder) {
  const server = spawn(LINKWRIGHT, ["studio", "carts.toml", "--no-browser"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const end = () => server.kill("SIGKILL");
  open.add(end);
  const address = await new Promise((resolve, reject) => {
    let said = "";
    setTimeout(() => reject(new Error(`the studio has not begun: ${said}`)), PATIENCE).unref();
    server.once("exit", () => open.delete(end) && reject(new Error(`the studio has ended: ${said}`)));
    server.stdout.on("data", (data) => {
      said += data;
      const match = /http:\S+/.exec(said);
      if (match) resolve(match[0]);
    });
  });
  return { server, address, origin: new URL(address).origin };
}

/** The studio in a browser, with its faults: errors and warnings of the console, and requests to elsewhere. */
export async function served(options) {
  bounded();
  const folder = folderWith(options);
  const { server, address, origin } = await studioOf(folder);
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGS });
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, reducedMotion: "reduce", acceptDownloads: true });
  const faults = [];
  const page = await opened(context, address, faults);
  const end = async () => {
    await browser.close();
    for (const each of open) each();
    rmSync(folder, { recursive: true, force: true });
  };
  return { folder, server, address, origin, browser, context, page, faults, end };
}

/** A tab at an address, whose faults are noted. */
export async function opened(context, address, faults) {
  const page = await context.newPage();
  const { origin } = new URL(address);
  page.setDefaultTimeout(PATIENCE);
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("request", (request) => new URL(request.url()).origin !== origin && !/^(blob|data):/.test(request.url()) && faults.push(request.url()));
  page.on("dialog", (dialog) => dialog.accept());
  await page.goto(address);
  await known(page);
  return page;
}

/** Waits until the answer to the last change is there. */
export const known = (page) => page.waitForFunction(() => globalThis.studio?.state.machine.value && !globalThis.studio.busy());

/** Waits until slow analyses have answered too. */
export const complete = async (page) => {
  await known(page);
  await page.waitForFunction(() => !Object.values(globalThis.studio.state.lanes.value).includes("running"));
};

/** A number of the results, such as `steady_state.unevenness`. */
export const scalar = (page, name) => page.evaluate((of) => globalThis.studio.state.scalars.value.find(({ key }) => key === of)?.value, name);

/** Middle of the handle of a point on the screen, once the drawing stands: in the same place a frame later. */
export const handle = (page, point) => page.waitForFunction((name) => new Promise((resolve) => {
  const place = () => {
    const box = document.querySelector(`.handle[data-point="${name}"]`)?.getBoundingClientRect();
    return box && [box.x + box.width / 2, box.y + box.height / 2];
  };
  requestAnimationFrame(() => requestAnimationFrame(() => {
    const before = place();
    requestAnimationFrame(() => resolve(String(before) === String(place()) && before));
  }));
}), point).then((found) => found.jsonValue());

/** Presses the mouse on the handle of a point, and says where: what is under the mouse is what a user would press. */
export const grip = async (page, point) => {
  const [x, y] = await handle(page, point);
  await page.mouse.move(x, y);
  assert.deepEqual(await handle(page, point), [x, y], `the handle of ${point} moves away from the mouse`);
  await page.mouse.down();
  return [x, y];
};

/** What the page shows is painted after it is known: asked again until it is so. */
export const shows = async (ask, is) => {
  const end = Date.now() + PATIENCE;
  for (;;) {
    const answer = await ask();
    if (is(answer)) return;
    assert.ok(Date.now() < end, `${JSON.stringify(answer)} stays on the page`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
};

export const near = (found, wanted) => assert.ok(Math.abs(found - wanted) <= 1e-9 * Math.abs(wanted), `${found} is not ${wanted}`);
