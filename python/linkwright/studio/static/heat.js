// A result over two entries as a map of colours, with its numbers.
import { html } from "./html.js";
import { useLayoutEffect, useRef, useState } from "./vendor/hooks.mjs";
import { pen } from "./frame.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";
import { number, shownUnit } from "./units.js";

/** Viridis, which grows evenly in lightness. */
const STOPS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

/** @param {number} share of 0 to 1 */
function colour(share) {
  const at = Math.min(Math.max(share, 0), 1) * (STOPS.length - 1);
  const n = Math.min(Math.floor(at), STOPS.length - 2);
  return `rgb(${STOPS[n].map((from, k) => Math.round(from + (at - n) * (STOPS[n + 1][k] - from))).join(" ")})`;
}

/** @param {{ values: Float64Array, x: Curve, y: Curve, words: Words }} props */
export function Heat({ values, x, y, words }) {
  const own = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const [data, setData] = useState(false);
  const known = values.filter(Number.isFinite);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const axes = [x, y].map((axis) => ({ ...axis, ...shownUnit(axis.unit, state.units.value) }));
  const scale = shownUnit(words.unit, state.units.value);
  useLayoutEffect(() => {
    const canvas = /** @type {HTMLCanvasElement} */ (own.current);
    const ctx = pen(canvas);
    const [columns, rows] = [x.values.length, y.values.length];
    [canvas.width, canvas.height] = [columns * 12, rows * 12];
    ctx.fillStyle = colours().grid;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    values.forEach((value, n) => {
      if (!Number.isFinite(value)) return;
      ctx.fillStyle = colour((value - low) / (high - low || 1));
      ctx.fillRect((n % columns) * 12, canvas.height - 12 * (Math.floor(n / columns) + 1), 12, 12);
    });
  }, [values, shownLook.value]);
  const ends = (/** @type {{ values: Float64Array, factor: number, unit: string }} */ { values: all, factor, unit }) => [all[0], all[all.length - 1]].map((end) => `${number(end / factor, 3)} ${unit}`);
  const [[left, right], [bottom, top]] = axes.map(ends);
  return html`
    <div class="heat">
      <div class="of-y"><small>${top}</small><small>${y.word}</small><small>${bottom}</small></div>
      <canvas ref=${own} role="img" aria-label="Map of ${words.word}; its numbers are in the data table"></canvas>
      <span></span><div class="of-x"><small>${left}</small><small>${x.word}</small><small>${right}</small></div>
      <span></span><div class="of-x scale"><small>${number(low / scale.factor, 4)}</small><i></i><small>${number(high / scale.factor, 4)} ${scale.unit}</small></div>
    </div>
    <button class="quiet" aria-pressed=${data} onClick=${() => setData(!data)}>Data</button>
    ${data ? html`<div class="data-table" tabindex="0" role="region" aria-label="Data of the map"><table><thead><tr><th></th>${Array.from(x.values, (value) => html`<th scope="col">${number(value / axes[0].factor, 4)}</th>`)}</tr></thead>
      <tbody>${Array.from(y.values, (value, row) => html`<tr><th scope="row">${number(value / axes[1].factor, 4)}</th>${Array.from(x.values, (_, column) => html`<td>${number(values[row * x.values.length + column] / scale.factor, 4)}</td>`)}</tr>`)}</tbody></table></div>` : null}`;
}
