// Icons, drawn, since not every computer has letters for them.
import { html } from "./html.js";

const PATHS = /** @type {Record<string, string>} */ ({
  play: "M7 4.5v15l12-7.5z",
  pause: "M6.5 4.5h4v15h-4zM13.5 4.5h4v15h-4z",
  back: "M6 5h2.5v14H6zM19 5v14l-9.5-7z",
  on: "M15.5 5H18v14h-2.5zM5 5v14l9.5-7z",
  undo: "M9.5 4L4 9l5.5 5v-3.4c4.6 0 7.6 1.3 9.7 4.9-.5-5.2-3.9-8.7-9.7-8.9z",
  redo: "M14.5 4L20 9l-5.5 5v-3.4c-4.6 0-7.6 1.3-9.7 4.9.5-5.2 3.9-8.7 9.7-8.9z",
  close: "M6.4 5L12 10.6 17.6 5 19 6.4 13.4 12l5.6 5.6-1.4 1.4L12 13.4 6.4 19 5 17.6l5.6-5.6L5 6.4z",
  locked: "M7 10V8a5 5 0 0110 0v2h1.5v10h-13V10zm2.2 0h5.6V8a2.8 2.8 0 00-5.6 0z",
  open: "M7 10V8a5 5 0 019.6-2l-2 .9A2.8 2.8 0 009.2 8v2h9.3v10h-13V10z",
  light: "M12 7a5 5 0 110 10 5 5 0 010-10zM11 1.5h2v3.5h-2zM11 19h2v3.5h-2zM1.5 11H5v2H1.5zM19 11h3.5v2H19zM4 5.4L5.4 4l2.4 2.4L6.4 7.8zM16.2 17.6l1.4-1.4 2.4 2.4L18.6 20zM4 18.6l2.4-2.4 1.4 1.4L5.4 20zM16.2 6.4L18.6 4 20 5.4l-2.4 2.4z",
  dark: "M20 14.5A8.5 8.5 0 019.5 4 8.5 8.5 0 1020 14.5z",
  system: "M12 3a9 9 0 100 18 9 9 0 000-18zm0 2.2v13.6a6.8 6.8 0 010-13.6z",
});

/** @param {{ name: string }} props */
export const Icon = ({ name }) => html`<svg class="icon-drawn" viewBox="0 0 24 24" width="17" height="17" aria-hidden="true"><path d=${PATHS[name]} fill="currentColor" /></svg>`;
