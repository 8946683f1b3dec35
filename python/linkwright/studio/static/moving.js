// A canvas that is drawn anew at every frame while its picture moves, and once after every change.
import { html } from "./html.js";
import { useEffect, useLayoutEffect, useRef } from "./vendor/hooks.mjs";
import { blank } from "./frame.js";
import { frames } from "./stage.js";
import * as state from "./state.js";
import { colours, shownLook } from "./theme.js";

/** Longest time between two frames that moves the picture [s]: a tab that was away does not jump. */
const LONGEST = 0.1;

/** @param {{ label: string, draw: (paper: Paper) => void }} props */
export function Moving({ label, draw }) {
  const own = useRef(/** @type {HTMLCanvasElement | null} */ (null));
  const now = useRef(draw);
  const isDirty = useRef(true);
  useLayoutEffect(() => {
    now.current = draw;
    isDirty.current = true;
  });
  useEffect(() => {
    const canvas = /** @type {HTMLCanvasElement} */ (own.current);
    let [handle, before] = [0, 0];
    const observer = new ResizeObserver(() => (isDirty.current = true));
    observer.observe(canvas);
    /** @param {number} at */
    function step(at) {
      const passed = state.playing.value && before ? Math.min((at - before) / 1000, LONGEST) : 0;
      before = at;
      if (passed || isDirty.current) {
        isDirty.current = false;
        const { clientWidth: width, clientHeight: height } = canvas;
        const ink = colours();
        now.current({ ctx: blank(canvas, width, height), width, height, passed, ink, series: ink.series });
        frames.count += 1;
      }
      handle = requestAnimationFrame(step);
    }
    handle = requestAnimationFrame(step);
    return () => {
      cancelAnimationFrame(handle);
      observer.disconnect();
    };
  }, []);
  void shownLook.value;
  return html`<canvas ref=${own} role="img" aria-label=${label}></canvas>`;
}
