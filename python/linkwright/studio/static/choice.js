// A list to choose one of.
import { html } from "./html.js";

/** @param {{ value: string | number, options: Options, choose: (value: string) => void, [attribute: string]: any }} props */
export const Choice = ({ value, options, choose, ...rest }) => html`<select ...${rest} value=${value} onChange=${({ target }) => choose(target.value)}>
  ${options.map(([key, words, isOwn]) => html`<option key=${key} value=${key} translate=${isOwn ? "no" : undefined} selected=${key === value}>${words}</option>`)}</select>`;

/** Names as options. @param {string[]} names @returns {Options} */
export const ofNames = (names) => names.map((name) => [name, name, true]);
