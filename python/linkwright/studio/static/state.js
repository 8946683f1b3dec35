// What the page knows, as signals: what reads one is drawn again when it changes.
import { batch, computed, effect, signal } from "./vendor/signals-core.mjs";
import { history } from "./history.js";
import { UNITS, chosen } from "./units.js";

/** @template T @typedef {import("./vendor/signals-core.mjs").Signal<T>} Signal */

/** @param {string} key @param {any} usual */
function kept(key, usual) {
  let first = usual;
  try {
    first = JSON.parse(localStorage.getItem(key) ?? "null") ?? usual;
  } catch {
    // What cannot be read is as good as nothing kept.
  }
  const found = signal(first);
  effect(() => {
    try {
      localStorage.setItem(key, JSON.stringify(found.value));
    } catch {
      // A browser that keeps nothing forgets it with the tab.
    }
  });
  return found;
}

// -- the file
export const text = signal("");
export const saved = signal("");
/** Takes over what was typed into the text and not yet read. */
export const typed = { flush: () => {} };
export const place = signal({ place: "", name: "" });
export const unsaved = computed(() => text.value !== saved.value);
export const past = signal({ of: history(""), turn: 0 });

// -- the machine
export const machine = signal("");
/** @type {Signal<Group | null>} */
export const controls = signal(null);
/** Entries that are being pulled at: address → SI. @type {Signal<Record<string, any>>} */
export const live = signal({});
/** @type {Signal<Problem[]>} */
export const problems = signal([]);
/** @type {Signal<Chip[]>} */
export const chips = signal([]);
/** @type {Signal<Scene | null>} */
export const scene = signal(null);
/** Entries that follow a handle, and points with one, as words: what is the same words draws nothing anew. */
export const draggable = computed(() => (scene.value?.handles ?? []).flatMap(({ entries }) => entries).join("\n"));
export const handled = computed(() => [...new Set([...(scene.value?.handles ?? []).map(({ point }) => point), pulled.value])].filter((point) => scene.value?.points[point]).join("\n"));
export const isDrawn = computed(() => scene.value !== null);
/** Why a drag stops, and the crank angle at which the linkage is at its limit there. */
export const reason = signal("");
export const limit = signal(/** @type {number | null} */ (null));
/** Points whose paths are drawn besides those of the file. @type {Signal<string[]>} */
export const trails = signal([]);
/** The point of a curve that is pulled with the entries that were chosen; empty for none. */
export const pulled = signal("");
/** Whether joints merge that are dropped on joints. */
export const building = signal(false);
/** Kinds of elements that can be added. @type {Signal<{ kind: string, word: string, group: string }[]>} */
export const kinds = signal([]);
/** What the mouse draws, "link", "driving" or "passive" cylinder, or nothing; what waits for further ones, and for what. */
export const drawing = signal("");
/** @type {Signal<[Spot, Spot, string][]>} */
export const draft = signal([]);
export const waits = signal("");

// -- answers, those of each lane apart, so that one does not wait for another
/** @type {Signal<Record<string, Answers>>} */
export const answers = signal({});
/** State of each lane: "ready", "running", "stopped". @type {Signal<Record<string, string>>} */
export const lanes = signal({});
export const runs = computed(() => Object.values(lanes.value).includes("running"));
const inOrder = computed(() => ["fast", "study", "torsion"].map((lane) => answers.value[lane]).filter(Boolean));
export const results = computed(() => inOrder.value.flatMap((each) => each.results));
/** Numbers of all results, each with the key of its result and its own. */
export const scalars = computed(() => results.value.flatMap(({ name, scalars: own }) => own.map((each) => ({ ...each, of: name, key: `${name}.${each.name}` }))));
/** Pictures beside the drawing. @type {Signal<any[]>} */
export const views = /** @type {any} */ (computed(() => inOrder.value.flatMap((each) => each.views ?? [])));
/** The picture that was chosen. */
export const seen = signal("mechanism");
export const tables = computed(() => inOrder.value.flatMap((each) => each.tables ?? []));
export const headline = computed(() => inOrder.value.flatMap((each) => each.headline ?? []));
export const figures = computed(() => inOrder.value.flatMap((each) => each.figures));
export const findings = computed(() => [...new Set(inOrder.value.flatMap((each) => each.findings))]);
export const warnings = computed(() => [...new Set(inOrder.value.flatMap((each) => each.warnings))]);

// -- the user's choices, kept for the next time
const own = kept("units", chosen(0));
/** Units of the file. @type {Signal<Record<string, string>>} */
const ofFile = signal({});
/** SI unit → unit that is shown: of the file, else of the user. @type {Signal<Record<string, string>>} */
export const units = signal(own.value);
effect(() => {
  units.value = { ...own.value, ...ofFile.value };
});

/** What the user chooses holds, for this file too. @param {Record<string, string>} choice */
export const choose = (choice) => batch(() => {
  const changed = Object.fromEntries(Object.entries(choice).filter(([si, unit]) => unit !== units.value[si]));
  own.value = { ...own.value, ...changed };
  ofFile.value = Object.fromEntries(Object.entries(ofFile.value).filter(([si]) => !(si in changed)));
});

let read = "";
let isLinked = false;
/** The units of a file that is opened, or whose table of units changes; null of another file. @param {Record<string, [string, number]> | null} given */
export function follow(given) {
  const now = JSON.stringify(given);
  if (now === read) return;
  read = now;
  for (const [si, [unit, factor]] of Object.entries(given ?? {})) UNITS[si].units[unit] ??= factor;
  // Those of a link hold, whatever its file says.
  if (isLinked && given) return (isLinked = false);
  const next = Object.fromEntries(Object.entries(given ?? {}).map(([si, [unit]]) => [si, unit]));
  if (JSON.stringify(next) !== JSON.stringify(ofFile.value)) ofFile.value = next;
}
export const look = kept("look", "");
export const language = kept("language", "en");
export const layers = kept("layers", { names: true, paths: true, velocities: false, accelerations: false, forces: false, centres: false, handles: true });
export const pace = kept("playback", 0);
/** Addresses that hold their values in a drag. @type {Signal<Record<string, boolean>>} */
export const locks = signal({});
/** Plots that are hidden, and entries whose slider has ends of its own. */
export const hidden = kept("hidden", /** @type {Record<string, boolean>} */ ({}));
export const ends = signal(/** @type {Record<string, [number, number]>} */ ({}));

// -- design
/** Results of the motion of the mechanism, which have no place among the numbers. @type {Signal<{ key: string, word: string, unit: string, value: number | null }[]>} */
export const kinematic = signal([]);
/** What says how something was computed, or counts, is no goal. */
const NO_GOAL = /\.(accuracy|sweeps|steps|turns|settled|period_turns|multiplier)$|^(scheme|along|transient)\.|error/;
/** Results that can be pulled, swept and sought; those of one name with what they are of. */
export const goals = computed(() => {
  const all = [...kinematic.value.map((each) => ({ symbol: "", ...each })), ...scalars.value.filter(({ key }) => !NO_GOAL.test(key))];
  const count = (/** @type {string} */ word) => all.filter((each) => each.word === word).length;
  return all.map(({ key, word, symbol, unit, value }) => ({ key, symbol, unit, value, word, of: count(word) > 1 ? key.split(".")[0].replaceAll("_", " ") : "" }));
});
/** The result that is pulled as it is now, while it is held. */
export const reached = signal(/** @type {number | null} */ (null));
/** What other results keep to: key → at least, at most [SI]. @type {Signal<Record<string, [number | null, number | null]>>} */
export const bounds = signal({});
/** The result whose derivatives stand beside the entries; empty for none. */
export const goal = kept("goal", "");
/** @type {Signal<Slopes | null>} */
export const slopes = signal(null);
/** Entries that follow the result that is pulled. @type {Signal<Record<string, boolean>>} */
export const free = signal({});
/** @type {Signal<Pin[]>} */
export const pins = signal([]);
/** What the last sweep or search has found so far. @type {Signal<any>} */
export const search = signal(null);

// -- the instant
export const playing = signal(!matchMedia("(prefers-reduced-motion: reduce)").matches);
export const time = signal(0);
export const picked = signal("");
/** Point whose curves are among the plots. */
export const watched = signal("");

// -- the page
export const connected = signal(true);
/** Whether the studio has taken the key of this page. */
export const known = signal(true);
export const message = signal("");
export const dialog = signal("");
/** Name of the diagram that is seen over the page. */
export const enlarged = signal("");
/** @type {Signal<Listed[]>} */
export const listed = signal([]);
export const seconds = signal(0);

// -- what a link brings besides the machine
const LINKED = /** @type {Record<string, Signal<any>>} */ ({ units, look, language, layers, pace, hidden, locks, ends, goal, free, bounds, trails, watched, pulled, seen });
export const shared = () => Object.fromEntries(Object.entries(LINKED).map(([key, { value }]) => [key, value]));

/** Values of the same kind as ours; a link may hold anything. @param {Record<string, any>} given */
export const share = (given) => batch(() => {
  isLinked = Boolean(given.units);
  for (const [key, own] of Object.entries(LINKED)) if (Object.prototype.toString.call(given[key]) === Object.prototype.toString.call(own.value)) own.value = given[key];
});
