/** What curves are drawn over: crank angle, time, or the way of the slider. */

import { inShown, unitOf } from "../lib/numbers.js";
import { between, innerPosition, turned } from "./cycle.js";
import { range } from "./scale.js";

/**
 * @typedef {Pick<Page.Machine, "curves" | "centres">} Curved
 * @typedef {{ x: number, n: number }} Passed A point that a curve passes: x in shown units, and its place among the values.
 * @typedef {object} Across
 * @property {string} title
 * @property {string} unit as it is shown
 * @property {(series: Curved[]) => Page.Range} span
 * @property {(one: Curved, count: number) => Passed[]} path the way through the values of a turn, back to the first
 * @property {(one: Curved, angle: number) => number | null} place of a crank angle
 * @property {((x: number) => number) | null} angle at a place, where there is only one
 */

/** What there is to choose from; time needs a crank that turns at a speed. @type {{ name: string, title: string }[]} */
export const OVER = [
  { name: "angle", title: "crank angle" },
  { name: "time", title: "time" },
  { name: "position", title: "slider position" },
  { name: "way", title: "way from the inner dead centre" },
];

/** Return the way of the slider from its inner dead centre at a crank angle, mm. @param {Curved} one @param {number} angle */
export function wayAt({ curves, centres }, angle) {
  const [at, inner] = [between(curves.slider_position_mm, angle), innerPosition(curves, centres)];
  return at === null || inner === null ? null : at - inner;
}

/** Return what is chosen by name. rpm: of the crank, its sign the direction. @param {string} name @param {number} rpm @returns {Across} */
export function acrossOf(name, rpm) {
  if (name === "time" && rpm) return overTime(60 / Math.abs(rpm), Math.sign(rpm));
  if (name === "position" || name === "way") return overWay(name);
  return {
    title: "crank angle",
    unit: "°",
    span: () => ({ low: 0, high: 360 }),
    path: (_, count) => Array.from({ length: count + 1 }, (_, n) => ({ x: (360 * n) / count, n: n % count })),
    place: (_, angle) => angle,
    angle: (x) => x,
  };
}

/** @param {number} seconds of a turn @param {number} direction @returns {Across} */
function overTime(seconds, direction) {
  return {
    title: "time",
    unit: "s",
    span: () => ({ low: 0, high: seconds }),
    path: (_, count) => Array.from({ length: count + 1 }, (_, k) => ({ x: (seconds * k) / count, n: (((direction * k) % count) + count) % count })),
    place: (_, angle) => (seconds * turned(direction * angle)) / 360,
    angle: (x) => turned((direction * 360 * x) / seconds),
  };
}

/** @param {string} name @returns {Across} */
function overWay(name) {
  /** @param {Curved} one @param {number} angle */
  const place = (one, angle) => {
    const way = name === "way" ? wayAt(one, angle) : between(one.curves.slider_position_mm, angle);
    return way === null ? null : inShown(way, "mm");
  };
  return {
    title: name === "way" ? "way from the inner dead centre" : "slider position",
    unit: unitOf("mm"),
    span: (series) => range(series.flatMap((one) => one.centres.map((angle) => place(one, angle))), 0.02),
    path: (one, count) => Array.from({ length: count + 1 }, (_, n) => ({ x: place(one, (360 * n) / count) ?? NaN, n: n % count })),
    place,
    angle: null,
  };
}
