// Play, step, scrub, playback speed, and what is drawn.
import { Choice } from "./choice.js";
import { html } from "./html.js";
import { Icon } from "./icons.js";
import * as state from "./state.js";
import { between, placeOf } from "./timeline.js";

const LAYERS = /** @type {[keyof typeof state.layers.value & string, string][]} */ ([
  ["velocities", "Velocities"], ["accelerations", "Accelerations"], ["forces", "Joint forces"], ["centres", "Instant centres"], ["paths", "Paths"], ["names", "Names"], ["handles", "Handles"],
]);

/** @param {number} by steps of the scene */
function step(by) {
  const scene = state.scene.value;
  if (!scene) return;
  state.playing.value = false;
  const last = scene.times.length - 1;
  const k = Math.round(placeOf(scene.times, state.time.value)) + by;
  state.time.value = scene.times[scene.swings ? Math.min(Math.max(k, 0), last) : (k + last) % last];
}

export const Play = () => html`<button class="icon play" onClick=${() => (state.playing.value = !state.playing.value)} aria-label=${state.playing.value ? "Pause" : "Play"} title="Play or pause (space)"><${Icon} name=${state.playing.value ? "pause" : "play"} /></button>`;

export const Speed = () => html`
  <label class="speed">Speed
    <input type="range" min="-2" max="1" step="0.05" value=${state.pace.value} aria-valuetext=${`${(10 ** state.pace.value).toPrecision(2)} times`}
      onInput=${({ target }) => (state.pace.value = Number(target.value))} />
  </label>`;

/** Points that move. */
const movers = () => Object.keys(state.scene.value?.velocities ?? {});

/** The path of a point, or of all, is drawn or no longer. @param {string} name */
function trail(name) {
  const now = state.trails.value;
  if (name === "*") state.trails.value = now.length ? [] : movers();
  else state.trails.value = now.includes(name) ? now.filter((each) => each !== name) : [...now, name];
}

function Scrub() {
  const scene = state.scene.value;
  if (!scene) return null;
  const last = scene.times.length - 1;
  const k = placeOf(scene.times, state.time.value);
  const degrees = (between(scene.angles, k) * 180) / Math.PI;
  return html`<input type="range" id="scrub" aria-label="Crank angle" min="0" max=${last} step="any" value=${k}
    aria-valuetext=${`${degrees.toFixed(0).replace("-", "−")} degrees`}
    onInput=${({ target }) => {
      state.playing.value = false;
      const n = Math.min(Number(target.value), last - 1e-9);
      state.time.value = between(scene.times, n);
    }} />`;
}

/** @param {{ isDrawing?: boolean }} props whether a drawing has what can be left out */
export function Playbar({ isDrawing = true }) {
  if (!state.isDrawn.value) return null;
  const points = movers();
  return html`
    <div class="playbar" role="group" aria-label="Motion">
      <button class="icon" onClick=${() => step(-1)} aria-label="One step back" title="One step back"><${Icon} name="back" /></button>
      <${Play} />
      <button class="icon" onClick=${() => step(1)} aria-label="One step on" title="One step on"><${Icon} name="on" /></button>
      <${Scrub} />
      <output id="instant"></output>
      <${Speed} />
    </div>
    ${isDrawing ? html`<fieldset class="layers"><legend class="hidden">What is drawn</legend>
      ${LAYERS.map(([key, word]) => html`<label key=${key}><input type="checkbox" checked=${state.layers.value[key]}
        onChange=${({ target }) => (state.layers.value = { ...state.layers.value, [key]: target.checked })} /><i class="dot ${key}"></i>${word}</label>`)}
      <label>Trails <${Choice} id="trails" value="" choose=${trail} options=${[["", state.trails.value.length || "–"], ["*", state.trails.value.length ? "none" : "all points"], ...points.map((name) => [name, `${state.trails.value.includes(name) ? "✓ " : ""}${name}`, true])]} /></label>
    </fieldset>` : null}`;
}
