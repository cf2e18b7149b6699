/** Frame of a chart on canvas: grid, numbers, headings. */

import { headed } from "../front/columns.js";
import { FONT } from "./paint.js";

/** Return one tick per word for an axis of words. @type {(words: string[]) => [number, string][]} */
export function wordTicks(words) {
  return words.map((word, place) => [place, word]);
}

/**
 * Draw axes {at, ticks: [[value, text]], column} around an area.
 * @param {Page.Canvas} context @param {{ x: Page.Axis, y: Page.Axis, area: Page.Room, width: number, height: number, ink: Page.Ink }} options
 */
export function drawAxes(context, { x, y, area, width, height, ink }) {
  const [right, bottom] = [width - area.right, height - area.bottom];
  Object.assign(context, {
    font: FONT,
    strokeStyle: ink.line,
    fillStyle: ink.quiet,
    lineWidth: 1,
    globalAlpha: 0.7,
  });
  context.beginPath();
  for (const [value] of x.ticks) {
    context.moveTo(x.at(value), area.top);
    context.lineTo(x.at(value), bottom);
  }
  for (const [value] of y.ticks) {
    context.moveTo(area.left, y.at(value));
    context.lineTo(right, y.at(value));
  }
  context.stroke();
  Object.assign(context, { globalAlpha: 1, textAlign: "center", textBaseline: "top" });
  for (const [value, text] of x.ticks) context.fillText(text, x.at(value), bottom + 6);
  context.fillStyle = ink.text;
  context.fillText(axisTitle(x), (area.left + right) / 2, bottom + 24, right - area.left);
  Object.assign(context, { fillStyle: ink.quiet, textAlign: "right", textBaseline: "middle" });
  for (const [value, text] of y.ticks)
    context.fillText(text, area.left - 6, y.at(value), area.left - 22);
  context.save();
  context.translate(11, (area.top + bottom) / 2);
  context.rotate(-Math.PI / 2);
  Object.assign(context, { textAlign: "center", fillStyle: ink.text });
  context.fillText(axisTitle(y), 0, 0, bottom - area.top);
  context.restore();
}

/** Return the heading of an axis and its better direction. @param {Page.Axis} axis */
function axisTitle({ column, better }) {
  return better ? `${headed(column)} (${better})` : headed(column);
}
