// The page as a whole: links and crashes, every tab in both languages, keys alone, clicks alone, two tabs, diagrams.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import * as studio from "./served.mjs";
import { LINKWRIGHT, PATIENCE, ROOT, complete, grip, handle, known, near, opened, scalar, shows, studioOf } from "./served.mjs";

const AXE = readFileSync(`${ROOT}node_modules/axe-core/axe.min.js`, "utf8");
const RADIUS = "mechanism.cranks.A1.radius";
const CARTS = readFileSync(`${ROOT}machines/roller_two_carts.toml`, "utf8");

let folder, server, page, context, faults, end;

before(async () => {
  ({ folder, server, page, context, faults, end } = await studio.served());
});

after(() => end?.());

const text = (of = page) => of.evaluate(() => globalThis.studio.state.text.value);
const open = async (place, name) => {
  await page.evaluate(([where, which]) => globalThis.studio.open(where, which), [place, name]);
  await known(page);
};
const write = async (words) => {
  await page.evaluate((all) => globalThis.studio.write(all), words);
  await known(page);
};
const entries = () => page.evaluate(() => {
  const { of } = globalThis.studio.state.past.value;
  let count = 0;
  while (of.undo() !== null) count += 1;
  for (let n = 0; n < count; n += 1) of.redo();
  return count;
});

test("a link holds the whole state: machine, variants, units, layers, instant", async () => {
  await page.locator("#scrub").fill("30");
  await page.getByLabel("Velocities").check();
  await page.evaluate(() => (globalThis.studio.state.ends.value = { "mechanism.cranks.A1.radius": [0.1, 0.3] }));
  await page.getByRole("tab", { name: "Design" }).click();
  await page.locator("#pin").click();
  const pinned = await scalar(page, "steady_state.unevenness");
  await write(CARTS.replace('radius = "0.2 m"', 'radius = "0.22 m" # longer'));
  const [found, time] = [await scalar(page, "steady_state.unevenness"), await page.evaluate(() => globalThis.studio.state.time.value)];
  await page.getByRole("button", { name: "Units" }).click();
  await page.getByRole("button", { name: "Inch" }).click();
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Copy" }).click();
  const link = page.locator(".copy pre").last();
  await shows(() => link.textContent(), (words) => words.startsWith("#state="));
  const letters = await link.textContent();
  await page.keyboard.press("Escape");
  // What the browser keeps is not what the link brings.
  await page.getByRole("button", { name: "Units" }).click();
  await page.getByRole("button", { name: "SI" }).click();
  await page.keyboard.press("Escape");
  await page.getByLabel("Velocities").uncheck();
  const other = await opened(context, `${new URL(page.url()).origin}/${letters}`, faults);
  await other.waitForFunction((t) => globalThis.studio.state.pins.value.length === 1 && globalThis.studio.state.time.value === t, time);
  await known(other);
  assert.match(await text(other), /radius = "0\.22 m" # longer/);
  near(await scalar(other, "steady_state.unevenness"), found);
  const state = await other.evaluate(() => {
    const { units, layers, ends, pins, place, unsaved } = globalThis.studio.state;
    return { unit: units.value.m, velocities: layers.value.velocities, ends: ends.value, pinned: pins.value[0].scalars["steady_state.unevenness"], curves: Object.keys(pins.value[0].plots).length, place: place.value, unsaved: unsaved.value };
  });
  near(state.pinned, pinned);
  assert.ok(state.curves > 5);
  // It is no file of this folder, whatever its name: saving asks for one.
  assert.deepEqual({ ...state, pinned: 0, curves: 0 }, { unit: "in", velocities: true, ends: { [RADIUS]: [0.1, 0.3] }, pinned: 0, curves: 0, place: { place: "", name: "" }, unsaved: true });
  await other.close();
  const broken = await opened(context, `${new URL(page.url()).origin}/#state=none`, faults);
  await broken.getByRole("alert").getByText("The link contains no state").waitFor();
  assert.match(await broken.locator("h1").textContent(), /two carts/);
  await broken.close();
  await page.evaluate(() => (globalThis.studio.state.units.value = { ...globalThis.studio.state.units.value, m: "m", "rad/s": "rad/s" }));
});

test("two tabs do not disturb each other", async () => {
  const before = await text();
  const other = await opened(context, `${new URL(page.url()).origin}/#open=library/v8_diesel`, faults);
  await other.evaluate(() => globalThis.studio.write(globalThis.studio.state.text.value.replace("V-8", "V-8 of the other tab")));
  await known(other);
  assert.equal(await text(), before);
  await page.reload();
  await known(page);
  assert.equal(await text(), before, "the first tab has its own changes back");
  await other.reload();
  await known(other);
  assert.match(await text(other), /of the other tab/);
  await other.evaluate(() => globalThis.studio.open("library", "v8_diesel"));
  await other.close();
});

test("what was not saved is there after a crash of the studio", async () => {
  await write(`${CARTS}# not saved\n`);
  server.kill("SIGKILL");
  await new Promise((resolve) => server.once("exit", resolve));
  await page.getByRole("alert").getByText("Your work is kept").waitFor();
  const again = await studioOf(folder);
  server = again.server;
  await page.close();
  page = await opened(context, again.address, faults);
  await page.getByRole("alert").getByText("Unsaved changes are restored").waitFor();
  assert.ok((await text()).endsWith("# not saved\n"));
  await page.keyboard.press("Control+z");
  await known(page);
  assert.equal(await text(), CARTS);
  await page.reload();
  await known(page);
  assert.equal(await text(), CARTS);
  assert.equal(await page.getByRole("alert").count(), 0);
  // A socket that was cut is told on the console.
  faults.splice(0, faults.length, ...faults.filter((words) => !/WebSocket|ERR_CONNECTION/.test(words)));
});

test("the keyboard alone builds a machine from nothing, moves a joint, and saves it", async () => {
  const reach = async (role, name) => {
    for (let n = 0; n < 300; n += 1) {
      await page.keyboard.press("Tab");
      const at = await page.evaluate(() => {
        const { activeElement: own } = document;
        return [own?.getAttribute("role") ?? own?.tagName.toLowerCase(), own?.getAttribute("aria-label") ?? own?.textContent?.trim() ?? ""];
      });
      if (at[0] === role && at[1] === name) return;
    }
    assert.fail(`${role} ${name} is not reached by Tab`);
  };
  await page.mouse.click(2, 2);
  await reach("button", "Machines");
  await page.keyboard.press("Enter");
  await reach("button", "Start with an empty machine");
  await page.keyboard.press("Enter");
  await known(page);
  for (const kind of ["Crank", "Rod and slider", "Body", "Friction load"]) {
    await reach("button", kind);
    await page.keyboard.press("Enter");
    await known(page);
  }
  await reach("button", "Add a motor");
  await page.keyboard.press("Enter");
  await known(page);
  const built = await text();
  await reach("button", "Joint A1");
  await page.keyboard.press("Shift+ArrowUp");
  await known(page);
  assert.notEqual(await text(), built);
  await page.keyboard.press("Control+s");
  await page.locator("#save-name").waitFor();
  await reach("input", "");
  await page.keyboard.press("Control+a");
  await page.keyboard.type("by keys.toml");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !globalThis.studio.state.unsaved.value);
  const { results } = JSON.parse(execFileSync(LINKWRIGHT, ["run", "by keys.toml", "--json"], { cwd: folder, encoding: "utf8", timeout: PATIENCE }));
  near(await scalar(page, "steady_state.torque_motor_rms"), results.steady_state.torque_motor_rms);
});

test("links that the mouse draws make a four-bar linkage", async () => {
  await page.evaluate(() => (globalThis.studio.state.dialog.value = "gallery"));
  await page.locator("#empty").click();
  await known(page);
  const { x, y, width, height } = await page.locator(".stage canvas").boundingBox();
  const at = (u, v) => [x + u * width, y + v * height];
  const link = async (from, to) => {
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 4 });
    await page.mouse.up();
    await known(page);
  };
  await page.locator("#draw").click();
  const [pivot, pin, joint, frame] = [at(0.3, 0.6), at(0.35, 0.45), at(0.6, 0.25), at(0.7, 0.6)];
  await link(pivot, pin);
  await shows(() => text(), (words) => words.includes("cranks.A1"));
  const crank = await text();
  // Close to the pin is on it; a coupler alone waits for a rocker.
  await link([pin[0] + 3, pin[1] - 2], joint);
  await page.getByText("J1 has one link").waitFor();
  assert.equal(await text(), crank);
  await link(joint, frame);
  await shows(() => text(), (words) => /start = "A1"\nend = "J1"[\s\S]*start = "J1"\nend = "P2"/.test(words));
  await page.locator("#draw").click();
  await complete(page);
  const drawn = await page.evaluate(() => Object.keys(globalThis.studio.state.scene.value.points));
  assert.ok(["A1", "J1"].every((name) => drawn.includes(name)), drawn.join());
  // No more digits than a pixel is worth.
  assert.match(await text(), /joints\.J1\]\nx = "-?0?\.?\d{1,4} m"/);
  await page.evaluate(() => (globalThis.studio.state.saved.value = globalThis.studio.state.text.value));
});

test("every drag is done by clicks too: one entry a gesture, none if nothing moved", async () => {
  await open("folder", "carts.toml");
  const before = await text();
  await page.locator('.handle[data-point="A2"]').click();
  await page.keyboard.press("Escape");
  await known(page);
  assert.equal(await entries(), 0);
  const [x, y] = await handle(page, "A2");
  await page.mouse.click(x, y);
  await page.mouse.click(x + 10, y - 30);
  await known(page);
  await shows(() => text(), (words) => words !== before);
  await shows(() => handle(page, "A2"), ([X, Y]) => Math.hypot(X - x - 10, Y - y + 30) < 2);
  assert.equal(await entries(), 1);
  await page.keyboard.press("Control+z");
  await known(page);
  assert.equal(await text(), before);
  // The mouse holds nothing any more.
  const place = await handle(page, "A2");
  await page.mouse.move(x + 60, y - 80, { steps: 2 });
  assert.deepEqual(await handle(page, "A2"), place);
});

test("a locked entry holds while a joint is dragged, beyond the edge of the drawing too", async () => {
  const before = await text();
  await page.getByRole("button", { name: "Lock radius of A2" }).click();
  const [x, y] = await grip(page, "A2");
  await page.mouse.move(x + 30, y - 60, { steps: 3 });
  await page.mouse.move(x + 30, 20, { steps: 2 });
  await page.mouse.up();
  await known(page);
  await shows(() => text(), (words) => words !== before && words.includes('cranks.A2]\nradius = "0.2 m"'));
  await page.mouse.move(x, y + 40);
  await known(page);
  assert.equal(await entries(), 1, "what is let go outside is no longer held");
  await page.getByRole("button", { name: "Lock radius of A2" }).click();
  await page.keyboard.press("Control+z");
  await known(page);
});

test("the ends of a slider are the user's", async () => {
  const row = page.locator(".row", { has: page.locator(`[data-slider="${RADIUS}"]`) });
  await row.hover();
  await row.getByLabel("upper end").fill("0.21");
  await row.getByLabel("upper end").press("Enter");
  const slider = page.locator(`[data-slider="${RADIUS}"]`);
  await shows(() => slider.getAttribute("max"), (most) => most === "0.21");
  await slider.focus();
  for (let n = 0; n < 12; n += 1) {
    await page.keyboard.press("Shift+ArrowRight");
    await known(page);
  }
  assert.match(await text(), /radius = "0\.21 m"/);
  await write(CARTS);
});

test("a peak of the speed is pulled, and the command line finds it there", async () => {
  await page.getByRole("tab", { name: "Design" }).click();
  await page.locator("#goal").selectOption("steady_state.speed_max");
  await page.locator(`[data-free="mechanism.cranks.A2.phase"]`).check();
  const before = await scalar(page, "steady_state.speed_max");
  const wanted = Math.round(1000 * (before + 0.03)) / 1000;
  await page.getByLabel("Wanted value").fill(String(wanted));
  await page.getByLabel("Wanted value").press("Enter");
  await shows(() => scalar(page, "steady_state.speed_max"), (value) => Math.abs(value / wanted - 1) < 1e-6);
  const phase = /phase = "([\d.]+ deg)"/.exec(await text())[1];
  const { results } = JSON.parse(execFileSync(LINKWRIGHT, ["run", `${ROOT}machines/roller_two_carts.toml`, "--json", "--set", `mechanism.cranks.A2.phase=${phase}`], { encoding: "utf8", timeout: PATIENCE }));
  near(await scalar(page, "steady_state.speed_max"), results.steady_state.speed_max);
  await page.locator("#goal").selectOption("");
  await write(CARTS);
});

test("one cursor stands in all plots of the crank angle, a click scrubs, a drag zooms, a double click shows all", async () => {
  await page.getByRole("tab", { name: "Plots" }).click();
  const over = page.locator(".panel .u-over");
  const box = await over.first().boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 40);
  const cursor = (n) => over.nth(n).locator(".u-cursor-x").evaluate((own) => Number(/translate\(([\d.]+)px/.exec(own.style.transform)?.[1]));
  await shows(async () => [await cursor(0), await cursor(1)], ([a, b]) => Math.abs(a - b) < 1 && Math.abs(a - 0.4 * box.width) < 2);
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 40);
  await shows(() => page.locator("#instant").textContent(), (words) => Math.abs(Number(/φ\s+([\d.]+)/.exec(words)[1]) - 180) < 2);
  const marks = () => page.locator(".panel canvas").first().evaluate((own) => own.toDataURL());
  const whole = await marks();
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 40, { steps: 4 });
  await page.mouse.up();
  await shows(marks, (now) => now !== whole);
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 40);
  await shows(marks, (now) => now === whole);
});

test("a chip says what stands in the way, and its button mends it", async () => {
  const chip = page.locator(".chip", { hasText: "Run-down" });
  await chip.getByText("The driveline has no brake.").waitFor();
  await chip.getByRole("button", { name: "Add a brake" }).click();
  await complete(page);
  await shows(() => chip.getAttribute("class"), (words) => words.includes("ready"));
  assert.ok((await scalar(page, "run_down.time")) > 0);
  await write(CARTS);
});

test("tables of the report stand among the numbers, diagrams are enlarged, both in the units of the page", async () => {
  await complete(page);
  await page.getByRole("tab", { name: "Numbers" }).click();
  const caption = page.locator("caption", { hasText: "Dead points" });
  await caption.waitFor();
  await page.getByRole("button", { name: "Units" }).click();
  await page.getByRole("button", { name: "Workshop" }).click();
  await page.keyboard.press("Escape");
  await complete(page);
  await shows(() => page.locator(".warning li").allTextContents(), (words) => words.some((each) => each.includes(" rpm")) && !words.some((each) => each.includes("rad/s")));
  await page.getByRole("tab", { name: "Diagrams" }).click();
  const figure = page.locator(".diagrams figure", { hasText: "Motion of" }).first();
  await shows(() => figure.locator("figcaption").textContent(), (words) => words.includes("m/s"));
  const small = (await figure.locator("svg").boundingBox()).width;
  await figure.getByRole("button", { name: "Enlarge" }).click();
  await shows(async () => (await page.locator("dialog[open] figure svg").boundingBox()).width, (width) => width > 1.8 * small);
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Units" }).click();
  await page.getByRole("button", { name: "SI" }).click();
  await page.keyboard.press("Escape");
  await known(page);
});

test("the units of a file are those of the page, until the user chooses others", async () => {
  const unit = () => page.evaluate(() => [globalThis.studio.state.units.value.m, globalThis.studio.state.units.value.N]);
  const before = await unit();
  await write(`${CARTS}\n[units]\nlength = "cm"\nforce = "kN"\n`);
  await shows(unit, (now) => now.join() === "cm,kN");
  assert.equal(await page.locator(`[data-address="${RADIUS}"]`).inputValue(), "20");
  await page.evaluate(() => globalThis.studio.state.choose({ ...globalThis.studio.state.units.value, m: "in" }));
  await known(page);
  await shows(unit, (now) => now.join() === "in,kN");
  await write(CARTS);
  await shows(unit, (now) => now[1] === before[1]);
  await page.evaluate((m) => globalThis.studio.state.choose({ ...globalThis.studio.state.units.value, m }), before[0]);
  await known(page);
});

test("own files are the first of the list, names have no quotes, and no two entries the same", async () => {
  await page.getByRole("button", { name: "Machines" }).click();
  assert.equal(await page.locator("dialog h3").first().textContent(), "Files of this folder");
  await page.keyboard.press("Escape");
  await page.getByRole("tab", { name: "Design" }).click();
  const words = await page.locator("#over-0 option").allTextContents();
  assert.equal(new Set(words).size, words.length, words.join("; "));
  assert.ok(words.some((each) => each.includes("cart1.rod")) && !words.some((each) => /["']/.test(each)), words.join("; "));
  const results = await page.locator("#asked option").allTextContents();
  assert.equal(new Set(results).size, results.length, results.join("; "));
  assert.ok(results.includes("stroke of the slide of cart1") && !results.some((each) => /sweeps/.test(each)), results.join("; "));
});

test("a name with markup is a name", async () => {
  await write(CARTS.replace(/^name = .*$/m, 'name = "<img src=x onerror=alert(1)><b>cart</b>"'));
  await complete(page);
  assert.equal(await page.locator("h1").textContent(), "<img src=x onerror=alert(1)><b>cart</b>");
  for (const tab of ["Plots", "Numbers", "Diagrams", "Design"]) {
    await page.getByRole("tab", { name: tab }).click();
    assert.equal(await page.locator("img[src=x]").count(), 0);
  }
  await write(CARTS);
});

/** What axe finds that is serious in a part of the page as it is. */
const serious = async (part = "body") => {
  const { violations } = await page.evaluate((of) => globalThis.axe.run(of, { resultTypes: ["violations"] }), part);
  return violations.filter(({ impact }) => ["serious", "critical"].includes(impact)).map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160)).join(" | ")}`);
};

for (const language of ["en", "uk"]) {
  test(`axe finds nothing serious in any tab and any dialog: ${language}`, async () => {
    await page.locator(".bar select").selectOption(language);
    await page.waitForFunction((code) => document.documentElement.lang === code, language);
    await page.evaluate(AXE);
    // Of a train and of a knife other words are said, in the same places.
    for (const name of [...(language === "en" ? ["geared_train_frequencies", "topper_crank"] : []), "roller_two_carts"]) {
      await open("library", name);
      assert.deepEqual(await serious(), [], name);
      for (const [list, count] of [["entries", 2], ["results", 4]]) {
        for (let n = 1; n < count; n += 1) {
          await page.locator(`#${list}-${n}`).click();
          if (list === "results" && n === 3 && name === "roller_two_carts") await page.locator("#goal").selectOption("steady_state.unevenness");
          await known(page);
          assert.deepEqual(await serious(`#${list}-panel`), [], `${name}: ${list} ${n}`);
        }
        await page.locator(`#${list}-0`).click();
      }
    }
    for (const dialog of ["gallery", "save", "files", "units", "elsewhere"]) {
      await page.evaluate((which) => (globalThis.studio.state.dialog.value = which), dialog);
      await page.locator(`dialog.${dialog}[open]`).waitFor();
      assert.deepEqual(await serious("dialog[open]"), [], dialog);
      await page.keyboard.press("Escape");
      await page.waitForFunction(() => !globalThis.studio.state.dialog.value);
    }
    await page.evaluate(() => (globalThis.studio.state.goal.value = ""));
  });
}

test("on the screen of a phone nothing is wider than it", async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  for (const language of ["en", "uk"]) {
    await page.locator(".bar select").selectOption(language);
    await page.waitForFunction((code) => document.documentElement.lang === code, language);
    for (const name of ["roller_two_carts", "geared_train_frequencies", "topper_crank"]) {
      await open("library", name);
      for (let n = 0; n < 4; n += 1) {
        await page.locator(`#results-${n}`).click();
        const wide = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
        assert.equal(wide[0], wide[1], `${name}, ${language}, tab ${n}`);
      }
    }
  }
  await page.locator(".bar select").selectOption("en");
  await page.setViewportSize({ width: 1440, height: 900 });
});

test("before the first answer the page says of nothing that it is wrong", async () => {
  const tab = await context.newPage();
  await tab.routeWebSocket(/./, () => {});
  await tab.goto(page.url());
  await tab.locator(".panels").waitFor();
  const words = await tab.locator("body").innerText();
  assert.match(words, /Opening …/);
  assert.doesNotMatch(words, /no TOML|No curves/);
  await tab.close();
});

test("there was no error on the console, and no request to elsewhere", () => assert.deepEqual(faults, []));
