// Colours of canvas and plots: those of the style sheet, read once for each look.
import { look } from "./state.js";
import { computed, effect, signal } from "./vendor/signals-core.mjs";

/** @type {Colours | null} */
let known = null;
let of = "";
const dark = matchMedia("(prefers-color-scheme: dark)");
const isDark = signal(dark.matches);
/** The look on the page: the user's, or that of the system. */
export const shownLook = computed(() => look.value || (isDark.value ? "dark" : "light"));

/** @returns {any} */
export function colours() {
  const now = shownLook.value;
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

dark.addEventListener("change", () => (isDark.value = dark.matches));
// Before what is drawn asks for its colours.
effect(() => {
  document.documentElement.dataset.look = shownLook.value;
});
