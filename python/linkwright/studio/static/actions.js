// What a user does, and what becomes of the answers.
import { batch, effect, signal } from "./vendor/signals-core.mjs";
import { folded, unfolded } from "./folded.js";
import { history } from "./history.js";
import { taken } from "./key.js";
import { speak } from "./language.js";
import * as state from "./state.js";
import { hodographs, pointPlots } from "./points.js";
import { connect } from "./socket.js";
import { between, placeOf } from "./timeline.js";
import { listed } from "./units.js";

/** Where the browser keeps what is not saved, one text a file, and which file was changed last. @param {{ place: string, name: string }} of */
const keptAs = ({ place, name }) => `kept text ${place}/${name}`;
const LAST = "kept last";

/** Grows with every machine that is no longer pulled at. */
const turn = signal(0);
let begun = 0;

/** Hooks of the measurements in the tests: milliseconds from a change to the plots drawn anew. */
export const measured = /** @type {{ redrawn: number[] }} */ ({ redrawn: [] });

const link = connect({
  answer: (number, body) => batch(() => HEAR[body.of]?.(body)),
  state(connected, known) {
    if (connected) tongue();
    if (connected && !state.connected.value && state.text.value) {
      compute({ text: state.text.value });
    }
    state.connected.value = connected;
    state.known.value = known;
    if (connected) begin();
  },
});

/** No problems, which are the same at every change: nothing is drawn anew. @type {Problem[]} */
const SOUND = [];

/** @type {Record<string, (body: any) => void>} */
const HEAR = {
  entered({ kinds }) {
    state.kinds.value = kinds;
  },
  machine(body) {
    state.seconds.value = body.seconds;
    state.reason.value = body.reason ?? "";
    state.limit.value = body.limit ?? null;
    state.reached.value = body.reached ?? null;
    if (body.words) state.message.value = body.words;
    if (body.draft === "done") state.draft.value = [];
    if (body.draft === "refused") state.draft.value = state.draft.value.slice(0, -1);
    if (body.draft) state.waits.value = body.waits ?? "";
    state.problems.value = body.problems ?? SOUND;
    if (body.text !== undefined) {
      state.text.value = body.text;
      remember(body.text);
    }
    if (body.controls) state.controls.value = body.controls;
    if (body.chips) state.chips.value = body.chips;
    if (body.units) state.follow(body.units);
    if (body.goals) state.kinematic.value = body.goals;
    if (body.lanes) begunLanes(body.lanes, !body.problems);
    state.live.value = body.controls === undefined ? body.set : {};
    if (body.machine !== undefined) state.machine.value = body.machine;
    if (body.controls !== undefined) turn.value += 1;
    if (body.results) {
      atTheSameAngle(state.scene.value, body.scene);
      state.scene.value = body.scene;
      put("fast", body);
    }
    if (begun) requestAnimationFrame(redrawn);
  },
  beside(body) {
    put(body.lane, body);
    state.lanes.value = { ...state.lanes.value, [body.lane]: "ready" };
  },
  stopped(body) {
    state.lanes.value = { ...state.lanes.value, [body.lane]: "stopped" };
  },
  search(body) {
    state.search.value = { ...state.search.value, ...body };
  },
  refused(body) {
    state.message.value = body.words;
  },
};

/** Another length is another motion over time: the drawing stays at its crank angle. @param {Scene | null} before @param {Scene | null} after */
function atTheSameAngle(before, after) {
  if (!before || !after) return;
  const angle = between(before.angles, placeOf(before.times, state.time.value));
  state.time.value = between(after.times, placeOf(after.angles, angle));
}

/** @param {string[]} lanes @param {boolean} sound */
function begunLanes(lanes, sound) {
  state.lanes.value = Object.fromEntries(lanes.map((lane) => [lane, sound ? "running" : "stopped"]));
  const there = ["fast", ...lanes];
  state.answers.value = Object.fromEntries(Object.entries(state.answers.value).filter(([lane]) => there.includes(lane)));
}

/** @param {string} lane @param {any} body */
function put(lane, { results, findings, warnings, figures, views, tables, headline }) {
  state.answers.value = { ...state.answers.value, [lane]: { results, findings, warnings, figures, views, tables, headline } };
}

function redrawn() {
  measured.redrawn.push(performance.now() - begun);
  begun = 0;
}

/** @param {string} text */
function remember(text) {
  state.past.value.of.put(text);
  state.past.value = { ...state.past.value };
  keep();
}

function keep() {
  const [key, text] = [keptAs(state.place.value), state.text.value];
  try {
    localStorage.removeItem(key);
    if (!state.unsaved.value) return;
    localStorage.setItem(key, text);
    localStorage.setItem(LAST, JSON.stringify(state.place.value));
  } catch {
    // Without storage there is nothing to recover from.
  }
}

/** Whether an answer is on its way. */
export const busy = () => link.busy();

/** @param {Omit<Asked, "ask">} request */
function compute(request) {
  begun = performance.now();
  link.compute({ ask: "compute", ...(request.text === undefined ? {} : state.place.value), ...request });
}

// -- changes

/** A slider or a joint that is held. @param {Record<string, any>} set */
export const hold = (set) => compute({ held: true, set });

/**
 * A joint that is dragged, or let go; the entries of its handle follow, or those with limits.
 * @param {{ point: string, x: number, y: number, angle: number, pixel: number, free?: Record<string, [number, number]> }} drag @param {boolean} [held]
 */
export function pull(drag, held = true) {
  const locked = Object.keys(state.locks.value).filter((address) => state.locks.value[address]);
  compute({ held, drag: { ...drag, locked } });
}

/** What hangs on a joint hangs on another; its element goes. @param {string} joint @param {string} into */
export const merge = (joint, into) => compute({ merge: { joint, into } });

/** An element more, of the size of the drawing. @param {string} kind */
export function add(kind) {
  const box = state.scene.value?.box;
  const size = (box ? Math.max(box[2] - box[0], box[3] - box[1]) : 0) || 1;
  compute({ add: { kind, size, picked: state.watched.value } });
}

/** Links that were drawn: they become elements once each new joint has two. @param {number} angle @param {number} pixel */
export const draw = (angle, pixel) => compute({ draw: { links: state.draft.value, angle, pixel } });

/** Let go: what was held goes into the file. @param {Record<string, any>} set @param {string} [text] another text in its place */
export const settle = (set, text) => (text === undefined ? compute({ set }) : write(text));

/** The result that is looked at goes to a value; entries follow within their limits. @param {number} value @param {Record<string, [number, number]>} free @param {boolean} held */
export const to = (value, free, held) => compute({ held, reach: { of: state.goal.value, value, free, bounds: state.bounds.value } });

/** The machine at hand stays beside those that follow. */
export function pin(text = state.text.value) {
  const names = new Set(state.pins.value.map(({ name }) => name));
  let n = 1;
  while (names.has(`Variant ${n}`)) n += 1;
  const results = state.results.value;
  const scalars = Object.fromEntries(state.scalars.value.map(({ key, value }) => [key, value]));
  const plots = Object.fromEntries([...pointPlots(), ...hodographs(), ...results.flatMap(({ plots: own }) => own)].map(({ key, x, curves }) => [key, { x: x.values, curves: Object.fromEntries(curves.map(({ name, values }) => [name, values])) }]));
  state.pins.value = [...state.pins.value, { name: `Variant ${n}`, text, scalars, plots }];
}

/** @param {number} place */
export const unpin = (place) => (state.pins.value = state.pins.value.filter((_, n) => n !== place));

/** @param {object} asked */
export function seek(asked) {
  state.search.value = { ...asked, done: 0, rows: 0, course: { machines: [], best: [] }, axes: [], kind: "" };
  link.send({ ask: "search", ...asked, bounds: state.bounds.value });
}

/** A file of the machine; null if it was stopped or cannot be made. @param {object} asked @returns {Promise<Blob | null>} */
export async function make(asked) {
  const body = await link.ask({ ask: "export", ...asked });
  if (body.words) state.message.value = body.words;
  if (!body.data) return null;
  return new Blob([Uint8Array.from(atob(body.data), (letter) => letter.charCodeAt(0))]);
}

export const stopMaking = () => link.send({ ask: "end export" });

export const stopSearch = () => link.send({ ask: "end search" });

// Derivatives follow the machine, and the result that is looked at.
effect(() => {
  const [response, now] = [state.goal.value, turn.value];
  state.slopes.value = null;
  if (!response || !now || state.problems.peek().length) return;
  link.ask({ ask: "slopes", response }).then((body) => {
    if (body.of === "slopes" && response === state.goal.value && now === turn.value) state.slopes.value = body;
  });
});

/** What the server says from now on is in the language of the page, and in its units. */
const tongue = () => link.send({ ask: "language", code: state.language.value, units: listed(state.units.value) });

effect(() => {
  if (taken.value) speak(state.language.value, taken.value);
});

let spoken = "";
effect(() => {
  const now = [state.language.value, ...listed(state.units.value)].join();
  if (spoken && now !== spoken) {
    tongue();
    // What was said in the language before goes, unless its answer comes anew at once.
    const { fast } = state.answers.peek();
    if (now.slice(0, 2) !== spoken.slice(0, 2)) state.answers.value = fast && !state.problems.peek().length ? { fast } : {};
    if (state.text.peek()) compute({ text: state.text.peek() });
  }
  spoken = now;
});

/** The pose before the gesture. */
export const letBack = () => compute({ text: state.text.value });

/** @param {string} text */
export function write(text) {
  state.text.value = text;
  remember(text);
  compute({ text });
}

export function undo() {
  const text = state.past.value.of.undo();
  if (text !== null) again(text);
}

export function redo() {
  const text = state.past.value.of.redo();
  if (text !== null) again(text);
}

/** @param {string} text */
function again(text) {
  state.text.value = text;
  state.past.value = { ...state.past.value };
  keep();
  compute({ text });
}

export const stop = () => link.send({ ask: "stop" });

// -- files

/** @param {string} place @param {string} name */
export async function open(place, name) {
  const body = await link.ask({ ask: "open", place, name });
  if (body.of !== "file") return HEAR.refused(body);
  start(body, body.text, body.text);
}

/** @param {{ place: string, name: string }} of @param {string} text @param {string} saved */
export function start({ place, name }, text, saved) {
  batch(() => {
    state.follow(null);
    state.place.value = { place, name };
    state.text.value = text;
    state.saved.value = saved;
    state.past.value = { of: history(text), turn: 0 };
    state.answers.value = {};
    state.scene.value = null;
    state.time.value = 0;
    state.picked.value = "";
    state.watched.value = "";
    state.pulled.value = "";
    state.trails.value = [];
    state.message.value = "";
    state.dialog.value = "";
    state.locks.value = {};
    state.ends.value = {};
    state.free.value = {};
    state.bounds.value = {};
    state.draft.value = [];
    state.waits.value = "";
    state.pins.value = [];
    state.search.value = null;
  });
  globalThis.history.replaceState(null, "", place ? `#open=${place}/${encodeURIComponent(name)}` : "#");
  compute({ text });
}

/** @param {string} name @param {boolean | string} replace or the text that it replaces */
export async function save(name, replace) {
  state.typed.flush();
  const text = state.text.value;
  const body = await link.ask({ ask: "save", name, text, replace });
  if (body.of !== "saved") return HEAR.refused(body);
  batch(() => {
    state.place.value = { place: "folder", name };
    state.saved.value = text;
    state.dialog.value = "";
    state.message.value = `Saved as ${name}.`;
  });
  globalThis.history.replaceState(null, "", `#open=folder/${encodeURIComponent(name)}`);
  keep();
}

export async function list() {
  const body = await link.ask({ ask: "gallery" });
  if (body.of === "gallery") state.listed.value = body.machines;
}

/** @param {string} place @param {string} name @returns {Promise<any>} */
export const thumbnail = (place, name) => link.ask({ ask: "thumbnail", place, name });

/** What was not saved of the file at hand when the page was left, as a change that can be undone. */
function recover() {
  const text = localStorage.getItem(keptAs(state.place.value));
  if (text === null || text === state.text.value) return;
  write(text);
  state.message.value = "Unsaved changes are restored; Undo removes them.";
}

/** The whole state of the page as letters for an address. */
export const whole = () => folded(JSON.stringify({ ...state.shared(), of: state.place.value, text: state.text.value, time: state.time.value, pins: state.pins.value.map(({ text }) => text) }));

/** A state from an address. A file of the folder that has the same name is another one. @param {string} letters */
async function restore(letters) {
  const { of, text, time, pins, ...given } = JSON.parse(await unfolded(letters));
  start(of?.place === "library" ? of : { place: "", name: "" }, String(text), "");
  state.share(given);
  for (const each of Array.isArray(pins) ? pins : []) {
    compute({ text: String(each) });
    await idle();
    if (!state.problems.value.length) pin(String(each));
  }
  if (state.pins.value.length) compute({ text: state.text.value });
  await idle();
  state.playing.value = false;
  state.time.value = Number(time) || 0;
}

/** Ends once no answer is on its way. @returns {Promise<void>} */
const idle = () => new Promise((resolve) => {
  const look = () => (link.busy() ? setTimeout(look, 20) : resolve());
  look();
});

let hasBegun = false;

/** Opens what the address names: a machine, or a whole state. */
async function begin() {
  if (hasBegun) return;
  hasBegun = true;
  const words = new URLSearchParams(location.hash.slice(1));
  const [place, ...rest] = (words.get("open") ?? "").split("/");
  const packed = words.get("state");
  let problem = "";
  if (packed) {
    try {
      return await restore(packed);
    } catch {
      problem = "The link contains no state of a studio.";
    }
  }
  const last = JSON.parse(localStorage.getItem(LAST) ?? "null");
  const of = rest.length ? { place, name: rest.join("/") } : last && localStorage.getItem(keptAs(last)) !== null ? last : { place: "library", name: "roller_two_carts" };
  if (of.name) await open(of.place, of.name);
  else start(of, "", "");
  recover();
  if (problem) state.message.value = problem;
}
