// Units of the page: SI comes in, the user's choice is shown, everywhere at once.
import { decimal, point, unitSaid } from "./language.js";

const TURN = 2 * Math.PI;
const DEGREE = Math.PI / 180;

/**
 * SI unit as results print it → units to choose from with their factor to SI; the first is that of the sets "SI", "workshop" and "inch".
 * @type {Record<string, { word: string, units: Record<string, number>, sets: [string, string, string] }>}
 */
export const UNITS = {
  m: { word: "Length", units: { m: 1, mm: 1e-3, cm: 1e-2, in: 0.0254, ft: 0.3048 }, sets: ["m", "mm", "in"] },
  rad: { word: "Angle", units: { rad: 1, "°": DEGREE }, sets: ["°", "°", "°"] },
  "rad/s": { word: "Angular speed", units: { "rad/s": 1, rpm: TURN / 60, "°/s": DEGREE }, sets: ["rad/s", "rpm", "rpm"] },
  "m/s": { word: "Speed", units: { "m/s": 1, "mm/s": 1e-3, "m/min": 1 / 60, "in/s": 0.0254, "ft/s": 0.3048 }, sets: ["m/s", "m/s", "in/s"] },
  "m/s²": { word: "Acceleration", units: { "m/s²": 1, "mm/s²": 1e-3, "ft/s²": 0.3048 }, sets: ["m/s²", "m/s²", "ft/s²"] },
  N: { word: "Force", units: { N: 1, kN: 1e3, lbf: 4.4482216152605, kgf: 9.80665 }, sets: ["N", "N", "lbf"] },
  "N m": { word: "Torque", units: { "N m": 1, "kN m": 1e3, "N mm": 1e-3, "lbf ft": 1.3558179483314004, "lbf in": 0.1129848290276167 }, sets: ["N m", "N m", "lbf ft"] },
  kg: { word: "Mass", units: { kg: 1, g: 1e-3, t: 1e3, lb: 0.45359237 }, sets: ["kg", "kg", "lb"] },
  "kg m²": { word: "Moment of inertia", units: { "kg m²": 1, "kg cm²": 1e-4, "lb ft²": 0.04214011009380480 }, sets: ["kg m²", "kg m²", "lb ft²"] },
  W: { word: "Power", units: { W: 1, kW: 1e3, hp: 745.6998715822701 }, sets: ["W", "kW", "hp"] },
  "m³/s": { word: "Volume flow", units: { "m³/s": 1, "m³/d": 1 / 86400, "l/min": 1e-3 / 60, "bbl/d": 0.158987294928 / 86400 }, sets: ["m³/d", "m³/d", "bbl/d"] },
  s: { word: "Time", units: { s: 1, ms: 1e-3, min: 60 }, sets: ["s", "s", "s"] },
  J: { word: "Energy", units: { J: 1, kJ: 1e3, "kW h": 3.6e6, Btu: 1055.056 }, sets: ["J", "J", "Btu"] },
  Pa: { word: "Pressure", units: { Pa: 1, MPa: 1e6, bar: 1e5, psi: 6894.757293168361 }, sets: ["MPa", "MPa", "psi"] },
};

export const SETS = ["SI", "Workshop", "Inch"];

/** The units of a choice, one of each kind. @param {Record<string, string>} choice */
export const listed = (choice) => Object.entries(UNITS).map(([si, { sets }]) => choice[si] ?? sets[0]);

/** @param {number} set @returns {Record<string, string>} */
export const chosen = (set) => Object.fromEntries(Object.entries(UNITS).map(([si, { sets }]) => [si, sets[set]]));

/** The unit as results print it: files write `kg m^2`. @param {string} unit */
export const printed = (unit) => unit.replace(/\^(-?\d)/g, (_, power) => raised(power.replace("-", "⁻")));

/** Unit that is shown for an SI unit, and its factor. @param {string} si @param {Record<string, string>} choice @returns {{ unit: string, factor: number }} */
export function shownUnit(si, choice) {
  const known = printed(si);
  const unit = choice[known];
  const factor = unit === undefined ? undefined : UNITS[known]?.units[unit];
  return factor === undefined ? { unit: unitSaid(known), factor: 1 } : { unit: unitSaid(unit), factor };
}

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/**
 * A number as it is read: so many significant digits, a power of ten where it is very large or small, the decimal sign of the language.
 * @param {number} value @param {number} [digits]
 */
export const number = (value, digits = 5) => decimal(written(Math.abs(value) < TINY ? 0 : value, digits).replaceAll("-", "−").replace(/e(−?)(\d+)/, (_, sign, power) => `·10${sign && "⁻"}${raised(power)}`));

/** @param {string} digits */
const raised = (digits) => digits.replace(/\d/g, (digit) => RAISED[+digit]);

/** Below the smallest normal number, a double has lost its digits. */
const TINY = 2.3e-308;

/** Below this, a number with more places than digits is written out: 20240 W, not 2.024·10⁴ W. */
const LARGE = 1e7;

/** A number as files have it. @param {number} value @param {number} [digits] */
export function written(value, digits = 5) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= LARGE || size < 1e-4) return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(digits)));
}

const WRITTEN = /^([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([^\d.,].*|)$/i;

/** What was typed, or shown before, as files have it: 1.5·10⁻⁷, 1.5*10^-7 and 1,5e−7 are 1.5e-7. @param {string} text */
const plain = (text) => point(text.trim().replaceAll("−", "-")).replace(/ ?[·×*] ?10(?:\^(-?\d+)|(⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+))/, (_, power, high) => `e${power ?? high.replace("⁻", "-").replace(/[^-]/g, (/** @type {string} */ digit) => RAISED.indexOf(digit))}`);

/** A number in a field, or NaN. @param {string} text */
export const read = (text) => Number(plain(text));

/**
 * What was typed into a field: a number in the unit that is shown, or a text with a unit of its own, which the file then has.
 * @param {string} text @param {number} factor
 * @returns {number | string | null} SI number, text, or null for nothing
 */
export function typed(text, factor) {
  const match = WRITTEN.exec(plain(text));
  if (!match) return text.trim() || null;
  const value = Number(match[1]) * factor;
  return match[2] ? `${match[1]} ${match[2]}` : Number.isFinite(value) ? value : text;
}
