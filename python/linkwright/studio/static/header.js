// The bar at the top: which machine it is, files, undo, units, look.
import { html } from "./html.js";
import { redo, save, undo } from "./actions.js";
import { Icon } from "./icons.js";
import { LANGUAGES } from "./language.js";
import * as state from "./state.js";

const LOOKS = /** @type {Record<string, [string, string]>} */ ({ "": ["system", "Look of the system"], light: ["light", "Light"], dark: ["dark", "Dark"] });

export function saveNow() {
  const { place, name } = state.place.value;
  if (place === "folder" && name) save(name, state.saved.value);
  else state.dialog.value = "save";
}

/** @param {string} dialog */
const opens = (dialog) => () => (state.dialog.value = dialog);

export function Header() {
  const past = state.past.value.of;
  const { place, name } = state.place.value;
  const [mark, about] = LOOKS[state.look.value];
  const next = { "": "light", light: "dark", dark: "" }[/** @type {""} */ (state.look.value)];
  return html`
    <header class="bar">
      <img src="icon.svg" alt="" width="28" height="28" />
      <div class="title"><h1 translate="no">${state.machine.value || "Linkwright studio"}</h1>
        <small>${name ? html`<span translate="no">${name}</span>` : "unnamed"}${place && place !== "folder" ? html`<span>${`, from the ${place}`}</span>` : null}${state.unsaved.value ? html` <span class="unsaved" title="There are unsaved changes">● unsaved</span>` : null}</small></div>
      <nav aria-label="File">
        <button onClick=${opens("gallery")}>Machines</button>
        <button onClick=${saveNow} title="Save (Ctrl+S)">Save</button>
        <button onClick=${opens("save")}>Save as</button>
        <button onClick=${opens("files")} title="Report, motion, drawing">Export</button>
        <span class="gap"></span>
        <button class="icon" disabled=${!past.canUndo} onClick=${undo} aria-label="Undo" title="Undo (Ctrl+Z)"><${Icon} name="undo" /></button>
        <button class="icon" disabled=${!past.canRedo} onClick=${redo} aria-label="Redo" title="Redo (Ctrl+Shift+Z)"><${Icon} name="redo" /></button>
        <span class="gap"></span>
        <button onClick=${opens("units")}>Units</button>
        <button onClick=${opens("elsewhere")} title="Command line, Python, link">Copy</button>
        <select class="quiet" aria-label="Language" translate="no" value=${state.language.value} onChange=${({ target }) => (state.language.value = target.value)}>
          ${Object.entries(LANGUAGES).map(([code, word]) => html`<option key=${code} value=${code} lang=${code} translate="no" selected=${code === state.language.value}>${word}</option>`)}</select>
        <button class="icon" onClick=${() => (state.look.value = next)} aria-label="Look: ${about}" title=${about}><${Icon} name=${mark} /></button>
      </nav>
    </header>`;
}
