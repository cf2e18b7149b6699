/** Parallel coordinates on canvas: a line for each design, an axis for each quantity; dragging on an axis sets limits. */

import { inDisplayUnit, text } from "../lib/numbers.js";
import { wordTicks } from "./axes.js";
import { Density } from "./density.js";
import { drawHistograms } from "./histogram.js";
import { drawLine, nearestLine } from "./lines.js";
import { FONT, canvasLayers, rgb, writeOver } from "./paint.js";
import { addKeyboardAccess } from "./keyboard_access.js";
import { addPointerAccess } from "./pointer_access.js";
import { colours, logScale, scale } from "./scale.js";
import { shadesOf } from "./shades.js";

/** @import { FrontData } from "../front/data.js" */
/** @import { Limits } from "../front/limits.js" */
/**
 * @typedef {object} Chart What is drawn, and what is done with what the reader does.
 * @property {FrontData} data
 * @property {Limits} limits
 * @property {() => { key: string, flipped: boolean }[]} axes
 * @property {() => string} colour key of the column that colours the lines; of many lines all have one
 * @property {() => Page.Mark[]} marks
 * @property {(key: string) => boolean} log whether the axis of a column is logarithmic
 * @property {(key: string, limit: Page.Limit | null) => void} limit
 * @property {(row: number) => string} say a design in words
 * @property {(row: number | null) => void} point
 * @property {(row: number) => void} open
 * @property {(row: number) => void} select
 *
 * @typedef {object} View
 * @property {number} width
 * @property {number} height
 * @property {{ key: string, flipped: boolean }[]} axes
 * @property {number[]} across
 * @property {Page.Scale[]} scales
 * @property {Int16Array} heights
 * @property {Density | null} all of all designs, where there are many
 * @property {boolean} backed
 * @property {{ density: Density, mask: Uint8Array } | null} chosen as it was drawn last
 * @property {Page.Ink} ink
 * @property {ReturnType<typeof shadesOf>} shades
 */

const MARGIN = 12; // pixels above and below the axes
const NEAR = 22; // pixels around an axis in which a drag acts on it
const BELOW = 20; // pixels from the axes to the end of the panel
const EDGE = 7; // pixels around an end of a limit in which a drag moves it
const FEW = 500; // maximum number of separate lines; more are drawn as a density
const [BACK, FRONT, OVER] = [0, 1, 2];

/**
 * Return {place, draw(what)}. chart: the data to draw (data, limits, axes() [{key, flipped}], marks() [{row, colour}]) and the handlers
 * of user actions: limit(key, limit), point(row or null), open(row).
 * @param {Chart} chart
 */
export function parallel(chart) {
  const stack = canvasLayers(
    3,
    "Parallel coordinates: arrow keys move between designs and axes, Enter opens a design, Space selects it. The menu of an axis sets the same limits as dragging.",
  );
  const { place, contexts } = stack;
  /** @type {View} */
  let view; // empty before the first drawing
  /** @type {{ axis: number, from: number, span: number[] | null, moved: boolean } | null} */
  let dragged = null;

  /** Lay out the axes and the designs on them. */
  function lay() {
    const width = Math.max(1, Math.round(place.clientWidth));
    place.style.height = "0";
    const panel = place.closest(".panel")?.getBoundingClientRect().bottom ?? 0;
    const room = Math.round(panel - place.getBoundingClientRect().top - BELOW); // as high as the panel beside it
    const height = Math.max(200, Math.min(360, Math.round(window.innerHeight * 0.42)), room);
    const { data } = chart;
    const axes = chart.axes().filter(({ key }) => data.has(key));
    const across = axes.map((_, index) => ((index + 0.5) * width) / Math.max(1, axes.length));
    const scales = axes.map(({ key, flipped }) => {
      const { low, high } = data.range(key);
      const [start, end] = flipped ? [MARGIN, height - MARGIN] : [height - MARGIN, MARGIN];
      return (chart.log(key) ? logScale : scale)(low, high, start, end);
    });
    const heights = new Int16Array(data.count * axes.length).fill(-1);
    axes.forEach(({ key }, axis) => {
      const numbers = data.numbers(key);
      const { at } = scales[axis];
      const even = !chart.log(key); // multiplied out: tens of thousands of calls are slow
      const zero = at(0);
      const factor = at(1) - zero;
      for (let row = 0; row < numbers.length; row += 1) {
        if (!Number.isNaN(numbers[row]))
          heights[row * axes.length + axis] = Math.round(
            even ? zero + factor * numbers[row] : at(numbers[row]),
          );
      }
    });
    const ink = colours();
    const all = data.count > FEW ? new Density(width, height, across, heights) : null;
    stack.resize(width, height, all ? [BACK, FRONT] : []);
    view = {
      width,
      height,
      axes,
      across,
      scales,
      heights,
      all,
      backed: false,
      chosen: null,
      ink,
      shades: shadesOf(data, chart.colour(), ink),
    };
    if (all) for (let row = 0; row < data.count; row += 1) all.add(row, 1);
    else
      lines(
        contexts[BACK],
        (row) => row >= 0,
        () => ink.line,
        1,
      );
  }

  /** Draw all designs once, behind the remaining ones; many designs are visible only while some are excluded. */
  function drawBack() {
    if (!view.all || view.backed) return;
    view.backed = true;
    view.all.paint(contexts[BACK], rgb(view.ink.quiet), strength(chart.data.count) / 3);
  }

  /** @param {Page.Canvas} context @param {(row: number) => boolean} wanted @param {(row: number) => string} colour @param {number} width @param {number} alpha */
  function lines(context, wanted, colour, width, alpha = 1) {
    const { axes, across, heights } = view;
    context.lineWidth = width;
    context.globalAlpha = alpha;
    for (let row = 0; row < chart.data.count; row += 1) {
      if (!wanted(row)) continue;
      context.strokeStyle = colour(row);
      drawLine(context, row, axes.length, across, heights);
    }
    context.globalAlpha = 1;
  }

  /** Draw the remaining designs. With many designs, redraw only those that changed, unless most changed. */
  function drawChosen() {
    const { mask, chosen } = chart.limits;
    const some = chosen < chart.data.count;
    stack.show(BACK, some || !view.all);
    if (some) drawBack();
    if (!view.all) {
      stack.clear(FRONT);
      const { of, colours: inks } = view.shades;
      lines(
        contexts[FRONT],
        (row) => mask[row] === 1,
        (row) => inks[of[row]],
        1.2,
        chosen > 60 ? 0.6 : 0.85,
      );
      return;
    }
    if (!view.chosen) {
      view.chosen = {
        density: new Density(view.width, view.height, view.across, view.heights),
        mask: new Uint8Array(mask.length).fill(1),
      };
      view.chosen.density.counts.set(view.all.counts);
    }
    const { density, mask: before } = view.chosen;
    let changed = 0;
    for (let row = 0; row < mask.length; row += 1) if (mask[row] !== before[row]) changed += 1;
    if (changed <= chosen) {
      for (let row = 0; row < mask.length; row += 1)
        if (mask[row] !== before[row]) density.add(row, mask[row] ? 1 : -1);
    } else {
      density.clear();
      for (let row = 0; row < mask.length; row += 1) if (mask[row]) density.add(row, 1);
    }
    view.chosen.mask = mask.slice();
    density.paint(contexts[FRONT], rgb(view.ink.accent), strength(chosen));
  }

  /** Draw axes, limits and marked designs. */
  function drawOver() {
    stack.clear(OVER);
    const context = contexts[OVER];
    const { ink, axes, across, scales, heights, height } = view;
    drawHistograms(context, view, chart.limits.mask, MARGIN);
    Object.assign(context, { font: FONT, textBaseline: "middle" });
    axes.forEach(({ key }, axis) => {
      const x = across[axis];
      const words = chart.data.words(key);
      Object.assign(context, { strokeStyle: ink.text, lineWidth: 1 });
      context.beginPath();
      context.moveTo(x, MARGIN);
      context.lineTo(x, height - MARGIN);
      context.stroke();
      drawLimit(context, axis, chart.limits.of.get(key));
      const unit = chart.data.column(key).unit;
      for (const [value, label] of words
        ? wordTicks(words)
        : ticks(chart.data.range(key), unit, chart.log(key))) {
        const y = scales[axis].at(value);
        writeOver(context, label, x + 7, y, ink);
        context.fillRect(x - 3, y - 0.5, 6, 1);
      }
    });
    for (const { row = 0, cells, colour, width = 2.5, read = false } of chart.marks()) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      if (cells) drawLine(context, 0, axes.length, across, heightsOf(cells));
      else drawLine(context, row, axes.length, across, heights);
      if (read) drawValues(context, row);
    }
  }

  /** Return where a design outside the front crosses the axes; values out of range lie just beyond the end of an axis. @param {Api.Row} cells */
  function heightsOf(cells) {
    return Int16Array.from(view.axes, ({ key }, axis) => {
      const words = chart.data.words(key);
      const y = view.scales[axis].at(
        words ? words.indexOf(String(cells[key])) : Number(cells[key] ?? NaN),
      );
      return Number.isFinite(y) ? Math.min(view.height - MARGIN / 2, Math.max(MARGIN / 2, y)) : -1;
    });
  }

  /** Write the values of a design at the axes, on the side without ticks. @param {Page.Canvas} context @param {number} row */
  function drawValues(context, row) {
    const { ink, axes, across, heights, height } = view;
    Object.assign(context, { textAlign: "right", font: `600 ${FONT}` });
    axes.forEach(({ key }, axis) => {
      const y = heights[row * axes.length + axis];
      if (y < 0) return;
      const words = text(chart.data.cell(key, row), chart.data.column(key).unit, 4);
      writeOver(context, words, across[axis] - 9, Math.min(height - 8, Math.max(8, y)), ink, 5);
    });
    context.textAlign = "left";
  }

  /** @param {Page.Canvas} context @param {number} axis @param {Page.Limit | undefined} limit */
  function drawLimit(context, axis, limit) {
    if (!limit) return;
    const { ink, across } = view;
    for (const [top, bottom] of spans(axis, limit)) {
      context.fillStyle = ink.mark;
      context.globalAlpha = 0.3;
      context.fillRect(across[axis] - 7, top, 14, bottom - top);
      context.globalAlpha = 1;
      context.fillRect(across[axis] - 9, top - 1, 18, 2.5);
      context.fillRect(across[axis] - 9, bottom - 1, 18, 2.5);
    }
  }

  /** Return the pixels [top, bottom] within a limit. @param {number} axis @param {Page.Limit} limit @returns {number[][]} */
  function spans(axis, limit) {
    const { at, low, high } = view.scales[axis];
    /** @param {number} a @param {number} b @returns {number[]} */
    const sorted = (a, b) => (a < b ? [a, b] : [b, a]);
    if (limit.words) {
      const words = chart.data.words(view.axes[axis].key) ?? [];
      return limit.words
        .filter((word) => words.includes(word))
        .map((word) => [at(words.indexOf(word)) - 9, at(words.indexOf(word)) + 9]);
    }
    /** @param {number | null} value @param {number} end */
    const inside = (value, end) => at(Math.min(high, Math.max(low, value ?? end)));
    return [sorted(inside(limit.low, low), inside(limit.high, high))];
  }

  /** @param {{ x: number, y: number }} here */
  function axisAt({ x, y }) {
    const axis = view.across.findIndex((at) => Math.abs(at - x) <= NEAR);
    return { axis, y: Math.min(view.height - MARGIN, Math.max(MARGIN, y)) };
  }

  /**
   * Start to drag on an axis, an end of its limit, or the whole limit; return whether there is an axis.
   * @param {{ x: number, y: number }} here @param {PointerEvent} event
   */
  function begin(here, event) {
    const { axis, y } = axisAt(here);
    if (axis < 0) return false;
    event.preventDefault();
    const limit = chart.limits.of.get(view.axes[axis].key);
    const [span] = limit && !limit.words ? spans(axis, limit) : [];
    dragged = { axis, from: y, span: null, moved: false };
    if (span && Math.abs(y - span[0]) <= EDGE) dragged.from = span[1];
    else if (span && Math.abs(y - span[1]) <= EDGE) dragged.from = span[0];
    else if (span && y > span[0] && y < span[1]) dragged = { ...dragged, from: y, span };
    return true;
  }

  /** Set the limit while dragging; return whether the drag is long enough. @param {{ x: number, y: number }} here */
  function drag(here) {
    if (!dragged) return false;
    const pending = axisAt(here).y;
    if (!dragged.moved && Math.abs(pending - dragged.from) < 3) return false;
    dragged.moved = true;
    let ends = [dragged.from, pending];
    if (dragged.span) {
      const by = Math.min(
        view.height - MARGIN - dragged.span[1],
        Math.max(MARGIN - dragged.span[0], pending - dragged.from),
      );
      ends = dragged.span.map((end) => end + by);
    }
    const { key } = view.axes[dragged.axis];
    const { at, value, low, high } = view.scales[dragged.axis];
    const [first, second] = ends.map(value).sort((a, b) => a - b);
    const words = chart.data.words(key);
    if (words) {
      chart.limit(key, {
        words: words.filter((_, index) => index >= first - 0.3 && index <= second + 0.3),
      });
      return true;
    }
    const bit = (at(high) - at(low)) / 500; // fraction of the axis within which a limit snaps to its end
    const step = value(at(low) + bit) - low;
    /** @param {number} number */
    const tidy = (number) =>
      Number(
        number.toPrecision(
          Math.max(3, 1 + Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / step))),
        ),
      );
    chart.limit(key, {
      low: first <= low + step ? null : tidy(first),
      high: second >= value(at(high) - bit) ? null : tidy(second),
    });
    return true;
  }

  const at = addPointerAccess(stack.top, chart, {
    isDrawn: () => Boolean(view),
    under: ({ x, y }) => nearestLine(view, chart.limits.mask, x, y),
    cursor: (here, row) =>
      axisAt(here).axis >= 0 ? "ns-resize" : row === null ? "default" : "pointer",
    begin,
    drag,
    end: (here) => {
      const isOnAxis = dragged !== null || axisAt(here).axis >= 0;
      dragged = null;
      return !isOnAxis;
    },
  });
  stack.top.addEventListener("dblclick", (event) => {
    const { axis } = axisAt(at(event));
    if (axis >= 0) chart.limit(view.axes[axis].key, null);
  });
  let along = 0; // the axis along which keys move between designs
  addKeyboardAccess(place, {
    mask: () => chart.limits.mask,
    point: chart.point,
    open: chart.open,
    select: chart.select,
    say: (row) =>
      `${chart.say(row)}. The up and down keys follow the axis of ${chart.data.column(view.axes[along].key).title}.`,
    next(row, key) {
      if (key === "ArrowLeft" || key === "ArrowRight") {
        along = (along + (key === "ArrowRight" ? 1 : view.axes.length - 1)) % view.axes.length;
        return row;
      }
      const { axes, heights } = view;
      along = Math.min(along, axes.length - 1);
      return {
        of: (other) => heights[other * axes.length + along],
        by: key === "ArrowUp" ? -1 : 1,
      };
    },
  });

  return {
    place,
    /** Draw: "all" after a change of axes, size or colours; "chosen" after one of limits; "marks". @param {"all" | "chosen" | "marks"} what */
    draw(what) {
      if (what === "all" || !view) {
        lay();
        setTimeout(drawBack); // after this frame, so that the first limit is set without delay
      }
      if (what !== "marks") drawChosen();
      drawOver();
    },
  };
}

/** Return the opacity of one of `count` lines. @param {number} count */
function strength(count) {
  return Math.min(0.6, 40 / Math.max(1, count) + 0.02);
}

/** @param {Page.Range} options @param {string} unit @param {boolean} log @returns {[number, string][]} */
function ticks({ low, high }, unit, log) {
  if (low === high) return [[low, text(low, unit)]];
  const displayScale = (log ? logScale : scale)(
    inDisplayUnit(low, unit),
    inDisplayUnit(high, unit),
    0,
    1,
    4,
  );
  const factor = inDisplayUnit(1, unit);
  return displayScale.ticks.map((tick) => [tick / factor, displayScale.text(tick)]);
}
