/** Whether numbers are all the same but for rounding: the rule of slidercrank's optimise/front/constant_numbers.py, which says why. */

const SAME = 1e-9; // relative spread of what counts as one number

/**
 * Return whether the numbers from `low` to `high` are one. size: what they are rounded against besides, a target.
 * @param {number} low @param {number} high @param {number} size
 */
export function isConstant(low, high, size = 0) {
  const apart = high - low;
  return !(
    apart >
    (apart === Infinity ? 0 : SAME * Math.max(Math.abs(low), Math.abs(high), Math.abs(size)))
  );
}
