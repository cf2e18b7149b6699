/** Lever on a fixed pivot, and its cylinder, which turns about another pivot. */

import { svg } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";
import { arcOf, bar, bearing, placed } from "./scenery.js";

/**
 * @import { View } from "./frame.js"
 * @typedef {NonNullable<Api.Outlines["lever"]>} Lever
 */

/**
 * Return the pivots of lever and cylinder, the pin, and the foot of the cylinder's line at a lever angle, deg; all in pixels.
 * @param {Page.Lengths} linkage @param {Lever} lever @param {Pick<View, "x" | "y">} view @param {number} degrees
 */
export function leverAt({ crank_mm: r, rod_mm: f, offset_mm: e }, lever, { x, y }, degrees) {
  const [frame, crank] = [lever.frame_angle_deg, degrees + lever.pin_angle_deg].map(
    (angle) => (angle * Math.PI) / 180,
  );
  const [right, up] = [f * Math.cos(frame), f * Math.sin(frame)];
  const [across, high] = [r * Math.cos(crank), r * Math.sin(crank)];
  // From A to B: the component along the cylinder's line is the length, the one across it the offset.
  const [u, v] = [across - right, high - up];
  const square = u * u + v * v;
  const length = Math.sqrt(square - e * e);
  const along = length / square;
  const foot = [across - along * (u * length + v * e), high - along * (v * length - u * e)];
  /** @param {number} one @param {number} other @returns {Page.Point} */
  const at = (one, other) => [x(one), y(other)];
  return {
    pivot: at(0, 0),
    base: at(right, up),
    pin: at(across, high),
    foot: at(foot[0], foot[1]),
  };
}

/** Outline of a cylinder along +x. @param {number} barrel @param {number} length @param {number} lug @param {number} width */
const shape = (barrel, length, lug, width) =>
  `M0 ${lug}V0M0 ${-width / 2}H${barrel}V${width / 2}H0ZM${barrel} ${-width / 5}H${length}V${width / 5}H${barrel}`;

/** Return {node, size(view, linkage, lever, link), move(foot, pin)} of the cylinder. */
export function cylinder() {
  const [path, pin] = [svg("path", { class: "link" }), svg("circle", { class: "pin" })];
  const node = svg("g", { class: "turning-cylinder" }, path, pin);
  /** @type {(length: number) => string} */
  let outline = () => "";
  return {
    node,
    /** @param {View} view @param {Page.Lengths} linkage @param {Lever | null | undefined} lever @param {number} link */
    size({ unit }, { offset_mm: e }, lever, link) {
      node.toggleAttribute("hidden", !lever);
      if (!lever) return;
      outline = (length) => shape(lever.barrel_mm * unit, length, e * unit, 1.25 * link);
      pin.setAttribute("cy", String(e * unit));
      pin.setAttribute("r", String(Math.max(2.5, 0.28 * link)));
    },
    /** @param {Page.Point} foot @param {Page.Point} to */
    move(foot, to) {
      node.setAttribute("transform", placed(foot, to));
      path.setAttribute("d", outline(Math.hypot(to[0] - foot[0], to[1] - foot[1])));
    },
  };
}

/**
 * Return the fixed parts: both bearings, the path of the pin, both ends of the swing and, if written, dimensions.
 * @param {{ linkage: Page.Lengths, lever: Lever, view: View, link: number, written: boolean }} options
 */
export function leverScenery({ linkage, lever, view, link, written }) {
  const { crank_mm: r, rod_mm: f, offset_mm: e } = linkage;
  const angles = [lever.start_deg, lever.end_deg];
  const ends = angles.map((angle) => leverAt(linkage, lever, view, angle));
  const { pivot, base } = ends[0];
  /** Whether a point is left of the line from O to A. @param {Page.Point} point */
  const isLeft = ([x, y]) =>
    (base[0] - pivot[0]) * (y - pivot[1]) < (base[1] - pivot[1]) * (x - pivot[0]);
  const away = isLeft(ends[0].pin) ? 1 : -1;
  const far =
    Math.abs(lever.end_deg - lever.frame_angle_deg) <
    Math.abs(lever.start_deg - lever.frame_angle_deg)
      ? 0
      : 1;
  const gap = 0.9 * link + 12;
  return [
    arcOf(
      view,
      r,
      angles.map((angle) => ({ angle: angle + lever.pin_angle_deg })),
    ),
    svg("line", { class: "centre-line", x1: pivot[0], y1: pivot[1], x2: base[0], y2: base[1] }),
    ends.map(({ foot, pin }) =>
      svg(
        "g",
        { class: "ghost" },
        svg("path", { d: bar(view.unit * r, link), transform: placed(pivot, pin) }),
        svg("path", {
          d: shape(
            lever.barrel_mm * view.unit,
            Math.hypot(pin[0] - foot[0], pin[1] - foot[1]),
            e * view.unit,
            1.25 * link,
          ),
          transform: placed(foot, pin),
        }),
      ),
    ),
    bearing(...pivot, link),
    bearing(...base, link),
    written && [
      dimension(pivot, base, away * gap, `rod ${withUnit(f, "mm", 4)}`),
      dimension(pivot, ends[far].pin, -away * gap, `crank ${withUnit(r, "mm", 4)}`),
      Math.abs(e) * view.unit > 3 &&
        svg("text", { x: base[0] + 1.3 * link, y: base[1] + 4 }, `offset ${withUnit(e, "mm", 4)}`),
      ends.map(({ pin: [x, y] }, n) =>
        svg("text", { x: x + link, y: y + 4 }, `${text(angles[n], "deg", 4)}°`),
      ),
    ],
  ];
}

/** Dimension the distance between two points, beside their line. @param {Page.Point} from @param {Page.Point} to @param {number} gap @param {string} words */
function dimension(from, to, gap, words) {
  const long = Math.hypot(to[0] - from[0], to[1] - from[1]);
  if (long < 70) return null;
  const turned = to[0] < from[0] ? ` rotate(180)` : "";
  return svg(
    "g",
    { class: "dimension", transform: placed(from, to) },
    svg("path", {
      d: `M6 ${gap - 3}L0 ${gap}L6 ${gap + 3}M0 ${gap}H${long}M${long - 6} ${gap - 3}L${long} ${gap}L${long - 6} ${gap + 3}M0 0V${gap}M${long} 0V${gap}`,
    }),
    svg(
      "text",
      {
        "text-anchor": "middle",
        transform: `translate(${long / 2} ${gap})${turned} translate(0 -4)`,
      },
      words,
    ),
  );
}
