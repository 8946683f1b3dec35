// Curves of a point that is picked: the arrays of the drawing as plots, place, velocity and acceleration over the crank angle.
import * as state from "./state.js";

/** @typedef {import("./types.js").Plot} Plot */

/** @param {Float64Array} pairs @param {0 | 1} which */
const column = (pairs, which) => Float64Array.from({ length: pairs.length / 2 }, (_, n) => pairs[2 * n + which]);

/** @returns {Plot[]} */
export function pointPlots() {
  const scene = state.scene.value;
  const name = state.watched.value;
  if (!scene || !(name in scene.velocities)) return [];
  const x = { name: "crank_angle", word: "crank angle", symbol: "φ", unit: "rad", values: scene.angles };
  const kinds = /** @type {[string, string, string, Float64Array][]} */ ([
    ["place", "", "m", scene.points[name]],
    ["velocity", "v_", "m/s", scene.velocities[name]],
    ["acceleration", "a_", "m/s²", scene.accelerations[name]],
  ]);
  return kinds.map(([word, head, unit, pairs]) => ({
    key: `points.${word}`,
    title: `${word} of ${name}`,
    unit,
    x,
    curves: /** @type {const} */ ([0, 1]).map((which) => ({ name: `${name}.${word}.${which}`, word: `${word} of ${name} along ${"xy"[which]}`, symbol: `${head}${"xy"[which]}`, unit, values: column(pairs, which) })),
  }));
}
