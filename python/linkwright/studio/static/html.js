// Templates without a compiler. Texts of an element, and what it is called, appear in the language of the page, unless it says `translate="no"`.
import htm from "./vendor/htm.mjs";
import { h } from "./vendor/preact.mjs";
import { said } from "./language.js";

/** Attributes that are read or heard. */
const SAID = ["title", "aria-label", "aria-valuetext", "placeholder"];

/** @this {any} @param {any} type @param {any} props @param {any[]} children */
function element(type, props, ...children) {
  // Another language draws anew what never changes otherwise (htm, "Caching").
  this[0] = 3;
  // As a property of an element it is yes or no in truth values.
  if (props?.translate === "no") return h(type, { ...props, translate: false }, ...children);
  if (typeof type !== "string") return h(type, props, ...children);
  const called = props && Object.fromEntries(SAID.flatMap((name) => (typeof props[name] === "string" ? [[name, said(props[name])]] : [])));
  return h(type, { ...props, ...called }, ...children.map((child) => (typeof child === "string" ? said(child) : child)));
}

/** What is heard takes any event. @type {(texts: TemplateStringsArray, ...values: (((event: any) => any) | object | string | number | boolean | null | undefined)[]) => any} */
export const html = htm.bind(/** @type {typeof h} */ (/** @type {unknown} */ (element)));
