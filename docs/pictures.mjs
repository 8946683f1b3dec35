// The pictures of the documentation. Those of docs/studio_tutorial.md: walks through its steps in the real studio and fails where a step does not do
// what the page says. The studio and the report of the two carts, for docs/studio.md and README.md.
//   npm ci && node docs/pictures.mjs
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const ROOT = fileURLToPath(new URL("../", import.meta.url));
const folder = mkdtempSync(`${tmpdir()}/tutorial-`);
const linkwright = `${ROOT}.venv/bin/linkwright`;
const servers = [];
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const faults = [];
let page;

/** An empty page of a browser. */
const blank = async (width, height) => {
  page = await (await browser.newContext({ viewport: { width, height }, reducedMotion: "reduce", bypassCSP: true })).newPage();
  page.setDefaultTimeout(90_000);
  page.on("pageerror", (error) => faults.push(error.message));
};
/** The studio with a machine of the library, or as it opens. */
const studio = async (...machine) => {
  const server = spawn(linkwright, ["studio", "--no-browser", ...machine], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  servers.push(server);
  const address = await new Promise((resolve) => server.stdout.on("data", (data) => /http:\S+/.test(data) && resolve(/http:\S+/.exec(data)[0])));
  await blank(1280, 800);
  await page.goto(address);
  await known();
};
/** All is computed, slow analyses too. */
const known = () => page.waitForFunction(() => globalThis.studio?.state.machine.value && !globalThis.studio.busy() && !Object.values(globalThis.studio.state.lanes.value).includes("running"));
const picture = async (name) => {
  await known();
  await page.waitForTimeout(400);
  await page.screenshot({ path: `${ROOT}docs/images/${name}.png` });
};
const add = async (word) => {
  await page.locator(".kinds").getByRole("button", { name: word, exact: true }).click();
  await known();
};
const type = async (entry, words) => {
  const field = page.locator(`input.number[data-address="${entry}"]`);
  await field.fill(words);
  await field.press("Enter");
  await known();
};
const scalar = (name) => page.evaluate((of) => globalThis.studio.state.results.value.flatMap(({ name: result, scalars }) => scalars.map((each) => [`${result}.${each.name}`, each.value])).find(([key]) => key === of)?.[1], name);

try {
  await studio();
  await page.getByRole("button", { name: "Machines" }).click();
  await page.locator("#empty").click();
  await known();
  for (const word of ["Crank", "Rod and slider", "Body", "Friction load"]) await add(word);
  await type("mechanism.cranks.A1.radius", "80 mm");
  await type("mechanism.sliders.S1.rod", "300 mm");
  await type("bodies.S1.mass", "40 kg");
  await type("loads.load1.force", "600 N");
  await page.locator("#scrub").fill("30");
  await picture("tutorial_built");

  await page.getByRole("tab", { name: "File" }).click();
  const area = page.getByLabel("Text of the machine file");
  await area.fill(`${await area.inputValue()}
[drive]
speed = "120 rpm"

[drive.motor]
kind = "induction"
catalogue = "AIR 0.75 kW 6-pole"
inertia = "0.00173 kg m^2"

[drive.gearbox]
ratio = 7.6
efficiency = 0.9

[drive.flywheel]
inertia = "2 kg m^2"
on = "crank"
`);
  await known();
  await page.getByRole("tab", { name: "Entries" }).click();
  await picture("tutorial_driven");
  const before = await scalar("steady_state.unevenness");
  assert.ok(before > 0, "the machine has a steady motion");

  await page.getByLabel("Joint forces").check();
  await page.getByLabel("Velocities").check();
  await page.getByLabel("Instant centres").check();
  await page.locator("#scrub").fill("25");
  await picture("tutorial_arrows");
  for (const word of ["Joint forces", "Velocities", "Instant centres"]) await page.getByLabel(word).uncheck();

  await page.getByRole("tab", { name: "Design" }).click();
  await page.locator("#pin").click();
  await page.locator("#goal").selectOption("steady_state.unevenness");
  await page.locator('[data-free="drive.flywheel.inertia"]').check();
  await page.locator('[data-slope="drive.flywheel.inertia"]').waitFor();
  await page.getByLabel("Wanted value").fill(String(0.7 * before));
  await page.getByLabel("Wanted value").press("Enter");
  await known();
  const after = await scalar("steady_state.unevenness");
  assert.ok(Math.abs(after / (0.7 * before) - 1) < 1e-4, `δ is ${after}, not 0.7 of ${before}`);
  await picture("tutorial_pulled");

  await page.locator("#over-0").selectOption("drive.flywheel.inertia");
  await page.locator("#seek").click();
  await page.waitForFunction(() => globalThis.studio.state.search.value?.rows && globalThis.studio.state.search.value.done === globalThis.studio.state.search.value.rows);
  await page.locator("#found").evaluate((found) => {
    let pane = found;
    while (pane.scrollHeight <= pane.clientHeight) pane = pane.parentElement;
    pane.scrollTop = pane.scrollHeight;
  });
  await picture("tutorial_swept");

  await page.getByRole("button", { name: "Export" }).click();
  await picture("tutorial_export");

  await studio("roller_two_carts");
  await page.getByLabel("Joint forces").check();
  await page.locator("#scrub").fill("36");
  await picture("studio");

  execFileSync(linkwright, ["run", "roller_two_carts", "--out", "two_carts"], { cwd: folder, stdio: "ignore" });
  await blank(880, 800);
  await page.goto(`file://${folder}/two_carts/report.html`);
  await page.addStyleTag({ content: "main { padding: 12px; } main > :not(.sketch, #figure-speed), h1, h2, header, footer, nav, figcaption { display: none !important; }" });
  // Without the empty space above and below.
  await page.locator(".sketch svg").evaluate((svg) => {
    const [left, , width] = svg.getAttribute("viewBox").split(" ").map(Number);
    const { y, height } = svg.getBBox();
    svg.setAttribute("viewBox", `${left} ${y - height / 10} ${width} ${1.2 * height}`);
    svg.style.height = "auto";
  });
  await page.locator("#angle").fill(String(37 / 360));
  await page.locator("#angle").blur();
  await page.locator("main").screenshot({ path: `${ROOT}docs/images/two_carts.png` });
  assert.deepEqual(faults, []);
} finally {
  await browser.close();
  for (const server of servers) server.kill();
  rmSync(folder, { recursive: true, force: true });
}
