/** Curves over a turn of the crank, as the API gives them: values at evenly spaced angles from 0 deg. */

/** Return an angle in [0, 360). */
export function turned(angle) {
  return ((angle % 360) + 360) % 360;
}

/** Return the value of a curve at a crank angle, deg, straight between its points; null where it has none. */
export function between(values, angle) {
  const place = (turned(angle) / 360) * values.length;
  const first = Math.floor(place);
  const [from, to] = [values[first % values.length], values[(first + 1) % values.length]];
  if (from === null || to === null) return null;
  return from + (place - first) * (to - from);
}

/** Return {low, high} of a curve, each with its {angle, value}; null for a curve without values. */
export function extremes(values) {
  let low = null;
  let high = null;
  values.forEach((value, n) => {
    if (value === null) return;
    const point = { angle: (360 * n) / values.length, value };
    if (low === null || value < low.value) low = point;
    if (high === null || value > high.value) high = point;
  });
  return low && { low, high };
}
