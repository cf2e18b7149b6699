/** Extent of a mechanism, and its position on the screen. */

import { extremes } from "../charts/cycle.js";

/**
 * @typedef {{ left: number, right: number, low: number, high: number, block: number, tall: number }} Frame
 * @typedef {ReturnType<typeof fitFrame>} View
 */

const MARGIN = 32; // pixels for parts beside the mechanism
const HEIGHTS = [170, 430];
const LOW = 96; // minimum height of a small drawing

/**
 * Return the inner and outer end of the slider's travel, each {angle, value}.
 * @param {Api.Curves} motion
 */
export function sliderRange(motion) {
  const ends = extremes(motion.slider_position_mm);
  if (!ends)
    throw new Error("A mechanism that is drawn must turn; this one has no slider position.");
  return ends;
}

/**
 * Return {left, right, low, high, block, tall}, mm, of a mechanism. block: two thirds of the slider's length; tall: its height. outlines:
 * further drawn parts, from the API.
 * @param {Page.Lengths} linkage @param {Api.Curves} motion @param {Api.Outlines} [outlines] @returns {Frame}
 */
export function frameOf(linkage, motion, outlines) {
  if (outlines?.lever) return frameOfExtent(outlines.extent_mm);
  const { low, high } = sliderRange(motion);
  const linkageFrame = frameWithin(linkage, low.value, high.value);
  if (!outlines) return linkageFrame;
  const [left, bottom, right, top] = outlines.extent_mm;
  const [block, tall] = [outlines.slider_length_mm / 1.5, outlines.slider_height_mm];
  return frameAround([
    linkageFrame,
    { left, low: bottom - 0.1 * block, right, high: top + 0.1 * block, block, tall },
  ]);
}

/** Return the frame of levers, which have no slider. @param {Api.Outlines["extent_mm"]} extent @returns {Frame} */
export function frameOfExtent([left, low, right, high]) {
  return { left, low, right, high, block: 0, tall: 0 };
}

/**
 * Return the frame of a mechanism whose slider moves between two positions, mm.
 * @param {Page.Lengths} linkage @param {number} inner @param {number} outer @returns {Frame}
 */
export function frameWithin({ crank_mm: r, offset_mm: e }, inner, outer) {
  const far = Math.max(Math.abs(inner), Math.abs(outer));
  const block = Math.max(0.16 * (r + Math.max(r, Math.abs(e))), 0.05 * (far + r));
  return {
    left: Math.min(-r, inner - 1.3 * block) - 0.3 * block,
    right: Math.max(r, outer + 1.3 * block),
    low: Math.min(-r, e - 0.9 * block),
    high: Math.max(r, e + 0.9 * block),
    block,
    tall: block,
  };
}

/** Return a frame that contains several others; mechanisms drawn in one frame have one scale. @param {Frame[]} frames @returns {Frame} */
export function frameAround(frames) {
  // Math.min(...) fails with 100,000 arguments and more.
  return frames.reduce((all, one) => ({
    left: Math.min(all.left, one.left),
    right: Math.max(all.right, one.right),
    low: Math.min(all.low, one.low),
    high: Math.max(all.high, one.high),
    block: Math.max(all.block, one.block),
    tall: Math.max(all.tall, one.tall),
  }));
}

/**
 * Return {width, height, unit, x(mm), y(mm)} of a frame for a width in pixels. unit: pixels per millimetre. small: whether a low height
 * is permitted.
 * @param {Frame} frame @param {number} width @param {boolean} small
 */
export function fitFrame(frame, width, small = false) {
  const [wide, tall] = [frame.right - frame.left, frame.high - frame.low];
  const across = (width - 2 * MARGIN) / wide;
  const height = Math.round(
    Math.min(Math.max(across * tall + 2 * MARGIN, small ? LOW : HEIGHTS[0]), HEIGHTS[1]),
  );
  const unit = Math.min(across, (height - 2 * MARGIN) / tall);
  const left = (width - unit * wide) / 2;
  const top = (height - unit * tall) / 2;
  return {
    width,
    height,
    unit,
    /** @param {number} millimetres */
    x: (millimetres) => left + unit * (millimetres - frame.left),
    /** @param {number} millimetres */
    y: (millimetres) => top + unit * (frame.high - millimetres),
  };
}

/**
 * Return the position in the mechanism, mm, of a point on the screen.
 * @param {Element} node that shows it @param {View} view @param {number} x @param {number} y @returns {Page.Point}
 */
export function placeIn(node, view, x, y) {
  const box = node.getBoundingClientRect();
  const factor = view.width / box.width;
  return [
    ((x - box.left) * factor - view.x(0)) / view.unit,
    (view.y(0) - (y - box.top) * factor) / view.unit,
  ];
}
