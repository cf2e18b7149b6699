/**
 * Curves over a cycle, as the API gives them: values at even places of it, from 0 to 360. Of a turn of the crank the places are its
 * angles from 0 deg on; of a cycle of two turns half of them; of a swing times, forth up to 180 and then back.
 */

/** @typedef {Pick<Page.Machine, "curves" | "turns">} Cranked What says where the crank stands. */

/** Return the crank angle at a place, deg. @param {Cranked} machine @param {number} place @returns {number} */
export function crankAt({ curves, turns }, place) {
  return turns ? turns * place : (between(curves.crank_angle_deg, place) ?? NaN);
}

/**
 * Return the place at which the crank stands at an angle, deg, or as near to it as it comes; of several the one in the half of the cycle
 * that it is in now.
 * @param {Cranked} machine @param {number} angle @param {number} now a place
 */
export function placeOf(machine, angle, now) {
  const half = turned(now) < 180 ? 0 : 180;
  if (machine.turns === 1) return turned(angle);
  if (machine.turns === 2) return half + turned(angle) / 2;
  let [best, least] = [half, Infinity];
  for (let place = half; place <= half + 180; place += 0.25) {
    const off = Math.abs(turned(crankAt(machine, place) - angle + 180) - 180);
    if (off < least) [best, least] = [place, off];
  }
  return turned(best);
}

/** Return an angle in [0, 360). @param {number} angle */
export function turned(angle) {
  return ((angle % 360) + 360) % 360;
}

/**
 * Return the value of a curve at a crank angle, deg, straight between its points; null where it has none.
 * @param {readonly (number | null)[]} values @param {number} angle @returns {number | null}
 */
export function between(values, angle) {
  const place = (turned(angle) * values.length) / 360; // in this order, so that the angle of a point is exact
  const first = Math.floor(place);
  const [from, to] = [values[first % values.length], values[(first + 1) % values.length]];
  if (from === null || place === first) return from;
  return to === null ? null : from + (place - first) * (to - from);
}

/** Return {low, high} of a curve, each with its {angle, value}; null for a curve without values. @param {readonly (number | null)[]} values */
export function extremes(values) {
  let [low, high] = [-1, -1]; // where they are
  let [least, most] = [Infinity, -Infinity];
  values.forEach((value, n) => {
    if (value === null) return;
    if (low < 0 || value < least) [low, least] = [n, value];
    if (high < 0 || value > most) [high, most] = [n, value];
  });
  /** @type {(n: number, value: number) => { angle: number, value: number }} */
  const endAt = (n, value) => ({ angle: (360 * n) / values.length, value });
  return low < 0 ? null : { low: endAt(low, least), high: endAt(high, most) };
}
