import assert from "node:assert/strict";
import { test } from "node:test";
import { paintArrows } from "../../../python/linkwright/studio/static/arrows.js";
import { csv, svg, ticks } from "../../../python/linkwright/studio/static/exported.js";
import { folded, unfolded } from "../../../python/linkwright/studio/static/folded.js";
import { barLength, fit, toMachine, toScreen, zoomed } from "../../../python/linkwright/studio/static/frame.js";
import { history } from "../../../python/linkwright/studio/static/history.js";
import { between, onward, pairAt, placeOf } from "../../../python/linkwright/studio/static/timeline.js";
import { paintTrain } from "../../../python/linkwright/studio/static/twist.js";
import { pack, unpack } from "../../../python/linkwright/studio/static/wire.js";

test("a message holds words and arrays", () => {
  const text = JSON.stringify({ of: "π", a: { $: [0, 3] }, b: { $: [3, 2, 2] } });
  const words = new TextEncoder().encode(text);
  const length = Math.ceil(words.length / 8) * 8;
  const bytes = new Uint8Array(8 + length + 56).fill(32);
  new DataView(bytes.buffer).setUint32(0, 7, true);
  new DataView(bytes.buffer).setUint32(4, length, true);
  bytes.set(words, 8);
  new Float64Array(bytes.buffer, 8 + length).set([1, 2, 3, 4, 5, 6, 7]);
  const { number, body } = unpack(bytes.buffer);
  assert.equal(number, 7);
  assert.equal(body.of, "π");
  assert.deepEqual([...body.a], [1, 2, 3]);
  assert.deepEqual([...body.b], [4, 5, 6, 7]);
});

test("a request says its number and its length", () => {
  const message = pack(9, { ask: "gallery" });
  assert.deepEqual([...new Uint32Array(message.slice(0, 8))], [9, message.byteLength - 8]);
});

test("an instant lies between two entries of uneven times", () => {
  const times = [0, 1, 3, 4];
  assert.equal(placeOf(times, 2), 1.5);
  assert.equal(placeOf(times, 9), 3);
  assert.equal(between([0, 10, 20, 30], 1.5), 15);
  assert.equal(between([0, 10], 1), 10);
  assert.deepEqual(pairAt([0, 0, 2, 4], 0.5), [1, 2]);
});

test("time goes round, or back and forth", () => {
  assert.deepEqual(onward(3.5, 1, 1, 4, false), [0.5, 1]);
  assert.deepEqual(onward(3.5, 1, 1, 4, true), [3.5, -1]);
  assert.deepEqual(onward(0.5, -1, 1, 4, true), [0.5, 1]);
});

test("the drawing is to one scale, inside its frame, and leads back", () => {
  const frame = fit([-1, -0.5, 3, 0.5], 800, 400);
  for (const [x, y] of [[-1, -0.5], [3, 0.5]]) {
    const [X, Y] = toScreen(frame, x, y);
    assert.ok(X >= 0 && X <= 800 && Y >= 0 && Y <= 400);
    const [u, v] = toMachine(frame, X, Y);
    assert.ok(Math.abs(u - x) + Math.abs(v - y) < 1e-9);
  }
  const near = zoomed(frame, 2, 100, 50);
  const [u, v] = [toMachine(frame, 100, 50), toMachine(near, 100, 50)];
  assert.ok(Math.abs(u[0] - v[0]) + Math.abs(u[1] - v[1]) < 1e-12);
  assert.equal(barLength({ scale: 500, x: 0, y: 0 }), 0.2);
});

test("undo takes back one gesture, and a new one forgets what was undone", () => {
  const past = history("a");
  past.put("b");
  past.put("b");
  past.put("c");
  assert.equal(past.undo(), "b");
  assert.equal(past.undo(), "a");
  assert.equal(past.undo(), null);
  assert.equal(past.redo(), "b");
  past.put("d");
  assert.equal(past.canRedo, false);
  assert.equal(past.undo(), "b");
});

test("a state in a link comes back whole", async () => {
  const text = "name = 'π ✓'\n".repeat(200);
  const letters = await folded(text);
  assert.match(letters, /^[\w-]+$/);
  assert.ok(letters.length < text.length / 10);
  assert.equal(await unfolded(letters), text);
});

test("files of a plot have its heads, its numbers and no markup", () => {
  const sheet = { title: "<b>", heads: ["φ [°]", 'a, "b"'], rows: [[0, 1, 2], [1, NaN, 3]] };
  assert.equal(csv(sheet), 'φ [°],"a, ""b"""\n0,1\n1,\n2,3\n');
  const drawn = svg(sheet, ["red"]);
  assert.ok(drawn.includes("&lt;b&gt;") && !drawn.includes("<b>") && !drawn.includes("NaN"));
  assert.deepEqual(ticks(0, 10, 5), [0, 2, 4, 6, 8, 10]);
});

test("a train is drawn on paper of any size", () => {
  const radii = [];
  const call = (of) => (...given) => {
    if (of === "ellipse") radii.push(given[2], given[3]);
    if (of === "arc") radii.push(given[2]);
    return { width: 60 };
  };
  const ctx = new Proxy({}, { get: (_, of) => call(of), set: () => true });
  const disc = (name, x) => ({ name, x, row: 0, half: 0.4 });
  const part = { name: "s", kind: "shaft", ends: [0, 1], from: [0, 0], to: [1, 0], turned: false };
  const view = { kind: "train", discs: [disc("engine", 0), disc("generator", 1)], parts: [part], frequencies: [9], shapes: [1, -1], nodes: [[]], box: [0, 1, 1] };
  const paper = { ctx, ink: {}, series: [], names: true };
  for (const [width, height] of [[600, 400], [300, 60], [60, 20], [20, 6], [0, 0], [1, 400]]) paintTrain({ ...paper, width, height }, view, 0, 0.5);
  assert.ok(radii.length > 10);
  assert.ok(radii.every((radius) => radius > 0), String(radii));
});

test("arrows end on the canvas, the longest of each kind is a part of the drawing", () => {
  globalThis.devicePixelRatio = 1;
  /** @type {[number, number][]} */
  const tips = [];
  const ctx = /** @type {any} */ (new Proxy({ canvas: { width: 600, height: 200 } }, {
    get: (target, name) => target[name] ?? ((x, y) => name === "lineTo" && tips.push([x, y])),
    set: () => true,
  }));
  // A flat drawing; a point at its upper edge with a velocity upwards, and one that moves along.
  const box = [0, 0, 2, 0.4];
  const points = { A: new Float64Array([1, 0.4, 1, 0.4]), B: new Float64Array([1, 0, 1, 0]) };
  const scene = { box, points, velocities: { A: new Float64Array([0, 3, 0, 3]), B: new Float64Array([1, 0, 1, 0]) }, accelerations: {}, forces: [] };
  const frame = fit(box, 600, 200);
  paintArrows(/** @type {any} */ ({ ctx, scene, frame, k: 0, series: [], ink: {} }), { velocities: true });
  assert.ok(tips.length > 4);
  assert.ok(tips.every(([x, y]) => x >= 0 && x <= 600 && y >= 0 && y <= 200), String(tips));
  const highest = Math.min(...tips.map(([, y]) => y));
  assert.ok(Math.abs(highest - 4) < 1e-9, `${highest}`);
});
