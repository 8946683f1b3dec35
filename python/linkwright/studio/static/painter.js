// Draws the parts of a scene at an instant, from behind to the front; nothing is computed here but where they lie on the screen.
import { toScreen } from "./frame.js";
import { circle, fill, line, stroke } from "./ink.js";
import { between, pairAt } from "./timeline.js";

const WIDTHS = /** @type {Record<string, number>} */ ({ crank: 9, cable: 2.5, arm: 5 });

/** @param {View} view @param {string} name @returns {[number, number]} */
export function at(view, name) {
  const [x, y] = pairAt(view.scene.points[name], view.k);
  return toScreen(view.frame, x, y);
}

/** @param {View} view @param {string | null | undefined} link @param {number} [angle] on the screen, where y points down */
function turned(view, link, angle = 0) {
  const own = link ? between(view.scene.headings[link], view.k) : 0;
  return -(own + angle);
}

/** @param {View} view @param {Part} part */
const colour = (view, part) => view.series[(part.series ?? 0) % view.series.length];

/** Draws about the origin of a part, turned with its link. @param {View} view @param {Part} part @param {(ctx: Ctx) => void} draw */
function carried(view, part, draw) {
  const { ctx } = view;
  const [x, y] = at(view, part.at);
  ctx.save();
  ctx.translate(x, y);
  ctx.rotate(turned(view, part.link, part.angle));
  draw(ctx);
  ctx.restore();
}

/** @param {View} view @param {number} length */
function hatch({ ctx, ink }, length) {
  ctx.beginPath();
  for (let s = -length / 2; s <= length / 2 + 0.01; s += 8) {
    ctx.moveTo(s, 0);
    ctx.lineTo(s - 6, 8);
  }
  stroke(ctx, ink.soft, 1);
}

/** @param {View} view @param {string} text @param {number} x @param {number} y */
function word({ ctx, ink }, text, x, y) {
  ctx.font = "12.5px system-ui, sans-serif";
  ctx.lineWidth = 4;
  ctx.strokeStyle = ink.panel;
  ctx.strokeText(text, x, y);
  ctx.fillStyle = ink.ink;
  ctx.fillText(text, x, y);
}

/** @param {Ctx} ctx @param {Part} part @param {number} s @param {string} style @param {number} x @param {number} y */
function rod(ctx, part, s, style, x, y) {
  if (!part.rod) return;
  line(ctx, [[x, y], [part.rod[0] * s, -part.rod[1] * s]]);
  stroke(ctx, style, 6);
}

/** A line in a colour between those of the lowest and of the highest stress. @param {View} view @param {number[][]} places @param {number} share @param {number} width */
function mixed({ ctx, series }, places, share, width) {
  for (const [style, alpha] of /** @type {[string, number][]} */ ([[series[0], 1], [series[1], Math.min(Math.max(share, 0), 1)]])) {
    ctx.globalAlpha = alpha;
    line(ctx, places);
    stroke(ctx, style, width);
  }
  ctx.globalAlpha = 1;
}

/** Parts that stand still. @type {Record<string, (view: View, part: Part) => void>} */
export const STILL = {
  guide(view, part) {
    const { ctx, frame, ink } = view;
    const [a, b] = part.ends.map(([x, y]) => toScreen(frame, x, y));
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) + 76;
    ctx.save();
    ctx.translate((a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
    ctx.rotate(-part.angle);
    ctx.translate(0, 16);
    line(ctx, [[-length / 2, 0], [length / 2, 0]]);
    stroke(ctx, ink.soft, 1.5);
    hatch(view, length);
    ctx.restore();
  },
  ground(view, part) {
    const { ctx, ink } = view;
    const [x, y] = at(view, part.name);
    line(ctx, [[x, y], [x - 13, y + 22], [x + 13, y + 22]], true);
    fill(ctx, ink.panel);
    stroke(ctx, ink.soft, 1.5);
    ctx.save();
    ctx.translate(x, y + 22);
    hatch(view, 38);
    ctx.restore();
    word(view, part.name, x - 4, y + 45);
  },
  trace(view, part) {
    const { ctx, frame, ink, scene } = view;
    const path = scene.points[part.name];
    ctx.beginPath();
    for (let n = 0; n < path.length; n += 2) ctx.lineTo(...toScreen(frame, path[n], path[n + 1]));
    ctx.setLineDash([5, 4]);
    stroke(ctx, ink.soft, 1.3);
    ctx.setLineDash([]);
  },
};

/** Parts that move. @type {Record<string, (view: View, part: Part) => void>} */
export const MOVING = {
  rail(view, part) {
    const s = view.frame.scale;
    carried(view, part, (ctx) => {
      for (const side of [-9, 9]) {
        const y = -part.offset * s + side;
        line(ctx, [[part.span[0] * s - 16, y], [part.span[1] * s + 16, y]]);
        stroke(ctx, colour(view, part), 2);
      }
    });
  },
  slot(view, part) {
    const s = view.frame.scale;
    const y = -part.offset * s;
    carried(view, part, (ctx) => {
      line(ctx, [[0, 0], [0, y]]);
      stroke(ctx, colour(view, part), 6);
      line(ctx, part.bar.map((end) => [end * s, y]));
      stroke(ctx, colour(view, part), 20);
      line(ctx, part.span.map((end) => [end * s, y]));
      stroke(ctx, view.ink.panel, 12);
    });
  },
  gear(view, part) {
    const r = part.radius * view.frame.scale;
    carried(view, part, (ctx) => {
      circle(ctx, 0, 0, r);
      fill(ctx, colour(view, part), 0.08);
      stroke(ctx, colour(view, part), 2);
      if (!part.link) return;
      line(ctx, [[0, 0], [r, 0]]);
      stroke(ctx, colour(view, part), 2);
    });
  },
  cam(view, part) {
    const s = view.frame.scale;
    carried(view, part, (ctx) => {
      part.outlines.forEach((outline, n) => {
        line(ctx, outline.map(([x, y]) => [x * s, -y * s]), true);
        if (n === 0) {
          fill(ctx, colour(view, part), 0.14);
        }
        stroke(ctx, colour(view, part), 2);
      });
      const [x, y] = part.outlines[0][0];
      line(ctx, [[0, 0], [x * s, -y * s]]);
      stroke(ctx, colour(view, part), 1);
    });
  },
  roller(view, part) {
    const s = view.frame.scale;
    const [x, y] = [part.place[0] * s, -part.place[1] * s];
    carried(view, part, (ctx) => {
      rod(ctx, part, s, colour(view, part), x, y);
      circle(ctx, x, y, Math.max(part.radius * s, 4));
      fill(ctx, view.ink.panel);
      stroke(ctx, colour(view, part), 2.5);
    });
  },
  face(view, part) {
    const s = view.frame.scale;
    const [x, y] = [part.place[0] * s, -part.place[1] * s];
    const [c, d] = [Math.cos(part.along), -Math.sin(part.along)];
    carried(view, part, (ctx) => {
      rod(ctx, part, s, colour(view, part), x, y);
      line(ctx, /** @type {number[]} */ (part.ends).map((end) => [x + end * s * c, y + end * s * d]));
      stroke(ctx, colour(view, part), 5);
    });
  },
  belt(view, part) {
    const { ctx } = view;
    const [a, b] = [at(view, part.from), at(view, part.to)];
    const [r, R] = part.radii.map((each) => each * view.frame.scale);
    const distance = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const lean = Math.acos((part.crossed ? r + R : r - R) / distance);
    const own = Math.atan2(b[1] - a[1], b[0] - a[0]);
    for (const turn of [lean, -lean]) {
      const [c, s] = [Math.cos(own + turn), Math.sin(own + turn)];
      const far = part.crossed ? -R : R;
      line(ctx, [[a[0] + r * c, a[1] + r * s], [b[0] + far * c, b[1] + far * s]]);
      stroke(ctx, view.ink.soft, 2.5);
    }
  },
  rack(view, part) {
    const s = view.frame.scale;
    const [a, b] = part.span.map((end) => end * s);
    const side = part.side === "right" ? 8 : -8;
    carried(view, part, (ctx) => {
      line(ctx, [[a - 30, side], [b + 30, side]]);
      for (let x = a - 30; x <= b + 30; x += 10) {
        ctx.moveTo(x, side);
        ctx.lineTo(x, 0);
      }
      stroke(ctx, colour(view, part), 2.5);
    });
  },
  arc(view, part) {
    const [low, high] = part.span;
    carried(view, part, (ctx) => {
      ctx.beginPath();
      const arc = () => ctx.arc(0, 0, part.radius * view.frame.scale, -low, -high, true);
      arc();
      stroke(ctx, colour(view, part), 6);
      // It is part of its link.
      ctx.beginPath();
      ctx.moveTo(0, 0);
      arc();
      fill(ctx, colour(view, part), 0.18);
    });
  },
  link(view, part) {
    const { ctx } = view;
    ctx.lineCap = "round";
    line(ctx, [at(view, part.from), at(view, part.to)]);
    stroke(ctx, colour(view, part), WIDTHS[part.role] ?? 6);
    ctx.lineCap = "butt";
  },
  plate(view, part) {
    const { ctx } = view;
    line(ctx, part.corners.map((name) => at(view, name)), true);
    fill(ctx, colour(view, part), 0.18);
    stroke(ctx, colour(view, part), 1.5);
  },
  spring(view, part) {
    const [a, b] = [at(view, part.from), at(view, part.to)];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const [nx, ny] = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
    line(view.ctx, Array.from({ length: 13 }, (_, n) => {
      const side = n < 2 || n > 10 ? 0 : n % 2 ? 9 : -9;
      return [a[0] + (n / 12) * (b[0] - a[0]) + side * nx, a[1] + (n / 12) * (b[1] - a[1]) + side * ny];
    }));
    stroke(view.ctx, view.ink.soft, 2);
  },
  rods(view, part) {
    const { ctx, frame, ink, scene, k } = view;
    const [{ heights, shares }, count] = [/** @type {Record<string, Float64Array>} */ (scene.rods), scene.times.length];
    const half = part.half * frame.scale;
    const [[x, top], foot, head] = [toScreen(frame, part.x, part.top), ...part.barrel.map((y) => toScreen(frame, 0, y)[1])];
    for (const side of [-half, half]) {
      line(ctx, [[x + side, top], [x + side, head]]);
      stroke(ctx, ink.soft, 1.2);
    }
    line(ctx, [[x - 0.6 * half, head], [x - 0.6 * half, foot], [x + 0.6 * half, foot], [x + 0.6 * half, head]]);
    stroke(ctx, ink.ink, 2);
    ctx.save();
    ctx.translate(x, top);
    hatch(view, 6 * half);
    ctx.restore();
    const at = (/** @type {Float64Array} */ values, /** @type {number} */ n) => between(values.subarray(n * count, (n + 1) * count), k);
    const ys = part.wide.map((_, n) => toScreen(frame, 0, at(heights, n))[1]);
    part.wide.slice(1).forEach((wide, n) => mixed(view, [[x, ys[n]], [x, ys[n + 1]]], (at(shares, n) + at(shares, n + 1)) / 2, 6 * wide));
    ctx.beginPath();
    ctx.rect(x - 0.45 * half, ys[ys.length - 1] - 0.9 * half, 0.9 * half, 1.8 * half);
    fill(ctx, ink.panel);
    stroke(ctx, ink.ink, 1.5);
    const [right, low] = [x + 2 * half, top + 8 * half];
    for (let n = 0; n < 12; n += 1) mixed(view, [[right, low - (n * half) / 2], [right, low - ((n + 1) * half) / 2]], n / 11, 6);
    const said = view.stress ?? ((value) => `${Number((value / 1e6).toPrecision(3))} MPa`.replace("-", "−"));
    part.range.forEach((value, n) => word(view, said(value), right + 8, (n ? low - 6 * half : low) + 4));
  },
  slider(view, part) {
    const [w, h] = part.heavy ? [44, 30] : [30, 22];
    carried(view, part, (ctx) => {
      ctx.beginPath();
      ctx.roundRect(-w / 2, -h / 2, w, h, 3);
      fill(ctx, view.ink.panel);
      stroke(ctx, colour(view, part), 3);
    });
  },
  mass(view, part) {
    const s = view.frame.scale;
    carried(view, part, (ctx) => {
      const [x, y] = part.place ?? [0, 0];
      circle(ctx, x * s, -y * s, part.place ? 4 : 9);
      fill(ctx, view.ink.ink, part.place ? 0.75 : 0.3);
    });
  },
  point(view, part) {
    const { ctx, ink } = view;
    const [x, y] = at(view, part.name);
    circle(ctx, x, y, 5);
    fill(ctx, ink.panel);
    stroke(ctx, view.light === part.name ? ink.accent : ink.ink, view.light === part.name ? 3.5 : 2);
    if (part.slides) word(view, part.name, x - 16, y - 24 - 15 * (part.series ?? 0));
  },
};

/** @param {View} view */
export function paintStill(view) {
  view.ctx.lineJoin = "round";
  for (const part of view.scene.parts) STILL[part.kind]?.(view, part);
}

/** @param {View} view */
export function paintMoving(view) {
  view.ctx.lineJoin = "round";
  for (const part of view.scene.parts) MOVING[part.kind]?.(view, part);
}
