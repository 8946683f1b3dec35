// Design in place: pull a result and let entries follow, compare variants, sweep one or two entries, search for the best.
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { letBack, pin, seek, settle, stopSearch, to, unpin } from "./actions.js";
import { Chart } from "./chart.js";
import { Choice, ofNames } from "./choice.js";
import { endsOf, follows, wayOf } from "./controls.js";
import { Heat } from "./heat.js";
import { said } from "./language.js";
import { Sign } from "./numbers.js";
import { effect, entryAt, named, ranked } from "./slopes.js";
import * as state from "./state.js";
import { number, read, shownUnit } from "./units.js";

/** Entries that are listed first. */
const FIRST = 8;

/** Results to choose from. @returns {Options} */
const choices = () => state.goals.value.map(({ key, word, symbol, of }) => [key, [said(word), symbol && `, ${symbol.replace("_", " ")}`, of && ` (${said(of)})`].join("")]);

/** @param {{ children?: any, title: string }} props */
const Section = ({ title, children }) => html`<section class="design" aria-label=${title}><h3>${title}</h3>${children}</section>`;

function Goal() {
  const found = choices();
  const now = state.goals.value.find(({ key }) => key === state.goal.value);
  return html`
    <${Section} title="Pull a result">
      <label class="line"><span>Result</span> <${Choice} id="goal" value=${now ? state.goal.value : ""} choose=${(key) => (state.goal.value = key)}
        options=${[["", "none"], ...found]} /></label>
      ${found.length ? null : html`<p class="about">A result can be set once something moves.</p>`}
      ${now && known(now) !== null ? html`<${Pull} now=${{ ...now, value: known(now) }} />` : null}
    <//>`;
}

/** Value of a goal: while it is pulled the last one that was reached; else that of its derivatives, which some need to be known by. @param {{ key: string, value: number | null }} goal */
const known = ({ key, value }) => state.reached.value ?? value ?? (state.slopes.value?.response === key ? state.slopes.value.value : null);

/** @param {{ now: { symbol: string, unit: string, value: number } }} props */
function Pull({ now }) {
  const { unit, factor } = shownUnit(now.unit, state.units.value);
  // While it is pulled the ends stay where they were.
  const [held, setHeld] = useState(/** @type {number | null} */ (null));
  const from = held ?? now.value;
  const free = follows();
  const [low, high] = from >= 0 ? [0, 2 * from || 1] : [2 * from, 0];
  const done = () => {
    setHeld(null);
    state.reason.value = "";
  };
  return html`
    <div class="line"><span>${now.symbol ? html`<${Sign} symbol=${now.symbol} />` : "Value"}</span>
      <input class="number" aria-label="Wanted value" inputmode="decimal" value=${number(now.value / factor, 6)}
        onChange=${({ target }) => {
          const value = read(target.value);
          if (Number.isFinite(value)) to(value * factor, free, false);
          else target.value = number(now.value / factor, 6);
        }} /> <small>${unit}</small></div>
    <input type="range" id="pull" step="any" min=${low} max=${high} value=${now.value} aria-label="Pull the result" aria-valuetext="${number(now.value / factor, 4)} ${unit}"
      onInput=${({ target }) => {
        if (held === null) setHeld(now.value);
        to(Number(target.value), free, true);
      }}
      onChange=${({ target }) => {
        done();
        to(Number(target.value), free, false);
      }}
      onKeyDown=${(event) => {
        const way = wayOf(event);
        if (event.key === "Escape") {
          done();
          letBack();
        }
        if (!way) return;
        event.preventDefault();
        to(now.value * (1 + (way * (event.shiftKey ? 10 : 1)) / 100), free, false);
      }} />
    ${state.reason.value ? html`<p class="problem" role="status">${state.reason.value}</p>` : null}
    <${Following} />`;
}

/** An entry that may follow. @param {{ address: string, words?: string }} props */
const Tick = ({ address, words }) => html`<label class="check"><input type="checkbox" data-free=${address} checked=${state.free.value[address] ?? false}
  onChange=${({ target }) => (state.free.value = { ...state.free.value, [address]: target.checked })} /><span>${named(address)}</span> <small>${words}</small></label>`;

function Following() {
  const [all, setAll] = useState(false);
  const slopes = state.slopes.value;
  if (!slopes) return html`<p class="about">Derivatives are being computed …</p>`;
  const listed = ranked(slopes).filter(({ address }, n) => all || n < FIRST || state.free.value[address]);
  return html`
    <h4>Entries that follow</h4>
    ${slopes.tie ? html`<p class="about">${slopes.tie}</p>` : null}
    <div class="following">${listed.map(({ address, entry, slope }) => {
      const { words } = effect(slopes, slope, entry, state.units.value);
      return html`<${Tick} key=${address} address=${address} words=${words} />`;
    })}</div>
    <p class="about">They stay within the ranges of their sliders. <button class="quiet" onClick=${() => setAll(!all)}>${all ? "Show fewer" : "Show all"}</button></p>`;
}

/** A point of a curve that is pulled in the drawing. */
function PointGoal() {
  const points = Object.keys(state.scene.value?.velocities ?? {});
  const lengths = entries().filter(({ address }) => address.startsWith("mechanism."));
  if (!points.length) return null;
  return html`
    <${Section} title="Pull a point of a curve">
      <label class="line"><span>Point</span> <${Choice} id="pulled" value=${state.pulled.value} options=${[["", "none"], ...ofNames(points)]} choose=${(name) => {
        state.pulled.value = name;
        state.trails.value = [...new Set([...state.trails.value, name])].filter(Boolean);
      }} /></label>
      ${state.pulled.value ? html`
        <p class="about">Drag it in the drawing: the ticked entries follow, within the ranges of their sliders.</p>
        <div class="following of-point">${lengths.map(({ address }) => html`<${Tick} key=${address} address=${address} />`)}</div>` : null}
    <//>`;
}

function Variants() {
  const pins = state.pins.value;
  const shown = state.scalars.value.filter(({ key }) => HEADS.includes(key));
  return html`
    <${Section} title="Compare variants">
      <button id="pin" disabled=${!state.results.value.length} onClick=${() => pin()}>Pin this machine</button>
      ${pins.length ? html`
        <div class="data-table" tabindex="0" role="region" aria-label="Measures of the variants"><table id="variants"><thead><tr><th scope="col">Measure</th><th scope="col">Now</th>${pins.map(({ name }, n) => html`<th scope="col" key=${n}>${name}</th>`)}</tr></thead>
        <tbody>${shown.map(({ key, word, unit: si, value }) => {
          const { unit, factor } = shownUnit(si, state.units.value);
          return html`<tr key=${key}><th scope="row">${word}${unit ? `, ${unit}` : ""}</th><td>${number(value / factor, 4)}</td>
            ${pins.map(({ scalars: old }, n) => html`<td key=${n}>${key in old ? html`${number(old[key] / factor, 4)} <small>${against(value, old[key])}</small>` : "–"}</td>`)}</tr>`;
        })}</tbody></table></div>
        <div class="sets">${pins.map(({ name, text }, n) => html`<span key=${n} class="chip">${name} <button onClick=${() => settle({}, text)}>Back to it</button><button aria-label="Unpin ${name}" onClick=${() => unpin(n)}>×</button></span>`)}</div>
        <p class="about">Their curves are dashed in the plots.</p>` : html`<p class="about">A pinned machine stays for comparison: its curves in the plots, its measures here.</p>`}
    <//>`;
}

/** Measures of variants. */
const HEADS = ["unevenness", "dynamism", "speed_mean_time", "speed_min", "speed_max", "torque_motor_rms", "torque_motor_max", "power_motor_mean", "efficiency"].map((name) => `steady_state.${name}`).concat("forces.shaking_force_max", "forces.torque_drive_max");

/** @param {number} now @param {number} old */
const against = (now, old) => (old ? `(${now >= old ? "+" : "−"}${number(Math.abs(now / old - 1) * 100, 2)} %)` : "");

/** What other results keep to while one is pulled, swept or sought. */
function Bounded() {
  const bounds = state.bounds.value;
  const put = (/** @type {string} */ key, /** @type {0 | 1} */ which, /** @type {number} */ factor) => (/** @type {any} */ { target }) => {
    const pair = /** @type {[number | null, number | null]} */ ([...bounds[key]]);
    const value = read(target.value) * factor;
    pair[which] = target.value.trim() && Number.isFinite(value) ? value : null;
    state.bounds.value = { ...bounds, [key]: pair };
  };
  const left = choices().filter(([key]) => !(key in bounds));
  return html`
    <${Section} title="Limits of results">
      ${Object.entries(bounds).map(([key, ends]) => {
        const goal = state.goals.value.find((each) => each.key === key);
        const { unit, factor } = shownUnit(goal?.unit ?? "", state.units.value);
        const field = (/** @type {0 | 1} */ which, /** @type {string} */ word) => html`<label>${word} <input class="number" inputmode="decimal" aria-label="${word}, ${goal?.word ?? key}" value=${ends[which] === null ? "" : number(ends[which] / factor, 6)} onChange=${put(key, which, factor)} /></label>`;
        return html`<div class="bound" key=${key}><span>${goal?.word ?? key}</span> ${field(0, "at least")} ${field(1, "at most")} <small>${unit}</small>
          <button class="quiet" aria-label="Remove the limit of ${goal?.word ?? key}" onClick=${() => (state.bounds.value = Object.fromEntries(Object.entries(bounds).filter(([each]) => each !== key)))}>remove</button></div>`;
      })}
      <label class="line"><span>Limit</span> <${Choice} id="bound" value="" options=${[["", "choose a result"], ...left]} choose=${(key) => key && (state.bounds.value = { ...bounds, [key]: [null, null] })} /></label>
      <p class="about">A result that is pulled stops at them, a sweep leaves gaps beyond them, a search keeps them.</p>
    <//>`;
}

function Search() {
  const [kind, setKind] = useState("sweep");
  const [direction, setDirection] = useState("minimise");
  const [wanted, setAsked] = useState("steady_state.unevenness");
  const [picked, setPicked] = useState(["", ""]);
  const [steps, setSteps] = useState(41);
  const all = state.goals.value;
  const asked = all.some(({ key }) => key === wanted) ? wanted : all[0]?.key ?? "";
  const numbers = entries();
  const free = Object.keys(follows());
  const chosen = kind === "sweep" ? picked.filter(Boolean) : free;
  const start = () => {
    const count = chosen.length > 1 ? Math.min(steps, 25) : steps;
    const listed = chosen.flatMap((address) => {
      const entry = entryAt(address);
      if (!entry) return [];
      const [low, high] = endsOf(entry);
      return [{ address, low, high, ...(kind === "sweep" ? { steps: count } : {}) }];
    });
    seek({ kind, response: asked, entries: listed, direction, machines: 2000 });
  };
  return html`
    <${Section} title="Sweep or search">
      <div class="line"><span>What</span> <${Choice} aria-label="What is done" value=${kind} choose=${setKind} options=${[["sweep", "Sweep entries"], ["optimise", "Search for the best"]]} /></div>
      <label class="line"><span>Result</span> <${Choice} id="asked" value=${asked} choose=${setAsked} options=${choices()} /></label>
      ${kind === "sweep" ? [0, 1].map((n) => html`
        <label class="line" key=${n}><span>${n ? "and over" : "over"}</span> <${Choice} id="over-${n}" value=${picked[n]} choose=${(address) => setPicked(picked.map((each, k) => (k === n ? address : each)))}
          options=${[["", n ? "nothing more" : "choose an entry"], ...numbers.map(({ address }) => [address, named(address)])]} /></label>`) : html`
        <div class="line"><span>Goal</span> <${Choice} aria-label="Direction" value=${direction} choose=${setDirection} options=${[["minimise", "Minimum"], ["maximise", "Maximum"]]} /></div>
        <p class="about">${free.length ? `${free.length === 1 ? "The entry" : "The entries"} ${free.map(named).join(", ")} may vary.` : "Choose under Pull a result which entries may vary."}</p>`}
      ${kind === "sweep" ? html`<label class="line"><span>Values</span> <input type="number" min="2" max="401" value=${steps} onChange=${({ target }) => setSteps(Math.min(Math.max(Math.round(Number(target.value)) || 2, 2), 401))} /></label>` : null}
      <p><button id="seek" class="main" disabled=${!chosen.length || !asked} onClick=${start}>Start</button> ${runs(state.search.value) ? html`<button onClick=${stopSearch}>Stop</button>` : null}</p>
      <p class="about">Entries vary within the ranges of their sliders.</p>
      <${Found} />
    <//>`;
}

/** Entries of the file that are numbers. @returns {Entry[]} */
function entries() {
  /** @type {Entry[]} */
  const found = [];
  const walk = (/** @type {Group} */ group) => {
    found.push(...group.entries.filter(({ holds, si }) => holds === "quantity" && typeof si === "number"));
    group.groups.forEach(walk);
  };
  if (state.controls.value) walk(state.controls.value);
  return found;
}

/** Whether a search goes on. @param {any} found */
const runs = (found) => found && !found.ended && !found.last && !(found.kind === "sweep" && found.done === found.rows);

function Found() {
  const found = state.search.value;
  if (!found) return null;
  const result = state.goals.value.find(({ key }) => key === found.response);
  const words = result ? { ...result, name: result.key } : { name: found.response ?? "", word: found.response ?? "", symbol: "", unit: "" };
  const state_ = found.words ?? (found.ended ? `stopped after ${found.done ?? 0} of ${found.rows ?? 0}` : runs(found) ? `${found.done} of ${found.rows} machines` : `${found.done} machines`);
  return html`
    <p class="about" role="status" id="found">${state_}</p>
    ${found.kind === "sweep" ? html`<${Swept} found=${found} words=${words} />` : null}
    ${found.kind === "optimise" && found.course.machines.length ? html`<${Course} found=${found} words=${words} />` : null}
    ${found.warnings?.map((/** @type {string} */ text) => html`<p class="about" key=${text}>${text}</p>`)}`;
}

/** @param {{ found: any, words: Words }} props */
function Swept({ found, words }) {
  const { axes, values } = found;
  const use = (/** @type {1 | -1} */ sign) => {
    let best = -1;
    for (let n = 0; n < values.length; n += 1) if (Number.isFinite(values[n]) && (best < 0 || sign * values[n] < sign * values[best])) best = n;
    if (best < 0) return;
    const inner = axes.length > 1 ? axes[1].values.length : 1;
    const places = axes.length > 1 ? [Math.floor(best / inner), best % inner] : [best];
    settle(Object.fromEntries(places.map((place, n) => [axes[n].address, axes[n].values[place]])));
  };
  const x = (/** @type {any} */ axis) => ({ name: axis.address, word: named(axis.address), symbol: named(axis.address), unit: entryAt(axis.address)?.unit ?? "", values: axis.values });
  const plot = { key: "search", title: words.word, unit: words.unit, x: x(axes[0]), curves: [{ ...words, values }] };
  return html`
    <h4>${words.word}</h4>
    ${axes.length === 1 ? html`<${Chart} plot=${plot} />` : html`<${Heat} values=${values} x=${x(axes[1])} y=${x(axes[0])} words=${words} />`}
    ${found.done === found.rows ? html`<p><button onClick=${() => use(1)}>Use the minimum</button> <button onClick=${() => use(-1)}>Use the maximum</button></p>` : null}`;
}

/** @param {{ found: any, words: Words }} props */
function Course({ found, words }) {
  const { machines, best } = found.course;
  const plot = { key: "course", title: words.word, unit: words.unit, x: { name: "machines", word: "machines", symbol: "machines", unit: "", values: machines }, curves: [{ ...words, values: best }] };
  const { unit, factor } = shownUnit(words.unit, state.units.value);
  return html`
    <h4>Best so far: ${found.value === null ? "none keeps the limits" : `${number(found.value / factor, 5)} ${unit}`}</h4>
    <${Chart} plot=${plot} />
    <ul class="about">${Object.entries(found.entries).map(([address, value]) => {
      const own = shownUnit(entryAt(address)?.unit ?? "", state.units.value);
      return html`<li key=${address}>${named(address)} = ${number(/** @type {number} */ (value) / own.factor, 5)} ${own.unit}</li>`;
    })}</ul>
    ${found.value === null ? null : html`<p><button id="take" onClick=${() => settle(found.entries)}>Apply</button></p>`}`;
}

export const Design = () => html`<${Goal} /><${PointGoal} /><${Bounded} /><${Variants} /><${Search} />`;
