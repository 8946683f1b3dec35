// Scalars of all results, the few that one looks for first at the head.
import { html } from "./html.js";
import { useState } from "./vendor/hooks.mjs";
import { said } from "./language.js";
import * as state from "./state.js";
import { number, shownUnit } from "./units.js";

/** Scalars of the head: by name of the result and of the quantity. */
const HEAD = [
  "axis.motor.torque_rms", "axis.motor.torque_peak", "dc_bus.power_max", "cylinder.force_max", "cylinder.pressure_max", "cylinder.flow_max",
  "topper.length_exact", "topper.uncut_share", "topper.uncut_share_mean", "topper.worst_phase", "topper.cutting_speed_min", "topper.frequency",
  "rotator.string_turn_days", "pumping_unit.stroke", "pumping_unit.torque_factor_max", "cam.stroke", "cam.pressure_angle_max", "cam.curvature_radius_convex_min", "cam_force.force_max",
  "turning_moment.unevenness", "turning_moment.energy_fluctuation", "turning_moment.flywheel_inertia", "turning_moment.torque_mean",
  "steady_state.unevenness", "steady_state.speed_mean_time", "steady_state.torque_motor_rms", "steady_state.power_motor_mean", "run_up.time",
  "forces.shaking_force_max", "forces.torque_drive_max",
];
const HEAD_MOST = 6;

/** Natural frequencies of a train at the head, and scalars that one does not look for first. */
const MODES_MOST = 3;
const NO_RESULT = /^(scheme|along|transient)\.|^linkage\.period_turns$|error/;

/** Of axes and cylinders each has its own: key of the quantity without the name of the part. @param {string} key */
const bare = (key) => key.replace(/^(axis|cylinder)\..*?((motor\.)?[^.]+)$/, "$1.$2");
/** Name of the part; empty of the only one. @param {string} of */
const partOf = (of) => /^(?:axis|cylinder)\.(?!motor$)(.+?)(?:\.motor)?$/.exec(of)?.[1] ?? "";

/** Index marks of a symbol, as M_d,max or φ(ω_min). @param {{ symbol: string }} props */
export function Sign({ symbol }) {
  const [head, index, rest] = (/^([^_]*)_?([^)]*)(.*)$/.exec(symbol) ?? []).slice(1);
  return html`<span class="symbol" translate="no">${head}${index ? html`<sub>${index}</sub>` : null}${rest}</span>`;
}

/** @param {string} name */
const titled = (name) => {
  const words = name.replaceAll("_", " ");
  return words[0].toUpperCase() + words.slice(1);
};

export function Head() {
  const lead = state.headline.value;
  const known = new Map(state.scalars.value.map((each) => [each.key, each]));
  const found = HEAD.flatMap((name) => [...known.values()].filter(({ key }) => bare(key) === name));
  const fill = [...known.entries()].flatMap(([name, each]) => (found.includes(each) || NO_RESULT.test(name) ? [] : [each]));
  const train = state.views.value.find(({ kind }) => kind === "train");
  const modes = Array.from(train && !state.isDrawn.value && !lead.length ? train.frequencies.subarray(0, MODES_MOST) : [], (/** @type {number} */ f, n) => ({ name: `mode_${n + 1}`, word: `natural frequency, mode ${n + 1}`, symbol: "f", unit: "Hz", value: f, of: "", key: "" }));
  const shown = [...modes, ...found, ...fill].slice(0, found.length >= 3 ? Math.min(found.length, HEAD_MOST) : HEAD_MOST);
  if (!shown.length && !lead.length) return null;
  return html`<dl class="head" aria-label="Main results">${lead.map(([word, value, unit]) => html`<div key=${word}><dt>${word}</dt><dd><b>${value}</b> <small translate="no">${unit}</small></dd></div>`)}${shown.map((each) => {
    const { unit, factor } = shownUnit(each.unit, state.units.value);
    return html`<div key=${each.key || each.name} data-name=${each.name}><dt>${partOf(each.of) ? html`<span translate="no">${partOf(each.of)}</span>: ` : null}${/^(time|revolutions)$/.test(each.name) ? `${said(titled(each.of))}: ${each.word}` : each.word}</dt><dd><b data-value=${each.value}>${number(each.value / factor, 4)}</b> <small>${unit || "–"}</small></dd></div>`;
  })}</dl>`;
}

export function Numbers() {
  const [wanted, setWanted] = useState("");
  const seek = wanted.toLowerCase();
  const groups = state.results.value
    .map(({ name, scalars }) => ({ name, scalars: scalars.filter(({ word, symbol, name: own }) => `${word} ${symbol} ${own}`.toLowerCase().includes(seek)) }))
    .filter(({ scalars }) => scalars.length);
  const tables = state.tables.value.map((each) => ({ ...each, rows: each.rows.filter((row) => `${each.title} ${row}`.toLowerCase().includes(seek)) })).filter(({ rows }) => rows.length);
  return html`
    <input type="search" class="seek" placeholder="Find a quantity" aria-label="Find a quantity" value=${wanted} onInput=${({ target }) => setWanted(target.value)} />
    ${groups.map(({ name, scalars }) => html`
      <table key=${name}><caption>${titled(name.replace(".", ", "))}</caption><tbody>
        ${scalars.map((each) => {
          const { unit, factor } = shownUnit(each.unit, state.units.value);
          return html`<tr key=${each.name}><th scope="row">${each.word}</th><td><${Sign} symbol=${each.symbol} /></td><td class="value" data-scalar="${name}.${each.name}" data-value=${each.value}>${number(each.value / factor)}</td><td>${unit}</td></tr>`;
        })}
      </tbody></table>`)}
    ${tables.map(({ name, title, heads, rows }) => html`
      <div key=${name} class="scrolled" tabindex="0" role="region" aria-label=${title}><table><caption>${title}</caption>
        <thead><tr>${heads.map((head) => html`<th scope="col" translate="no">${head}</th>`)}</tr></thead>
        <tbody>${rows.map((row) => html`<tr>${row.map((cell) => html`<td translate="no">${cell}</td>`)}</tr>`)}</tbody></table></div>`)}
    ${groups.length || tables.length ? null : html`<p class="nothing">${state.runs.value ? "Being computed …" : "No such quantity among the results."}</p>`}`;
}
