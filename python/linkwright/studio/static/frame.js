// Where the drawing stands on the screen: metres to pixels, to one scale in both directions, y up in the machine.

const MARGIN = 64;

/**
 * @param {number[]} box minimum x, minimum y, maximum x, maximum y [m]
 * @param {number} width @param {number} height pixels
 * @param {number} [most] of margin
 * @returns {Frame}
 */
export function fit([left, bottom, right, top], width, height, most = MARGIN) {
  const margin = Math.min(most, 0.14 * Math.min(width, height));
  const scale = Math.min((width - 2 * margin) / Math.max(right - left, 1e-9), (height - 2 * margin) / Math.max(top - bottom, 1e-9));
  return { scale, x: width / 2 - (scale * (left + right)) / 2, y: height / 2 + (scale * (bottom + top)) / 2 };
}

/** @param {Frame} frame @param {number} x @param {number} y @returns {[number, number]} */
export const toScreen = (frame, x, y) => [frame.x + frame.scale * x, frame.y - frame.scale * y];

/** @param {Frame} frame @param {number} x @param {number} y @returns {[number, number]} */
export const toMachine = (frame, x, y) => [(x - frame.x) / frame.scale, (frame.y - y) / frame.scale];

/** Nearer or farther about a place on the screen. @param {Frame} frame @param {number} factor @param {number} x @param {number} y @returns {Frame} */
export function zoomed(frame, factor, x, y) {
  return { scale: frame.scale * factor, x: x - factor * (x - frame.x), y: y - factor * (y - frame.y) };
}

/** Length of a scale bar: the largest of 1, 2, 5 · 10ⁿ that is at most so many pixels long [m]. @param {Frame} frame @param {number} [most] */
export function barLength(frame, most = 120) {
  const raw = most / frame.scale;
  const power = 10 ** Math.floor(Math.log10(raw));
  const share = raw / power;
  return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

/** What draws on a canvas. @param {HTMLCanvasElement} canvas */
export const pen = (canvas) => /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));

/** The same over an empty sheet of so many pixels of the page. @param {HTMLCanvasElement} canvas @param {number} width @param {number} height */
export function blank(canvas, width, height) {
  const [ctx, ratio] = [pen(canvas), devicePixelRatio || 1];
  const [wide, high] = [width, height].map((size) => Math.max(1, Math.round(size * ratio)));
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  return ctx;
}
