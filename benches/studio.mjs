// The studio in a browser: change → redrawn plots, frames a second, first paint, size of the page. Times on the clock are those of this machine and of what
// else it does; processor times of server and page are the work alone.
//   npm ci && node benches/studio.mjs
import { spawn } from "node:child_process";
import { readFileSync, readdirSync, statSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const ROOT = fileURLToPath(new URL("../", import.meta.url));
const ARGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const CHANGES = 120;

const server = spawn(`${ROOT}.venv/bin/linkwright`, ["studio", "roller_two_carts", "--no-browser"], { cwd: ROOT, stdio: ["ignore", "pipe", "inherit"] });
const address = await new Promise((resolve) => server.stdout.on("data", (data) => /http:\S+/.test(data) && resolve(/http:\S+/.exec(data)[0])));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ARGS });
const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
await page.goto(address);
await page.waitForFunction(() => globalThis.studio?.state.scene.value && !Object.values(globalThis.studio.state.lanes.value).includes("running"), {}, { timeout: 120_000 });
const paint = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime - performance.getEntriesByType("navigation")[0].responseStart);

const frames = await page.evaluate(async () => {
  const begun = [globalThis.studio.frames.count, performance.now()];
  await new Promise((resolve) => setTimeout(resolve, 4000));
  return (1000 * (globalThis.studio.frames.count - begun[0])) / (performance.now() - begun[1]);
});

/** Milliseconds of processor time that the server, and the thread of the page, have had; ticks of Linux are hundredths of a second. */
const session = await page.context().newCDPSession(page);
await session.send("Performance.enable", { timeDomain: "threadTicks" });
async function processor() {
  const [own, kernel] = readFileSync(`/proc/${server.pid}/stat`, "utf8").split(") ")[1].split(" ").slice(11, 13);
  const { metrics } = await session.send("Performance.getMetrics");
  return { server: 10 * (Number(own) + Number(kernel)), page: 1000 * metrics.find(({ name }) => name === "TaskDuration").value };
}

await page.evaluate(() => (globalThis.studio.state.playing.value = false));
const before = await processor();
const redrawn = await page.evaluate(async (count) => {
  const { measured, state, hold, busy } = globalThis.studio;
  const server = [];
  for (let n = -10; n < count; n += 1) {
    if (n === 0) measured.redrawn.length = server.length = 0;
    const before = measured.redrawn.length;
    hold({ "mechanism.cranks.A1.radius": 0.2 + 0.0002 * (n + 11) });
    while (measured.redrawn.length === before || busy()) await new Promise((resolve) => setTimeout(resolve, 1));
    server.push(1000 * state.seconds.value);
  }
  return { whole: measured.redrawn, server };
}, CHANGES);
const after = await processor();
const work = (name) => ((after[name] - before[name]) / (CHANGES + 10)).toFixed(1);

const folder = `${ROOT}python/linkwright/studio/static`;
const size = (path) => (statSync(path).isDirectory() ? readdirSync(path).reduce((sum, name) => sum + size(`${path}/${name}`), 0) : /\.(m?js|css|html|svg)$/.test(path) ? statSync(path).size : 0);
const share = (values, part) => [...values].sort((a, b) => a - b)[Math.floor(part * (values.length - 1))].toFixed(1);
console.log(`change → redrawn plots [ms]: median ${share(redrawn.whole, 0.5)}, first decile ${share(redrawn.whole, 0.1)}, ninth ${share(redrawn.whole, 0.9)}`);
console.log(`of these in the server [ms]: median ${share(redrawn.server, 0.5)}, first decile ${share(redrawn.server, 0.1)}`);
console.log(`processor time of a change [ms]: server ${work("server")}, page ${work("page")}`);
console.log(`frames a second: ${frames.toFixed(1)}`);
console.log(`first paint after the server answered [ms]: ${paint.toFixed(0)}`);
console.log(`page [kB]: ${(size(folder) / 1000).toFixed(0)}`);
await browser.close();
server.kill();
