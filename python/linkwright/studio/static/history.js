// Undo and redo: whole texts, one entry a gesture, none if nothing changed.

const MOST = 200;

/** @param {string} text */
export function history(text) {
  let texts = [text];
  let at = 0;
  return {
    /** @param {string} next */
    put(next) {
      if (next === texts[at]) return;
      texts = [...texts.slice(0, at + 1), next].slice(-MOST);
      at = texts.length - 1;
    },
    undo: () => (at > 0 ? texts[--at] : null),
    redo: () => (at < texts.length - 1 ? texts[++at] : null),
    get canUndo() { return at > 0; },
    get canRedo() { return at < texts.length - 1; },
  };
}
