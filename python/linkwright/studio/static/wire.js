// Messages: number, length of the JSON, JSON, doubles. The other side is `wire.py`.

const HEAD = 8;

/** @param {number} number @param {object} body @returns {ArrayBuffer} */
export function pack(number, body) {
  const text = new TextEncoder().encode(JSON.stringify(body));
  const bytes = new Uint8Array(HEAD + text.length);
  const head = new DataView(bytes.buffer);
  head.setUint32(0, number, true);
  head.setUint32(4, text.length, true);
  bytes.set(text, HEAD);
  return bytes.buffer;
}

/** Arrays are views of the message: nothing is copied. @param {ArrayBuffer} message @returns {{ number: number, body: any }} */
export function unpack(message) {
  const head = new DataView(message);
  const length = head.getUint32(4, true);
  const text = new TextDecoder().decode(new Uint8Array(message, HEAD, length));
  const doubles = new Float64Array(message, HEAD + length);
  return { number: head.getUint32(0, true), body: filled(JSON.parse(text), doubles) };
}

/** A value with its arrays in their places: a walk by hand takes a third of a reviver's time. @param {any} value @param {Float64Array} doubles @returns {any} */
function filled(value, doubles) {
  if (typeof value !== "object" || value === null) return value;
  if (Array.isArray(value.$)) {
    const [first, rows, columns = 1] = value.$;
    return doubles.subarray(first, first + rows * columns);
  }
  for (const key in value) if (typeof value[key] === "object") value[key] = filled(value[key], doubles);
  return value;
}
