// The studio's drawing in a notebook: the machine in motion, its crank angle as a trait. The modules that it draws with stand above it.

/** @typedef {{ get: (name: string) => any, set: (name: string, value: any) => void, save_changes: () => void, on: (name: string, hear: () => void) => void, off: (name: string, hear: () => void) => void }} Model */

import { paintArrows } from "../static/arrows.js";
import { paintCentres } from "../static/centres.js";
import { blank, fit } from "../static/frame.js";
import { paintMoving, paintStill } from "../static/painter.js";
import { between, onward, placeOf, watchable } from "../static/timeline.js";
import { unpack } from "../static/wire.js";

/** Traits that change what is drawn. */
const DRAWN = ["scene", "angle", "layers", "height"];

/** Whether a notebook is dark: by its own word, or by that of the system. */
const isDark = () => (document.body.dataset.jpThemeLight ? document.body.dataset.jpThemeLight === "false" : matchMedia("(prefers-color-scheme: dark)").matches);

/** @param {{ model: Model, el: HTMLElement }} given */
function render({ model, el }) {
  const words = model.get("words");
  const canvas = Object.assign(document.createElement("canvas"), { ariaLabel: words.drawing });
  canvas.setAttribute("role", "img");
  const bar = document.createElement("div");
  bar.style.cssText = "display: flex; gap: 8px; align-items: center; font: 13px system-ui, sans-serif";
  const button = document.createElement("button");
  const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, step: "any", ariaLabel: words.angle });
  slider.style.flex = "1";
  const said = document.createElement("output");
  bar.append(button, slider, said);
  el.append(canvas, bar);

  /** @type {Scene} */
  let scene;
  let [time, way, before, handle] = [0, 1, 0, 0];
  function hearScene() {
    const view = /** @type {DataView} */ (model.get("scene"));
    scene = unpack(new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer).body;
    slider.max = String(scene.times.length - 1);
    hearAngle();
  }
  function hearAngle() {
    const angle = model.get("angle");
    // The trait may be what the drawing itself has said, to fewer digits.
    if (Math.abs(angle - between(scene.angles, placeOf(scene.times, time))) > 1e-9) time = between(scene.times, placeOf(scene.angles, angle));
    draw();
  }
  function draw() {
    const looks = model.get("looks")[isDark() ? "dark" : "light"];
    const series = ["blue", "red", "green", "purple", "orange", "sky"].map((name) => looks[name]);
    const [width, height] = [el.clientWidth || 640, model.get("height")];
    canvas.style.cssText = `width: ${width}px; height: ${height}px; background: ${looks.panel}`;
    const ctx = blank(canvas, width, height);
    const k = placeOf(scene.times, time);
    const layers = Object.fromEntries(model.get("layers").map((/** @type {string} */ name) => [name, true]));
    const view = { ctx, scene, frame: fit(scene.box, width, height), k, ink: looks, series };
    paintStill(view);
    paintMoving(view);
    if (layers.centres) paintCentres(view);
    paintArrows(view, layers);
    slider.value = String(k);
    said.textContent = `φ ${((between(scene.angles, k) * 180) / Math.PI).toFixed(1).replace("-", "−").replace(".", words.decimal)}°`;
  }
  /** What the drawing shows is what Python reads. */
  function tell() {
    model.set("angle", between(scene.angles, placeOf(scene.times, time)));
    model.save_changes();
  }
  function hearPlaying() {
    const playing = model.get("playing");
    button.textContent = playing ? "❚❚" : "▶";
    button.ariaLabel = playing ? words.pause : words.play;
    cancelAnimationFrame(handle);
    before = 0;
    if (playing) handle = requestAnimationFrame(step);
  }
  /** @param {number} now */
  function step(now) {
    const period = scene.times[scene.times.length - 1];
    if (before) [time, way] = onward(time, way, ((now - before) / 1000) * (period / watchable(period)), period, scene.swings);
    before = now;
    draw();
    handle = requestAnimationFrame(step);
  }
  button.onclick = () => {
    const playing = !model.get("playing");
    model.set("playing", playing);
    model.save_changes();
    if (!playing) tell();
  };
  slider.oninput = () => {
    time = between(scene.times, Math.min(Number(slider.value), scene.times.length - 1 - 1e-9));
    draw();
    tell();
  };
  const heard = DRAWN.map((name) => /** @type {const} */ ([`change:${name}`, name === "scene" ? hearScene : name === "angle" ? hearAngle : draw])).concat([["change:playing", hearPlaying]]);
  for (const [name, hear] of heard) model.on(name, hear);
  const observer = new ResizeObserver(() => draw());
  hearScene();
  hearPlaying();
  observer.observe(el);
  return () => {
    cancelAnimationFrame(handle);
    observer.disconnect();
    for (const [name, hear] of heard) model.off(name, hear);
  };
}

export default { render };
