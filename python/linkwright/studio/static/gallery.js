// All machines that can be opened, moving.
import { html } from "./html.js";
import { useEffect, useRef, useState } from "./vendor/hooks.mjs";
import { list, open, start, thumbnail } from "./actions.js";
import { blank, fit } from "./frame.js";
import { line, stroke } from "./ink.js";
import { paintKnife } from "./knife.js";
import { said } from "./language.js";
import { paintMoving, paintStill } from "./painter.js";
import * as state from "./state.js";
import { colours } from "./theme.js";
import { onward, placeOf, watchable } from "./timeline.js";
import { paintTrain } from "./twist.js";

const PLACES = /** @type {Record<string, string>} */ ({ folder: "Files of this folder", template: "Templates to start from", library: "Machines of the library" });

/** Seconds of one period of a train. */
const PERIOD = 2.4;

/** Room about curves. */
const MARGIN = 14;

/** One request at a time, in the order in which cards are seen. */
let queue = Promise.resolve();
/** @type {Map<string, any>} */
const known = new Map();

/** @param {string} place @param {string} name */
function sceneOf(place, name) {
  const key = `${place}/${name}`;
  if (!known.has(key)) known.set(key, (queue = queue.then(() => thumbnail(place, name))));
  return known.get(key).then((/** @type {any} */ body) => body?.scene ?? body?.view ?? null);
}

/** @param {HTMLCanvasElement} canvas @param {any} scene @returns {() => void} */
function moving(canvas, scene) {
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let [time, way, before, handle, seen] = [0, 1, 0, 0, true];
  const watch = new IntersectionObserver(([entry]) => (seen = entry.isIntersecting));
  watch.observe(canvas);
  /** @param {number} now */
  function step(now) {
    const period = scene.times ? scene.times[scene.times.length - 1] : scene.seconds ?? PERIOD;
    if (before && !still) [time, way] = onward(time, way, ((now - before) / 1000) * (period / watchable(period)), period, scene.swings);
    before = now;
    if (seen) draw();
    if (!still) handle = requestAnimationFrame(step);
  }
  function draw() {
    const ink = colours();
    const { clientWidth: width, clientHeight: height } = canvas;
    const ctx = blank(canvas, width, height);
    if (!scene.times) return beside(ctx, width, height, ink);
    const zoom = 0.45;
    ctx.scale(zoom, zoom);
    const parts = scene.parts.map((/** @type {any} */ part) => ({ ...part, slides: false, name: part.kind === "point" || part.kind === "trace" || part.kind === "ground" ? part.name : "" }));
    const view = { ctx, scene: { ...scene, parts }, frame: fit(scene.box, width / zoom, height / zoom), k: placeOf(scene.times, time), ink, series: ink.series };
    paintStill({ ...view, scene: { ...scene, parts: parts.filter((/** @type {any} */ { kind }) => kind !== "ground") } });
    paintMoving(view);
  }
  /** A train in its lowest mode, or a knife on its way. @param {CanvasRenderingContext2D} ctx @param {number} width @param {number} height @param {any} ink */
  function beside(ctx, width, height, ink) {
    const paper = { ctx, width, height, passed: 0, ink, series: ink.series };
    if (scene.kind === "turning") paintCurves(paper, scene.curves);
    else if (scene.kind === "topper") paintKnife(paper, scene, scene.span[0] + (still ? 0.5 : time / scene.seconds) * (scene.span[1] - scene.span[0]), false);
    else if (scene.frequencies.length) paintTrain(paper, scene, 0, Math.cos((2 * Math.PI * time) / PERIOD), false);
  }
  handle = requestAnimationFrame(step);
  return () => {
    cancelAnimationFrame(handle);
    watch.disconnect();
  };
}

/** Curves over one axis, about zero. @param {Paper} paper @param {{ x: ArrayLike<number>, y: ArrayLike<number> }[]} curves */
function paintCurves({ ctx, width, height, ink, series }, curves) {
  const ends = (/** @type {number[]} */ all) => [Math.min(...all), Math.max(...all) - Math.min(...all) || 1];
  const [left, across] = ends(curves.flatMap(({ x }) => Array.from(x)));
  const [low, high] = ends([0, ...curves.flatMap(({ y }) => Array.from(y))]);
  const place = (/** @type {number} */ x, /** @type {number} */ y) => [MARGIN + ((x - left) / across) * (width - 2 * MARGIN), height - MARGIN - ((y - low) / high) * (height - 2 * MARGIN)];
  line(ctx, [place(left, 0), place(left + across, 0)]);
  stroke(ctx, ink.soft, 1);
  curves.forEach(({ x, y }, n) => {
    line(ctx, Array.from(x, (at, k) => place(at, y[k])));
    stroke(ctx, series[n], 1.5);
  });
}

/** @param {{ listed: Listed }} props */
function Card({ listed: { place, name, title } }) {
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const [state_, setState] = useState("waiting");
  useEffect(() => {
    const element = /** @type {HTMLCanvasElement} */ (canvas.current);
    let end = () => {};
    const watch = new IntersectionObserver(([entry]) => {
      if (!entry.isIntersecting) return;
      watch.disconnect();
      sceneOf(place, name).then((/** @type {any} */ scene) => {
        setState(scene ? "moving" : "none");
        if (scene && element.isConnected) end = moving(element, scene);
      });
    });
    watch.observe(element);
    return () => {
      watch.disconnect();
      end();
    };
  }, [place, name]);
  return html`
    <button class="card ${state_}" onClick=${() => leaves() && open(place, name)} data-open="${place}/${name}">
      <canvas ref=${canvas} aria-hidden="true"></canvas>
      <b translate="no">${title}</b><small translate="no">${name}</small>
    </button>`;
}

/** Whether the machine at hand may be left. */
const leaves = () => !state.unsaved.value || confirm(said("Discard unsaved changes?"));

/** What a machine begins with that is built from nothing. */
const EMPTY = 'format = 1\nname = "New machine"\n\n[mechanism]\n';

export function Gallery() {
  const [wanted, setWanted] = useState("");
  useEffect(() => {
    list();
  }, []);
  const seek = wanted.toLowerCase();
  const found = state.listed.value.filter(({ title, name }) => `${title} ${name}`.toLowerCase().includes(seek));
  return html`
    <input type="search" class="seek" placeholder="Find a machine" aria-label="Find a machine" value=${wanted} onInput=${({ target }) => setWanted(target.value)} />
    <p class="sets"><button id="empty" onClick=${() => leaves() && start({ place: "", name: "" }, EMPTY, "")}>Start with an empty machine</button></p>
    ${Object.entries(PLACES).map(([place, words]) => {
      const here = found.filter((each) => each.place === place);
      return here.length ? html`<h3>${words}</h3><div class="cards">${here.map((each) => html`<${Card} key="${place}/${each.name}" listed=${each} />`)}</div>` : null;
    })}`;
}
