/** Forces as arrows: frame on crank, crank on rod, rod on slider, guide on slider, and the load; or those on a lever. */

import { interpolatedValue } from "../charts/cycle.js";
import { h, svg } from "../lib/dom.js";
import { fromDisplayUnit, inDisplayUnit, withUnit } from "../lib/numbers.js";

const LONGEST = 110; // pixels of the greatest force over the revolution
const SHORTEST = 3; // pixels; shorter arrows become dots
const DOT = 2.5;
const HEAD = 7;

/**
 * Arrows. at: 0 pivot, 1 crank pin, 2 slider pin or the cylinder's pivot; along: keys of the curves of its components in x and y.
 * @type {{ name: string, title: string, at: number, along: [string | null, string | null] }[]}
 */
export const ARROWS = [
  { name: "pivot", title: "frame on crank", at: 0, along: ["pivot_x_N", "pivot_y_N"] },
  { name: "crank-pin", title: "crank on rod", at: 1, along: ["crank_pin_x_N", "crank_pin_y_N"] },
  {
    name: "slider-pin",
    title: "rod on slider",
    at: 2,
    along: ["slider_pin_x_N", "slider_pin_y_N"],
  },
  { name: "crank-pin", title: "piston rod on crank", at: 1, along: ["pin_x_N", "pin_y_N"] },
  {
    name: "slider-pin",
    title: "frame on cylinder",
    at: 2,
    along: ["cylinder_pivot_x_N", "cylinder_pivot_y_N"],
  },
  { name: "guide-force", title: "guide on slider", at: 2, along: [null, "guide_N"] },
  { name: "load-force", title: "load on slider", at: 2, along: ["load_N", null] },
];

/** Return the greatest force among curves, N; 0 without forces. @param {Api.Curves} curves */
export function largestForce(curves) {
  let greatest = 0;
  for (const { along } of ARROWS) {
    const [x, y] = along.map((key) => (key === null ? undefined : curves[key]));
    for (let n = 0; n < (x ?? y ?? []).length; n += 1)
      greatest = Math.max(greatest, Math.hypot(x?.[n] ?? 0, y?.[n] ?? 0));
  }
  return greatest;
}

/**
 * Return the magnitude of a force at a crank angle, N; null where friction leaves it undetermined.
 * @param {(typeof ARROWS)[0]} arrow @param {Api.Curves} curves @param {number} angle
 */
export function forceAt({ along }, curves, angle) {
  const parts = along.flatMap((key) =>
    key && curves[key] ? [interpolatedValue(curves[key], angle)] : [],
  );
  return parts.some((part) => part === null) ? null : Math.hypot(...parts.map(Number));
}

/** Return the scale bar for arrows, a round force. greatest: force of the longest arrow, N. @param {number} greatest */
export function scaleOf(greatest) {
  const greatestDisplayed = inDisplayUnit(greatest, "N");
  if (!(greatestDisplayed > 0)) return "no force acts";
  const power = 10 ** Math.floor(Math.log10(greatestDisplayed));
  const round = fromDisplayUnit(
    power * (greatestDisplayed / power >= 5 ? 5 : greatestDisplayed / power >= 2 ? 2 : 1),
    "N",
  );
  const bar = h("span", { class: "force-scale", "aria-hidden": "true" });
  bar.style.width = `${((LONGEST * round) / greatest).toFixed(1)}px`;
  return h("span", {}, bar, ` ${withUnit(round, "N", 3)}; a dot: too small for an arrow`);
}

/** Return {node, size(curves, view, largest), move(pivot, pin, slider, angle)}: all arrows in one group. */
export function arrows() {
  const lines = ARROWS.map(({ name }) => svg("path", { class: `force ${name}` }));
  /** @type {Api.Curves} */
  let curves = {};
  let unit = 0; // pixels per newton
  return {
    node: svg("g", { class: "forces", hidden: true }, lines),
    /** @param {Api.Curves} motion @param {unknown} _view @param {number | undefined} largest */
    size(motion, _view, largest = largestForce(motion)) {
      curves = motion;
      unit = largest > 0 ? LONGEST / largest : 0;
    },
    /** @param {Page.Point} pivot @param {Page.Point} pin @param {Page.Point} slider @param {number} angle */
    move(pivot, pin, slider, angle) {
      const places = [pivot, pin, slider];
      ARROWS.forEach(({ at, along }, n) => {
        const [x, y] = along.map((key) =>
          key && curves[key] ? (interpolatedValue(curves[key], angle) ?? 0) : 0,
        );
        lines[n].setAttribute("d", arrow(places[at], unit * x, -unit * y));
      });
    },
  };
}

/** @param {Page.Point} from @param {number} right @param {number} down */
function arrow([x, y], right, down) {
  const size = Math.hypot(right, down);
  if (!(size > 0)) return "M0 0";
  if (size < SHORTEST)
    return `M${(x - DOT).toFixed(1)} ${y.toFixed(1)}a${DOT} ${DOT} 0 1 0 ${2 * DOT} 0a${DOT} ${DOT} 0 1 0 ${-2 * DOT} 0`;
  const [tip, turn] = [[x + right, y + down], Math.atan2(down, right)];
  const head = Math.min(HEAD, size);
  /** @param {number} by */
  const wing = (by) =>
    `${(tip[0] - head * Math.cos(turn + by)).toFixed(1)} ${(tip[1] - head * Math.sin(turn + by)).toFixed(1)}`;
  return `M${x.toFixed(1)} ${y.toFixed(1)}L${tip[0].toFixed(1)} ${tip[1].toFixed(1)}M${wing(0.45)}L${tip[0].toFixed(1)} ${tip[1].toFixed(1)}L${wing(-0.45)}`;
}
