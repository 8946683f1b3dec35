// Instant centres of links with their centrodes: the curve on the frame stands, the one on the link rolls on it.
import { at } from "./painter.js";
import { toScreen } from "./frame.js";
import { circle, fill, line, stroke } from "./ink.js";
import { between, pairAt } from "./timeline.js";

/** Centres farther away than so many times the drawing are not drawn: towards parallel cranks they go to infinity. */
const FAR = 6;

/** @param {View} view */
export function paintCentres(view) {
  const { ctx, scene, frame, k, series, ink } = view;
  const [left, bottom, right, top] = scene.box;
  const far = FAR * Math.max(right - left, top - bottom);
  const [cx, cy] = [(left + right) / 2, (bottom + top) / 2];
  const near = (/** @type {number} */ x, /** @type {number} */ y) => Math.abs(x - cx) < far && Math.abs(y - cy) < far;
  const names = Object.keys(scene.centres);
  names.forEach((name, n) => {
    const { at: start, angle, fixed, moving } = scene.centres[name];
    const colour = series[n % series.length];
    /** @param {Float64Array} pairs @param {(x: number, y: number) => [number, number]} place */
    const curve = (pairs, place) => {
      ctx.beginPath();
      let pen = false;
      for (let i = 0; i < pairs.length; i += 2) {
        // Whether it is near is asked of the centre on the frame, so that both curves have the same ends.
        const is = near(fixed[i], fixed[i + 1]);
        if (is && pen) ctx.lineTo(...place(pairs[i], pairs[i + 1]));
        else if (is) ctx.moveTo(...place(pairs[i], pairs[i + 1]));
        pen = is;
      }
      ctx.strokeStyle = colour;
      ctx.stroke();
    };
    ctx.lineWidth = 1.4;
    curve(fixed, (x, y) => toScreen(frame, x, y));
    const [px, py] = pairAt(scene.points[start], k);
    const turn = between(angle, k);
    const [c, s] = [Math.cos(turn), Math.sin(turn)];
    ctx.setLineDash([7, 4]);
    curve(moving, (u, v) => toScreen(frame, px + c * u - s * v, py + s * u + c * v));
    ctx.setLineDash([]);
    const [x, y] = pairAt(fixed, k);
    if (!Number.isFinite(x) || !near(x, y)) return;
    const spot = toScreen(frame, x, y);
    line(ctx, [at(view, start), spot]);
    stroke(ctx, ink.soft, 0.8);
    circle(ctx, ...spot, 4.5);
    fill(ctx, colour);
    ctx.font = "12px system-ui, sans-serif";
    ctx.fillText(`C ${name}`, spot[0] + 8, spot[1] - 6);
  });
}
