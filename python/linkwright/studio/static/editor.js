// The text of the file beside its controls, with the lines of its problems.
import { html } from "./html.js";
import { useEffect, useRef } from "./vendor/hooks.mjs";
import { write } from "./actions.js";
import * as state from "./state.js";

/** Milliseconds after the last key until the text is read. */
const QUIET = 350;

export function Editor() {
  const area = useRef(/** @type {HTMLTextAreaElement | null} */ (null));
  const numbers = useRef(/** @type {HTMLPreElement | null} */ (null));
  const timer = useRef(0);
  const typed = useRef("");
  const text = state.text.value;
  useEffect(() => {
    if (area.current && area.current.value !== text && !timer.current) area.current.value = text;
  }, [text]);
  const wrong = new Map(state.problems.value.filter(({ line }) => line).map((each) => [each.line, each]));
  const lines = text.split("\n").length;
  const flush = () => {
    if (!timer.current) return;
    clearTimeout(timer.current);
    timer.current = 0;
    write(typed.current);
  };
  const changed = () => {
    typed.current = area.current?.value ?? "";
    clearTimeout(timer.current);
    timer.current = setTimeout(flush, QUIET);
  };
  // What was typed last counts when it is saved at once, or the tab is left.
  useEffect(() => {
    state.typed.flush = flush;
    return () => {
      flush();
      state.typed.flush = () => {};
    };
  }, []);
  return html`
    <div class="editor">
      <pre class="lines" aria-hidden="true" ref=${numbers}>${Array.from({ length: lines }, (_, n) => html`<span class=${wrong.has(n + 1) ? "bad" : ""}>${n + 1}</span>`)}</pre>
      <textarea ref=${area} aria-label="Text of the machine file" spellcheck=${false} wrap="off" defaultValue=${text} onInput=${changed}
        onScroll=${({ target }) => numbers.current && (numbers.current.scrollTop = target.scrollTop)}></textarea>
    </div>
    ${state.problems.value.map(({ key, line, found, expected, remedy }) => html`
      <p class="problem">${line ? `Line ${line}: ` : ""}${key && html`<code>${key}</code> `}${found && `found ${found}`}${expected && `, expected ${expected}`}${remedy && `; ${remedy}`}</p>`)}`;
}
