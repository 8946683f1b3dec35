// A vector over the revolution to one scale, with its arrow at the instant, or dynamometer cards, load over position: drag a part to enlarge it, double-click for all, click to move the machine there.
import { html } from "./html.js";
import { useEffect, useRef } from "./vendor/hooks.mjs";
import { rows, short } from "./chart.js";
import { ticks } from "./exported.js";
import { blank, fit, toMachine, toScreen } from "./frame.js";
import { circle, fill } from "./ink.js";
import { saidOf } from "./language.js";
import { followers } from "./stage.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";
import { between, placeOf } from "./timeline.js";
import { number, shownUnit } from "./units.js";

const HEIGHT = 260;

/** Room for the numbers of the axes. */
const [LEFT, BELOW] = [58, 34];

/** Height of a card over its width on the page. */
const FLAT = 0.45;

/** Ends of components and the origin. @param {ArrayLike<number>[]} rows */
function ends(rows) {
  const values = rows.flatMap((row) => Array.from(row)).filter(Number.isFinite);
  return [Math.min(0, ...values), Math.max(0, ...values)];
}

/** Components along and across in turn, and what those across are multiplied by to be drawn to one scale. @param {Plot} plot @returns {{ phi: Float64Array, pairs: ArrayLike<number>[][], flat: number }} */
function sized(plot) {
  const [phi, ...columns] = rows(plot);
  const pairs = columns.flatMap((xs, n) => (n % 2 ? [] : [[xs, columns[n + 1]]]));
  if (!plot.isCard) return { phi, pairs, flat: 1 };
  const [wide, high] = [0, 1].map((side) => ends(pairs.map((pair) => pair[side])).reduce((low, top) => top - low));
  const flat = (FLAT * wide) / (high || 1);
  return { phi, pairs: pairs.map(([xs, ys]) => [xs, Array.from(ys, (y) => y * flat)]), flat };
}

/** @param {{ plot: Plot }} props */
export function Hodograph({ plot }) {
  const holder = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const now = useRef(plot);
  const redraw = useRef(() => {});
  now.current = plot;
  useEffect(() => {
    const canvas = /** @type {HTMLCanvasElement} */ (holder.current);
    let seen = true;
    let [zoom, at, from] = /** @type {(number[] | null)[]} */ ([null, null, null]);
    let frame = { scale: 1, x: 0, y: 0 };
    /** The sample that is nearest to the pointer, and its pair. @param {ArrayLike<number>[][]} pairs */
    const nearest = (pairs) => {
      if (!at) return [-1, 0];
      const [px, py] = at;
      const away = pairs.flatMap(([xs, ys], p) => Array.from(xs, (x, n) => {
        const [X, Y] = toScreen(frame, x, ys[n]);
        return [Math.hypot(X - px, Y - py), n, p];
      })).filter(([far]) => far < 40);
      return away.length ? away.reduce((a, b) => (b[0] < a[0] ? b : a)).slice(1) : [-1, 0];
    };
    const draw = () => {
      if (!seen) return;
      const { phi, pairs, flat } = sized(now.current);
      const ink = colours();
      const [width, height] = [canvas.clientWidth, HEIGHT];
      const ctx = blank(canvas, width, height);
      /** @param {[number, number]} place @param {string} style */
      const dot = (place, style) => {
        circle(ctx, ...toScreen(frame, ...place), 4);
        fill(ctx, style);
      };
      const [[left, right], [bottom, top]] = [0, 1].map((side) => ends(pairs.map((pair) => pair[side])));
      frame = fit(zoom ?? [left, bottom, right, top], width - LEFT, height - BELOW, 18);
      frame.x += LEFT;
      const [x0, y1] = toMachine(frame, LEFT, 0);
      const [x1, y0] = toMachine(frame, width, height - BELOW);
      ctx.font = "11px system-ui, sans-serif";
      /** @param {string} style @param {number} wide @param {[number, number][]} places */
      const line = (style, wide, places) => {
        ctx.strokeStyle = style;
        ctx.lineWidth = wide;
        ctx.beginPath();
        let pen = false;
        for (const place of places) {
          const is = place.every(Number.isFinite);
          if (is) ctx[pen ? "lineTo" : "moveTo"](...toScreen(frame, ...place));
          pen = is;
        }
        ctx.stroke();
      };
      ctx.fillStyle = ink.soft;
      ctx.textAlign = "center";
      for (const x of ticks(x0, x1, Math.max(3, width / 80))) {
        line(x ? ink.grid : ink.soft, 1, [[x, y0], [x, y1]]);
        ctx.fillText(number(x, 4), toScreen(frame, x, 0)[0], height - BELOW + 14);
      }
      ctx.textAlign = "right";
      for (const y of ticks(y0 / flat, y1 / flat, 5)) {
        line(y ? ink.grid : ink.soft, 1, [[x0, y * flat], [x1, y * flat]]);
        ctx.fillText(number(y, 4), LEFT - 6, toScreen(frame, 0, y * flat)[1] + 4);
      }
      const { curves, isCard } = now.current;
      const units = curves.map(({ unit }) => shownUnit(unit, state.units.value));
      const [along, across] = curves.map(({ symbol, word }, n) => (isCard ? units[n].unit : short(symbol, word)));
      ctx.fillText(along, width - 6, height - 4);
      ctx.textAlign = "left";
      ctx.fillText(across, LEFT + 12, 12);
      ctx.save();
      ctx.beginPath();
      ctx.rect(LEFT, 0, width - LEFT, height - BELOW);
      ctx.clip();
      for (const { plots } of state.pins.value) {
        const old = plots[now.current.key];
        if (!old) continue;
        ctx.setLineDash([5, 4]);
        pairs.forEach((_, p) => {
          const [u, v] = [2 * p, 2 * p + 1].map((n) => old.curves[curves[n].name]);
          if (u && v) line(ink.series[p % 6], 1.1, Array.from(u, (value, n) => [value / units[2 * p].factor, (v[n] / units[2 * p + 1].factor) * flat]));
        });
        ctx.setLineDash([]);
      }
      pairs.forEach(([xs, ys], p) => line(ink.series[p % 6], 1.8, Array.from(xs, (x, n) => [x, ys[n]])));
      const scene = state.scene.value;
      if (scene && now.current.x.name === "crank_angle") {
        const k = placeOf(now.current.x.values, between(scene.angles, placeOf(scene.times, state.time.value)));
        for (const [xs, ys] of pairs) {
          const tip = /** @type {[number, number]} */ ([between(xs, k), between(ys, k)]);
          if (!isCard) line(ink.accent, 2, [[0, 0], tip]);
          dot(tip, ink.accent);
        }
      }
      const [n, p] = from ? [-1, 0] : nearest(pairs);
      if (n >= 0) {
        const [x, y] = [pairs[p][0][n], pairs[p][1][n]];
        dot([x, y], ink.ink);
        const words = `${short(now.current.x.symbol, now.current.x.word)} ${number(phi[n], 4)}: ${number(x, 4)}, ${number(y / flat, 4)}`;
        ctx.fillStyle = ink.panel;
        ctx.fillRect(LEFT + 4, height - BELOW - 20, ctx.measureText(words).width + 10, 16);
        ctx.fillStyle = ink.ink;
        ctx.fillText(words, LEFT + 8, height - BELOW - 8);
      }
      if (from && at) {
        ctx.strokeStyle = ink.accent;
        ctx.strokeRect(from[0], from[1], at[0] - from[0], at[1] - from[1]);
      }
      ctx.restore();
    };
    const over = (/** @type {PointerEvent} */ event) => {
      at = [event.offsetX, event.offsetY];
      draw();
    };
    const up = () => {
      const [began, ended] = [from, at];
      from = null;
      if (began && ended && Math.hypot(ended[0] - began[0], ended[1] - began[1]) > 6) {
        const [a, b] = [began, ended].map(([x, y]) => toMachine(frame, x, y));
        zoom = [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[0], b[0]), Math.max(a[1], b[1])];
      } else if (ended) {
        const [n] = nearest(sized(now.current).pairs);
        const scene = state.scene.value;
        if (n >= 0 && scene && now.current.x.name === "crank_angle") {
          state.playing.value = false;
          state.time.value = between(scene.times, placeOf(scene.angles, now.current.x.values[n]));
        }
      }
      draw();
    };
    const down = (/** @type {PointerEvent} */ event) => ((from = [event.offsetX, event.offsetY]), canvas.setPointerCapture(event.pointerId));
    Object.assign(canvas, { onpointermove: over, onpointerdown: down, onpointerup: up, onpointerleave: () => ((at = null), draw()), ondblclick: () => ((zoom = null), draw()) });
    const watch = new IntersectionObserver(([entry]) => ((seen = entry.isIntersecting), draw()));
    watch.observe(canvas);
    const observer = new ResizeObserver(draw);
    observer.observe(canvas);
    followers.add(draw);
    redraw.current = draw;
    return () => {
      followers.delete(draw);
      watch.disconnect();
      observer.disconnect();
    };
  }, []);
  useEffect(() => redraw.current(), [plot, shownLook.value, state.units.value, state.pins.value]);
  const label = saidOf(plot.isCard ? "Plot of {}; its numbers are in the data table" : "Hodograph of {}; its numbers are in the data table", plot.title);
  return html`<div class="chart hodograph" data-plot=${plot.key}><canvas ref=${holder} role="img" aria-label=${label}></canvas></div>`;
}
