/** A linear scale: values to pixels and back, and round numbers for its ticks. */

import { isConstant } from "../lib/constant.js";

/**
 * Return {at(value), value(pixel), ticks, text(tick)} for values from `low` to `high` on pixels from `start` to `end`.
 * @param {number} low @param {number} high @param {number} start @param {number} end @param {number} count @returns {Page.Scale}
 */
export function scale(low, high, start, end, count = 5) {
  if (isConstant(low, high)) {
    const room = Math.abs(low) * 1e-3 || 1;
    [low, high] = [low - room, high + room];
  }
  const factor = (end - start) / (high - low);
  const step = roundStep((high - low) / count);
  const power = Math.floor(Math.log10(step) + 1e-9); // of the last digit in which ticks differ
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1) ticks.push(i * step);
  return {
    low,
    high,
    ticks,
    at: (value) => start + (value - low) * factor,
    value: (pixel) => low + (pixel - start) / factor,
    text: (tick) => tickText(tick, power),
  };
}

/** Return a tick as text, to the digit of a power of ten. @param {number} tick @param {number} power */
function tickText(tick, power) {
  const size = Math.abs(tick);
  const text = size >= 1e5 ? tick.toExponential(Math.max(0, Math.floor(Math.log10(size)) - power)) : tick.toFixed(Math.max(0, -power));
  return text.replace(/^-0(\.0*)?$/, "0").replace("-", "−");
}

/**
 * Return {low, high} of values, those that are no numbers left out, with `room` of the range on both sides.
 * @param {Iterable<Api.Row[string]>} values @param {number} room @returns {Page.Range}
 */
export function range(values, room = 0.04) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (typeof value !== "number" || !Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return { low: 0, high: 1 };
  const more = (high - low) * room;
  return { low: low - more, high: high + more };
}

/** Return 1, 2 or 5 times a power of ten, at least `step`. @param {number} step */
function roundStep(step) {
  const power = 10 ** Math.floor(Math.log10(step));
  return power * ([1, 2, 5].find((factor) => factor * power >= step * (1 - 1e-9)) ?? 10);
}

/** Return the colours of the page's style, as canvas needs them. @param {Element} element @returns {Page.Ink} */
export function colours(element = document.documentElement) {
  const style = getComputedStyle(element);
  return new Proxy({}, { get: (_, name) => style.getPropertyValue(`--${String(name)}`).trim() });
}
