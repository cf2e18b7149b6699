/** Minimum and maximum of every curve of a design, for its charts. */

import { valueOf } from "../lib/numbers.js";

const ENDS = ["least", "greatest"];

/**
 * Return the extremes of a design's curves by column, with their positions in the cycle; `way_mm` is measured from the inner dead centre.
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
