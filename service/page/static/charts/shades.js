/** Colours of designs by one column, the same in every chart of a front. */

import { palette, ramp } from "./paint.js";

/** @import { FrontData } from "../front/data.js" */

const SHADES = 24;

/**
 * Return {of, colours}: the index of each design's colour, and the colours from low to high; for words, one colour each.
 * @param {FrontData} data @param {string} key of the column; empty for one colour @param {Page.Ink} ink
 */
export function shadesOf(data, key, ink) {
  if (!key || !data.has(key)) return { of: new Uint8Array(data.count), colours: [ink.accent] };
  const numbers = data.numbers(key);
  if (data.words(key))
    return {
      of: Uint8Array.from(numbers, (number) => (Number.isNaN(number) ? 0 : number % 6)),
      colours: palette(ink, 6),
    };
  const { low, high } = data.range(key);
  const shadeOf = new Uint8Array(numbers.length);
  for (let row = 0; row < numbers.length; row += 1)
    shadeOf[row] = Math.min(SHADES - 1, ((numbers[row] - low) / (high - low || 1)) * SHADES);
  return { of: shadeOf, colours: ramp(ink, SHADES) };
}
