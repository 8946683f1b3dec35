// The timing diagram: cams and axes over one revolution of the master, with handles at the ends of their sections.
import { html } from "./html.js";
import { useEffect, useRef, useState } from "./vendor/hooks.mjs";
import { hold, letBack, settle } from "./actions.js";
import { wayOf } from "./controls.js";
import { line, stroke } from "./ink.js";
import { said } from "./language.js";
import { Moving } from "./moving.js";
import { Playbar } from "./playbar.js";
import { advance, tellInstant } from "./stage.js";
import * as state from "./state.js";
import { between, placeOf } from "./timeline.js";
import { number, read, shownUnit } from "./units.js";

const TURN = 2 * Math.PI;
const DEGREE = Math.PI / 180;

/** Room to the left and the right of the diagram, height of a row of sections, of a head, and room below for angles [px]. */
const [LEFT, RIGHT, ROW, HEAD, BELOW] = [70, 18, 26, 15, 20];

/** Shortest section that a drag leaves [rad]. */
const LEAST = DEGREE;

/** Angle within one revolution. @param {number} angle */
const within = (angle) => ((angle % TURN) + TURN) % TURN;

/** Angle of the master up to the end of section k; of 0, the start. @param {Track} track @param {number} k */
const angleOf = ({ phase, sections }, k) => sections.slice(0, k).reduce((sum, { angle }) => sum + angle, phase);

/** Starts and ends of sections: the last of a whole revolution is the start. @param {Track[]} tracks @returns {SectionEnd[]} */
const endsOf = (tracks) => tracks.flatMap((track, row) => {
  const isWhole = angleOf(track, Infinity) - track.phase > TURN - 1e-9;
  return track.sections.length ? Array.from({ length: track.sections.length + (isWhole ? 0 : 1) }, (_, k) => ({ track, row, k, key: `${track.name} ${k}`, angle: angleOf(track, k) })) : [];
});

/** Entries that move an end by an angle: address, unit, SI value. The next section gives what its neighbour takes. @param {SectionEnd} end @param {number} by @returns {[string, string, number][]} */
function moved({ track: { phase, address, sections }, k }, by) {
  if (!k) return [[address ?? "", "rad", (phase + by) % TURN]];
  const [own, next] = [sections[k - 1], sections[k]];
  const room = next ? next.angle - LEAST : TURN - sections.reduce((sum, { angle }) => sum + angle, 0);
  const part = Math.min(Math.max(by, LEAST - own.angle), Math.max(room, 0));
  const change = (/** @type {Section} */ { address: of, unit, angle, rate }, /** @type {number} */ more) => /** @type {[string, string, number]} */ ([of, unit, (angle + more) * rate]);
  return [change(own, part), ...(next ? [change(next, -part)] : [])];
}

/** A value with its unit and as many digits as sections need to fill a revolution. @param {[string, string, number]} entry */
const text = ([address, unit, value]) => [address, unit === "rad" ? `${Number((value / DEGREE).toPrecision(12))} deg` : `${Number(value.toPrecision(12))} ${unit}`];

/** @param {SectionEnd} end */
const wordsOf = ({ k, track: { name } }) => (k ? `End of section ${k} of ${name}` : `Start of the sections of ${name}`);

/** @param {{ view: { angles: Float64Array, tracks: Track[] } }} props */
export function Timing({ view }) {
  const [picked, pick] = useState("");
  const holder = useRef(/** @type {HTMLDivElement | null} */ (null));
  /** The end in hand, where the pointer was, and by what it was moved. */
  const gesture = useRef(/** @type {{ end: SectionEnd, x: number, by: number } | null} */ (null));
  const letGo = () => {
    if (gesture.current?.by) letBack();
    gesture.current = null;
  };
  useEffect(() => letGo, []);
  const ends = endsOf(view.tracks);
  const own = ends.find(({ key }) => key === picked);
  const place = (/** @type {SectionEnd} */ end, /** @type {number} */ by) => settle(Object.fromEntries(moved(end, by).map(text)));

  /** @param {PointerEvent} event */
  function over({ clientX }) {
    const now = gesture.current;
    if (!now || !holder.current) return;
    const by = ((clientX - now.x) / (holder.current.clientWidth - LEFT - RIGHT)) * TURN;
    // To whole degrees of the master.
    now.by = Math.round((now.end.angle + by) / DEGREE) * DEGREE - now.end.angle;
    hold(Object.fromEntries(moved(now.end, now.by).map(([address, , value]) => [address, value])));
  }
  function up() {
    const now = gesture.current;
    gesture.current = null;
    if (now?.by) place(now.end, now.by);
  }
  /** @param {KeyboardEvent} event @param {SectionEnd} end */
  function key(event, end) {
    if (event.key === "Escape") return letGo();
    const way = wayOf(event);
    if (!way) return;
    event.preventDefault();
    place(end, way * DEGREE * (event.shiftKey ? 10 : 1));
  }
  const { unit, factor } = shownUnit("rad", state.units.value);
  const scene = state.scene.value;
  const instant = scene ? within(between(scene.angles, placeOf(scene.times, state.time.value))) : 0;
  return html`
    <div class="stage timing" ref=${holder}>
      <${Moving} label="Timing diagram of ${view.tracks.map(({ name }) => name).join(", ")}" draw=${(/** @type {Paper} */ paper) => {
        advance(paper.passed);
        tellInstant();
        paint(paper, view, instant);
      }} />
      <div class="handles">${ends.map((end) => html`
        <button key=${end.key} class="handle" data-end=${end.key} title="Drag to move; the next section gives what this one takes" aria-label=${wordsOf(end)} aria-pressed=${picked === end.key}
          style=${{ left: `calc(${LEFT}px + (100% - ${LEFT + RIGHT}px) * ${within(end.angle) / TURN})`, top: `${(end.row + 0.5) * ROW + 4}px` }}
          onPointerDown=${(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            gesture.current = { end, x: event.clientX, by: 0 };
            pick(end.key);
          }} onPointerMove=${over} onPointerUp=${up} onPointerCancel=${letGo} onFocus=${() => pick(end.key)} onKeyDown=${(event) => key(event, end)}></button>`)}</div>
    </div>
    ${own ? html`<div class="playbar"><label class="mode">${wordsOf(own)} <input id="end" inputmode="decimal" value=${number(own.angle / factor, 7)} onChange=${({ target }) => {
      const wanted = read(target.value) * factor;
      if (Number.isFinite(wanted)) place(own, wanted - own.angle);
    }} /> ${unit}</label></div>` : null}
    <${Playbar} isDrawing=${false} />`;
}

/** @param {Paper} paper @param {{ angles: Float64Array, tracks: Track[] }} view @param {number} instant */
function paint({ ctx, width, height, ink, series }, { angles, tracks }, instant) {
  const X = (/** @type {number} */ angle) => LEFT + (angle / TURN) * (width - LEFT - RIGHT);
  ctx.font = "12px system-ui, sans-serif";
  ctx.textBaseline = "middle";
  const [top, foot] = [tracks.length * ROW + 10, height - BELOW];
  for (let degrees = 0; degrees <= 360; degrees += 45) {
    line(ctx, [[X(degrees * DEGREE), 4], [X(degrees * DEGREE), foot]]);
    stroke(ctx, ink.grid, 1);
    ctx.textAlign = "center";
    ctx.fillStyle = ink.soft;
    if (degrees % 90 === 0) ctx.fillText(`${degrees}°`, X(degrees * DEGREE), foot + 11);
  }
  tracks.forEach((track, row) => {
    const y = (row + 0.5) * ROW + 4;
    ctx.textAlign = "right";
    ctx.fillStyle = series[row % series.length];
    ctx.fillText(track.name, LEFT - 8, y, LEFT - 12);
    line(ctx, [[X(0), y], [X(TURN), y]]);
    stroke(ctx, ink.grid, 2);
    track.sections.forEach(({ angle, dwells }, k) => {
      const from = within(angleOf(track, k));
      ctx.globalAlpha = dwells ? 0.15 : 0.6;
      // A section over the end of the revolution goes on at its start.
      for (const start of [from, from - TURN]) {
        const [low, high] = [Math.max(start, 0), Math.min(start + angle, TURN)];
        if (high > low) ctx.fillRect(X(low), y - 8, X(high) - X(low), 16);
      }
      ctx.globalAlpha = 1;
    });
  });
  const count = tracks[0].curves.length;
  const high = (foot - top) / count;
  for (let n = 0; n < count; n += 1) panel(n, top + n * high, high);
  line(ctx, [[X(instant), 4], [X(instant), foot]]);
  stroke(ctx, ink.accent, 1.2);

  /** Each curve over its range, or over its peak, with its size at the head. @param {number} n @param {number} y @param {number} tall */
  function panel(n, y, tall) {
    const isRange = n === 0;
    ctx.textAlign = "left";
    ctx.fillStyle = ink.ink;
    const words = said(n === count - 1 ? "torque or force" : tracks[0].curves[n].name);
    ctx.fillText(words, 8, y + HEAD / 2 + 2);
    let x = Math.max(LEFT, ctx.measureText(words).width + 20);
    const [low, size] = [y + tall - 4, tall - HEAD - 10];
    const zero = isRange ? low : low - size / 2;
    line(ctx, [[X(0), zero], [X(TURN), zero]]);
    stroke(ctx, ink.grid, 1);
    tracks.forEach(({ name, curves }, row) => {
      const { values, unit: si } = curves[n];
      const { unit, factor } = shownUnit(si, state.units.value);
      const [least, most] = [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
      const peak = isRange ? most - least : Math.max(Math.abs(least), Math.abs(most));
      const scale = peak ? (isRange ? size : size / 2) / peak : 0;
      line(ctx, Array.from(values, (value, k) => [X(angles[k]), zero - (value - (isRange ? least : 0)) * scale]));
      stroke(ctx, series[row % series.length], 1.6);
      const head = `${name} ${isRange ? "" : "± "}${number(peak / factor, 4)}${unit === "°" ? "" : " "}${unit}`;
      ctx.fillStyle = series[row % series.length];
      if (x < width - RIGHT) ctx.fillText(head, x, y + HEAD / 2 + 2);
      x += ctx.measureText(head).width + 14;
    });
  }
}
