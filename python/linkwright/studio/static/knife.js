// The knife of a topper over the heads of a row, from above: the swept area grows, what is left uncut stays.
import { pen } from "./frame.js";

/**
 * @typedef {{ kind: "topper", law: Float64Array, rate: number, drift: number, phase: number, angle: number, length: number, speed: number,
 *   diameter: number, offset: number, heads: number[][], span: number[], box: number[], seconds: number }} Knife
 * @typedef {import("./moving.js").Paper} Paper
 */

const TURN = 2 * Math.PI;

/** Places of the edge over the way: many in each stroke. */
const LEAST = 600;
const MOST = 3000;
const EACH_STROKE = 160;

/** Place of the middle of the edge across the row at a time [m]. @param {Knife} view @param {number} t */
export function across({ law, phase, rate, drift }, t) {
  const turned = (((phase + rate * t) % TURN) + TURN) % TURN;
  const k = (turned / TURN) * (law.length - 1);
  const n = Math.min(Math.floor(k), law.length - 2);
  return law[n] + (k - n) * (law[n + 1] - law[n]) + drift * t;
}

/** What was swept so far, in its colour, and the part of it over the heads. @type {WeakMap<Knife, { key: string, done: number, layers: HTMLCanvasElement[] }>} */
const swept = new WeakMap();

/**
 * Draws the knife at a time [s], heads from behind to the front.
 * @param {Paper} paper @param {Knife} view @param {number} t @param {boolean} [names]
 */
export function paintKnife(paper, view, t, names = true) {
  const { ctx, width, height, ink, series } = paper;
  const [x0, y0, x1, y1] = view.box;
  const margin = names ? 22 : 6;
  const scale = Math.min((width - 2 * margin) / (x1 - x0), (height - 2 * margin) / (y1 - y0));
  // Before a page has its size there is no room.
  if (scale <= 0) return;
  const X = (/** @type {number} */ x) => width / 2 + scale * (x - (x0 + x1) / 2);
  const Y = (/** @type {number} */ y) => height / 2 - scale * (y - (y0 + y1) / 2);
  const [sin, cos] = [Math.sin(view.angle), Math.cos(view.angle)];
  const radius = (view.diameter / 2) * scale;
  const place = (/** @type {number} */ at) => [view.speed * at, across(view, at)];
  const ends = (/** @type {number[]} */ [x, y]) => [-0.5, 0.5].map((share) => [X(x + share * view.length * sin), Y(y + share * view.length * cos)]);
  const [first, last] = view.span;
  const count = Math.round(Math.min(Math.max(LEAST, (EACH_STROKE * view.rate * (last - first)) / TURN), MOST));
  const instant = (/** @type {number} */ n) => first + ((last - first) * n) / count;
  const done = Math.min(Math.floor(((t - first) / (last - first)) * count), count);

  if (view.offset) {
    ctx.fillStyle = ink.grid;
    ctx.globalAlpha = 0.5;
    ctx.fillRect(0, Y(view.offset), width, 2 * view.offset * scale);
    ctx.globalAlpha = 1;
  }
  ctx.strokeStyle = ink.soft;
  ctx.lineWidth = 1;
  ctx.setLineDash([8, 4, 2, 4]);
  ctx.beginPath();
  ctx.moveTo(0, Y(0));
  ctx.lineTo(width, Y(0));
  ctx.stroke();
  ctx.setLineDash([]);

  const layers = sweptUpTo();
  ctx.globalAlpha = 0.16;
  ctx.drawImage(layers[0], 0, 0, width, height);
  ctx.globalAlpha = 1;
  for (const [hx, hy] of view.heads) disc(hx, hy, series[2], 0.55);
  ctx.drawImage(layers[1], 0, 0, width, height);
  for (const [hx, hy] of view.heads) disc(hx, hy, "", 0);

  const here = place(t);
  ctx.strokeStyle = ink.soft;
  ctx.lineWidth = 1;
  ctx.beginPath();
  for (let n = 0; n <= done; n += 1) {
    const [x, y] = place(instant(n));
    ctx.lineTo(X(x), Y(y));
  }
  ctx.lineTo(X(here[0]), Y(here[1]));
  ctx.stroke();
  const [a, b] = ends(here);
  ctx.strokeStyle = ink.ink;
  ctx.lineWidth = names ? 5 : 3;
  ctx.lineCap = "round";
  ctx.beginPath();
  ctx.moveTo(a[0], a[1]);
  ctx.lineTo(b[0], b[1]);
  ctx.stroke();
  ctx.lineCap = "butt";
  ctx.fillStyle = ink.panel;
  ctx.beginPath();
  ctx.arc(X(here[0]), Y(here[1]), 3.5, 0, TURN);
  ctx.fill();
  ctx.lineWidth = 2;
  ctx.stroke();

  /** A head, filled or its rim. @param {number} x @param {number} y @param {string} colour @param {number} alpha */
  function disc(x, y, colour, alpha) {
    ctx.beginPath();
    ctx.arc(X(x), Y(y), radius, 0, TURN);
    if (alpha) {
      ctx.globalAlpha = alpha;
      ctx.fillStyle = colour;
      ctx.fill();
      ctx.globalAlpha = 1;
      return;
    }
    ctx.strokeStyle = ink.ink;
    ctx.lineWidth = 1.5;
    ctx.stroke();
  }

  /** Two layers: what was swept, and that over heads in the colour of a cut; only what is new is drawn. */
  function sweptUpTo() {
    const ratio = devicePixelRatio || 1;
    const key = [width, height, ratio, ink.panel].join("|");
    let known = swept.get(view);
    if (!known || known.key !== key || known.done > done) {
      const layers = [0, 1].map(() => {
        const layer = document.createElement("canvas");
        [layer.width, layer.height] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
        return layer;
      });
      known = { key, done: 0, layers };
      swept.set(view, known);
      for (const [n, layer] of layers.entries()) {
        const on = pen(layer);
        on.setTransform(ratio, 0, 0, ratio, 0, 0);
        on.fillStyle = on.strokeStyle = n ? "#f2c230" : series[0];
        if (!n) continue;
        on.beginPath();
        for (const [hx, hy] of view.heads) {
          on.moveTo(X(hx) + radius, Y(hy));
          on.arc(X(hx), Y(hy), radius, 0, TURN);
        }
        on.clip();
      }
    }
    for (; known.done < done; known.done += 1) {
      const [[a, b], [d, c]] = [ends(place(instant(known.done))), ends(place(instant(known.done + 1)))];
      for (const layer of known.layers) {
        const on = pen(layer);
        on.beginPath();
        for (const [x, y] of [a, b, c, d]) on.lineTo(x, y);
        on.closePath();
        on.fill();
        // No seam between two slices.
        on.lineWidth = 0.6;
        on.stroke();
      }
    }
    return known.layers;
  }
}
