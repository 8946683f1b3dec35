// The page.
import { html } from "./html.js";
import { render } from "./vendor/preact.mjs";
import { useState } from "./vendor/hooks.mjs";
import { effect } from "./vendor/signals-core.mjs";
import "./vendor/signals.mjs";
import { busy, hold, measured, open, redo, undo, write } from "./actions.js";
import { Chips, Findings } from "./chips.js";
import { Controls } from "./controls.js";
import { Design } from "./design.js";
import { Dialog } from "./dialogs.js";
import { Editor } from "./editor.js";
import { Header, saveNow } from "./header.js";
import { Head, Numbers } from "./numbers.js";
import { Diagrams, Plots } from "./plots.js";
import { frames } from "./stage.js";
import * as state from "./state.js";
import { Picture } from "./views.js";

/** @param {{ name: string, tabs: [string, any][] }} props */
function Tabs({ name, tabs }) {
  const [at, setAt] = useState(0);
  const Inside = tabs[at][1];
  const key = (/** @type {KeyboardEvent} */ event) => {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!way) return;
    const next = (at + way + tabs.length) % tabs.length;
    setAt(next);
    const own = /** @type {HTMLElement} */ (event.currentTarget).children[next];
    if (own instanceof HTMLElement) own.focus();
  };
  return html`
    <div class="tabs" role="tablist" aria-label=${name} onKeyDown=${key}>
      ${tabs.map(([word], n) => html`<button key=${word} role="tab" id="${name}-${n}" aria-selected=${n === at} aria-controls="${name}-panel" tabindex=${n === at ? 0 : -1} onClick=${() => setAt(n)}>${word}</button>`)}
    </div>
    <div class="tab-panel" role="tabpanel" id="${name}-panel" aria-labelledby="${name}-${at}" tabindex="0"><${Inside} /></div>`;
}

function Message() {
  const words = state.connected.value ? state.message.value : state.known.value ? "The studio has ended, or cannot be reached. Your work is kept in this page." : "This page has no key to the studio. Open the address that linkwright studio printed last.";
  if (!words) return null;
  return html`<div class="message" role="alert">${words} ${state.connected.value ? html`<button onClick=${() => (state.message.value = "")}>Close</button>` : null}</div>`;
}

function App() {
  return html`
    <${Header} />
    <main>
      <aside class="left" aria-label="Entries of the machine"><${Tabs} name="entries" tabs=${[["Entries", Controls], ["File", Editor]]} /></aside>
      <section class="middle" aria-label="Machine in motion">
        <${Picture} /><${Chips} />
        <div class="below"><${Head} /><${Findings} /></div>
      </section>
      <aside class="right" aria-label="Results"><${Tabs} name="results" tabs=${[["Plots", Plots], ["Numbers", Numbers], ["Diagrams", Diagrams], ["Design", Design]]} /></aside>
    </main>
    <${Message} /><${Dialog} />`;
}

effect(() => {
  document.title = `${state.unsaved.value ? "● " : ""}${state.machine.value || "Linkwright"} – studio`;
});

addEventListener("beforeunload", (event) => {
  if (state.unsaved.value) event.preventDefault();
});

addEventListener("keydown", (event) => {
  const inField = event.target instanceof HTMLElement && event.target.matches("input, textarea, select");
  const key = event.key.toLowerCase();
  if ((event.ctrlKey || event.metaKey) && key === "s") {
    event.preventDefault();
    saveNow();
  } else if ((event.ctrlKey || event.metaKey) && key === "z" && !(event.target instanceof HTMLTextAreaElement)) {
    event.preventDefault();
    (event.shiftKey ? redo : undo)();
  } else if (key === "escape" && state.drawing.value) {
    state.draft.value = [];
    state.waits.value = "";
  } else if (key === " " && !inField && !(event.target instanceof HTMLButtonElement)) {
    event.preventDefault();
    state.playing.value = !state.playing.value;
  }
});

// What the tests of the page measure.
Object.assign(globalThis, { studio: { state, measured, frames, busy, hold, open, write } });

render(html`<${App} />`, /** @type {HTMLElement} */ (document.getElementById("app")));
