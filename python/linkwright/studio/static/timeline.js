// Time of the drawing: where in the tables of a scene an instant lies, and how the instant goes on.

/** Place in a growing table, which may lie between two entries. @param {ArrayLike<number>} times @param {number} time */
export function placeOf(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const step = times[high] - times[low];
  return step > 0 ? low + Math.min(Math.max((time - times[low]) / step, 0), 1) : low;
}

/** @param {ArrayLike<number>} values @param {number} k */
export function between(values, k) {
  const n = Math.min(Math.floor(k), values.length - 2);
  return values[n] + (k - n) * (values[n + 1] - values[n]);
}

/** A point of an array of pairs. @param {ArrayLike<number>} pairs @param {number} k @returns {[number, number]} */
export function pairAt(pairs, k) {
  const n = Math.min(Math.floor(k), pairs.length / 2 - 2);
  const z = k - n;
  const [x, y, X, Y] = [pairs[2 * n], pairs[2 * n + 1], pairs[2 * n + 2], pairs[2 * n + 3]];
  return [x + z * (X - x), y + z * (Y - y)];
}

/** Seconds on the page for one period at playback speed 1: the machine's own time where one can watch that. @param {number} period */
export const watchable = (period) => Math.min(Math.max(period, 2), 8);

/**
 * The next instant: round and round, or back and forth.
 * @param {number} time @param {number} way @param {number} by @param {number} period @param {boolean} swings
 * @returns {[number, number]} time and way
 */
export function onward(time, way, by, period, swings) {
  const next = time + way * by;
  if (!swings) return [((next % period) + period) % period, 1];
  if (next >= period) return [Math.max(2 * period - next, 0), -1];
  if (next <= 0) return [Math.min(-next, period), 1];
  return [next, way];
}
