import assert from "node:assert/strict";
import { test } from "node:test";
import { chosen, number, printed, read, shownUnit, typed, UNITS } from "../../../python/linkwright/studio/static/units.js";

test("numbers have the digits that are read, and no others", () => {
  const cases = [[0.2, "0.2"], [0.08496123, "0.084961"], [-1234.5678, "−1234.6"], [1e7, "1·10⁷"], [1.5e7, "1.5·10⁷"], [1234567, "1234600"], [1.5e-7, "1.5·10⁻⁷"], [0, "0"], [NaN, "–"], [100000, "100000"]];
  for (const [value, text] of cases) assert.equal(number(value), text);
});

test("a unit of a set is one of its row", () => {
  for (const { units, sets } of Object.values(UNITS)) for (const unit of sets) assert.ok(units[unit] > 0, unit);
});

test("what files write and what results print is one unit", () => {
  assert.equal(printed("kg m^2"), "kg m²");
  assert.deepEqual(shownUnit("kg m^2", chosen(1)), { unit: "kg m²", factor: 1 });
  assert.deepEqual(shownUnit("m", chosen(2)), { unit: "in", factor: 0.0254 });
  assert.deepEqual(shownUnit("N s/m", chosen(2)), { unit: "N s/m", factor: 1 });
});

test("a typed number is in the unit that is shown, a text keeps its own", () => {
  assert.equal(typed("210", 1e-3), 0.21);
  assert.equal(typed("−3.5e2", 1), -350);
  assert.equal(typed(" 8.5 in ", 1e-3), "8.5 in");
  assert.equal(typed("", 1), null);
  assert.equal(typed("lots", 1), "lots");
  // What no number of a machine can be is said as it was typed.
  for (const text of ["1e999", "1,5", "1.2.3"]) assert.equal(typed(text, 1), text);
  for (const text of ["1.5e7", "1.5E+7", "1.5·10⁷", "1.5·10^7", "1.5 × 10^7", "1.5*10^7"]) assert.equal(typed(text, 2), 3e7, text);
  assert.equal(typed("1.5·10⁻⁷ Pa", 1), "1.5e-7 Pa");
  assert.equal(read("−2·10⁻³"), -0.002);
});

test("a number that is shown can be typed again, and has no hyphen for its minus", () => {
  for (const value of [-350, 3.5e-5, -3.5e-5, -1.25e7, 0, 0.125]) {
    assert.equal(typed(number(value), 1), value);
    assert.ok(!number(value).includes("-"), number(value));
  }
});

test("what is nothing is shown as zero", () => {
  assert.equal(number(-2.9e-323), "0");
});
