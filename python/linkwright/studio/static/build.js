// Elements to build a machine from, with sizes of the drawing and names that are there.
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { merge, settle } from "./actions.js";
import { Choice, ofNames } from "./choice.js";
import * as state from "./state.js";
import { written } from "./units.js";

/** @param {string} head @param {Set<string>} names */
function fresh(head, names) {
  for (let n = 1; ; n += 1) if (!names.has(`${head}${n}`)) return `${head}${n}`;
}

/** Names of a table of the file. @param {string} address */
function named(address) {
  let group = state.controls.value;
  for (const key of address.split(".")) group = group?.groups.find((each) => each.key === key) ?? null;
  return group ? [...group.groups.map(({ key }) => key), ...group.entries.map(({ key }) => key)] : [];
}

/** @param {number} length */
const metres = (length) => `${written(length, 2)} m`;

/** What each kind adds: address and entries; null where there is nothing to build it on. @returns {[string, [string, object] | null, string][]} */
function kinds() {
  const scene = state.scene.value;
  const size = scene ? Math.max(scene.box[2] - scene.box[0], scene.box[3] - scene.box[1]) : 1;
  const tables = ["points", "cranks", "sliders", "rockers", "rigid_points"];
  const names = new Set(tables.flatMap((table) => named(`mechanism.${table}`)));
  const watched = state.watched.value;
  const moving = [watched, ...named("mechanism.cranks"), ...named("mechanism.rockers")].find((name) => name && scene?.velocities[name]);
  const links = [...named("mechanism.rockers").map((name) => `${name}.coupler`), ...named("mechanism.sliders").map((name) => `${name}.rod`), ...named("mechanism.cranks")];
  const fixed = named("mechanism.points").find((name) => name);
  const carrier = watched && scene?.velocities[watched] ? watched : [...named("mechanism.sliders"), ...links][0];
  const word = "a moving point, such as the pin of a crank";
  return [
    ["Fixed point", [`mechanism.points.${fresh("P", names)}`, { x: metres(0.5 * size), y: "0 m" }], ""],
    ["Crank", [`mechanism.cranks.${fresh("A", names)}`, { radius: metres(0.15 * size) }], ""],
    ["Rod and slider", moving ? [`mechanism.sliders.${fresh("S", names)}`, { crank: moving, rod: metres(0.7 * size) }] : null, word],
    ["Coupler and rocker", moving && fixed ? [`mechanism.rockers.${fresh("R", names)}`, { crank: moving, pivot: fixed, coupler: metres(0.5 * size), rocker: metres(0.4 * size) }] : null, `${word}, and a fixed point`],
    ["Point of a link", links.length ? [`mechanism.rigid_points.${fresh("K", names)}`, { link: links[0], along: metres(0.3 * size), across: metres(0.1 * size) }] : null, "a link"],
    ["Body", carrier ? [`bodies.${/[^\w-]/.test(carrier) ? `"${carrier}"` : carrier}`, { mass: "1 kg" }] : null, "something that moves"],
    ["Friction load", named("mechanism.sliders")[0] ? [`loads.${fresh("load", new Set(named("loads")))}`, { kind: "dry", on: named("mechanism.sliders")[0], force: "100 N" }] : null, "a slider"],
    ["Gravity", named("loads").includes("gravity") ? null : ["loads.gravity", { kind: "gravity" }], "no gravity yet"],
  ];
}

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

export function Build() {
  return html`
    <details class="part build" open=${!state.place.value.name} onToggle=${({ target }) => (state.building.value = target.open)}><summary>Add an element</summary>
      <div class="kinds">${kinds().map(([word, made, needs]) => html`
        <button key=${word} disabled=${!made} title=${made ? `Adds ${made[0]}` : `Needs ${needs}`} onClick=${() => made && settle({ [made[0]]: made[1] })}>${word}</button>`)}</div>
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
export const isElement = (address) => /^(mechanism\.[a-z_]+|bodies|loads|train\.[a-z]+s)\.("[^"]*"|[^.]+)$/.test(address);
