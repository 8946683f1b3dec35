// The plots of all results, diagrams of the slow ones, the data behind each.
import { html } from "./html.js";
import { useMemo, useRef, useState } from "./vendor/hooks.mjs";
import { Chart, rows, short } from "./chart.js";
import { Choice, ofNames } from "./choice.js";
import { csv, download, png, svg } from "./exported.js";
import { Icon } from "./icons.js";
import { Hodograph } from "./hodograph.js";
import { catalogue } from "./language.js";
import { hodographs, pointPlots } from "./points.js";
import { Sign } from "./numbers.js";
import * as state from "./state.js";
import { colours } from "./theme.js";
import { number, shownUnit } from "./units.js";

/** Rows of a data table on the page; the CSV has all. */
const ROWS_MOST = 181;

/** Plots that say the same as another, or nothing that one looks for first. */
const ASIDE = /^hodograph\.joint|^forces\.(time|speed|acceleration|power_residual|crank_angle)$|\.time$|^rod_string\.(crank_angle|rod_position)$|^forces\.shaking_force_|_moment$|^run_(up|down)\.crank_angle$|^(motion|reduction)\.|^(steady_state|forces)\.power|^forced\.(mean_torques|torque_|.*_heat|power|unevenness_|shaft_torque_max)|^stress\.(mean|greatest|continuous|transient)/;

const titled = (/** @type {string} */ words) => words[0].toUpperCase() + words.slice(1);

/** @param {Plot} plot @param {boolean} [isDrawn] as a picture, in which a hodograph has no angle @returns {Sheet} */
function sheet(plot, isDrawn = false) {
  const heads = [plot.x, ...plot.curves].map(({ symbol, word, unit }) => {
    const { unit: shown } = shownUnit(unit, state.units.value);
    return `${short(symbol, word)} [${shown || "-"}]`;
  });
  const from = isDrawn && plot.isHodograph ? 1 : 0;
  return { title: titled(plot.title), heads: heads.slice(from), rows: rows(plot).slice(from), isToScale: from > 0 && !plot.isCard, isPairs: from > 0 && plot.isCard };
}

/** @param {{ plot: Plot }} props */
function Data({ plot }) {
  const { heads, rows: columns } = sheet(plot);
  const count = columns[0].length;
  const step = Math.max(1, Math.ceil(count / ROWS_MOST));
  const shown = Array.from({ length: Math.ceil(count / step) }, (_, n) => n * step);
  return html`
    <div class="data-table" tabindex="0" role="region" aria-label="Data of ${plot.title}">
      <table><thead><tr>${heads.map((head) => html`<th scope="col">${head}</th>`)}</tr></thead>
      <tbody>${shown.map((n) => html`<tr key=${n}>${columns.map((column) => html`<td>${number(column[n], 6)}</td>`)}</tr>`)}</tbody></table>
    </div>`;
}

/** Curves that the legend names: of a card its loads. @param {Plot} plot */
const named = ({ curves, isHodograph, isCard }) => (isCard ? curves.filter((_, n) => n % 2) : isHodograph ? [] : curves);

/** @param {{ plot: Plot }} props */
function Panel({ plot }) {
  const [data, setData] = useState(false);
  const { unit } = shownUnit(plot.unit, state.units.value);
  const now = useRef(plot);
  now.current = plot;
  const file = (/** @type {string} */ kind) => `${state.machine.value} ${now.current.title}.${kind}`;
  const asPng = async () => {
    const canvas = document.querySelector(`[data-plot="${CSS.escape(plot.key)}"] canvas`);
    if (canvas instanceof HTMLCanvasElement) download(await png(canvas, `${titled(plot.title)} [${unit || "–"}]`, named(plot).map(({ symbol, word }) => short(symbol, word)), colours()), file("png"));
  };
  const asSvg = () => download(new Blob([svg(sheet(now.current, true), ["#0072b2", "#d55e00", "#009e73", "#a8478a", "#b97f00", "#56b4e9"])], { type: "image/svg+xml" }), file("svg"));
  const asCsv = () => download(new Blob([csv(sheet(now.current))], { type: "text/csv" }), file("csv"));
  // The head has words alone, which other numbers leave as they are.
  const head = useMemo(() => html`
      <header>
        <h3>${titled(plot.title)} <small>${unit}</small></h3>
        <span class="legend">${plot.curves.length > 1 ? named(plot).map(({ symbol, word, own }, n) => html`<span key=${n} title=${word} translate=${own ? "no" : undefined}><i class="key c${n % 6} ${n < 6 ? "" : "again"}"></i>${symbol ? html`<${Sign} symbol=${symbol} />` : word}</span>`) : null}</span>
        <span class="tools">
          <button class="quiet" aria-pressed=${data} onClick=${() => setData(!data)} title="The numbers as a table">Data</button>
          ${[["CSV", asCsv], ["PNG", asPng], ["SVG", asSvg]].map(([kind, make]) => html`<button key=${kind} class="quiet" onClick=${make} title="Download ${kind}">${kind}</button>`)}
          <button class="quiet" aria-label="Hide the plot of ${plot.title}" title="Hide" onClick=${() => (state.hidden.value = { ...state.hidden.value, [plot.key]: true })}><${Icon} name="close" /></button>
        </span>
      </header>`, [catalogue.value, data, unit, plot.title, plot.curves.map(({ symbol, word }) => symbol + word).join()]);
  return html`
    <section class="panel" aria-label=${plot.title}>${head}
      <${plot.isHodograph ? Hodograph : Chart} plot=${plot} />
      ${data ? html`<${Data} plot=${plot} />` : null}
    </section>`;
}

/** @param {Plot} plot */
const isHidden = ({ key }) => state.hidden.value[key] ?? ASIDE.test(key);

export function Plots() {
  const all = [...pointPlots().map((plot) => ({ plot, of: "points" })), ...state.results.value.flatMap(({ name, plots }) => plots.map((plot) => ({ plot, of: name }))), ...hodographs().map((plot) => ({ plot, of: "hodograph" }))];
  const points = Object.keys(state.scene.value?.velocities ?? {});
  const shown = all.filter(({ plot }) => !isHidden(plot));
  const others = all.filter(({ plot }) => isHidden(plot));
  return html`
    ${points.length ? html`
      <label class="watch">Curves of a point <${Choice} value=${points.includes(state.watched.value) ? state.watched.value : ""} options=${[["", "none"], ...ofNames(points)]} choose=${(name) => (state.watched.value = name)} /></label>` : null}
    <div class="panels">
      ${shown.map(({ plot }) => html`<${Panel} key=${plot.key} plot=${plot} />`)}
      ${shown.length ? null : html`<p class="nothing">${state.runs.value ? "Being computed …" : !state.controls.value && !state.problems.value.length ? "Opening …" : state.figures.value.length ? "No curves to read; Numbers and Diagrams have the results." : "No curves. The chips below the drawing state what is missing."}</p>`}
    </div>
    ${others.length ? html`
      <details class="others"><summary>${others.length} more plots</summary>
        ${others.map(({ plot, of }) => html`<button class="add" key=${plot.key} onClick=${() => (state.hidden.value = { ...state.hidden.value, [plot.key]: false })}><b>${titled(plot.title)}</b> ${of.replaceAll("_", " ")}</button>`)}
      </details>` : null}`;
}

export function Diagrams() {
  return html`<div class="diagrams">${state.figures.value.map((each) => html`<${Diagram} key=${each.name} figure=${each} />`)}
    ${state.figures.value.length ? null : html`<p class="nothing">${state.runs.value ? "Being computed …" : "No diagrams of this machine."}</p>`}</div>`;
}

/** One diagram over the page. */
export function Enlarged() {
  const figure = state.figures.value.find(({ name }) => name === state.enlarged.value);
  return figure ? html`<${Diagram} figure=${figure} />` : null;
}

/** @param {{ figure: Figure }} props */
function Diagram({ figure }) {
  const drawn = useMemo(() => parsed(figure.svg), [figure.svg]);
  const put = (/** @type {HTMLElement | null} */ element) => element?.replaceChildren(drawn);
  return html`
    <figure class="diagram">
      <h3>${figure.title}</h3>
      <div ref=${put} role="img" aria-label=${figure.caption}></div>
      <figcaption>${figure.caption} ${state.dialog.value === "diagram" ? null : html`<button class="quiet" onClick=${() => ((state.enlarged.value = figure.name), (state.dialog.value = "diagram"))}>Enlarge</button>`}<button class="quiet" onClick=${() => download(new Blob([figure.svg], { type: "image/svg+xml" }), `${state.machine.value} ${figure.title}.svg`)}>SVG</button></figcaption>
    </figure>`;
}

/** A drawing of the server as an element: the page allows no styles in its text, so they are set one by one. @param {string} text */
function parsed(text) {
  const root = new DOMParser().parseFromString(text.replace(/<style.*?<\/style>/gs, "").replace(/ style="/g, ' data-style="'), "image/svg+xml").documentElement;
  const drawn = document.importNode(root, true);
  for (const each of /** @type {NodeListOf<SVGElement>} */ (drawn.querySelectorAll("[data-style]"))) {
    each.style.cssText = each.dataset.style ?? "";
    each.removeAttribute("data-style");
  }
  return drawn;
}
