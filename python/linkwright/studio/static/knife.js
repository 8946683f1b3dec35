// The knife of a topper over the heads of a row, from above: the swept area grows, what is left uncut stays.
import { blank, pen } from "./frame.js";
import { circle, fill, line, stroke } from "./ink.js";
import { between } from "./timeline.js";

const TURN = 2 * Math.PI;

/** Places of the edge over the way: many in each stroke. */
const LEAST = 600;
const MOST = 3000;
const EACH_STROKE = 160;

/** Place of the middle of the edge across the row at a time [m]. @param {Knife} view @param {number} t */
export function across({ law, phase, rate, drift }, t) {
  const turned = (((phase + rate * t) % TURN) + TURN) % TURN;
  return between(law, (turned / TURN) * (law.length - 1)) + drift * t;
}

/** What was swept so far, in its colour, and the part of it over the heads. @type {WeakMap<Knife, { key: string, done: number, layers: HTMLCanvasElement[] }>} */
const swept = new WeakMap();

/** Draws the knife at a time [s], heads from behind to the front. @param {Paper} paper @param {Knife} view @param {number} t @param {boolean} [names] */
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
  ctx.setLineDash([8, 4, 2, 4]);
  line(ctx, [[0, Y(0)], [width, Y(0)]]);
  stroke(ctx, ink.soft, 1);
  ctx.setLineDash([]);

  const layers = sweptUpTo();
  ctx.globalAlpha = 0.16;
  ctx.drawImage(layers[0], 0, 0, width, height);
  ctx.globalAlpha = 1;
  for (const [hx, hy] of view.heads) disc(hx, hy, series[2], 0.55);
  ctx.drawImage(layers[1], 0, 0, width, height);
  for (const [hx, hy] of view.heads) disc(hx, hy, "", 0);

  const here = place(t);
  line(ctx, [...Array.from({ length: done + 1 }, (_, n) => place(instant(n))), here].map(([x, y]) => [X(x), Y(y)]));
  stroke(ctx, ink.soft, 1);
  ctx.lineCap = "round";
  line(ctx, ends(here));
  stroke(ctx, ink.ink, names ? 5 : 3);
  ctx.lineCap = "butt";
  circle(ctx, X(here[0]), Y(here[1]), 3.5);
  fill(ctx, ink.panel);
  stroke(ctx, ink.ink, 2);

  /** A head, filled or its rim. @param {number} x @param {number} y @param {string} colour @param {number} alpha */
  function disc(x, y, colour, alpha) {
    circle(ctx, X(x), Y(y), radius);
    if (alpha) {
      fill(ctx, colour, alpha);
      return;
    }
    stroke(ctx, ink.ink, 1.5);
  }

  /** Two layers: what was swept, and that over heads in the colour of a cut; only what is new is drawn. */
  function sweptUpTo() {
    const key = [width, height, devicePixelRatio, ink.panel].join("|");
    let known = swept.get(view);
    if (!known || known.key !== key || known.done > done) {
      const layers = [0, 1].map(() => {
        const layer = document.createElement("canvas");
        blank(layer, width, height);
        return layer;
      });
      known = { key, done: 0, layers };
      swept.set(view, known);
      for (const [n, layer] of layers.entries()) {
        const on = pen(layer);
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
        line(on, [a, b, c, d], true);
        on.fill();
        // No seam between two slices.
        on.lineWidth = 0.6;
        on.stroke();
      }
    }
    return known.layers;
  }
}
