// What opens over the page: the gallery, saving, units, the same result elsewhere.
import { Choice } from "./choice.js";
import { html } from "./html.js";
import { useEffect, useRef, useState } from "./vendor/hooks.mjs";
import { save, whole } from "./actions.js";
import { Files } from "./files.js";
import { Gallery } from "./gallery.js";
import { Icon } from "./icons.js";
import { unitSaid } from "./language.js";
import { Enlarged } from "./plots.js";
import * as state from "./state.js";
import { SETS, UNITS, chosen } from "./units.js";

function Units() {
  const choice = state.units.value;
  return html`
    <div class="sets" role="group" aria-label="Sets of units">${SETS.map((word, n) => html`<button key=${word} onClick=${() => state.choose(chosen(n))}>${word}</button>`)}</div>
    <div class="units">${Object.entries(UNITS).map(([si, { word, units }]) => html`
      <label key=${si}>${word}<${Choice} value=${choice[si]} options=${Object.keys(units).map((unit) => [unit, unitSaid(unit)])} choose=${(unit) => state.choose({ ...choice, [si]: unit })} /></label>`)}</div>
    <p class="about">The units of the table [units] of a file are used when it is opened; the file keeps its units. A number with its own unit, such as <code>8.5 in</code>, can be typed into every field.</p>`;
}

function SaveAs() {
  const { place, name } = state.place.value;
  const [wanted, setWanted] = useState(place === "folder" ? name : `${name || "machine"}.toml`);
  const [over, setOver] = useState(false);
  return html`
    <form onSubmit=${(event) => {
      event.preventDefault();
      save(wanted.endsWith(".toml") ? wanted : `${wanted}.toml`, over);
    }}>
      <label>Name, below the folder of the studio <input id="save-name" value=${wanted} onInput=${({ target }) => setWanted(target.value)} /></label>
      <label class="check"><input type="checkbox" checked=${over} onChange=${({ target }) => setOver(target.checked)} />Replace a file of this name</label>
      <button class="main" type="submit">Save</button>
    </form>`;
}

/** @param {{ words: string, label: string }} props */
function Copy({ words, label }) {
  const [done, setDone] = useState(false);
  return html`
    <div class="copy"><h3>${label}</h3><pre tabindex="0" translate="no">${words}</pre>
      <button onClick=${async () => {
        await navigator.clipboard.writeText(words);
        setDone(true);
      }}>${done ? "Copied" : "Copy"}</button></div>`;
}

function Elsewhere() {
  const [link, setLink] = useState("");
  const { place, name } = state.place.value;
  useEffect(() => {
    whole().then((letters) => setLink(`#state=${letters}`));
  }, [state.text.value]);
  const file = place === "folder" || place === "library" ? name : "machine.toml";
  const isTrain = !("study" in state.lanes.value);
  const first = place === "template" || state.unsaved.value ? "Save the file first: these lines read it.\n" : "";
  return html`
    ${first ? html`<p class="about">${first}</p>` : null}
    <${Copy} label="Command line" words=${`linkwright ${isTrain ? "torsion" : "run"} ${file} --out out`} />
    <${Copy} label="Python" words=${`import linkwright as lw\n\nmachine = lw.read("${file}")\n${isTrain ? 'study = lw.torsion_study(machine)\nstudy.plot("mode_shapes").savefig("modes.png")' : 'study = lw.study(machine)\nlw.write_report(study, "report.html")'}`} />
    <${Copy} label="This state, to be appended to the address of any studio" words=${link} />`;
}

const DIALOGS = /** @type {Record<string, [string, any]>} */ ({
  gallery: ["Machines", Gallery],
  save: ["Save as", SaveAs],
  files: ["Export", Files],
  units: ["Units", Units],
  elsewhere: ["The same elsewhere", Elsewhere],
  diagram: ["Diagram", Enlarged],
});

export function Dialog() {
  const own = useRef(/** @type {HTMLDialogElement | null} */ (null));
  const which = state.dialog.value;
  useEffect(() => {
    if (which && own.current && !own.current.open) own.current.showModal();
    if (!which && own.current?.open) own.current.close();
  }, [which]);
  const [title, Inside] = DIALOGS[which] ?? ["", null];
  return html`
    <dialog ref=${own} class=${which} aria-label=${title || "Dialog"} onClose=${() => (state.dialog.value = "")} onClick=${({ target }) => target === own.current && (state.dialog.value = "")}>
      <div class="sheet"><header><h2>${title}</h2><button class="icon" aria-label="Close" onClick=${() => (state.dialog.value = "")}><${Icon} name="close" /></button></header>
      ${Inside ? html`<${Inside} />` : null}</div>
    </dialog>`;
}
