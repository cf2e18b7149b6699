/**
 * Curves over a cycle as in the API, at evenly spaced positions from 0 to 360. For one revolution, positions are crank angles from 0 deg;
 * for two revolutions, half of them. For a swing, they are times: forward up to 180, then back.
 */

/** @typedef {Pick<Page.Machine, "curves" | "turns">} Cranked What says where the crank stands. */

/** Return the crank angle at a position in the cycle, deg. @param {Cranked} machine @param {number} place @returns {number} */
export function crankAt({ curves, turns }, place) {
  return turns ? turns * place : (interpolatedValue(curves.crank_angle_deg, place) ?? NaN);
}

/**
 * Return the position in the cycle at which the crank is at an angle, deg, or nearest to it; of several, the one in the current half of
 * the cycle.
 * @param {Cranked} machine @param {number} angle @param {number} now a place
 */
export function positionOfAngle(machine, angle, now) {
  const half = wrappedAngle(now) < 180 ? 0 : 180;
  if (machine.turns === 1) return wrappedAngle(angle);
  if (machine.turns === 2) return half + wrappedAngle(angle) / 2;
  let [best, least] = [half, Infinity];
  for (let place = half; place <= half + 180; place += 0.25) {
    const off = Math.abs(wrappedAngle(crankAt(machine, place) - angle + 180) - 180);
    if (off < least) [best, least] = [place, off];
  }
  return wrappedAngle(best);
}

/** Return an angle in [0, 360). @param {number} angle */
export function wrappedAngle(angle) {
  return ((angle % 360) + 360) % 360;
}

/**
 * Return the value of a curve at a crank angle, deg, by linear interpolation; null where it is undefined.
 * @param {readonly (number | null)[]} values @param {number} angle @returns {number | null}
 */
export function interpolatedValue(values, angle) {
  const place = (wrappedAngle(angle) * values.length) / 360; // this order keeps the angle of a point exact
  const first = Math.floor(place);
  const [from, to] = [values[first % values.length], values[(first + 1) % values.length]];
  if (from === null || place === first) return from;
  return to === null ? null : from + (place - first) * (to - from);
}

/** Return {low, high} of a curve, each with its {angle, value}; null for a curve without values. @param {readonly (number | null)[]} values */
export function extremes(values) {
  let [low, high] = [-1, -1];
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
