// Files of the machine: report, motion, pose.
import { Choice } from "./choice.js";
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { make, stopMaking } from "./actions.js";
import { download } from "./exported.js";
import * as state from "./state.js";
import { between, placeOf } from "./timeline.js";
import { listed, read } from "./units.js";

const SECTIONS = /** @type {[string, string][]} */ ([
  ["summary", "Summary"], ["sketch", "Drawing"], ["results", "Results"], ["formulas", "Formulas"], ["data", "Machine data"], ["assumptions", "Assumptions"], ["repeat", "Reproduction"],
]);

/** Choices stay while the page is open. */
const chosen = { of: "study", sections: SECTIONS.map(([key]) => key), company: "", units: false, variants: true, seconds: 4 };

/** Crank angle of the drawing. */
function angle() {
  const scene = state.scene.value;
  return scene ? between(scene.angles, placeOf(scene.times, state.time.value)) : 0;
}

export function Files() {
  const [, again] = useState(0);
  const [running, setRunning] = useState("");
  const set = (/** @type {Partial<typeof chosen>} */ more) => {
    Object.assign(chosen, more);
    again(performance.now());
  };
  const lanes = Object.keys(state.lanes.value);
  const of = lanes.includes(chosen.of) ? chosen.of : lanes[0] ?? "study";
  const pins = state.pins.value;
  const run = async (/** @type {string} */ kind) => {
    setRunning(kind);
    const { place, name } = state.place.value;
    const file = place === "folder" || place === "library" ? name : "machine.toml";
    const units = chosen.units ? listed(state.units.value) : [];
    const variants = chosen.variants ? pins.map((pin) => ({ name: pin.name, text: pin.text })) : [];
    const blob = await make({ kind, of, sections: chosen.sections, company: chosen.company, units, variants, seconds: chosen.seconds, angle: angle(), command: `linkwright ${of === "torsion" ? "torsion" : "run"} ${file}` });
    setRunning("");
    if (blob) download(blob, `${state.machine.value || "machine"}.${kind}`);
  };
  const buttons = (/** @type {[string, string][]} */ kinds, /** @type {boolean} */ on = true) => html`<p class="sets">${kinds.map(([kind, word]) => html`<button key=${kind} class="main" data-make=${kind} disabled=${!on || running !== ""} onClick=${() => run(kind)}>${word}</button>`)}</p>`;
  return html`
    <h3>Report</h3>
    ${lanes.length > 1 ? html`<label class="line">Of <${Choice} value=${of} choose=${(one) => set({ of: one })} options=${[["study", "the whole machine"], ["torsion", "its torsional vibration"]]} /></label>` : null}
    <fieldset class="layers"><legend class="hidden">Sections</legend>${SECTIONS.map(([key, word]) => html`<label key=${key}><input type="checkbox" checked=${chosen.sections.includes(key)} onChange=${({ target }) => set({ sections: SECTIONS.map(([each]) => each).filter((each) => (each === key ? target.checked : chosen.sections.includes(each))) })} />${word}</label>`)}</fieldset>
    <label class="line">Company file for the letterhead <input value=${chosen.company} placeholder="company.toml" onChange=${({ target }) => set({ company: target.value.trim() })} /></label>
    <label class="check line"><input type="checkbox" checked=${chosen.units} onChange=${({ target }) => set({ units: target.checked })} />In the units of this page, not those of the file</label>
    ${pins.length ? html`<label class="check line"><input type="checkbox" checked=${chosen.variants} onChange=${({ target }) => set({ variants: target.checked })} />With the pinned variants beside it</label>` : null}
    ${buttons([["html", "HTML page"], ["pdf", "PDF"]], lanes.length > 0)}
    <h3>Motion</h3>
    <label class="line">Seconds <input type="number" min="0.5" max="60" step="0.5" value=${chosen.seconds} onChange=${({ target }) => set({ seconds: Math.min(Math.max(read(target.value) || 4, 0.5), 60) })} /></label>
    ${buttons([["gif", "GIF"], ["mp4", "MP4"]], state.isDrawn.value)}
    <h3>Pose at this crank angle</h3>
    ${buttons([["dxf", "DXF"], ["svg", "SVG"], ["png", "PNG"]], state.isDrawn.value)}
    <p class="about" role="status">${running ? html`Being made: ${running.toUpperCase()} … <button onClick=${stopMaking}>Stop</button>` : "Files are made of the machine as it is now, saved or not."}</p>`;
}
