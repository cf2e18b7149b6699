/** Thumbnail of a linkage. */

import { svg } from "../lib/dom.js";
import { leverAt } from "./lever.js";
import { motionOf } from "./motion.js";

/**
 * @import { Frame } from "./frame.js"
 * @import { Lever } from "./lever.js"
 */

const WIDTH = 88;
const HEIGHTS = [26, 64];
const ANGLES = [60, 30, 90, 0, 120, 330, 180, 270]; // crank angles, deg: no links overlap at the first, but not every linkage closes there

/**
 * Return a picture of a linkage in a frame shared by several, so that they have one scale.
 * @param {Page.Lengths} linkage @param {Frame} frame @param {Lever | null} [lever] half-way, for a linkage that is one
 */
export function smallLinkage(linkage, frame, lever) {
  const { crank_mm: r, offset_mm: e } = linkage;
  const [wide, tall] = [frame.right - frame.left, frame.high - frame.low];
  const unit = Math.min(WIDTH / wide, HEIGHTS[1] / tall);
  const height = Math.max(unit * tall, HEIGHTS[0]);
  /** @param {number} millimetres */
  const x = (millimetres) =>
    (WIDTH / 2 + unit * (millimetres - (frame.left + frame.right) / 2)).toFixed(1);
  /** @param {number} millimetres */
  const y = (millimetres) =>
    (height / 2 + unit * ((frame.high + frame.low) / 2 - millimetres)).toFixed(1);
  const size = {
    class: "small-linkage",
    viewBox: `0 0 ${WIDTH} ${height.toFixed(0)}`,
    width: WIDTH,
    height: height.toFixed(0),
    "aria-hidden": "true",
  };
  if (lever) {
    const at = leverAt(
      linkage,
      lever,
      { x: (mm) => Number(x(mm)), y: (mm) => Number(y(mm)) },
      (lever.start_deg + lever.end_deg) / 2,
    );
    return svg(
      "svg",
      size,
      svg("path", { class: "way", d: `M${at.pivot}L${at.base}` }),
      svg("path", { class: "links", d: `M${at.pivot}L${at.pin}L${at.foot}` }),
      [at.pivot, at.base].map(([cx, cy]) => svg("circle", { class: "pivot", cx, cy, r: 2 })),
    );
  }
  const positions = motionOf(linkage).slider_position_mm;
  const degrees = ANGLES.find((at) => Number.isFinite(positions[at])) ?? ANGLES[0];
  const angle = (degrees * Math.PI) / 180;
  const [across, up] = [r * Math.cos(angle), r * Math.sin(angle)];
  const slider = Number.isFinite(positions[degrees]) ? positions[degrees] : 0;
  return svg(
    "svg",
    size,
    svg("line", { class: "way", x1: x(frame.left), x2: x(frame.right), y1: y(e), y2: y(e) }),
    svg("circle", { class: "way", cx: x(0), cy: y(0), r: (unit * r).toFixed(1) }),
    svg("path", {
      class: "links",
      d: `M${x(0)} ${y(0)}L${x(across)} ${y(up)}L${x(slider)} ${y(e)}`,
    }),
    svg("rect", {
      class: "block",
      x: Number(x(slider)) - 5,
      y: Number(y(e)) - 3.5,
      width: 10,
      height: 7,
      rx: 1,
    }),
    svg("circle", { class: "pivot", cx: x(0), cy: y(0), r: 2 }),
  );
}
