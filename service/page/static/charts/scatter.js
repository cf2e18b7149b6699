/** Scatter plot of two quantities on canvas, coloured by a third. */

import { inDisplayUnit } from "../lib/numbers.js";
import { drawAxes, wordTicks } from "./axes.js";
import { drawLasso, thinned } from "./lasso.js";
import { FONT, canvasLayers, drawSquares, writeOver } from "./paint.js";
import { addKeyboardAccess } from "./keyboard_access.js";
import { addPointerAccess, nearest } from "./pointer_access.js";
import { colours, logScale, range, scale } from "./scale.js";
import { shadesOf } from "./shades.js";

/** @import { FrontData } from "../front/data.js" */
/** @import { Limits } from "../front/limits.js" */
/**
 * @typedef {object} Chart What is drawn, and what is done with what the reader does.
 * @property {FrontData} data
 * @property {Limits} limits
 * @property {() => string} x
 * @property {() => string} y
 * @property {() => string} colour
 * @property {(key: string) => boolean} log whether the axis of a column is logarithmic
 * @property {(row: number) => string} say a design in words
 * @property {() => Page.Mark[]} marks
 * @property {() => Api.Row[]} others designs that are marked and none of the front; the axes reach to them
 * @property {() => Api.Row[]} behind designs of a run before, drawn behind all of these
 * @property {(row: number | null) => void} point
 * @property {(row: number) => void} open
 * @property {(row: number) => void} select
 * @property {(x: Page.Limit, y: Page.Limit) => void} box
 * @property {(line: Page.Point[]) => void} lasso
 *
 * @typedef {{ width: number, height: number, x: Page.Axis, y: Page.Axis, across: Float64Array, up: Float64Array, many: boolean, ink: Page.Ink, shades: { of: Uint8Array, colours: string[] } }} View
 */

const MARGIN = 0.04; // of a logarithmic axis, beyond the designs
const NEAR = 10; // pixels around a design in which the pointer is on it
const FEW = 1500; // maximum number of discs; more designs are drawn as squares, in a tenth of the time
const [BACK, FRONT, OVER] = [0, 1, 2];
const AREA = { left: 64, right: 12, top: 10, bottom: 44 };

/** @param {Page.Canvas} context @param {number} x @param {number} y @param {number} size */
function diamond(context, x, y, size) {
  context.moveTo(x, y - size);
  for (const [a, b] of [
    [1, 0],
    [0, 1],
    [-1, 0],
  ])
    context.lineTo(x + a * size, y + b * size);
  context.closePath();
}

/**
 * Return {place, draw(what), colours()}. chart: the data to draw (data, limits, the keys x(), y() and colour(), marks() [{row, colour,
 * name}], pointed() (a row or null)) and the handlers of user actions: box(x, y) with limits, lasso(line) with corners in the units of
 * the columns, point(row or null), open(row), select(row).
 * @param {Chart} chart
 */
export function scatter(chart) {
  const stack = canvasLayers(
    3,
    "Scatter plot of two quantities: arrow keys move between designs, Enter opens one, Space selects it. The table below lists the same designs.",
  );
  const { place, contexts, top } = stack;
  /** @type {View} */
  let view; // empty before the first drawing
  /** @type {{ x: number, y: number, right: number, bottom: number } | null} */
  let box = null;
  /** @type {Page.Point[] | null} */
  let line = null; // pixels of the freehand line
  let free = false; // whether a drag draws a line instead of a box

  function lay() {
    const width = Math.max(1, Math.round(place.clientWidth));
    const height = Math.max(260, Math.min(460, Math.round(width * 0.72)));
    const { data } = chart;
    const [x, y] = [
      axis(chart.x(), AREA.left, width - AREA.right, 6),
      axis(chart.y(), height - AREA.bottom, AREA.top, 6),
    ];
    const across = data.numbers(chart.x()).map(x.at);
    const up = data.numbers(chart.y()).map(y.at);
    const many = data.count > FEW;
    const ink = colours();
    stack.resize(width, height, many ? [BACK, FRONT] : []);
    view = {
      width,
      height,
      x,
      y,
      across,
      up,
      many,
      ink,
      shades: shadesOf(data, chart.colour(), ink),
    };
    const context = contexts[BACK];
    // Squares replace the content of the layer, so they come first.
    if (many) drawSquares(context, across, up, null, new Uint8Array(data.count), [view.ink.line]);
    drawAxes(context, { x, y, area: AREA, width, height, ink: view.ink });
    Object.assign(context, { strokeStyle: view.ink.quiet, lineWidth: 1 });
    for (const cells of chart.behind()) {
      const [a, b] = placeOf({ cells, colour: "" });
      context.beginPath();
      context.arc(a, b, 3, 0, 7);
      context.stroke();
    }
    context.fillStyle = view.ink.line;
    if (!many) for (let row = 0; row < data.count; row += 1) dot(context, row);
  }

  /** @param {string} key @param {number} start @param {number} end @param {number} count @returns {Page.Axis} */
  function axis(key, start, end, count) {
    const { data } = chart;
    const column = data.column(key);
    const words = data.words(key);
    const reach = words ? { low: -0.5, high: words.length - 0.5 } : range(withOthers(key));
    const bare = chart.log(key) ? range(withOthers(key), 0) : reach;
    const log = chart.log(key) && bare.low > 0; // a design outside the front may have a smaller value
    const spread = log ? (bare.high / bare.low) ** MARGIN : 1;
    const { low, high } = log ? { low: bare.low / spread, high: bare.high * spread } : reach;
    const makeScale = log ? logScale : scale;
    const drawn = makeScale(low, high, start, end);
    const factor = inDisplayUnit(1, column.unit);
    const displayScale = makeScale(
      inDisplayUnit(drawn.low, column.unit),
      inDisplayUnit(drawn.high, column.unit),
      start,
      end,
      count,
    );
    const ticks = words
      ? wordTicks(words)
      : displayScale.ticks.map(
          (tick) => /** @type {[number, string]} */ ([tick / factor, displayScale.text(tick)]),
        );
    return { ...drawn, column, ticks, better: data.better(key) };
  }

  /** Return the numbers that an axis must include. @param {string} key @returns {Iterable<Api.Row[string]>} */
  function withOthers(key) {
    const others = [...chart.others(), ...chart.behind()];
    return others.length
      ? [...chart.data.numbers(key), ...others.map((row) => row[key])]
      : chart.data.numbers(key);
  }

  /** Return the position of a mark. @param {Page.Mark} mark @returns {Page.Point} */
  function placeOf({ row = 0, cells }) {
    if (!cells) return [view.across[row], view.up[row]];
    return [view.x.at(Number(cells[chart.x()])), view.y.at(Number(cells[chart.y()]))];
  }

  /** @param {Page.Canvas} context @param {number} row */
  function dot(context, row) {
    context.beginPath();
    context.arc(view.across[row], view.up[row], 3.5, 0, 7);
    context.fill();
  }

  function drawChosen() {
    const context = contexts[FRONT];
    const { of, colours: inks } = view.shades;
    const { mask } = chart.limits;
    if (view.many) {
      drawSquares(context, view.across, view.up, mask, of, inks);
      return;
    }
    stack.clear(FRONT);
    for (let row = 0; row < mask.length; row += 1) {
      if (!mask[row]) continue;
      context.fillStyle = inks[of[row]];
      dot(context, row);
    }
  }

  function drawOver() {
    stack.clear(OVER);
    const context = contexts[OVER];
    const { ink } = view;
    /** @type {{ start: number, end: number, y: number }[]} */
    const written = [];
    for (const mark of chart.marks()) {
      const { colour, name } = mark;
      const [x, y] = placeOf(mark);
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      Object.assign(context, { strokeStyle: colour, fillStyle: colour, lineWidth: 2.5 });
      context.beginPath();
      if (mark.cells) diamond(context, x, y, 7);
      else context.arc(x, y, 8, 0, 7);
      if (mark.cells) context.fill();
      context.stroke();
      if (name) write(context, name, x, y, ink, written);
    }
    if (box) {
      Object.assign(context, { fillStyle: ink.mark, globalAlpha: 0.18 });
      context.fillRect(box.x, box.y, box.right - box.x, box.bottom - box.y);
      context.globalAlpha = 1;
    }
    const { lasso } = chart.limits;
    const drawn =
      lasso && lasso.x === chart.x() && lasso.y === chart.y()
        ? lasso.line.map(([a, b]) => /** @type {Page.Point} */ ([view.x.at(a), view.y.at(b)]))
        : null;
    const outline = line ?? drawn;
    if (outline) drawLasso(context, outline, ink);
  }

  /**
   * Write a name beside a design, unless it would overlap names already `written`.
   * @param {Page.Canvas} context @param {string} name @param {number} x @param {number} y @param {Page.Ink} ink
   * @param {{ start: number, end: number, y: number }[]} written
   */
  function write(context, name, x, y, ink, written) {
    context.font = FONT;
    const left = x > view.width * 0.7;
    const { width } = context.measureText(name);
    const start = left ? x - 9 - width : x + 9;
    if (
      written.some(
        (other) => start < other.end && start + width > other.start && Math.abs(y - other.y) < 15,
      )
    )
      return;
    written.push({ start, end: start + width, y });
    Object.assign(context, { textAlign: left ? "right" : "left", textBaseline: "bottom" });
    writeOver(context, name, x + (left ? -9 : 9), y - 5, ink);
  }

  /** @type {{ x: number, y: number }} */
  let from; // where the button was pressed
  addPointerAccess(top, chart, {
    isDrawn: () => Boolean(view),
    under: ({ x, y }) => {
      const { across, up } = view;
      const { mask } = chart.limits;
      /** @param {number} row */
      const distance = (row) =>
        mask[row] ? (across[row] - x) ** 2 + (up[row] - y) ** 2 : Infinity;
      return nearest(mask.length, distance, NEAR * NEAR);
    },
    cursor: (_, row) => (row === null ? "crosshair" : "pointer"),
    begin: (here) => {
      from = here;
      return true;
    },
    drag,
    end: () => {
      const drawn = box ?? line;
      [box, line] = [null, null];
      if (drawn) drawOver();
      return true;
    },
  });

  /** Draw a box or a line from where the button was pressed; return whether it is large enough. @param {{ x: number, y: number }} here */
  function drag(here) {
    if (!box && !line && Math.hypot(here.x - from.x, here.y - from.y) < 5) return false;
    if (free) {
      line = [...(line ?? [[from.x, from.y]]), [here.x, here.y]];
      if (line.length > 2)
        chart.lasso(thinned(line).map(([x, y]) => [view.x.value(x), view.y.value(y)]));
      return true;
    }
    box = {
      x: Math.min(from.x, here.x),
      right: Math.max(from.x, here.x),
      y: Math.min(from.y, here.y),
      bottom: Math.max(from.y, here.y),
    };
    chart.box(
      limitOf(chart.x(), view.x, box.x, box.right),
      limitOf(chart.y(), view.y, box.bottom, box.y),
    );
    return true;
  }

  addKeyboardAccess(place, {
    mask: () => chart.limits.mask,
    point: chart.point,
    open: chart.open,
    select: chart.select,
    say: chart.say,
    next: (_, key) =>
      key === "ArrowLeft" || key === "ArrowRight"
        ? { of: (row) => view.across[row], by: key === "ArrowRight" ? 1 : -1 }
        : { of: (row) => view.up[row], by: key === "ArrowUp" ? -1 : 1 },
  });

  /** @param {string} key @param {Page.Axis} drawn @param {number} first @param {number} second @returns {Page.Limit} */
  function limitOf(key, drawn, first, second) {
    const [low, high] = [drawn.value(first), drawn.value(second)];
    const words = chart.data.words(key);
    if (words) return { words: words.filter((_, index) => index >= low && index <= high) };
    const step = (drawn.high - drawn.low) / 500 / (chart.log(key) ? drawn.high / drawn.low : 1);
    const places = Math.max(0, Math.ceil(-Math.log10(step)));
    /** @param {number} value */
    const tidy = (value) => Number(value.toFixed(Math.min(20, places)));
    const ends = chart.data.range(key);
    return { low: low <= ends.low ? null : tidy(low), high: high >= ends.high ? null : tidy(high) };
  }

  return {
    place,
    /** Draw: "all" after a change of quantities, size or colours; "chosen" after one of limits; "marks". @param {"all" | "chosen" | "marks"} what */
    draw(what) {
      if (what === "all" || !view) lay();
      if (what !== "marks") drawChosen();
      if (what !== "chosen" || box || line || chart.limits.lasso) drawOver();
    },
    /** Choose whether a drag draws a freehand line or a box. @param {boolean} yes */
    byHand: (yes) => {
      free = yes;
    },
    /** Return the colours of the legend, low to high. */
    colours: () => view.shades.colours,
  };
}
