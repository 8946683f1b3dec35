// Elements to build a machine from, and links that the mouse draws.
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { add, merge, settle } from "./actions.js";
import { Choice, ofNames } from "./choice.js";
import * as state from "./state.js";

/** Two joints made one without a mouse. */
function Merge() {
  const [[joint, into], set] = useState(["", ""]);
  const points = state.handled.value ? state.handled.value.split("\n") : [];
  const all = Object.keys(state.scene.value?.points ?? {}).filter((name) => points.includes(name) || name === "O");
  if (all.length < 2) return null;
  const choice = (/** @type {string} */ word, /** @type {string} */ value, /** @type {string[]} */ names, /** @type {(name: string) => void} */ put) => html`
    <label>${word} <${Choice} aria-label=${word} value=${value} choose=${put} options=${[["", "–"], ...ofNames(names)]} /></label>`;
  return html`
    <div class="line merge">${choice("Merge", joint, points, (name) => set([name, into]))} ${choice("with", into, all.filter((name) => name !== joint), (name) => set([joint, name]))}
      <button id="merge" disabled=${!joint || !into} onClick=${() => {
        merge(joint, into);
        set(["", ""]);
      }}>Merge</button></div>
    <p class="about">A joint dropped on another merges with it: elements of the first joint move to the second, and its element is removed.</p>`;
}

/** What is drawn in the drawing. */
const DRAWN = [["link", "draw", "Draw links"], ["driving", "draw-driving", "Draw a driving cylinder"], ["passive", "draw-passive", "Draw a passive cylinder"]];

function Links() {
  const is = state.drawing.value;
  return html`
    <p class="kinds">${DRAWN.map(([kind, id, words]) => html`<button key=${id} id=${id} class=${is === kind ? "main" : ""} aria-pressed=${is === kind} onClick=${() => {
      // Links and cylinders may wait for each other.
      if (!is || is === kind) {
        state.draft.value = [];
        state.waits.value = "";
      }
      state.playing.value = false;
      state.seen.value = "mechanism";
      state.drawing.value = is === kind ? "" : kind;
    }}>${words}</button>`)}</p>
    ${is && is !== "link" ? html`<p class="about">Press on its trunnion, a joint or a place in the plane, drag, and release at its eye. A driving cylinder moves what it is joined to; a passive one is a spring or damper between two points.</p>` : null}
    ${is === "link" ? html`<p class="about">Press on a joint or in the plane, drag, and release on a joint or in the plane. The first link is the crank; a link that begins in the plane turns about a point of the frame. Escape removes links that are not complete.</p>` : null}
    ${state.waits.value ? html`<p class="about" role="status">${state.waits.value}</p>` : null}`;
}

export function Build() {
  const groups = [...new Set(state.kinds.value.map(({ group }) => group))];
  return html`
    <details class="part build" open=${!state.place.value.name} onToggle=${({ target }) => (state.building.value = target.open)}><summary>Add an element</summary>
      <${Links} />
      ${groups.map((group) => html`<h4 key=${group}>${group}</h4><div class="kinds">${state.kinds.value.filter((each) => each.group === group).map(({ kind, word }) => html`
        <button key=${kind} data-kind=${kind} onClick=${() => add(kind)}>${word}</button>`)}</div>`)}
      <p class="about">New elements attach to the selected point, or to the first that fits; change it in their entries.</p>
      <${Merge} />
    </details>`;
}

/** Takes an element out of the file. @param {{ address: string, word: string }} props */
export const Remove = ({ address, word }) => html`<button class="quiet remove" aria-label="Remove ${word}" title="Remove ${word}" onClick=${(event) => {
  event.preventDefault();
  settle({ [address]: null });
}}>remove</button>`;

/** Whether a group is an element that can be taken out. @param {string} address */
export const isElement = (address) => /^(mechanism\.[a-z_]+|bodies|loads|axes|train\.[a-z]+s)\.("[^"]*"|[^.]+)$/.test(address);
