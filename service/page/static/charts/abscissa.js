/** Abscissas of curves: crank angle, time, slider displacement, or both strokes of a swing. */

import { inDisplayUnit, unitOf } from "../lib/numbers.js";
import { interpolatedValue, crankAt, wrappedAngle } from "./cycle.js";
import { range } from "./scale.js";

/**
 * @typedef {Pick<Page.Machine, "curves" | "centres" | "sliderEnds" | "turns">} Curved
 * @typedef {{ x: number, n: number }} Passed A point that a curve passes: x in shown units, and its place among the values.
 * @typedef {object} Abscissa
 * @property {string} title
 * @property {string} unit as it is shown
 * @property {{ at: number, text: string }[]} [ticks] where they are not those of the scale
 * @property {(series: Curved[]) => Page.Range} span
 * @property {(one: Curved, count: number) => Passed[]} path the way through the values of a turn, back to the first
 * @property {(one: Curved, angle: number) => number | null} place of a place in the cycle
 * @property {((x: number) => number) | null} angle the place in the cycle, where there is only one
 */

/** Available abscissas; time needs a crank speed. @type {{ name: string, title: string }[]} */
export const OVER = [
  { name: "angle", title: "crank angle" },
  { name: "time", title: "time" },
  { name: "position", title: "slider position" },
  { name: "way", title: "distance from the inner dead centre" },
];
/** Abscissas for a swing. @type {{ name: string, title: string }[]} */
export const OVER_SWING = [
  { name: "angle", title: "both strokes" },
  { name: "time", title: "time" },
  { name: "crank", title: "crank angle" },
  { name: "position", title: "slider position" },
];
/** Abscissas for a lever, whose cylinder counts as the slider. */
export const OVER_LEVER = [
  ...OVER_SWING.slice(0, 2),
  { name: "crank", title: "lever angle" },
  { name: "position", title: "cylinder length" },
];
const QUARTERS = [0, 90, 180, 270, 360];
const ENDS = [
  { at: 0, text: "start" },
  { at: 180, text: "end" },
  { at: 360, text: "start" },
];

/** Return the slider's displacement from its inner dead centre at a crank angle, mm. @param {Curved} one @param {number} angle */
export function wayAt({ curves, sliderEnds: [inner] }, angle) {
  const position = interpolatedValue(curves.slider_position_mm, angle);
  return position === null ? null : position - inner;
}

/**
 * Return the abscissa of a given name. rpm: cycles per minute, signed by the direction of the crank. turns: crank revolutions per cycle, 0
 * for a swing.
 * @param {string} name @param {number} rpm @param {number} turns @returns {Abscissa}
 */
export function abscissaOf(name, rpm, turns = 1) {
  if (name === "time" && rpm) return overTime(60 / Math.abs(rpm), Math.sign(rpm));
  if (name === "position" || name === "way") return overWay(name);
  if (name === "crank") return overCrank();
  return {
    title: turns ? "crank angle" : "forward and return stroke",
    unit: "°",
    ticks: turns ? QUARTERS.map((at) => ({ at, text: `${turns * at}°` })) : ENDS,
    span: () => ({ low: 0, high: 360 }),
    path: (_, count) =>
      Array.from({ length: count + 1 }, (_, n) => ({ x: (360 * n) / count, n: n % count })),
    place: (_, angle) => angle,
    angle: (x) => x,
  };
}

/** @param {number} seconds of a turn @param {number} direction @returns {Abscissa} */
function overTime(seconds, direction) {
  return {
    title: "time",
    unit: "s",
    span: () => ({ low: 0, high: seconds }),
    path: (_, count) =>
      Array.from({ length: count + 1 }, (_, k) => ({
        x: (seconds * k) / count,
        n: (((direction * k) % count) + count) % count,
      })),
    place: (_, angle) => (seconds * wrappedAngle(direction * angle)) / 360,
    angle: (x) => wrappedAngle((direction * 360 * x) / seconds),
  };
}

/** Return the crank angle of a swing, back and forth, as the abscissa. @returns {Abscissa} */
function overCrank() {
  /** @param {Curved} one @param {number} place */
  const place = (one, place) => crankAt(one, place);
  return {
    title: "crank angle",
    unit: "°",
    span: (series) =>
      range(
        series.flatMap(({ curves }) => curves.crank_angle_deg),
        0.02,
      ),
    path: (one, count) =>
      Array.from({ length: count + 1 }, (_, n) => ({
        x: place(one, (360 * n) / count),
        n: n % count,
      })),
    place,
    angle: null,
  };
}

/** @param {string} name @returns {Abscissa} */
function overWay(name) {
  /** @param {Curved} one @param {number} angle */
  const place = (one, angle) => {
    const way =
      name === "way" ? wayAt(one, angle) : interpolatedValue(one.curves.slider_position_mm, angle);
    return way === null ? null : inDisplayUnit(way, "mm");
  };
  return {
    title: name === "way" ? "distance from the inner dead centre" : "slider position",
    unit: unitOf("mm"),
    span: (series) =>
      range(
        series.flatMap((one) =>
          one.turns
            ? one.centres.map((angle) => place(one, angle))
            : one.curves.slider_position_mm.map((at) =>
                at === null ? null : inDisplayUnit(at, "mm"),
              ),
        ),
        0.02,
      ),
    path: (one, count) =>
      Array.from({ length: count + 1 }, (_, n) => ({
        x: place(one, (360 * n) / count) ?? NaN,
        n: n % count,
      })),
    place,
    angle: null,
  };
}
