/** Linear and logarithmic scales: conversion of values to pixels and back, and round numbers as ticks. */

import { isConstant } from "../lib/constant.js";
import { withPower } from "../lib/numbers.js";

const WIDE = 1.5; // minimum ratio of the ends of a logarithmic axis

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
  const power = Math.floor(Math.log10(step) + 1e-9);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1)
    ticks.push(i * step);
  return {
    low,
    high,
    ticks,
    at: (value) => start + (value - low) * factor,
    value: (pixel) => low + (pixel - start) / factor,
    text: (tick) => tickText(tick, power),
  };
}

/**
 * Return a logarithmic scale for positive values, in the form of `scale`. Ticks are 1, 2 and 5 times powers of ten; only the powers if
 * there are many; round numbers if there are too few.
 * @param {number} low @param {number} high @param {number} start @param {number} end @param {number} count @returns {Page.Scale}
 */
export function logScale(low, high, start, end, count = 5) {
  const even = scale(low, high, start, end, count);
  if (isConstant(low, high)) return even;
  const [from, to] = [Math.log10(low), Math.log10(high)];
  const factor = (end - start) / (to - from);
  const powers = Array.from(
    { length: Math.ceil(to) - Math.floor(from) + 1 },
    (_, n) => Math.floor(from) + n,
  );
  /** @param {number[]} steps */
  const within = (steps) =>
    powers
      .flatMap((power) => steps.map((step) => Number(`${step}e${power}`)))
      .filter((tick) => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9));
  const fine = within([1, 2, 5]);
  const ticks = fine.length < 3 ? even.ticks : fine.length > 2 * count ? within([1]) : fine;
  return {
    low,
    high,
    ticks,
    at: (value) => (value > 0 ? start + (Math.log10(value) - from) * factor : NaN),
    value: (pixel) => 10 ** (from + (pixel - start) / factor),
    text:
      fine.length < 3 ? even.text : (tick) => tickText(tick, Math.floor(Math.log10(tick) + 1e-9)),
  };
}

/** Whether a logarithmic axis is possible and useful for a range. @param {Page.Range} options */
export function mayBeLog({ low, high }) {
  return low > 0 && high >= WIDE * low;
}

/** Return a tick as text, rounded to the digit of a power of ten. @param {number} tick @param {number} power */
function tickText(tick, power) {
  const size = Math.abs(tick);
  if (size >= 1e6) return withPower(tick, 1 + Math.max(0, Math.floor(Math.log10(size)) - power));
  const text = tick.toFixed(Math.max(0, -power));
  return text.replace(/^-0(\.0*)?$/, "0").replace("-", "−");
}

/**
 * Return {low, high} of the finite values, with a margin of `room` times the range on both sides.
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

/** Return the colours of the page's style for use on canvas. @param {Element} element @returns {Page.Ink} */
export function colours(element = document.documentElement) {
  const style = getComputedStyle(element);
  return new Proxy({}, { get: (_, name) => style.getPropertyValue(`--${String(name)}`).trim() });
}
