/** Fixed parts of a mechanism: bearing, guide, centre lines, paths of the pins, dead centres, offset. */

import { svg } from "../lib/dom.js";
import { wrappedAngle } from "../charts/cycle.js";
import { text, withUnit } from "../lib/numbers.js";
import { barrel, walls } from "./attached_parts.js";

/** @typedef {{ angle: number, position: number }} Centre A dead centre, deg and mm. */

/** @import { View } from "./frame.js" */

const PITCH = 9; // pixels between hatching lines
const LETTER = 6.6; // pixels, mean width in labels

/**
 * Return the fixed parts as SVG elements.
 * - centres: the two dead centres of the curve, each {angle, position} in deg and mm; ends: the exact slider positions there, for the
 *   stroke dimension.
 * - view, block, tall: from frame.js; outlines: from the API; link: width of the links in pixels.
 * - written: whether the offset is given in words; swings: whether the centres are the ends of a swing.
 * - arc: crank angles between which the crank locks, deg.
 * - hasStrokeAngles: whether the crank angles of both strokes are drawn if the crank rotates fully.
 * @param {{
 *   linkage: Page.Lengths, centres: Centre[], ends?: Page.Point, view: View, block: number, tall: number, link: number, direction: number, written: boolean,
 *   swings?: boolean, outlines?: Api.Outlines, arc?: Page.Point | null, hasStrokeAngles?: boolean,
 * }} options
 */
export function scenery({
  linkage,
  centres,
  ends,
  view,
  block,
  tall,
  link,
  direction,
  written,
  swings = false,
  outlines,
  arc = null,
  hasStrokeAngles = false,
}) {
  const { crank_mm: r, offset_mm: e } = linkage;
  const [x, y] = [view.x, view.y];
  const positions = centres.map((centre) => centre.position);
  /** @param {string} kind @param {Page.Point} from @param {Page.Point} to */
  const line = (kind, from, to) =>
    svg("line", { class: kind, x1: from[0], y1: from[1], x2: to[0], y2: to[1] });
  const [start, end] = [
    x(Math.min(...positions) - 1.2 * block),
    x(Math.max(...positions) + 1.2 * block),
  ];
  const far = positions.reduce((a, b) => (Math.abs(a) > Math.abs(b) ? a : b));
  // The offset is dimensioned behind the crank, where no link passes.
  const beside =
    far > 0 ? Math.min(x(-r) - link / 2, start) - 6 : Math.max(x(r) + link / 2, end) + 6;
  const reach = [Math.min(x(-1.15 * r), start, beside), Math.max(x(1.15 * r), end, beside)];
  return [
    line("centre-line", [reach[0], y(0)], [reach[1], y(0)]),
    e === 0 ? null : line("centre-line", [reach[0], y(e)], [reach[1], y(e)]),
    swings || arc
      ? arcOf(view, r, arc?.map((angle) => ({ angle })) ?? centres)
      : svg("circle", { class: "path", cx: x(0), cy: y(0), r: view.unit * r }),
    line("path", [x(positions[0]), y(e)], [x(positions[1]), y(e)]),
    ...[-1, 1].map((side) => guide(start, end, y(e) - side * 0.54 * tall * view.unit, side)),
    ...centres.map((centre) => ghost(centre, linkage, view, block, tall, link)),
    ...(outlines?.cylinders ?? []).map((cylinder) => walls(view, cylinder, e)),
    outlines?.actuator ? barrel(view, outlines.actuator, e) : null,
    swings || arc ? null : rotation(view, r, direction),
    offset(view, e, beside, far > 0 ? -4 : 12, written),
    written &&
      ends?.every(Number.isFinite) &&
      strokeOf(view, linkage, ends, 0.54 * tall * view.unit + 15, link, swings),
    written && !swings && crankOf(view, r, e, far, link),
    hasStrokeAngles &&
      ends?.every(Number.isFinite) &&
      strokeAngles(
        view,
        linkage,
        centres,
        direction,
        { start, end, rail: 0.54 * tall * view.unit },
        1.7 * link,
      ),
    bearing(x(0), y(0), link),
  ];
}

/** Return the path of the crank pin between the ends of a swing. @param {View} view @param {number} r @param {{ angle: number }[]} ends */
export function arcOf(view, r, ends) {
  const [first, last] = ends.map(({ angle }) => (angle * Math.PI) / 180).sort((a, b) => a - b);
  const arcEnds = [first, last].map(
    (angle) => `${view.x(r * Math.cos(angle))} ${view.y(r * Math.sin(angle))}`,
  );
  const radius = view.unit * r;
  return svg("path", {
    class: "path",
    d: `M${arcEnds[0]}A${radius} ${radius} 0 ${last - first > Math.PI ? 1 : 0} 0 ${arcEnds[1]}`,
  });
}

/** @param {number} start @param {number} end @param {number} y @param {number} side */
function guide(start, end, y, side) {
  const strokes = [];
  for (let foot = start + PITCH; foot <= end; foot += PITCH)
    strokes.push(`M${foot} ${y}l${-PITCH * 0.8} ${-side * PITCH * 0.8}`);
  return svg("path", { class: "guide", d: `M${start} ${y}H${end}${strokes.join("")}` });
}

/** @param {Centre} centre @param {Page.Lengths} linkage @param {View} view @param {number} block @param {number} tall @param {number} link */
function ghost({ angle, position }, { crank_mm: r, offset_mm: e }, view, block, tall, link) {
  const turn = (angle * Math.PI) / 180;
  const pin = /** @type {Page.Point} */ ([view.x(r * Math.cos(turn)), view.y(r * Math.sin(turn))]);
  const slider = /** @type {Page.Point} */ ([view.x(position), view.y(e)]);
  const [long, high] = [1.5 * block * view.unit, tall * view.unit];
  return svg(
    "g",
    { class: "ghost" },
    svg("path", {
      d: bar(Math.hypot(pin[0] - view.x(0), pin[1] - view.y(0)), link),
      transform: placed([view.x(0), view.y(0)], pin),
    }),
    svg("path", {
      d: bar(Math.hypot(slider[0] - pin[0], slider[1] - pin[1]), link),
      transform: placed(pin, slider),
    }),
    svg("rect", {
      x: slider[0] - long / 2,
      y: slider[1] - high / 2,
      width: long,
      height: high,
      rx: 2,
    }),
  );
}

/** @param {View} view @param {number} r @param {number} direction */
function rotation(view, r, direction) {
  if (!direction) return null;
  /** @param {number} degrees @returns {Page.Point} */
  const pointAt = (degrees) => [
    view.x(0) + view.unit * r * Math.cos(degrees),
    view.y(0) - view.unit * r * Math.sin(degrees),
  ];
  const [from, to] = direction > 0 ? [2.0, 2.6] : [2.6, 2.0];
  const [start, end] = [pointAt(from), pointAt(to)];
  const radius = view.unit * r;
  const head = to + (direction > 0 ? Math.PI / 2 : -Math.PI / 2); // its direction there
  /** @param {number} by */
  const wing = (by) => `${end[0] - 9 * Math.cos(head + by)} ${end[1] + 9 * Math.sin(head + by)}`;
  const arc = `M${start}A${radius} ${radius} 0 0 ${direction > 0 ? 0 : 1} ${end}`;
  return svg("path", { class: "rotation", d: `${arc}M${wing(0.4)}L${end}L${wing(-0.4)}` });
}

/** @param {View} view @param {number} e @param {number} x @param {number} beside of the words @param {boolean} written */
function offset(view, e, x, beside, written) {
  const [from, to] = [view.y(0), view.y(e)];
  if (Math.abs(to - from) < 16) return null;
  const tip = Math.sign(to - from) * 6;
  const words = `offset ${withUnit(e, "mm", 4)}`;
  const long = LETTER * words.length + 8;
  const room = Math.abs(to - from) > long; // else beyond the pivot
  const heads = `M${x - 3} ${from + tip}L${x} ${from}L${x + 3} ${from + tip}M${x - 3} ${to - tip}L${x} ${to}L${x + 3} ${to - tip}`;
  return svg(
    "g",
    { class: "dimension" },
    svg("path", { d: `M${x} ${from}V${to}${heads}` }),
    written &&
      (room || (tip > 0 ? from > long : from + long < view.height)) &&
      svg(
        "text",
        {
          class: "dimension",
          transform: `translate(${x + beside} ${room ? (from + to) / 2 : from - 1.5 * tip}) rotate(-90)`,
          "text-anchor": room ? "middle" : tip > 0 ? "start" : "end",
        },
        words,
      ),
  );
}

/**
 * Dimension the stroke, outside the guide and the tangent from the outer slider pin to the crank circle, beyond which no link passes.
 * @param {View} view @param {Page.Lengths} linkage @param {Page.Point} ends @param {number} least distance from the slider line, pixels
 * @param {number} link @param {boolean} swings
 */
function strokeOf(view, { crank_mm: r, offset_mm: e }, ends, least, link, swings) {
  const [from, to] = ends.map(view.x).sort((a, b) => a - b);
  const size = withUnit(Math.abs(ends[1] - ends[0]), "mm", 4);
  const words = swings ? `travel ${size}` : `stroke ${size}`;
  const half = (LETTER * words.length) / 2;
  const room = to - from > 2 * half + 8;
  const beyond = ends[0] + ends[1] > 0 ? to + 6 : from - 6;
  const far = Math.max(...ends.map(Math.abs));
  const slope = Math.asin(Math.min(1, r / Math.hypot(far, e))) - Math.atan(Math.abs(e) / far);
  const depth = ((to - from) / 2 + half) * Math.tan(slope) + link / 2 / Math.cos(slope);
  const side = e < 0 ? 1 : -1;
  const y = view.y(e) + side * Math.max(least, room ? depth : 0);
  const heads = `M${from + 6} ${y - 3}L${from} ${y}L${from + 6} ${y + 3}M${to - 6} ${y - 3}L${to} ${y}L${to - 6} ${y + 3}`;
  return svg(
    "g",
    { class: "dimension stroke" },
    svg("path", { d: `M${from} ${y}H${to}${heads}M${from} ${y - 5}v10M${to} ${y - 5}v10` }),
    (room || (beyond > to ? beyond + 2 * half < view.width : beyond > 2 * half)) &&
      svg(
        "text",
        {
          class: "dimension stroke",
          x: room ? (from + to) / 2 : beyond,
          y: room ? y + (side > 0 ? 13 : -4) : y + 4,
          "text-anchor": room ? "middle" : beyond > to ? "start" : "end",
        },
        words,
      ),
  );
}

/** Dimension the crank as the radius of its circle, where no rod passes. @param {View} view @param {number} r @param {number} e @param {number} far @param {number} link */
function crankOf(view, r, e, far, link) {
  const radius = view.unit * r;
  if (radius < 45) return null;
  const down = e < 0 ? -1 : 1;
  // Away from the slider line, at least where the tangent from the outer slider pin touches the circle.
  const turn = Math.max(
    0.35 * Math.PI,
    Math.acos(Math.min(1, r / Math.hypot(far, e))) - Math.atan(Math.abs(e / far)),
  );
  const side = Math.sign(far);
  /** @param {number} size @returns {Page.Point} */
  const at = (size) => [
    view.x(0) + side * size * Math.cos(turn),
    view.y(0) + down * size * Math.sin(turn),
  ];
  const [x, y] = at(radius);
  const [left, edge] = at(radius + link / 2 + 4); // the value stays clear of the crank's end as it passes
  const along = Math.atan2(y - view.y(0), x - view.x(0));
  /** @param {number} by */
  const wing = (by) =>
    `${(x - 7 * Math.cos(along + by)).toFixed(1)} ${(y - 7 * Math.sin(along + by)).toFixed(1)}`;
  return svg(
    "g",
    { class: "dimension radius" },
    svg("path", { d: `M${view.x(0)} ${view.y(0)}L${x} ${y}M${wing(0.4)}L${x} ${y}L${wing(-0.4)}` }),
    svg(
      "text",
      {
        class: "dimension radius",
        x: left,
        y: edge + (down > 0 ? 10 : -1),
        "text-anchor": side > 0 ? "start" : "end",
      },
      `crank ${withUnit(r, "mm", 4)}`,
    ),
  );
}

/**
 * Draw the crank angles of the outward and the inward stroke, whose ratio is the time ratio at constant speed.
 * @param {View} view @param {Page.Lengths} linkage @param {Centre[]} centres @param {number} direction
 * @param {{ start: number, end: number, rail: number }} guide ends, and distance from the slider line, pixels @param {number} foot height of the bearing
 */
function strokeAngles(
  view,
  { crank_mm: r, offset_mm: e },
  [inner, outer],
  direction,
  { start, end, rail },
  foot,
) {
  const radius = 0.5 * view.unit * r;
  const shares = e < 0 ? [0.6, 0.7, 0.8, 0.4, 0.3] : [0.4, 0.3, 0.2, 0.6, 0.7]; // beside the dimension of the crank
  if (radius < 24) return null;
  const span = wrappedAngle(outer.angle - inner.angle); // counter-clockwise from the inner to the outer dead centre
  /** @param {number} degrees @param {number} size */
  const at = (degrees, size) => [
    view.x(0) + size * Math.cos((degrees * Math.PI) / 180),
    view.y(0) - size * Math.sin((degrees * Math.PI) / 180),
  ];
  return [
    { from: inner.angle, over: span, name: direction > 0 ? "outward" : "inward" },
    { from: outer.angle, over: 360 - span, name: direction > 0 ? "inward" : "outward" },
  ].map(({ from, over, name }) => {
    const place = shares
      .map((share) => at(from + share * over, 1.45 * radius))
      .find(
        ([x, y]) =>
          // off the guide and the hatching of the bearing
          (Math.abs(y - view.y(e)) > rail + 16 || x < start - 26 || x > end + 26) &&
          (Math.abs(x - view.x(0)) > 1.15 * foot + 24 || Math.abs(y - view.y(0) - foot) > 14),
      );
    return svg(
      "g",
      { class: `stroke-angle ${name}` },
      svg("path", {
        d: `M${at(from, radius)}A${radius} ${radius} 0 ${over > 180 ? 1 : 0} 0 ${at(from + over, radius)}`,
      }),
      place &&
        svg(
          "text",
          { class: `stroke-angle ${name}`, x: place[0], y: place[1] + 4, "text-anchor": "middle" },
          `${text(over, "deg", 4)}°`,
        ),
    );
  });
}

/** Return the bearing of a pivot. @param {number} x @param {number} y @param {number} link */
export function bearing(x, y, link) {
  const foot = 1.7 * link;
  const ground = y + foot;
  const strokes = [-1, -0.4, 0.2, 0.8].map((at) => `M${x + at * foot} ${ground}l${-5} 6`).join("");
  return svg(
    "g",
    { class: "bearing" },
    svg("path", { d: `M${x} ${y}L${x - 0.7 * foot} ${ground}H${x + 0.7 * foot}Z` }),
    svg("path", {
      class: "guide",
      d: `M${x - 1.15 * foot} ${ground}H${x + 1.15 * foot}${strokes}`,
    }),
  );
}

/** Return the outline of a link with round ends, from the origin along +x. @param {number} length @param {number} width */
export function bar(length, width) {
  const half = width / 2;
  return `M0 ${-half}H${length}A${half} ${half} 0 0 1 ${length} ${half}H0A${half} ${half} 0 0 1 0 ${-half}Z`;
}

/** Return the transform of such a link from one point towards another. @param {Page.Point} from @param {Page.Point} to */
export function placed(from, to) {
  const turn = (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI;
  return `translate(${from[0].toFixed(2)} ${from[1].toFixed(2)}) rotate(${turn.toFixed(3)})`;
}
