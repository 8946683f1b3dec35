// The picture: the mechanism, the train in one of its modes, or the knife of a topper; a tab each where there are several.
import { Choice } from "./choice.js";
import { html } from "./html.js";
import { useRef, useState } from "./vendor/hooks.mjs";
import { paintKnife, across } from "./knife.js";
import { Moving } from "./moving.js";
import { Play, Playbar, Speed } from "./playbar.js";
import { Stage } from "./stage.js";
import * as state from "./state.js";
import { Timing } from "./timing.js";
import { paintTrain } from "./twist.js";
import { number, shownUnit } from "./units.js";

/** Seconds of one period of a mode on the page. */
const PERIOD = 2.4;

/** Seconds at the end of a row before it begins again. */
const REST = 1.5;

const WORDS = /** @type {Record<string, string>} */ ({ mechanism: "Mechanism", train: "Shaft train", timing: "Timing diagram", topper: "Topper from above" });

/** @param {{ view: Train }} props */
function TrainView({ view }) {
  const [wanted, setMode] = useState(0);
  const time = useRef(0);
  const mode = Math.min(wanted, view.frequencies.length - 1);
  if (mode < 0) return html`<div class="stage"><p class="nothing">No mode of this train twists a shaft.</p></div>`;
  return html`
    <div class="stage"><${Moving} label="Shaft train in mode ${mode + 1}" draw=${(/** @type {Paper} */ paper) => {
      time.current += (paper.passed / PERIOD) * 10 ** state.pace.value;
      paintTrain(paper, view, mode, Math.cos(2 * Math.PI * time.current));
    }} /></div>
    <div class="playbar" role="group" aria-label="Motion">
      <${Play} />
      <label class="mode">Mode <${Choice} id="mode" value=${mode} choose=${(n) => setMode(Number(n))} options=${Array.from(view.frequencies, (f, n) => [n, `${n + 1}: ${number(f, 5)} ${shownUnit("Hz", state.units.value).unit}`])} /></label>
      <span class="about words">Angles are drawn greatly enlarged. Red dots: nodes, at rest.</span>
      <${Speed} />
    </div>`;
}

/** @param {{ view: Knife }} props */
function KnifeView({ view }) {
  const [first, last] = view.span;
  const own = useRef({ share: 0.5, rest: 0 });
  const slider = useRef(/** @type {HTMLInputElement | null} */ (null));
  const words = useRef(/** @type {HTMLOutputElement | null} */ (null));
  const [, again] = useState(0);
  const draw = (/** @type {Paper} */ paper) => {
    const at = own.current;
    if (at.share >= 1) at.rest += paper.passed;
    at.share = Math.min(1, at.share + (paper.passed / view.seconds) * 10 ** state.pace.value);
    if (at.rest > REST) [at.share, at.rest] = [0, 0];
    const t = first + at.share * (last - first);
    paintKnife(paper, view, t);
    if (slider.current && paper.passed) slider.current.value = String(at.share);
    const { unit, factor } = shownUnit("m", { ...state.units.value, m: state.units.value.m === "m" ? "mm" : state.units.value.m });
    if (words.current) words.current.textContent = `y = ${number(across(view, t) / factor, 3).padStart(6, "\u2007")} ${unit}`;
  };
  return html`
    <div class="stage"><${Moving} label="Knife of the topper over the heads of a row, from above" draw=${draw} /></div>
    <div class="playbar" role="group" aria-label="Motion">
      <${Play} />
      <input type="range" id="knife" ref=${slider} min="0" max="1" step="any" value=${own.current.share} aria-label="Way along the row" onInput=${({ target }) => {
        state.playing.value = false;
        own.current = { share: Number(target.value), rest: 0 };
        again(own.current.share);
      }} />
      <output ref=${words}></output>
      <${Speed} />
    </div>
    <p class="about words">The machine travels to the right. Green: haulm; yellow: cut; green behind the knife: left uncut. The head in the middle is the worst one.</p>`;
}

export function Picture() {
  const views = state.views.value;
  const names = [...(state.isDrawn.value || !views.length ? ["mechanism"] : []), ...views.map(({ kind }) => kind)];
  const at = names.includes(state.seen.value) ? state.seen.value : names[0];
  const view = views.find(({ kind }) => kind === at);
  return html`
    ${names.length > 1 ? html`<div class="sets views" role="group" aria-label="Picture">${names.map((name) => html`<button key=${name} aria-pressed=${name === at} onClick=${() => (state.seen.value = name)}>${WORDS[name]}</button>`)}</div>` : null}
    ${view?.kind === "train" ? html`<${TrainView} view=${view} />` : view?.kind === "topper" ? html`<${KnifeView} view=${view} />` : view?.kind === "timing" ? html`<${Timing} view=${view} />` : html`<${Stage} /><${Playbar} />`}`;
}
