/** Displayed curves of the API, and curves derived from them. */

import { capitalised } from "../lib/words.js";

const RESULTANTS = [
  ["pivot_N", "Pivot force", "pivot_x_N", "pivot_y_N"],
  ["crank_pin_N", "Crank pin force", "crank_pin_x_N", "crank_pin_y_N"],
  ["slider_pin_N", "Slider pin force", "slider_pin_x_N", "slider_pin_y_N"],
  ["pin_N", "Lever pin force", "pin_x_N", "pin_y_N"],
  ["cylinder_pivot_N", "Cylinder pivot force", "cylinder_pivot_x_N", "cylinder_pivot_y_N"],
];
const ORDER = [
  "way_mm",
  "slider_position",
  "length_mm",
  "cylinder_speed",
  "push_N",
  "slider_velocity",
  "slider_acceleration",
  "drive_",
  "power_W",
  "torque",
  "motor_torque",
  "motor_power",
  "transmission_angle",
  "load_N",
  "pivot_N",
  "crank_pin_N",
  "slider_pin_N",
  "pin_N",
  "cylinder_pivot_N",
  "guide_N",
  "position_error_mm",
  "position_error_rss_mm",
  "slider_position_error",
  "crank_position_error",
];

/**
 * Return {curves, columns} with the magnitudes of the joint forces after their components, and the displacement from the inner dead
 * centre, if there is one. A lever and its cylinder count as crank and slider.
 * @param {Api.Cycle} cycle
 */
export function withResultants({ curves, columns, turns, slider_ends_mm: [inner] }) {
  /** @type {Api.Curves} */
  const more = { ...curves };
  /** @type {Api.Column[]} */
  const allColumns = [...columns];
  for (const [key, title, x, y] of RESULTANTS) {
    if (!curves[x] || !curves[y]) continue;
    more[key] = curves[x].map((value, n) =>
      value === null || curves[y][n] === null ? null : Math.hypot(value, curves[y][n]),
    );
    allColumns.push({ key, title, unit: "N" });
  }
  if (curves.length_mm) {
    more.crank_angle_deg = curves.lever_angle_deg ?? curves.crank_angle_deg;
    more.slider_position_mm = curves.length_mm;
  }
  if (!turns) return { curves: more, columns: allColumns };
  more.way_mm = curves.slider_position_mm.map((value) => (value === null ? null : value - inner));
  allColumns.push({ key: "way_mm", title: "displacement from inner dead centre", unit: "mm" });
  return { curves: more, columns: allColumns };
}

/**
 * Return {key, title, unit} of each chart, without curves that are zero or undefined in all designs.
 * @param {Api.Column[]} columns @param {{ curves: Api.Curves }[]} designs
 */
export function panelsOf(columns, designs) {
  /** @param {Api.Column} column */
  const some = ({ key }) =>
    designs.some(({ curves }) => curves[key]?.some((value) => value !== null && value !== 0));
  const listedColumns = ORDER.flatMap(
    (start) => columns.find(({ key }) => key.startsWith(start)) ?? [],
  ).filter(some);
  return listedColumns.map(({ key, title, unit }) => ({
    key,
    title: capitalised(title),
    unit,
  }));
}
