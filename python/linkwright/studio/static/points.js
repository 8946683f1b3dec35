// Curves of the point that is picked, and hodographs of it and of forces, from the arrays of the drawing.
import { saidOf } from "./language.js";
import * as state from "./state.js";

/** @param {Float64Array} pairs @param {0 | 1} which */
const column = (pairs, which) => Float64Array.from({ length: pairs.length / 2 }, (_, n) => pairs[2 * n + which]);

/** @param {Scene} scene */
const angleOf = (scene) => ({ name: "crank_angle", word: "crank angle", symbol: "φ", unit: "rad", values: scene.angles });

/** @returns {Plot[]} */
export function pointPlots() {
  const scene = state.scene.value;
  const name = state.watched.value;
  if (!scene || !(name in scene.velocities)) return [];
  const x = angleOf(scene);
  const kinds = /** @type {[string, string, string, Float64Array][]} */ ([
    ["place", "", "m", scene.points[name]],
    ["velocity", "v_", "m/s", scene.velocities[name]],
    ["acceleration", "a_", "m/s²", scene.accelerations[name]],
  ]);
  return kinds.map(([word, head, unit, pairs]) => ({
    key: `points.${word}`,
    title: saidOf(`${word} of {}`, name),
    unit,
    x,
    curves: /** @type {const} */ ([0, 1]).map((which) => ({ name: `${name}.${word}.${which}`, word: `${word} of ${name} along ${"xy"[which]}`, symbol: `${head}${"xy"[which]}`, unit, get values() { return column(pairs, which); } })),
  }));
}

/** Vectors with their components as coordinates: of the point that is picked, of the shaking force, of each joint. @returns {Plot[]} */
export function hodographs() {
  const scene = state.scene.value;
  if (!scene) return [];
  const x = angleOf(scene);
  const name = state.watched.value;
  /** @param {string} key @param {string} word @param {string} symbol @param {string} unit @param {Float64Array} pairs @returns {Plot} */
  const of = (key, word, symbol, unit, pairs) => ({
    key: `hodograph.${key}`,
    title: saidOf("hodograph, {}", word),
    unit,
    x,
    isHodograph: true,
    curves: /** @type {const} */ ([0, 1]).map((which) => ({ name: "xy"[which], word: `${word}, ${"xy"[which]}`, symbol: `${symbol}_${"xy"[which]}`, unit, get values() { return column(pairs, which); } })),
  });
  const ofPoint = name in scene.velocities ? [of("velocity", saidOf("velocity of {}", name), "v", "m/s", scene.velocities[name]), of("acceleration", saidOf("acceleration of {}", name), "a", "m/s²", scene.accelerations[name])] : [];
  const ofJoints = scene.forces.map((each) => of(`${each.point === name ? "picked" : "joint"}.${each.name}`, saidOf("force in {}", each.name), "F", "N", each.force));
  const shaking = state.results.value.flatMap(({ plots }) => plots).find(({ key }) => key === "forces.shaking_force_x");
  const [along, across] = shaking?.curves ?? [];
  const ofFrame = shaking && across ? [{ ...of("shaking_force", saidOf("shaking force"), "F_g", "N", new Float64Array(0)), x: shaking.x, curves: [along, across] }] : [];
  return [...ofPoint, ...ofFrame, ...ofJoints];
}
