// Velocities, accelerations and forces as arrows at their points.
import { fit, toMachine } from "./frame.js";
import { fill, line, stroke } from "./ink.js";
import { at } from "./painter.js";
import { pairAt } from "./timeline.js";

/** Longest arrow over the shorter side of the drawing's box on the screen. */
const LONGEST = 0.35;

/** Metres of an arrow for one unit of each kind in a scene, and the canvas they are for. @type {WeakMap<object, [string, number]>} */
const known = new WeakMap();

/** Places with their vectors → metres of an arrow for one unit: all end on the canvas that the drawing fits. @param {View} view @param {Float64Array[][]} arrows */
function lengths({ ctx: { canvas }, scene: { box } }, arrows) {
  const [width, height] = [canvas.width, canvas.height].map((size) => size / (devicePixelRatio || 1));
  const home = fit(box, width, height);
  const [[left, top], [right, bottom]] = [toMachine(home, 4, 4), toMachine(home, width - 4, height - 4)];
  let [most, room] = [0, Infinity];
  for (const [places, vectors] of arrows) {
    for (let n = 0; n < vectors.length; n += 2) {
      const [x, y, u, v] = [places[n], places[n + 1], vectors[n], vectors[n + 1]];
      most = Math.max(most, Math.hypot(u, v));
      if (u) room = Math.min(room, ((u > 0 ? right : left) - x) / u);
      if (v) room = Math.min(room, ((v > 0 ? top : bottom) - y) / v);
    }
  }
  const span = LONGEST * Math.min(Math.max(box[2] - box[0], 1e-9), 2 * Math.max(box[3] - box[1], 1e-9));
  return most > 0 ? Math.max(Math.min(span / most, room), 0) : 0;
}

/** @param {View} view @param {[number, number]} from @param {number} dx @param {number} dy on the screen @param {string} colour */
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
  const { scene, frame, k, series, ctx: { canvas } } = view;
  for (const [layer, arrows, colour] of /** @type {[string, [string, Float64Array][], string][]} */ ([
    ["velocities", Object.entries(scene.velocities), series[2]],
    ["accelerations", Object.entries(scene.accelerations), series[4]],
    ["forces", scene.forces.map(({ point, force }) => [point, force]), series[1]],
  ])) {
    if (!layers[layer] || !arrows.length) continue;
    const [key, on] = [arrows[0][1], `${canvas.width} ${canvas.height}`];
    if (known.get(key)?.[0] !== on) known.set(key, [on, lengths(view, arrows.map(([name, vectors]) => [scene.points[name], vectors]))]);
    const size = frame.scale * (known.get(key)?.[1] ?? 0);
    for (const [name, vectors] of arrows) {
      const [x, y] = pairAt(vectors, k);
      arrow(view, at(view, name), size * x, -size * y, colour);
    }
  }
}
