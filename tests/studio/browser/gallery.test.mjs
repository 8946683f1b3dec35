// Every machine of the gallery with all its results, and what stays of a language that was left.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import * as studio from "./served.mjs";
import { complete, known, shows } from "./served.mjs";

let page, faults, end;

before(async () => {
  ({ page, faults, end } = await studio.served());
});

after(() => end?.());

const open = async (place, name) => {
  await page.evaluate(([where, which]) => globalThis.studio.open(where, which), [place, name]);
  await complete(page);
};

test("every machine of the gallery opens, and shows its curves, numbers and diagrams", async () => {
  await page.getByRole("button", { name: "Machines" }).click();
  await page.locator(".card").nth(40).waitFor({ state: "attached" });
  const listed = await page.evaluate(() => globalThis.studio.state.listed.value);
  await page.keyboard.press("Escape");
  assert.ok(listed.length > 50);
  for (const { place, name } of listed) {
    await open(place, name);
    const { problems, message, figures } = await page.evaluate(() => {
      const { problems: { value: found }, message: { value: words }, figures: { value: drawn } } = globalThis.studio.state;
      return { problems: found, message: words, figures: drawn.length };
    });
    assert.deepEqual([problems, message], [[], ""], `${place}/${name}`);
    for (const n of [0, 1, 2]) {
      await page.locator(`#results-${n}`).click();
      const text = await page.locator("body").innerText();
      assert.doesNotMatch(text, /\b(NaN|undefined|Infinity)\b|\[object/, `${place}/${name}, tab ${n}`);
    }
    await shows(() => page.locator(".diagrams figure svg").evaluateAll((drawn) => drawn.filter((each) => each.getBoundingClientRect().width > 100).length), (count) => count === figures);
  }
  await page.locator("#results-0").click();
});

test("when the language changes, no result stays in the language before", async () => {
  await open("library", "v8_diesel");
  const tiles = () => page.locator(".head dt").allTextContents();
  assert.ok((await tiles()).length > 4);
  await page.locator(".bar select").selectOption("uk");
  await page.waitForFunction(() => document.documentElement.lang === "uk");
  await known(page);
  // At once, while slow analyses are not said anew yet; and then. Names of parts may stand among the words.
  const english = async () => (await tiles()).filter((words) => !/[а-яіїє]/i.test(words));
  assert.deepEqual(await english(), []);
  await complete(page);
  assert.ok((await tiles()).length > 4);
  assert.deepEqual(await english(), []);
  await page.locator(".bar select").selectOption("en");
  await complete(page);
  assert.deepEqual(await english(), await tiles());
});

test("there was no error on the console, and no request to elsewhere", () => assert.deepEqual(faults, []));
