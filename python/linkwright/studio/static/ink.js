// Lines and areas on a canvas, that all pictures are made of.

/** The path through places. @param {Ctx} ctx @param {ArrayLike<number>[]} places @param {boolean} [closed] */
export function line(ctx, places, closed = false) {
  ctx.beginPath();
  for (const place of places) ctx.lineTo(place[0], place[1]);
  if (closed) ctx.closePath();
}

/** The path round a place. @param {Ctx} ctx @param {number} x @param {number} y @param {number} radius */
export function circle(ctx, x, y, radius) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
}

/** @param {Ctx} ctx @param {string} style @param {number} width */
export function stroke(ctx, style, width) {
  ctx.strokeStyle = style;
  ctx.lineWidth = width;
  ctx.stroke();
}

/** @param {Ctx} ctx @param {string} style @param {number} [alpha] */
export function fill(ctx, style, alpha = 1) {
  ctx.globalAlpha = alpha;
  ctx.fillStyle = style;
  ctx.fill();
  ctx.globalAlpha = 1;
}
