// The key to the studio: it stands in the address, and is kept by the page. A cookie would go to every port of this computer.
import { signal } from "./vendor/signals-core.mjs";

const NAME = "key";

/** The key that the server has taken; empty before. */
export const taken = signal("");

/** @param {string} key */
function keep(key) {
  try {
    localStorage.setItem(NAME, key);
  } catch {
    // A browser that keeps nothing asks for the address again.
  }
}

// What the address brings is kept, and leaves the address and with it the history.
let brought = /[#&]key=([\w-]+)/.exec(location.hash)?.[1] ?? "";
if (brought) {
  keep(brought);
  const rest = location.hash.slice(1).split("&").filter((part) => !part.startsWith("key="));
  history.replaceState(null, "", `#${rest.join("&")}`);
}

/** The key to try: another tab may have been opened by a newer one. */
export function key() {
  try {
    return localStorage.getItem(NAME) ?? brought;
  } catch {
    return brought;
  }
}

/** @param {string} own */
export function enter(own) {
  brought = taken.value = own;
  keep(own);
}

// An address that is typed over that of this page opens what it names.
addEventListener("hashchange", () => location.reload());
