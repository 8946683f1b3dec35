// What an entry does to the result that is looked at, in words: "δ falls by 3 % per cm".
import { isElement } from "./build.js";
import { catalogue, said, saidOf } from "./language.js";
import * as state from "./state.js";
import { number, shownUnit } from "./units.js";

/** Share of an entry that one step of its arrow is about. */
const STEP = 0.05;

/** Changes below this share are none. */
const NONE = 5e-5;

/** @type {{ of: Group | null, language: string, by: Map<string, Entry>, count: Map<string, number> }} */
let known = { of: null, language: "", by: new Map(), count: new Map() };

/** Keys of an address; names of the user may stand in quotes. @param {string} address @returns {string[]} */
export const keysOf = (address) => (address.match(/"[^"]*"|'[^']*'|[^.]+/g) ?? []).map((key) => key.replace(/^(["'])(.*)\1$/s, "$2"));

/** The entry at an address; undefined if there is none. @param {string} address */
export function entryAt(address) {
  const whole = state.controls.value;
  const language = catalogue.value.code;
  if (known.of !== whole || known.language !== language) {
    known = { of: whole, language, by: new Map(), count: new Map() };
    const walk = (/** @type {Group} */ group) => {
      for (const each of group.entries) {
        known.by.set(each.address, each);
        const words = worded(each.address);
        known.count.set(words, (known.count.get(words) ?? 0) + 1);
      }
      group.groups.forEach(walk);
    };
    if (whole) walk(whole);
  }
  return known.by.get(address);
}

/** An address as words: "radius of A1"; with its table where two entries are called so. @param {string} address */
export function named(address) {
  entryAt(address);
  const words = worded(address);
  const keys = keysOf(address);
  return keys.length > 2 && (known.count.get(words) ?? 0) > 1 ? `${words} (${said(keys[keys.length - 3].replaceAll("_", " "))})` : words;
}

/** @param {string} address */
function worded(address) {
  const keys = keysOf(address);
  const [of, key] = keys.slice(-2);
  // What the user has named keeps its name.
  const isNamed = isElement(address.slice(0, address.lastIndexOf(".")));
  return keys.length > 1 ? saidOf("{} of {}", said(key.replaceAll("_", " ")), isNamed ? of : said(of.replaceAll("_", " "))) : address;
}

/**
 * A step of an entry in the user's unit that one would make, and what it does.
 * @param {Slopes} slopes @param {number} slope @param {Entry} entry @param {Record<string, string>} units
 * @returns {{ share: number, words: string }} relative change of the result
 */
export function effect(slopes, slope, entry, units) {
  const { unit, factor } = shownUnit(entry.unit ?? "", units);
  const size = Math.abs((entry.si ?? 0) / factor);
  const step = unit === "°" ? 1 : 10 ** Math.round(Math.log10(STEP * (size || 1)));
  const share = (slope * step * factor) / Math.abs(slopes.value);
  const sign = slopes.symbol.split("_")[0] || slopes.word;
  if (!Number.isFinite(share) || Math.abs(share) < NONE) return { share: 0, words: `${sign} does not change` };
  const one = step === 1 ? unit || "unit" : `${number(step)} ${unit}`.trim();
  return { share, words: `${sign} ${share < 0 ? "falls" : "rises"} by ${number(100 * Math.abs(share), 2)} % per ${one}` };
}

/** Entries with derivatives, those that do most within five hundredths of themselves first. @param {Slopes} slopes */
export function ranked(slopes) {
  return Object.entries(slopes.slopes)
    .flatMap(([address, slope]) => {
      const entry = entryAt(address);
      return entry?.holds === "quantity" ? [{ address, slope, entry, weight: Math.abs(slope) * (Math.abs(entry.si ?? 0) || (entry.unit === "rad" ? 1 : 0)) }] : [];
    })
    .filter(({ slope }) => slope !== 0)
    .sort((a, b) => b.weight - a.weight);
}
