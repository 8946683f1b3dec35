// Colours of canvas and plots: those of the style sheet, read once for each look.
import { look } from "./state.js";

/** @typedef {Record<"ink" | "soft" | "grid" | "panel" | "paper" | "accent" | "bad", string> & { series: string[] }} Colours */

/** @type {Colours | null} */
let known = null;
let of = "";
const dark = matchMedia("(prefers-color-scheme: dark)");

/** @returns {any} */
export function colours() {
  const now = `${look.value} ${dark.matches}`;
  if (known && of === now) return known;
  const style = getComputedStyle(document.documentElement);
  const read = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["ink", "soft", "grid", "panel", "paper", "accent", "bad"];
  known = /** @type {any} */ ({
    ...Object.fromEntries(names.map((name) => [name, read(name)])),
    series: ["blue", "red", "green", "purple", "orange", "sky"].map(read),
  });
  of = now;
  return /** @type {Colours} */ (known);
}

dark.addEventListener("change", () => {
  look.value = `${look.value}`;
});
