// A shaft train from the side that twists in one of its modes; lines on the shafts show their twist.

import { circle, fill, line, stroke } from "./ink.js";

/** Angle of the peak amplitude as it is drawn [rad]; the true one is far below what one sees. */
const PEAK = 0.8;

/** Width of a face over its height, and lines on the half of a shaft that is seen. */
const FACE = 0.3;
const LINES = 8;

/** Slope of names that would meet their neighbours, half height of the largest disc, room beside the train [px], letters of names. */
const LEAN = 0.55;
const HIGH = 0.36;
const MARGIN = 26;
const LETTERS = "12px system-ui, sans-serif";

/** Amplitude of an end in the mode that is shown; 0 of the ground. @param {Sight} sight @param {number | null} disc */
const amplitude = ({ view, mode }, disc) => (disc === null ? 0 : view.shapes[mode * view.discs.length + disc]);

/** Shares of the way along a part, and amplitudes there. @param {Sight} sight @param {Joint} part @returns {[number[], number[]]} */
function along(sight, part) {
  const { share, angles } = part;
  if (share && angles) {
    const own = Array.from(angles.subarray(sight.mode * share.length, (sight.mode + 1) * share.length));
    return part.turned ? [Array.from(share, (each) => 1 - each).reverse(), own.reverse()] : [Array.from(share), own];
  }
  return [[0, 1], part.ends.map((end) => amplitude(sight, end))];
}

/** @param {Sight} sight @param {Joint} part */
function shaft(sight, part) {
  const { ctx, ink, series, X, Y, unit, swing } = sight;
  const [x0, x1, y] = [X(part.from[0]), X(part.to[0]), Y(part.from[1])];
  const isSoft = part.kind === "coupling";
  const r = Math.min(Math.max(0.085 * unit, 5), 13) * (isSoft ? 1.6 : 1);
  ctx.fillStyle = ink.panel;
  ctx.fillRect(Math.min(x0, x1), y - r, Math.abs(x1 - x0), 2 * r);
  const [shares, amplitudes] = along(sight, part);
  const fine = shares.length > 2 ? shares.map((share, n) => [share, amplitudes[n]]) : Array.from({ length: 13 }, (_, n) => [n / 12, amplitudes[0] + (n / 12) * (amplitudes[1] - amplitudes[0])]);
  ctx.beginPath();
  for (let n = 0; n < 2 * LINES; n += 1) {
    let pen = false;
    for (const [share, size] of fine) {
      const angle = (n * Math.PI) / LINES + PEAK * size * swing;
      // Only the half that faces the reader is seen.
      if (Math.sin(angle) <= 0) pen = false;
      else {
        const at = /** @type {const} */ ([x0 + share * (x1 - x0), y - r * Math.cos(angle)]);
        if (pen) ctx.lineTo(...at);
        else ctx.moveTo(...at);
        pen = true;
      }
    }
  }
  stroke(ctx, series[isSoft ? 4 : 0], 1.1);
  for (const side of [-r, r]) {
    line(ctx, [[x0, y + side], [x1, y + side]]);
    stroke(ctx, series[isSoft ? 4 : 0], 1.6);
  }
  if (part.ends[1] === null) wall(sight, x1, y, x1 > x0 ? 1 : -1);
}

/** The ground at the end of a shaft. @param {Sight} sight @param {number} x @param {number} y @param {number} side */
function wall({ ctx, ink, unit }, x, y, side) {
  const half = 0.32 * unit;
  line(ctx, [[x, y - half], [x, y + half]]);
  for (let at = -half; at < half; at += 8) {
    ctx.moveTo(x, y + at);
    ctx.lineTo(x + 7 * side, y + at + 7);
  }
  stroke(ctx, ink.soft, 1.5);
}

/** What holds a ring on its disc. */
const RINGS = new Set(["damper", "pendulum"]);

/** What is no shaft: gears, a damper, a bridge. @param {Sight} sight @param {Joint} part */
function tie({ ctx, ink, series, view, X, Y, unit }, part) {
  const isGear = part.kind === "gears" || part.kind === "mesh";
  const way = Math.sign(part.to[1] - part.from[1]);
  // Gears meet at their rims, not at their shafts.
  const rim = (/** @type {number | null} */ end) => (way && end !== null ? view.discs[end].half * unit : 0);
  const a = [X(part.from[0]), Y(part.from[1]) + way * rim(part.ends[0])];
  const b = [X(part.to[0]), Y(part.to[1]) - way * rim(part.ends[1])];
  ctx.setLineDash(isGear ? [2, 3] : [6, 4]);
  line(ctx, [a]);
  if (a[1] === b[1] && !RINGS.has(part.kind) && part.kind !== "bearing") ctx.quadraticCurveTo((a[0] + b[0]) / 2, a[1] - 0.6 * unit, b[0], b[1]);
  else ctx.lineTo(b[0], b[1]);
  stroke(ctx, isGear ? series[1] : RINGS.has(part.kind) ? series[2] : ink.soft, isGear ? 3 : 2.5);
  ctx.setLineDash([]);
}

/** @param {Sight} sight @param {Disc} disc @param {number} n */
function wheel(sight, disc, n) {
  const { ctx, ink, series, X, Y, unit, swing, names } = sight;
  const [x, y, half] = [X(disc.x), Y(disc.row), disc.half * unit];
  const [wide, thick] = [FACE * half, Math.min(Math.max(0.05 * unit, 4), 9)];
  const angle = PEAK * amplitude(sight, n) * swing;
  const face = (/** @type {number} */ at) => {
    ctx.beginPath();
    ctx.ellipse(at, y, wide, half, 0, 0, 2 * Math.PI);
  };
  ctx.lineWidth = 1.8;
  ctx.strokeStyle = ink.ink;
  ctx.fillStyle = ink.grid;
  face(x - thick);
  ctx.fill();
  ctx.stroke();
  ctx.fillRect(x - thick, y - half, 2 * thick, 2 * half);
  for (const side of [-half, half]) {
    line(ctx, [[x - thick, y + side], [x + thick, y + side]]);
    ctx.stroke();
  }
  face(x + thick);
  fill(ctx, ink.panel);
  // From where it rests to where it is.
  const rim = (/** @type {number} */ turn) => /** @type {const} */ ([x + thick + wide * Math.sin(turn), y - half * Math.cos(turn)]);
  line(ctx, [[x + thick, y], ...Array.from({ length: 13 }, (_, k) => rim((k / 12) * angle))], true);
  fill(ctx, series[angle < 0 ? 0 : 1], 0.35);
  for (let k = 0; k < 4; k += 1) {
    line(ctx, [[x + thick, y], rim(angle + (k * Math.PI) / 2)]);
    stroke(ctx, ink.ink, 1);
  }
  line(ctx, [[x + thick, y], rim(angle)]);
  stroke(ctx, series[angle < 0 ? 0 : 1], 3);
  face(x + thick);
  stroke(ctx, ink.ink, 1.8);
  if (!names) return;
  ctx.font = LETTERS;
  ctx.fillStyle = ink.ink;
  const words = disc.name.replaceAll("_", " ");
  ctx.save();
  ctx.translate(x, y + (sight.leans ? HIGH * unit : half) + 15);
  if (sight.leans) ctx.rotate(LEAN);
  ctx.textAlign = sight.leans ? "left" : "center";
  ctx.fillText(words, 0, 0);
  ctx.restore();
}

/** Places at rest, on shafts and on discs. @param {Sight} sight */
function nodes({ ctx, ink, view, mode, X, Y }) {
  for (const { at, share } of view.nodes[mode]) {
    const part = view.parts.find(({ name, kind }) => name === at && !RINGS.has(kind) && kind !== "arm");
    const disc = part ? null : view.discs.find(({ name }) => name === at);
    if (!part && !disc) continue;
    const way = part?.turned ? 1 - share : share;
    const [x, row] = part ? [part.from[0] + way * (part.to[0] - part.from[0]), part.from[1] + way * (part.to[1] - part.from[1])] : [disc?.x ?? 0, disc?.row ?? 0];
    circle(ctx, X(x), Y(row), 4.5);
    fill(ctx, ink.bad);
    stroke(ctx, ink.panel, 1.5);
  }
}

/** Smallest room for a train [px]. */
const LEAST = 12;

/**
 * Draws a train; `swing`, −1 to 1, is where in the period of the mode it is.
 * @param {Paper} paper @param {Train} view @param {number} mode @param {number} swing @param {boolean} [names] @returns {void}
 */
export function paintTrain(paper, view, mode, swing, names = true) {
  const { ctx, width, height } = paper;
  const [low, high, rows] = view.box;
  ctx.font = LETTERS;
  const longest = names ? Math.max(...view.discs.map(({ name }) => ctx.measureText(name.replaceAll("_", " ")).width)) : 0;
  const leans = longest > (0.8 * (width - 2 * MARGIN)) / (high - low + 0.5);
  const [left, right] = names ? [MARGIN, leans ? Math.max(MARGIN, longest * Math.cos(LEAN)) : MARGIN] : [8, 8];
  const foot = names ? (leans ? longest * Math.sin(LEAN) : 0) + 20 : 4;
  // Without room for names, as before a page has its size, the train stands alone, or nothing.
  if (Math.min(width - left - right, height - foot) < LEAST) {
    if (names) paintTrain(paper, view, mode, swing, false);
    return;
  }
  const scale = Math.min((width - left - right) / (high - low + 0.5), 1.1 * height);
  // Of one row the shape of the mode stands below it.
  const isOne = rows === 1 && names && height > 3 * foot + 200;
  const tall = isOne ? 0.55 * height : height;
  const unit = Math.min((tall - foot) / rows, 1.9 * scale);
  const X = (/** @type {number} */ x) => (left + width - right) / 2 + scale * (x - (low + high) / 2);
  const Y = (/** @type {number} */ row) => (tall - foot) / 2 + unit * (row - (rows - 1) / 2) + 4;
  const sight = { ...paper, view, mode: Math.min(mode, view.frequencies.length - 1), swing, names, leans, X, Y, unit };
  // From the left to the right: what is to the right stands before it.
  const drawn = /** @type {[number, () => void][]} */ ([
    ...view.parts.map((part) => [Math.min(part.from[0], part.to[0]) + 1e-3, () => (part.from[1] === part.to[1] && (part.kind === "shaft" || part.kind === "coupling") ? shaft(sight, part) : tie(sight, part))]),
    ...view.discs.map((disc, n) => [disc.x, () => wheel(sight, disc, n)]),
  ]);
  for (const [, draw] of drawn.sort(([a], [b]) => a - b)) draw();
  nodes(sight);
  if (isOne) shape(sight, tall + 0.5 * (height - tall) - 6, Math.min(0.5 * (height - tall) - 24, 90));
}

/** The shape of the mode over the train: peak amplitudes at their places, and where it is at this instant. @param {Sight} sight @param {number} y @param {number} high */
function shape(sight, y, high) {
  const { ctx, ink, series, view, X, swing } = sight;
  const [low, far] = [X(view.box[0]), X(view.box[1])];
  line(ctx, [[low - 12, y], [far + 12, y]]);
  stroke(ctx, ink.soft, 1);
  for (const part of view.parts.filter(({ kind }) => kind === "shaft" || kind === "coupling")) {
    const [shares, amplitudes] = along(sight, part);
    for (const [factor, wide] of /** @type {[number, number][]} */ ([[1, 1.2], [-1, 1.2], [swing, 2.6]])) {
      line(ctx, shares.map((share, n) => [X(part.from[0]) + share * (X(part.to[0]) - X(part.from[0])), y - factor * high * amplitudes[n]]));
      stroke(ctx, wide > 2 ? series[0] : ink.grid, wide);
    }
  }
  view.discs.forEach((disc, n) => {
    const at = y - swing * high * amplitude(sight, n);
    line(ctx, [[X(disc.x), y], [X(disc.x), at]]);
    stroke(ctx, ink.soft, 1);
    circle(ctx, X(disc.x), at, 3.5);
    fill(ctx, ink.ink);
  });
}
