// The socket: it brings the key first, then one request to compute at a time; of held ones that wait, the newest alone is sent.
import { enter, key } from "./key.js";
import { pack, unpack } from "./wire.js";

/** How a socket is closed that brings no key, or that of another studio. */
const NO_KEY = 4403;

/** @param {{ answer: (number: number, body: any) => void, state: (connected: boolean, known: boolean) => void }} hear */
export function connect(hear) {
  let number = 0;
  /** @type {WebSocket} */
  let socket;
  /** @type {Asked[]} */
  let waiting = [];
  let onTheWay = 0;
  let isIn = false;
  /** @type {Map<number, (body: any) => void>} */
  const asked = new Map();

  function open() {
    socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => socket.send(pack(0, { ask: "enter", key: key() }));
    socket.onclose = ({ code }) => {
      isIn = false;
      forget();
      hear.state(false, code !== NO_KEY);
      setTimeout(open, 1500);
    };
    socket.onmessage = ({ data }) => {
      const { number: of, body } = unpack(data);
      if (body.of === "entered") {
        enter(body.key);
        isIn = true;
        forget();
        hear.answer(of, body);
        return hear.state(true, true);
      }
      const told = asked.get(of);
      asked.delete(of);
      if (of === onTheWay && body.of !== "beside" && body.of !== "stopped") {
        onTheWay = 0;
        const next = waiting.shift();
        if (next) compute(next);
      }
      if (told) told(body);
      else hear.answer(of, body);
    };
  }

  /** What was asked over a socket that was cut, or while there was none, has no answer. */
  function forget() {
    onTheWay = 0;
    waiting = [];
    const without = [...asked.values()];
    asked.clear();
    for (const told of without) told({ of: "lost", words: "The connection was lost before the answer arrived." });
  }

  /** @param {Asked} body @returns {number} */
  function send(body) {
    number += 1;
    if (isIn && socket.readyState === WebSocket.OPEN) socket.send(pack(number, body));
    return number;
  }

  /** @param {Asked} body */
  function compute(body) {
    if (onTheWay) waiting = [...waiting.filter(({ held }) => !held), body];
    else onTheWay = send(body);
  }

  open();
  return {
    compute,
    busy: () => onTheWay !== 0 || waiting.length > 0 || asked.size > 0,
    send,
    /** @param {Asked} body @returns {Promise<any>} */
    ask: (body) => new Promise((resolve) => asked.set(send(body), resolve)),
  };
}
