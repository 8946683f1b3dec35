// The stage: the drawing on a canvas, handles over it, and the clock that moves both.
import { html } from "./html.js";
import { useEffect, useRef } from "./vendor/hooks.mjs";
import { effect } from "./vendor/signals-core.mjs";
import "./vendor/signals.mjs";
import { draw as drawLinks, letBack, merge, pull } from "./actions.js";
import { paintArrows } from "./arrows.js";
import { paintCentres } from "./centres.js";
import { follows } from "./controls.js";
import { barLength, blank, fit, pen, toMachine, toScreen, zoomed } from "./frame.js";
import { circle, line, stroke } from "./ink.js";
import { paintMoving, paintStill } from "./painter.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";
import { between, onward, pairAt, placeOf, watchable } from "./timeline.js";
import { decimal, saidOf } from "./language.js";
import { number, shownUnit } from "./units.js";

/** Part of the drawing's size that an arrow key moves a joint by. */
const NUDGE = 0.005;

/** Pixels within which a joint is dropped on another. */
const ONTO = 12;

/** What is drawn anew at every instant. @type {Set<(time: number) => void>} */
export const followers = new Set();

let way = 1;
/** Moves the instant on by seconds of the page. @param {number} passed */
export function advance(passed) {
  const scene = state.scene.value;
  if (!scene || !passed) return;
  const period = scene.times[scene.times.length - 1];
  [state.time.value, way] = onward(state.time.value, way, passed * (period / watchable(period)) * 10 ** state.pace.value, period, scene.swings);
}

/** All that shows the instant beside the picture. */
export function tellInstant() {
  for (const follow of followers) follow(state.time.value);
  const scene = state.scene.value;
  const words = document.getElementById("instant");
  if (!scene || !words) return;
  const k = placeOf(scene.times, state.time.value);
  const { unit, factor } = shownUnit("rad/s", state.units.value);
  const degrees = (between(scene.angles, k) * 180) / Math.PI;
  words.textContent = `φ ${decimal(degrees.toFixed(1).replace("-", "−")).padStart(6, "\u2007")}°  ${scene.true_speed ? `ω ${number(between(scene.speeds, k) / factor, 4)} ${unit}` : ""}`;
}

/** A stress in words. @param {number} value */
function stress(value) {
  const { unit, factor } = shownUnit("Pa", state.units.value);
  return `${number(value / factor, 3)} ${unit}`;
}

/** For the tests. */
export const frames = { count: 0 };

/** Whether nothing was built yet. */
const isEmpty = () => !(state.controls.value?.groups ?? []).some(({ key, groups }) => key !== "mechanism" || groups.length);

/** Metres that an empty drawing shows. */
const EMPTY = [-0.3, -0.25, 0.7, 0.45];

export function Stage() {
  const holder = useRef(/** @type {HTMLDivElement | null} */ (null));
  const canvas = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  useEffect(() => run(/** @type {any} */ (holder.current), /** @type {any} */ (canvas.current)), []);
  const points = state.handled.value ? state.handled.value.split("\n") : [];
  return html`
    <div class="stage ${state.drawing.value ? "draws" : ""}" ref=${holder}>
      <canvas ref=${canvas} role="img" aria-label="Drawing of ${state.machine.value || "the machine"}, to scale"></canvas>
      <div class="handles">
        ${state.layers.value.handles ? points.map((point) => html`
          <button key=${point} class="handle" data-point=${point} title="${point}: drag, or press Enter and click a place, or use the arrow keys"
            aria-label="Joint ${point}" aria-pressed=${state.picked.value === point}></button>`) : null}
      </div>
      ${state.reason.value ? html`<p class="reason" role="status">${state.reason.value}</p>` : null}
      ${state.isDrawn.value || state.drawing.value ? null : html`<p class="nothing">${state.problems.value.length ? "The file has problems, shown at their entries." : state.machine.value ? (isEmpty() ? "The machine is empty. Open Add an element, on the left, and begin with a crank." : "This machine has no moving linkage; its results are in the plots.") : "Opening …"}</p>`}
    </div>`;
}

/** @param {HTMLDivElement} holder @param {HTMLCanvasElement} canvas */
function run(holder, canvas) {
  const ctx = pen(canvas);
  const [still, shade] = [document.createElement("canvas"), document.createElement("canvas")];
  let frame = { scale: 1, x: 0, y: 0 };
  // Known from when it changed: asking for it while the page is written anew would lay the page out twice.
  let [width, height] = [holder.clientWidth, holder.clientHeight];
  let own = "";
  let before = 0;
  let dirty = true;
  let stillFor = /** @type {any} */ (null);
  /** @type {{ point: string, x: number, y: number, moved: boolean, key?: boolean, onto?: string } | null} */
  let gesture = null;

  function sized() {
    [width, height] = [holder.clientWidth, holder.clientHeight];
    // Under the mouse that draws, the plane stays where it is.
    if (!state.drawing.value) frame = fit(state.scene.value?.box ?? EMPTY, width, height);
    stillFor = null;
    dirty = true;
  }
  const observer = new ResizeObserver(sized);
  observer.observe(holder);

  const forget = effect(() => {
    for (const each of [state.scene, state.layers, shownLook, state.picked, state.units, state.trails, state.draft]) void each.value;
    if (state.drawing.value) {
      if (state.scene.peek()) toAssembly(/** @type {Scene} */ (state.scene.peek()));
      own = "";
    } else if (state.scene.value && !gesture) {
      // A drawing stays where it is while a length is pulled; another machine is fitted anew.
      const name = `${state.machine.value} ${Object.keys(state.scene.value.points).length}`;
      if (name !== own) {
        frame = fit(state.scene.value.box, width, height);
        own = name;
      }
    }
    stillFor = null;
    dirty = true;
  });

  const rest = effect(() => {
    void state.time.value;
    dirty = true;
  });

  function draw() {
    const scene = state.scene.value;
    blank(canvas, width, height);
    const ink = colours();
    if (!scene) {
      if (state.drawing.value) {
        plane(ink);
        bar(ink);
      }
      return;
    }
    const k = placeOf(scene.times, state.time.value);
    const view = { ctx, scene, frame, k, ink, series: ink.series, light: state.picked.value, stress };
    if (stillFor !== scene) {
      paintStill({ ...view, ctx: blank(still, width, height), scene: { ...scene, parts: [...scene.parts.filter(({ kind }) => state.layers.value.paths || kind !== "trace"), ...trails(scene)] } });
      stillFor = scene;
    }
    ctx.drawImage(still, 0, 0, width, height);
    paintMoving(state.layers.value.names ? view : { ...view, scene: { ...scene, parts: scene.parts.map((part) => ({ ...part, slides: false })) } });
    if (state.layers.value.centres) paintCentres(view);
    paintArrows(view, state.layers.value);
    if (gesture?.moved) {
      limitPose(view);
      ghost(view);
    }
    if (state.drawing.value) plane(ink);
    bar(ink);
    place(scene, k);
  }

  /** Paths that the user asked for. @param {Scene} scene @returns {any[]} */
  const trails = (scene) => state.trails.value.filter((name) => scene.points[name]).map((name) => ({ kind: "trace", name }));

  /** The pose in which the linkage is at the limit where the drag stops. @param {View} view */
  function limitPose(view) {
    const angle = state.limit.value;
    if (angle === null) return;
    const over = blank(shade, width, height);
    const parts = view.scene.parts.map((part) => ({ ...part, slides: false }));
    paintMoving({ ...view, ctx: over, scene: { ...view.scene, parts }, k: placeOf(view.scene.angles, angle) });
    over.globalCompositeOperation = "source-in";
    over.fillStyle = view.ink.bad;
    over.fillRect(0, 0, width, height);
    over.globalCompositeOperation = "source-over";
    ctx.globalAlpha = 0.4;
    ctx.drawImage(shade, 0, 0, width, height);
    ctx.globalAlpha = 1;
  }

  /** @param {View} view */
  function ghost({ ctx, ink, scene, k }) {
    if (!gesture || !scene.points[gesture.point]) return;
    const [x, y] = toScreen(frame, gesture.x, gesture.y);
    if (gesture.onto) {
      const place = toScreen(frame, ...pairAt(scene.points[gesture.onto], k));
      circle(ctx, ...place, 14);
      stroke(ctx, ink.accent, 3);
      ctx.fillStyle = ink.accent;
      ctx.font = "600 13px system-ui, sans-serif";
      ctx.fillText(saidOf("{} merges with {}", gesture.point, gesture.onto), place[0] + 20, place[1] - 12);
      return;
    }
    const [X, Y] = toScreen(frame, ...pairAt(scene.points[gesture.point], k));
    if (Math.hypot(X - x, Y - y) < 4) return;
    ctx.setLineDash([4, 4]);
    line(ctx, [[X, Y], [x, y]]);
    stroke(ctx, ink.bad, 1.5);
    circle(ctx, x, y, 8);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  /** The plane that links are drawn in: the origin, links that wait for others, the one in hand. @param {Record<string, any>} ink */
  function plane(ink) {
    const origin = toScreen(frame, 0, 0);
    for (const [dx, dy] of [[8, 0], [0, 8]]) {
      line(ctx, [[origin[0] - dx, origin[1] - dy], [origin[0] + dx, origin[1] + dy]]);
      stroke(ctx, ink.soft, 1.5);
    }
    ctx.setLineDash([6, 4]);
    for (const [start, end] of [...state.draft.value, ...(rope ? [rope] : [])]) {
      const ends = [start, end].map(({ x, y }) => toScreen(frame, x, y));
      line(ctx, ends);
      stroke(ctx, ink.accent, 3);
      for (const [x, y] of ends) {
        circle(ctx, x, y, 6);
        stroke(ctx, ink.accent, 2);
      }
    }
    ctx.setLineDash([]);
  }

  /** @param {Record<string, any>} ink */
  function bar(ink) {
    const { unit, factor } = shownUnit("m", state.units.value);
    const length = barLength({ ...frame, scale: frame.scale * factor });
    const pixels = length * factor * frame.scale;
    line(ctx, [[16, height - 20], [16, height - 14], [16 + pixels, height - 14], [16 + pixels, height - 20]]);
    stroke(ctx, ink.soft, 1.5);
    ctx.fillStyle = ink.soft;
    ctx.font = "12px system-ui, sans-serif";
    ctx.fillText(`${number(length)} ${unit}`, 22, height - 20);
  }

  /** @param {Scene} scene @param {number} k */
  function place(scene, k) {
    const words = /** @type {HTMLElement | null} */ (holder.querySelector(".reason"));
    if (words && gesture) {
      // Beside what is dragged, within the drawing.
      const [x, y] = toScreen(frame, ...pairAt(scene.points[gesture.point] ?? [gesture.x, gesture.y, gesture.x, gesture.y], k));
      words.style.transform = `translate(${Math.max(0, Math.min(x + 10, width - words.offsetWidth - 24)).toFixed()}px, ${Math.max(0, Math.min(y + 10, height - words.offsetHeight - 48)).toFixed()}px)`;
    }
    for (const button of /** @type {NodeListOf<HTMLElement>} */ (holder.querySelectorAll(".handle"))) {
      const path = scene.points[button.dataset.point ?? ""];
      if (!path) continue;
      const [x, y] = toScreen(frame, ...pairAt(path, k));
      button.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }

  /** @param {number} now */
  function step(now) {
    if (state.playing.value && before && !gesture) advance(Math.min(now - before, 100) / 1000);
    before = now;
    if (dirty) {
      dirty = false;
      draw();
      tellInstant();
      frames.count += 1;
    }
    handle = requestAnimationFrame(step);
  }
  let handle = requestAnimationFrame(step);

  // -- links that are drawn

  /** The link in hand. @type {[Spot, Spot] | null} */
  let rope = null;

  /** Joints are placed where the mechanism is assembled. @param {Scene} scene */
  function toAssembly(scene) {
    const mechanism = state.controls.peek()?.groups.find(({ key }) => key === "mechanism");
    const wanted = mechanism?.entries.find(({ key }) => key === "assembled_at")?.si ?? 0;
    state.time.value = between(scene.times, placeOf(scene.angles, wanted));
  }

  /** A joint near a place of the plane, or the place itself. @param {number} x @param {number} y @returns {Spot} */
  function spot(x, y) {
    const scene = state.scene.value;
    const k = scene ? placeOf(scene.times, state.time.value) : 0;
    const joints = [
      ...state.draft.value.flatMap(([start, end]) => [start, end]),
      ...Object.entries(scene?.points ?? {}).map(([point, path]) => ({ point, ...xy(pairAt(path, k)) })),
      { x: 0, y: 0, point: "O" },
    ];
    const near = joints.find((each) => Math.hypot(each.x - x, each.y - y) * frame.scale < ONTO);
    return near ? { ...near } : { x, y, point: "" };
  }
  const xy = (/** @type {[number, number]} */ [x, y]) => ({ x, y });

  /** The link in hand ends; one without a length is none. */
  function tied() {
    const link = rope;
    rope = null;
    dirty = true;
    if (!link || Math.hypot(link[0].x - link[1].x, link[0].y - link[1].y) * frame.scale < ONTO) return;
    state.draft.value = [...state.draft.value, [...link, state.drawing.value]];
    drawLinks(state.scene.value ? angle() : 0, 1 / frame.scale);
  }

  // -- gestures

  /** @param {PointerEvent | MouseEvent} event @returns {[number, number]} */
  function under(event) {
    const box = holder.getBoundingClientRect();
    return toMachine(frame, event.clientX - box.left, event.clientY - box.top);
  }

  /** Crank angle of the drawing. */
  function angle() {
    const scene = /** @type {Scene} */ (state.scene.value);
    return between(scene.angles, placeOf(scene.times, state.time.value));
  }

  /** @param {string} point */
  function begin(point) {
    const scene = /** @type {Scene} */ (state.scene.value);
    const [x, y] = pairAt(scene.points[point], placeOf(scene.times, state.time.value));
    gesture = { point, x, y, moved: false };
    at = angle();
    state.picked.value = point;
    state.watched.value = point;
  }
  let at = 0;

  /** @param {number} x @param {number} y */
  function move(x, y) {
    if (!gesture) return;
    Object.assign(gesture, { x, y, moved: true, onto: state.building.value ? neighbour(x, y) : "" });
    pulled();
    dirty = true;
  }

  /** Asks for the pose, or with what is let go for its entries. @param {boolean} [held] */
  function pulled(held = true) {
    if (!gesture) return;
    const { point, x, y } = gesture;
    pull({ point, x, y, angle: at, pixel: 1 / frame.scale, ...(point === state.pulled.value ? { free: follows() } : {}) }, held);
  }

  /** Another joint at a place, that the one in hand would merge with. @param {number} x @param {number} y */
  function neighbour(x, y) {
    const scene = state.scene.value;
    if (!scene || !gesture) return "";
    const k = placeOf(scene.times, state.time.value);
    const names = [...state.handled.value.split("\n"), "O"].filter((name) => name !== gesture?.point && scene.points[name]);
    return names.find((name) => {
      const [X, Y] = pairAt(scene.points[name], k);
      return Math.hypot(X - x, Y - y) * frame.scale < ONTO;
    }) ?? "";
  }

  /** @param {boolean} keep */
  function end(keep) {
    const was = gesture;
    dirty = true;
    if (keep && was?.moved && !was.onto) pulled(false);
    gesture = null;
    if (!was?.moved) return;
    if (keep && was.onto) merge(was.point, was.onto);
    else if (!keep) letBack();
    state.reason.value = "";
    state.limit.value = null;
  }

  /** Where the drawing was taken hold of, and whether it has left that place. @type {{ x: number, y: number, left: boolean } | null} */
  let panned = null;
  /** @param {PointerEvent} event */
  function down(event) {
    if (event.button !== 0) return;
    holder.setPointerCapture(event.pointerId);
    if (state.drawing.value) {
      const start = spot(...under(event));
      rope = [start, start];
      return;
    }
    const point = /** @type {HTMLElement} */ (event.target).closest?.(".handle")?.getAttribute("data-point");
    // A joint in hand follows the mouse, so that its own handle is under it where it is put down.
    if (point && !gesture?.moved) begin(point);
    else if (!gesture) panned = { x: event.clientX, y: event.clientY, left: false };
  }
  /** @param {PointerEvent} event */
  function over(event) {
    if (rope) {
      rope = [rope[0], spot(...under(event))];
      dirty = true;
      return;
    }
    if (gesture) return move(...under(event));
    if (!panned) return;
    const [dx, dy] = [event.clientX - panned.x, event.clientY - panned.y];
    if (!panned.left && Math.hypot(dx, dy) < 4) return;
    frame = { ...frame, x: frame.x + dx, y: frame.y + dy };
    panned = { x: event.clientX, y: event.clientY, left: true };
    stillFor = null;
    dirty = true;
  }
  /** @param {PointerEvent} event */
  function up(event) {
    panned = null;
    if (rope) return tied();
    if (!gesture) return;
    // A joint that was picked by a click goes where the next click is.
    const isPicked = gesture.key;
    gesture.key = true;
    if (isPicked && !gesture.moved) move(...under(event));
    if (!gesture.moved) return;
    end(true);
    if (isPicked) state.picked.value = "";
  }
  function cancelled() {
    panned = rope = null;
    end(false);
  }
  /** @param {KeyboardEvent} event */
  function key(event) {
    const button = /** @type {HTMLElement} */ (event.target).closest?.(".handle");
    if (event.key === "Escape" && (gesture || state.picked.value)) {
      end(false);
      state.picked.value = "";
      return;
    }
    if (event.key === "Enter" && button instanceof HTMLElement && !gesture) {
      event.preventDefault();
      begin(button.dataset.point ?? "");
      if (gesture) Object.assign(gesture, { key: true });
      return;
    }
    const ways = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] });
    if (!(button instanceof HTMLElement) || !ways[event.key]) return;
    event.preventDefault();
    const scene = state.scene.value;
    if (!scene) return;
    if (!gesture || gesture.point !== button.dataset.point) begin(button.dataset.point ?? "");
    if (!gesture) return;
    const size = Math.max(scene.box[2] - scene.box[0], scene.box[3] - scene.box[1]) * NUDGE * (event.shiftKey ? 10 : 1);
    const [dx, dy] = ways[event.key];
    move(gesture.x + dx * size, gesture.y + dy * size);
  }
  /** @param {KeyboardEvent} event */
  function keyUp(event) {
    if (event.key.startsWith("Arrow") && gesture?.moved) end(true);
  }
  /** @param {WheelEvent} event */
  function wheel(event) {
    event.preventDefault();
    const box = holder.getBoundingClientRect();
    frame = zoomed(frame, Math.exp(-event.deltaY / 500), event.clientX - box.left, event.clientY - box.top);
    stillFor = null;
    dirty = true;
  }
  function refit() {
    own = "";
    state.layers.value = { ...state.layers.value };
  }
  Object.assign(holder, { onpointerdown: down, onpointermove: over, onpointerup: up, onpointercancel: cancelled, onkeydown: key, onkeyup: keyUp, onwheel: wheel, ondblclick: refit });
  return () => {
    cancelAnimationFrame(handle);
    observer.disconnect();
    forget();
    rest();
  };
}
