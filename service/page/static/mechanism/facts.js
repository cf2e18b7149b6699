/** Facts about one mechanism. */

import { h } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";

/** Return why a mechanism cannot be assembled. @param {Page.Lengths} lengths */
export function reasonNotAssembled({ crank_mm, rod_mm, offset_mm }) {
  return `This mechanism cannot be assembled: the offset, ${withUnit(offset_mm, "mm")}, must be less than crank + rod, ${withUnit(crank_mm + rod_mm, "mm")}, on either side; reduce the offset or lengthen the rod.`;
}

/** Return the terms and descriptions of a mechanism that rotates fully. @param {Api.Example} example */
export function factsOf({
  stroke_mm,
  time_ratio,
  slow_stroke,
  least_transmission_angle_deg,
  slider_ends_mm,
  dead_centres_deg,
  clockwise,
  extremes,
}) {
  const [inner, outer] = dead_centres_deg;
  const forward = (((clockwise ? inner - outer : outer - inner) % 360) + 360) % 360;
  /** @param {number} n */
  const centre = (n) =>
    `slider at ${withUnit(slider_ends_mm[n], "mm")}, crank at ${text(dead_centres_deg[n], "deg", 4)}°`;
  /** @param {string} key @param {string} unit */
  const range = (key, unit) => {
    const [low, high] = extremes?.[key] ?? [];
    return low && high ? `${text(low.value, unit, 4)} to ${withUnit(high.value, unit, 4)}` : "";
  };
  /** @type {[string, string][]} */
  const lines = [
    ["Stroke", withUnit(stroke_mm, "mm")],
    [
      "Time ratio",
      `${text(time_ratio, "", 4)}${slow_stroke === "equal" ? "" : `, slow ${slow_stroke}`}`,
    ],
    ["Outward stroke", `over ${text(forward, "deg", 4)}° of the crank`],
    ["Inward stroke", `over ${text(360 - forward, "deg", 4)}°`],
    ["Least transmission angle", withUnit(least_transmission_angle_deg, "deg", 4)],
    ["Slider velocity", range("slider_velocity_m_s", "m/s")],
    ["Slider acceleration", range("slider_acceleration_m_s2", "m/s^2")],
    ["Inner dead centre", centre(0)],
    ["Outer dead centre", centre(1)],
  ];
  return lines.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]);
}
