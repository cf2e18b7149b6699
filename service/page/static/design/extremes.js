/** Least and greatest value of every curve of a design over the turn, and how its strokes differ. */

import { fill, h } from "../lib/dom.js";
import { text, unitOf, valueOf } from "../lib/numbers.js";
import { headedRow, headsOf, numberCell, scrolled, table } from "../lib/table.js";

const ENDS = ["least", "greatest"];
/** Heads of a table of the extremes of curves. */
export const HEADS = [
  "Curve",
  ...ENDS.flatMap((end) => [end, "at crank angle", "at slider position"]),
  "Unit",
];
const STROKES = /** @type {const} */ (["outward", "inward"]);
/** @type {[string, string, string, string][]} */
const ROWS = [
  // of the strokes: title, key of a stroke, of the difference, of the ratio
  ["crank angle", "crank_angle", "", "angle_ratio"],
  ["duration", "duration", "duration_difference", "duration_ratio"],
  ["greatest slider speed", "greatest_speed", "greatest_speed_difference", "greatest_speed_ratio"],
  ["– at crank angle", "greatest_speed_at_crank_angle", "", ""],
  ["– at slider position", "greatest_speed_at_slider_position", "", ""],
];

/** Put the tables into `place`. @param {HTMLElement} place @param {Api.Extremes} found @param {{ signal: AbortSignal }} given */
export function extremes(place, found, { signal }) {
  const draw = () =>
    fill(
      place,
      h("h3", {}, "Every curve"),
      scrolled("Every curve", curves(found)),
      h("h3", {}, "Strokes"),
      scrolled("Strokes", strokes(found)),
      h(
        "p",
        { class: "quiet hint" },
        "Found between the crank angles of the curves above as well. Difference and ratio are those of the outward stroke against the inward one.",
      ),
    );
  draw();
  window.addEventListener("units", draw, { signal });
}

/**
 * Return the extremes of the curves of a design by their columns, at places in the cycle; `way_mm` is the position from the inner dead
 * centre.
 * @param {Api.Extremes} found @param {Pick<Page.Machine, "curveColumns" | "sliderEnds" | "turns">} design
 * @returns {Record<string, Page.Ends>}
 */
export function endsOf(found, { curveColumns, sliderEnds: [inner], turns }) {
  /** @type {Record<string, Page.Ends>} */
  const ends = {};
  for (const [name, curve] of Object.entries(found.curves)) {
    const { unit } = valueOf(curve, "least");
    const column = curveColumns.find(
      ({ key }) => key.startsWith(`${name}_`) && valueOf({ [key]: 0 }, name).value === 0,
    );
    const [low, high] = ENDS.map((end) => ({
      value: valueOf(curve, end).value,
      angle: valueOf(curve, `${end}_at_crank_angle`).value,
    }));
    if (
      !column ||
      column.unit !== unit ||
      low.value === null ||
      low.angle === null ||
      high.value === null ||
      high.angle === null
    )
      continue;
    ends[column.key] = {
      low: { value: low.value, angle: low.angle / turns },
      high: { value: high.value, angle: high.angle / turns },
    };
  }
  const { slider_position_mm: position } = ends;
  if (position) {
    const [low, high] = [position.low, position.high].map(({ value, angle }) => ({
      value: value - inner,
      angle,
    }));
    ends.way_mm = { low, high };
  }
  return ends;
}

/** @param {Api.Extremes} found */
function curves({ curves: every }) {
  return numbersTable("Extremes of every curve", HEADS, extremeRows(every));
}

/** Return a row for each curve. @param {Api.Extremes["curves"]} every */
export function extremeRows(every) {
  return Object.values(every).map((curve) => {
    const ends = ENDS.map((end) => [
      cell(curve, end),
      cell(curve, `${end}_at_crank_angle`, { withUnit: true }),
      cell(curve, `${end}_at_slider_position`, { withUnit: true }),
    ]);
    return headedRow(
      curve.title,
      ends,
      h("td", { class: "quiet" }, unitOf(valueOf(curve, "least").unit)),
    );
  });
}

/** @param {Api.Extremes} found */
function strokes({ strokes: both }) {
  const known = ROWS.filter(([, key]) => valueOf(both.outward, key).value !== null); // no durations without a speed
  const rows = known.map(([title, key, difference, ratio]) =>
    headedRow(
      title,
      STROKES.map((stroke) => cell(both[stroke], key, { withUnit: true })),
      cell(both, difference, { withUnit: true }),
      cell(both, ratio),
    ),
  );
  return numbersTable(
    "Outward and inward stroke",
    ["Stroke", ...STROKES, "difference", "ratio"],
    rows,
  );
}

/** @param {Record<string, unknown>} record @param {string} name @param {{ withUnit?: boolean }} looks */
function cell(record, name, { withUnit = false } = {}) {
  if (!name) return h("td", {});
  const { value, unit } = valueOf(record, name);
  const shown = withUnit && value !== null && unit ? unitOf(unit) : "";
  return numberCell(
    name,
    value,
    text(value, unit),
    shown && shown !== "°" ? `\u00a0${shown}` : shown,
  );
}

/** Return a table of numbers. @param {string} caption @param {readonly string[]} heads @param {Node[]} rows */
export function numbersTable(caption, heads, rows) {
  const cells = headsOf(heads, (n) => n && !["Unit", "Where"].includes(heads[n]));
  return table(caption, cells, rows);
}
