// The page in the language of the user: its own texts, numbers and units. What the server says comes in that language.
import { signal } from "./vendor/signals-core.mjs";

/** @type {Catalogue} */
export const ENGLISH = { code: "en", texts: {}, units: {}, decimal: "." };

export const LANGUAGES = /** @type {Record<string, string>} */ ({ en: "English", uk: "Українська" });

export const catalogue = signal(ENGLISH);

/** Texts that were translated before: most are drawn again at every change. @type {{ of: Catalogue, texts: Map<string, string>, forms: [RegExp, string][] }} */
let known = { of: ENGLISH, texts: new Map(), forms: [] };

/** Most texts that are kept; numbers make new ones at every change. */
const MOST = 5000;

/** @param {string} text */
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** Letters of its own by which a text is known with something put in. */
const OWN = 3;

/** Texts into which something is put, those with most letters of their own first. @param {Catalogue} of @returns {[RegExp, string][]} */
const formsOf = ({ texts }) => Object.entries(texts).filter(([text]) => text.includes("{}") && text.replace(/[^a-z]/gi, "").length >= OWN).sort(([a], [b]) => b.length - a.length)
  .map(([text, words]) => [new RegExp(`^${escaped(text).replaceAll("\\{\\}", "(.+?)")}$`, "s"), words]);

/** A text in the language of the page; the text itself where it has no translation. Blanks at its ends stay. @param {string} text */
export function said(text) {
  const of = catalogue.value;
  if (of.code === "en" || !/[A-Za-z]{2}/.test(text)) return text;
  if (known.of !== of || known.texts.size > MOST) known = { of, texts: new Map(), forms: formsOf(of) };
  const before = known.texts.get(text);
  if (before !== undefined) return before;
  const bare = text.trim();
  const words = text.replace(bare, () => of.texts[bare] ?? filled(bare) ?? bare);
  known.texts.set(text, words);
  return words;
}

/** A text with something put in where it has `{}`, in the language of the page. @param {string} text @param {string[]} parts */
export const saidOf = (text, ...parts) => put(catalogue.value.texts[text] ?? text, parts);

/** @param {string} words @param {string[]} parts */
const put = (words, parts) => {
  const rest = [...parts];
  return words.replace(/\{(\d?)\}/g, (_, n) => (n ? parts[n - 1] : rest.shift()) ?? "");
};

/** @param {string} text @returns {string | null} */
function filled(text) {
  for (const [form, words] of known.forms) {
    const match = form.exec(text);
    if (match) return put(words, match.slice(1).map((part) => catalogue.value.texts[part] ?? part));
  }
  return null;
}

/** A unit as the language writes it: `N m` is `Н·м`. @param {string} unit */
export function unitSaid(unit) {
  const { code, units } = catalogue.value;
  if (code === "en") return unit;
  return unit.replace(/[A-Za-z]+/g, (part) => units[part] ?? part).replace(/(?<=[\p{L}²³⁴]) (?=\p{L})/gu, "·");
}

/** A number with the decimal sign of the language. @param {string} digits */
export const decimal = (digits) => (catalogue.value.decimal === "." ? digits : digits.replace(".", catalogue.value.decimal));

/** A number as it was typed, with a decimal point: a comma is one where the language has it. @param {string} digits */
export const point = (digits) => (catalogue.value.decimal === "." ? digits : digits.replace(catalogue.value.decimal, "."));

/** The catalogue of a language, from the server. @param {string} code @param {string} key */
export async function speak(code, key) {
  const found = code === "en" ? ENGLISH : await fetch(`texts/${code}.json`, { headers: { "X-Linkwright-Key": key } }).then((answer) => (answer.ok ? answer.json() : ENGLISH), () => ENGLISH);
  document.documentElement.lang = found.code;
  catalogue.value = found;
}
