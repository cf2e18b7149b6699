/** Whether numbers are equal within rounding, by the rule of optimise/front/saved_front.py, which gives the reason. */

const SAME = 1e-9; // relative range of equal numbers

/**
 * Return whether numbers from `low` to `high` are equal within rounding. size: further magnitude that determines rounding, such as a
 * target.
 * @param {number} low @param {number} high @param {number} size
 */
export function isConstant(low, high, size = 0) {
  const apart = high - low;
  return !(
    apart >
    (apart === Infinity ? 0 : SAME * Math.max(Math.abs(low), Math.abs(high), Math.abs(size)))
  );
}
