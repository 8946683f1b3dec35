// A vector over the revolution to one scale, with its arrow at the instant: drag a part to enlarge it, double-click for all, click to move the machine there.
import { html } from "./html.js";
import { useEffect, useRef } from "./vendor/hooks.mjs";
import { rows, short } from "./chart.js";
import { ticks } from "./exported.js";
import { blank, fit, toMachine, toScreen } from "./frame.js";
import { circle, fill } from "./ink.js";
import { followers } from "./stage.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";
import { between, placeOf } from "./timeline.js";
import { number, shownUnit } from "./units.js";

const HEIGHT = 260;

/** Room for the numbers of the axes. */
const [LEFT, BELOW] = [58, 34];

/** Ends of a component and the origin. @param {Float64Array} values */
const ends = (values) => [Math.min(0, ...values.filter(Number.isFinite)), Math.max(0, ...values.filter(Number.isFinite))];

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
    /** The sample that is nearest to the pointer. @param {Float64Array[]} own */
    const nearest = ([, xs, ys]) => {
      if (!at) return -1;
      const away = Array.from(xs, (x, n) => Math.hypot(...toScreen(frame, x, ys[n]).map((place, k) => place - /** @type {number[]} */ (at)[k])));
      const n = away.indexOf(Math.min(...away.filter(Number.isFinite)));
      return away[n] < 40 ? n : -1;
    };
    const draw = () => {
      if (!seen) return;
      const own = rows(now.current);
      const [phi, xs, ys] = own;
      const ink = colours();
      const [width, height] = [canvas.clientWidth, HEIGHT];
      const ctx = blank(canvas, width, height);
      /** @param {[number, number]} place @param {string} style */
      const dot = (place, style) => {
        circle(ctx, ...toScreen(frame, ...place), 4);
        fill(ctx, style);
      };
      const [[left, right], [bottom, top]] = [ends(xs), ends(ys)];
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
      for (const y of ticks(y0, y1, 5)) {
        line(y ? ink.grid : ink.soft, 1, [[x0, y], [x1, y]]);
        ctx.fillText(number(y, 4), LEFT - 6, toScreen(frame, 0, y)[1] + 4);
      }
      const [along, across] = now.current.curves.map(({ symbol, word }) => short(symbol, word));
      ctx.fillText(along, width - 6, height - 4);
      ctx.textAlign = "left";
      ctx.fillText(across, LEFT + 12, 12);
      ctx.save();
      ctx.beginPath();
      ctx.rect(LEFT, 0, width - LEFT, height - BELOW);
      ctx.clip();
      const { factor } = shownUnit(now.current.unit, state.units.value);
      for (const { plots } of state.pins.value) {
        const old = plots[now.current.key];
        if (!old) continue;
        const [u, v] = now.current.curves.map(({ name }) => old.curves[name]);
        ctx.setLineDash([5, 4]);
        line(ink.series[0], 1.1, Array.from(u, (value, n) => [value / factor, v[n] / factor]));
        ctx.setLineDash([]);
      }
      line(ink.series[0], 1.8, Array.from(xs, (x, n) => [x, ys[n]]));
      const scene = state.scene.value;
      if (scene) {
        const k = placeOf(now.current.x.values, between(scene.angles, placeOf(scene.times, state.time.value)));
        const tip = /** @type {[number, number]} */ ([between(xs, k), between(ys, k)]);
        line(ink.accent, 2, [[0, 0], tip]);
        dot(tip, ink.accent);
      }
      const n = from ? -1 : nearest(own);
      if (n >= 0) {
        dot([xs[n], ys[n]], ink.ink);
        const words = `${short(now.current.x.symbol, now.current.x.word)} ${number(phi[n], 4)}: ${number(xs[n], 4)}, ${number(ys[n], 4)}`;
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
        const n = nearest(rows(now.current));
        const scene = state.scene.value;
        if (n >= 0 && scene) {
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
  return html`<div class="chart hodograph" data-plot=${plot.key}><canvas ref=${holder} role="img" aria-label="Hodograph of ${plot.title}; its numbers are in the data table"></canvas></div>`;
}
