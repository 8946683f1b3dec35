// One plot: curves over one abscissa in the user's units, the instant as a line, one cursor in all of that abscissa.
import { html } from "./html.js";
import { useEffect, useLayoutEffect, useRef } from "./vendor/hooks.mjs";
import { followers } from "./stage.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";
import { between, placeOf } from "./timeline.js";
import { number, shownUnit } from "./units.js";

const HEIGHT = 190;
const uPlot = /** @type {any} */ (globalThis).uPlot;

/** Rows of a plot in the user's units: abscissa, then curves. @param {Plot} plot @returns {Float64Array[]} */
export function rows(plot) {
  return [plot.x, ...plot.curves].map(({ values, unit }) => {
    const { factor } = shownUnit(unit, state.units.value);
    return factor === 1 ? values : values.map((value) => value / factor);
  });
}

/** What is drawn: the rows, and those of pinned machines at the same abscissae; where there is no value, there is a gap. @param {Plot} plot @returns {any[]} */
function drawn(plot) {
  const pinned = state.pins.value.flatMap(({ plots }) => {
    const old = plots[plot.key];
    return old ? plot.curves.map(({ name, unit }) => within(old.x, old.curves[name], plot.x.values, shownUnit(unit, state.units.value).factor)) : [];
  });
  const own = rows(plot);
  const whole = own.slice(1).map((row) => (row.every(Number.isFinite) ? row : Array.from(row, (value) => (Number.isFinite(value) ? value : null))));
  return [own[0], ...whole, ...pinned];
}

/** A curve at other abscissae; null beyond its own. @param {Float64Array} xs @param {Float64Array | undefined} ys @param {Float64Array} at @param {number} factor */
function within(xs, ys, at, factor) {
  return Array.from(at, (x) => {
    if (!ys || x < xs[0] || x > xs[xs.length - 1]) return null;
    const value = between(ys, placeOf(xs, x)) / factor;
    return Number.isFinite(value) ? value : null;
  });
}

/** How often each curve of a plot is drawn dashed. @param {Plot} plot */
const copies = (plot) => state.pins.value.filter(({ plots }) => plots[plot.key]).length;

/** @param {string} symbol @param {string} word */
export const short = (symbol, word) => symbol.replace(/_(.*)/, " $1") || word;

/** The instant of the drawing at a place of the abscissa; null where that is no angle of it. @param {Plot} plot @param {number} value in SI */
function instantOf(plot, value) {
  const scene = state.scene.value;
  return scene && plot.x.name === "crank_angle" ? between(scene.times, placeOf(scene.angles, value)) : null;
}

/** @param {Plot} plot @returns {number | null} place of the instant on the abscissa, in SI */
function valueOf(plot) {
  const scene = state.scene.value;
  if (!scene || plot.x.name !== "crank_angle" || plot.key.startsWith("run")) return null;
  return between(scene.angles, placeOf(scene.times, state.time.value));
}

/** @param {Plot} plot @param {number} width */
function options(plot, width) {
  const ink = colours();
  const axis = { stroke: ink.soft, grid: { stroke: ink.grid, width: 1 }, ticks: { stroke: ink.grid, width: 1, size: 4 }, font: "11px system-ui, sans-serif" };
  const x = shownUnit(plot.x.unit, state.units.value);
  const values = (/** @type {any} */ _, /** @type {number[]} */ splits) => splits.map((value) => number(value, 4));
  return {
    width,
    height: HEIGHT,
    scales: { x: { time: false } },
    cursor: { sync: { key: plot.x.name + x.unit }, drag: { x: true, y: false, dist: 6 }, points: { size: 6 } },
    legend: { show: false },
    axes: [
      { ...axis, values, label: `${short(plot.x.symbol, plot.x.word)}${x.unit && `, ${x.unit}`}`, labelSize: 18, labelFont: axis.font, size: 30 },
      { ...axis, values, size: 58 },
    ],
    series: [
      {},
      ...plot.curves.map((_, n) => ({ stroke: ink.series[n % ink.series.length], width: 1.8, spanGaps: false, pxAlign: 0, dash: n < 6 ? [] : [9, 3] })),
      ...Array.from({ length: copies(plot) }, () => plot.curves.map((_, n) => ({ stroke: ink.series[n % ink.series.length], width: 1.1, dash: [5, 4], points: { show: false } }))).flat(),
    ],
  };
}

/** @param {{ plot: Plot }} props */
export function Chart({ plot }) {
  const holder = useRef(/** @type {HTMLDivElement | null} */ (null));
  const chart = useRef(/** @type {any} */ (null));
  const now = useRef(plot);
  now.current = plot;
  // What is not seen is drawn when it comes into sight.
  const seen = useRef({ is: true, drawn: plot });
  // Another look, another unit or another number of curves needs axes of its own.
  const form = [plot.key, plot.curves.length, shownUnit(plot.x.unit, state.units.value).unit, shownUnit(plot.unit, state.units.value).unit, shownLook.value, state.pins.value.map(({ name }) => name)].join("|");
  useEffect(() => {
    const element = /** @type {HTMLDivElement} */ (holder.current);
    const made = new uPlot(options(plot, Math.max(element.clientWidth, 160)), drawn(plot), element);
    chart.current = made;
    seen.current.drawn = plot;
    const line = document.createElement("div");
    line.className = "instant-line";
    made.over.append(line);
    const follow = () => {
      if (!seen.current.is) return;
      const value = valueOf(now.current);
      const { factor } = shownUnit(now.current.x.unit, state.units.value);
      line.hidden = value === null;
      if (value !== null) line.style.transform = `translateX(${made.valToPos(value / factor, "x").toFixed(1)}px)`;
    };
    followers.add(follow);
    const scrub = () => {
      const { left } = made.cursor;
      if (made.select.width > 0 || left < 0) return;
      const instant = instantOf(now.current, made.posToVal(left, "x") * shownUnit(now.current.x.unit, state.units.value).factor);
      if (instant === null) return;
      state.playing.value = false;
      state.time.value = instant;
    };
    made.over.addEventListener("click", scrub);
    const watch = new IntersectionObserver(([entry]) => {
      seen.current.is = entry.isIntersecting;
      refresh();
      follow();
    });
    watch.observe(element);
    const observer = new ResizeObserver(() => made.setSize({ width: Math.max(element.clientWidth, 160), height: HEIGHT }));
    observer.observe(element);
    follow();
    return () => {
      followers.delete(follow);
      watch.disconnect();
      observer.disconnect();
      made.destroy();
      chart.current = null;
    };
  }, [form]);
  function refresh() {
    const made = chart.current;
    if (!made || !seen.current.is || seen.current.drawn === now.current) return;
    const data = drawn(now.current);
    // Another number of curves is drawn by a chart of its own, which follows.
    if (data.length !== made.series.length) return;
    seen.current.drawn = now.current;
    made.setData(data, !isZoomed(made));
  }
  // In the frame of the answer, not in the one after it.
  useLayoutEffect(refresh, [plot]);
  return html`<div class="chart" ref=${holder} data-plot=${plot.key} role="img" aria-label="Plot of ${plot.title}; its numbers are in the data table"></div>`;
}

/** Whether a user looks at a part of the abscissa. @param {any} made */
function isZoomed(made) {
  const x = made.data[0];
  const { min, max } = made.scales.x;
  return x.length > 1 && (min > x[0] || max < x[x.length - 1]);
}
