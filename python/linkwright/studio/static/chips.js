// What can be computed: ready, running, or what data are missing and how to add them; findings and warnings.
import { html } from "./html.js";
import { settle, stop, undo } from "./actions.js";
import * as state from "./state.js";

/** @param {{ chip: Chip }} props */
function Chip({ chip }) {
  const { name, word, lane, obstacle, mend, entries } = chip;
  if (obstacle) {
    return html`<span class="chip blocked" title=${obstacle}><i aria-hidden="true">○</i>${word}<small>${obstacle}</small>
      ${mend ? html`<button onClick=${() => settle(entries ?? {})}>${mend}</button>` : null}</span>`;
  }
  const now = lane === "fast" ? (state.results.value.some((each) => each.name === name) || (name === "motion" && state.scene.value) ? "ready" : "failed") : state.lanes.value[lane] ?? "ready";
  const looks = /** @type {Record<string, [string, string]>} */ ({ ready: ["●", "ready"], running: ["◌", "running"], stopped: ["■", "stopped"], failed: ["▲", "cannot be computed; see the findings"] });
  const [mark, about] = looks[now];
  return html`<span class="chip ${now}" title="${word}: ${about}"><i aria-hidden="true">${mark}</i>${word}${now === "ready" ? null : html`<small>${now === "failed" ? "see findings" : now}</small>`}
      ${now === "failed" && state.past.value.of.canUndo ? html`<button onClick=${undo}>Undo</button>` : null}</span>`;
}

export function Chips() {
  const runs = state.runs.value;
  return html`
    <div class="chips" aria-label="Analyses">
      ${state.chips.value.map((chip) => html`<${Chip} key=${chip.name} chip=${chip} />`)}
      ${runs ? html`<button class="quiet stop" onClick=${stop} title="Stop the background computation">Stop</button>` : null}
    </div>`;
}

export function Findings() {
  const [found, warned] = [state.findings.value, state.warnings.value];
  return html`
    ${found.length ? html`<section class="box finding" aria-label="Failed checks"><h3>${found.length === 1 ? "A failed check" : `${found.length} failed checks`}</h3><ul>${found.map((each) => html`<li>${each}</li>`)}</ul></section>` : null}
    ${warned.length ? html`<section class="box warning" aria-label="Warnings"><h3>Warnings</h3><ul>${warned.map((each) => html`<li>${each}</li>`)}</ul></section>` : null}`;
}
