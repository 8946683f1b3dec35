// What can be computed: ready, running, or what data are missing and how to add them; findings and warnings.
import { html } from "./html.js";
import { settle, stop, undo } from "./actions.js";
import { said } from "./language.js";
import * as state from "./state.js";

/** Analyses that one thing stands in the way of. @param {{ chips: Chip[] }} props */
const Blocked = ({ chips: [first, ...rest] }) => html`<span class="chip blocked" title=${first.obstacle}><i aria-hidden="true">○</i>${[first, ...rest].map(({ word }) => said(word)).join(", ")}<small>${first.obstacle}</small>
  ${first.mend ? html`<button onClick=${() => settle(first.entries ?? {})}>${first.mend}</button>` : null}</span>`;

/** @param {{ chip: Chip }} props */
function Chip({ chip }) {
  const { name, word, lane } = chip;
  const now = lane === "fast" ? (state.results.value.some((each) => each.name.split(".")[0] === name) || state.views.value.some(({ kind }) => kind === name) || (name === "motion" && state.scene.value) ? "ready" : "failed") : state.lanes.value[lane] ?? "ready";
  const looks = /** @type {Record<string, [string, string]>} */ ({ ready: ["●", "ready"], running: ["◌", "running"], stopped: ["■", "stopped"], failed: ["▲", "cannot be computed; see the findings"] });
  const [mark, about] = looks[now];
  return html`<span class="chip ${now}" title="${word}: ${about}"><i aria-hidden="true">${mark}</i>${word}${now === "ready" ? null : html`<small>${now === "failed" ? "see findings" : now}</small>`}
      ${now === "failed" && state.past.value.of.canUndo ? html`<button onClick=${undo}>Undo</button>` : null}</span>`;
}

export function Chips() {
  const runs = state.runs.value;
  const chips = state.chips.value;
  const obstacles = [...new Set(chips.flatMap(({ obstacle }) => obstacle ?? []))];
  return html`
    <div class="chips" aria-label="Analyses">
      ${chips.filter(({ obstacle }) => !obstacle).map((chip) => html`<${Chip} key=${chip.name} chip=${chip} />`)}
      ${obstacles.map((words) => html`<${Blocked} key=${words} chips=${chips.filter(({ obstacle }) => obstacle === words)} />`)}
      ${runs ? html`<button class="quiet stop" onClick=${stop} title="Stop the background computation">Stop</button>` : null}
    </div>`;
}

export function Findings() {
  const [found, warned] = [state.findings.value, state.warnings.value];
  return html`
    ${found.length ? html`<section class="box finding" aria-label="Failed checks"><h3>${found.length === 1 ? "A failed check" : `${found.length} failed checks`}</h3><ul>${found.map((each) => html`<li>${each}</li>`)}</ul></section>` : null}
    ${warned.length ? html`<section class="box warning" aria-label="Warnings"><h3>Warnings</h3><ul>${warned.map((each) => html`<li>${each}</li>`)}</ul></section>` : null}`;
}
