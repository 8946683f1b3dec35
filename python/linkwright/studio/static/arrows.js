// Velocities, accelerations and forces as arrows at their points; the longest of each kind is a fixed part of the drawing.
import { fill, line, stroke } from "./ink.js";
import { at } from "./painter.js";
import { pairAt } from "./timeline.js";

/** Longest arrow over the shorter side of the drawing's box on the screen. */
const LONGEST = 0.35;

/** Largest size of each kind of arrow in a scene. @type {WeakMap<object, number>} */
const sizes = new WeakMap();

/** @param {Float64Array[]} arrays */
function largest(arrays) {
  let most = 0;
  for (const values of arrays) {
    for (let n = 0; n < values.length; n += 2) most = Math.max(most, values[n] ** 2 + values[n + 1] ** 2);
  }
  return Math.sqrt(most);
}

/** @param {object} key @param {() => Float64Array[]} arrays */
function sizeOf(key, arrays) {
  let size = sizes.get(key);
  if (size === undefined) sizes.set(key, (size = largest(arrays())));
  return size;
}

/**
 * @param {View} view @param {[number, number]} from @param {number} dx @param {number} dy on the screen
 * @param {string} colour
 */
function arrow({ ctx }, from, dx, dy, colour) {
  const length = Math.hypot(dx, dy);
  if (length < 2) return;
  const [x, y] = [from[0] + dx, from[1] + dy];
  const [ux, uy] = [dx / length, dy / length];
  const head = Math.min(9, 0.5 * length);
  const [u, v] = [x - ux * head, y - uy * head];
  line(ctx, [from, [u, v]]);
  stroke(ctx, colour, 2);
  line(ctx, [[x, y], [u - uy * head * 0.45, v + ux * head * 0.45], [u + uy * head * 0.45, v - ux * head * 0.45]]);
  fill(ctx, colour);
}

/** @param {View} view @param {Record<string, boolean>} layers */
export function paintArrows(view, layers) {
  const { scene, frame, k, series } = view;
  const span = LONGEST * frame.scale * Math.min(Math.max(scene.box[2] - scene.box[0], 1e-9), 2 * Math.max(scene.box[3] - scene.box[1], 1e-9));
  const kinds = /** @type {[string, Record<string, Float64Array>, string][]} */ ([
    ["velocities", scene.velocities, series[2]],
    ["accelerations", scene.accelerations, series[4]],
  ]);
  for (const [layer, rates, colour] of kinds) {
    if (!layers[layer]) continue;
    const size = sizeOf(rates, () => Object.values(rates));
    for (const [name, values] of Object.entries(rates)) {
      const [x, y] = pairAt(values, k);
      if (size > 0) arrow(view, at(view, name), (span * x) / size, (-span * y) / size, colour);
    }
  }
  if (!layers.forces || !scene.forces.length) return;
  const size = sizeOf(scene.forces, () => scene.forces.map(({ force }) => force));
  for (const { point, force } of scene.forces) {
    const [x, y] = pairAt(force, k);
    if (size > 0) arrow(view, at(view, point), (span * x) / size, (-span * y) / size, series[1]);
  }
}
