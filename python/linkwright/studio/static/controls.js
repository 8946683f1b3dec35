// Controls of all entries of the file, as the descriptions declare them.
import { Choice } from "./choice.js";
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { useComputed } from "./vendor/signals.mjs";
import { hold, letBack, settle } from "./actions.js";
import { Icon } from "./icons.js";
import { Build, Remove, isElement } from "./build.js";
import { said } from "./language.js";
import { effect, entryAt, keysOf } from "./slopes.js";
import * as state from "./state.js";
import { number, read, shownUnit, typed } from "./units.js";

/** Word of an entry: a sucker rod is no connecting rod, in other languages another word. @param {{ address: string, key: string }} entry */
const wordOf = ({ address, key }) => (/^rod_string\..*\.rod$/.test(address) ? "nominal size" : key.replaceAll("_", " "));

/** Whether an entry stands on a line of its own. @param {Entry} entry */
const isLong = ({ holds, written }) => (holds === "text" ? String(written).length > 16 : holds === "choice" && said(written.replaceAll("_", " ")).length > 13);

/** Largest share of a value that a slider reaches beyond it. */
const REACH = 2;

/** Ends of a slider [SI]. @param {Entry} entry @returns {[number, number]} */
export function endsOf({ address, si, unit, bounds = {} }) {
  const own = state.ends.value[address];
  if (own) return own;
  const value = si ?? 0;
  const least = bounds.exclusiveMinimum ?? bounds.minimum ?? -Infinity;
  const most = bounds.exclusiveMaximum ?? bounds.maximum ?? Infinity;
  if (unit === "rad" && Math.abs(value) <= Math.PI) return [Math.max(least, -Math.PI), Math.min(most, Math.PI)];
  const size = Math.abs(value) || 1;
  return [Math.max(least, value < 0 || least < 0 ? -REACH * size : 0, least === 0 ? 0 : -Infinity), Math.min(most, REACH * size)];
}

/** Entries that were chosen to follow, with their limits: the ends of their sliders. @returns {Record<string, [number, number]>} */
export function follows() {
  const chosen = Object.entries(state.free.value).flatMap(([address, is]) => (is ? [entryAt(address)] : []));
  return Object.fromEntries(chosen.flatMap((entry) => (entry ? [[entry.address, endsOf(entry)]] : [])));
}

/** @param {{ entry: Entry }} props */
function Quantity({ entry }) {
  const { address, unit = "" } = entry;
  const key = said(wordOf(entry));
  const { unit: word, factor } = shownUnit(unit, state.units.value);
  const pulled = useComputed(() => state.live.value[address]).value;
  const si = typeof pulled === "number" ? pulled : entry.si;
  const [draft, setDraft] = useState(/** @type {string | null} */ (null));
  const [low, high] = endsOf(entry);
  const shown = si === null || si === undefined ? String(entry.written) : number(si / factor, 7);
  const id = `at ${address}`;

  /** @param {any} target */
  function commit(target) {
    setDraft(null);
    if (target.value === shown) return;
    const value = typed(target.value, factor);
    if (value !== null) settle({ [address]: value });
  }
  /** @param {0 | 1} which */
  const end = (which) => (/** @type {any} */ { target }) => {
    const value = read(target.value) * factor;
    const next = /** @type {[number, number]} */ ([low, high]);
    next[which] = value;
    if (Number.isFinite(value) && next[0] < next[1]) state.ends.value = { ...state.ends.value, [address]: next };
  };
  const places = /** @param {number} value */ (value) => number(value / factor, 4);
  return html`
    <div class="field">
      <input id=${id} class="number" inputmode="decimal" autocomplete="off" spellcheck=${false} value=${draft ?? shown} aria-label="${key}, ${word || said("number")}" data-address=${address}
        onInput=${({ target }) => setDraft(target.value)}
        onChange=${({ target }) => commit(target)}
        onKeyDown=${({ key: pressed, target }) => {
          if (pressed === "Escape") setDraft(null);
          if (pressed === "Enter") commit(target);
        }} />
      <span class="unit">${word}${entry.tolerance ? ` ${entry.tolerance}` : ""}</span>
    </div>
    ${typeof si === "number" ? html`
      <div class="slide">
        <input class="end" value=${places(low)} aria-label="${key}, lower end of the slider" onChange=${end(0)} />
        <input type="range" step="any" min=${low} max=${high} value=${si} aria-label="${key}, slider" data-slider=${address}
          aria-valuetext="${number(si / factor)} ${word}"
          onInput=${({ target }) => hold({ [address]: coarse(target, factor) })}
          onChange=${({ target }) => settle({ [address]: coarse(target, factor) })}
          onKeyDown=${(event) => {
            if (event.key === "Escape") letBack();
            arrow(event, low, high, address, si);
          }} />
        <input class="end" value=${places(high)} aria-label="${key}, upper end of the slider" onChange=${end(1)} />
      </div>` : null}`;
}

/** The value of a slider with as many digits as a pixel of it is worth, within its ends. @param {any} target @param {number} factor */
function coarse({ value, min, max, clientWidth }, factor) {
  const [low, high] = [Number(min), Number(max)];
  const step = 10 ** Math.floor(Math.log10((high - low) / factor / Math.max(clientWidth, 1)));
  const near = Number((Math.round(Number(value) / factor / step) * step).toPrecision(12)) * factor;
  return near > low && near < high ? near : Number(value);
}

/** Which way an arrow key goes; 0 of another key. @param {{ key: string }} event */
export const wayOf = ({ key }) => /** @type {Record<string, number>} */ ({ ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 })[key] ?? 0;

/**
 * Arrow keys of a slider move it by a hundredth of its range, with Shift by a tenth.
 * @param {any} event @param {number} low @param {number} high @param {string} address @param {number} si
 */
function arrow(event, low, high, address, si) {
  const way = wayOf(event);
  if (!way) return;
  event.preventDefault();
  const value = Math.min(Math.max(si + (way * (high - low)) / (event.shiftKey ? 10 : 100), low), high);
  settle({ [address]: value });
}

/** @param {{ entry: Entry }} props */
function Other({ entry }) {
  const { address, holds, written, choices = [], key } = entry;
  const id = `at ${address}`;
  if (holds === "choice") {
    return html`<${Choice} id=${id} aria-label=${key} value=${written} options=${choices.map((each) => [each, each.replaceAll("_", " ")])} choose=${(value) => settle({ [address]: value })} />`;
  }
  if (holds === "switch") {
    return html`<input id=${id} type="checkbox" aria-label=${key} checked=${written} onChange=${({ target }) => settle({ [address]: target.checked })} />`;
  }
  if (holds === "text" && String(written).length > 60) {
    return html`<textarea id=${id} aria-label=${key} rows="3" value=${written} onChange=${({ target }) => settle({ [address]: target.value })}></textarea>`;
  }
  if (holds === "text" || holds === "count") {
    const counted = (/** @type {string} */ value) => (holds === "count" && Number.isInteger(Number(value)) ? Number(value) : value);
    return html`<input id=${id} aria-label=${key} value=${written} onChange=${({ target }) => settle({ [address]: counted(target.value) })} />`;
  }
  return html`<code class="data" title="Edit lists in the text of the file">${shortened(typeof written === "string" ? written : JSON.stringify(written))}</code>`;
}

/** @param {string} words */
const shortened = (words) => (words.length > 48 ? `${words.slice(0, 47)}…` : words);

/** @param {{ address: string }} props */
function Problems({ address }) {
  const own = state.problems.value.filter(({ key }) => key === address);
  return own.map(({ found, expected, remedy }) => html`<p class="problem" role="alert">${found && `found ${found}, `}expected ${expected}${remedy && `; ${remedy}`}</p>`);
}

/** @param {{ entry: Entry, draggable: Set<string> }} props */
function Row({ entry, draggable }) {
  const { address, key, about } = entry;
  const locked = useComputed(() => state.locks.value[address] ?? false).value;
  const isPulled = useComputed(() => address in state.live.value).value;
  return html`
    <div class="row ${isPulled ? "pulled" : ""} ${isLong(entry) ? "long" : ""}">
      <label for="at ${address}" title=${about}>${wordOf(entry)}</label>
      <span class="signs">${entry.holds === "quantity" ? html`<${Slope} entry=${entry} />` : null}${draggable.has(address) ? html`<button class="lock" aria-pressed=${locked} aria-label="Lock ${key} of ${keysOf(address).at(-2)}" title=${locked ? "Locked: dragging joints does not change it" : "Follows dragged joints; lock it"}
        onClick=${() => (state.locks.value = { ...state.locks.value, [address]: !locked })}><${Icon} name=${locked ? "locked" : "open"} /></button>` : null}</span>
      ${entry.holds === "quantity" ? html`<${Quantity} entry=${entry} />` : html`<div class="field"><${Other} entry=${entry} /></div>`}
      <${Problems} address=${address} />
    </div>`;
}

/** What the entry does to the result that is looked at. @param {{ entry: Entry }} props */
function Slope({ entry }) {
  const slopes = state.slopes.value;
  const slope = slopes?.slopes[entry.address];
  if (!slopes || slope === undefined) return null;
  const { share, words } = effect(slopes, slope, entry, state.units.value);
  if (!share) return null;
  return html`<span class="slope ${share < 0 ? "falls" : "rises"}" title=${words} data-slope=${entry.address}><i aria-hidden="true">${share < 0 ? "▼" : "▲"}</i><span aria-hidden="true">${number(100 * Math.abs(share), 2)} %</span><span class="hidden">${words}</span></span>`;
}

/** @param {{ group: Group }} props */
function More({ group }) {
  const [open, setOpen] = useState(false);
  const plain = group.missing.filter(({ expected }) => expected !== "a table" && !expected.startsWith("a list"));
  if (!plain.length) return null;
  return html`
    <div class="more">
      <button class="quiet" aria-expanded=${open} onClick=${() => setOpen(!open)}>${open ? "Fewer entries" : `Add an entry (${plain.length})`}</button>
      ${open ? plain.map((each) => html`
        <button class="add" key=${each.key} title=${each.about} onClick=${() => settle({ [each.address]: first(each) })}>
          <b>${wordOf(each)}</b> ${each.about} <i>${each.usual === null || each.usual === "" ? "" : `Now ${each.usual} ${each.unit ?? ""}.`}</i>
        </button>`) : null}
    </div>`;
}

/** What an entry begins with. @param {Missing} missing */
const first = ({ usual, choices = [], unit }) => usual ?? choices[0] ?? (unit === undefined ? "" : `0 ${unit}`.trim());

/** Depth of the groups that are open at first: all of a small machine. */
const SMALL = 40;

/** @param {Group} group @returns {number} */
const count = ({ entries, groups }) => entries.length + groups.reduce((sum, each) => sum + count(each), 0);

/** @param {{ group: Group, draggable: Set<string>, deep: number }} props */
function Part({ group, draggable, deep }) {
  const open = group.address.startsWith("mechanism") || count(state.controls.value ?? group) < SMALL ? 4 : 2;
  const wrong = state.problems.value.some(({ key }) => key === group.address || key.startsWith(`${group.address}.`));
  return html`
    <details class="part deep${deep}" open=${deep < open || wrong}>
      <summary title=${group.about}>${isElement(group.address) ? html`<span translate="no">${group.key}</span>` : group.key.replaceAll("_", " ")}${wrong ? html` <span class="badge">!</span>` : null}</summary>${isElement(group.address) ? html`<${Remove} address=${group.address} word=${group.key} />` : null}
      <${Problems} address=${group.address} />
      <${Inside} group=${group} draggable=${draggable} deep=${deep} />
    </details>`;
}

/** @param {{ group: Group, draggable: Set<string>, deep: number }} props */
function Inside({ group, draggable, deep }) {
  return html`
    ${group.entries.map((entry) => html`<${Row} key=${entry.address} entry=${entry} draggable=${draggable} />`)}
    ${group.groups.map((each) => html`<${Part} key=${each.address} group=${each} draggable=${draggable} deep=${deep + 1} />`)}
    <${More} group=${group} />`;
}

/** Entries that say what the file is come last: one opens a machine for its dimensions. */
const LAST = new Set(["format", "name", "description", "source"]);

export function Controls() {
  const whole = state.controls.value;
  if (!whole) return state.problems.value.length ? html`<p class="nothing">The text of the file is not valid TOML; correct it under File.</p>` : null;
  const draggable = new Set(state.draggable.value.split("\n"));
  const [heads, others] = [whole.entries.filter(({ key }) => LAST.has(key)), whole.entries.filter(({ key }) => !LAST.has(key))];
  const rank = ["mechanism", "drive", "bodies", "loads"];
  const place = (/** @type {Group} */ { key }) => (rank.indexOf(key) + 1 || rank.length + 1);
  const body = { ...whole, entries: others, groups: [...whole.groups].sort((a, b) => place(a) - place(b)) };
  return html`
    <${Problems} address="" />
    <${Inside} group=${body} draggable=${draggable} deep=${0} />
    <${Build} />
    <${Part} group=${{ ...whole, key: "about this machine", address: "", about: "", entries: heads, groups: [], missing: [] }} draggable=${draggable} deep=${2} />`;
}
