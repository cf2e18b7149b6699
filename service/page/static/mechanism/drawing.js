/** Moving mechanism: drawn once, then only moved. */

import { interpolatedValue, crankAt } from "../charts/cycle.js";
import { fill, h, svg } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";
import { arrows } from "./arrows.js";
import { attached } from "./attached_parts.js";
import { frameAround, fitFrame, frameOf, placeIn, sliderRange } from "./frame.js";
import { cylinder, leverAt, leverScenery } from "./lever.js";
import { bar, placed, scenery } from "./scenery.js";

/**
 * @import { Frame, View } from "./frame.js"
 * @import { Grips } from "./grips.js"
 * @typedef {{ frame?: Frame, direction?: number, dead_centres_deg?: Page.Point, slider_ends_mm?: Page.Point, arc?: Page.Point | null, largest_force?: number, small?: boolean, angle?: number, turns?: number, outlines?: Api.Outlines }} Options
 */

const EVERY = 100; // ms between values during motion; faster changes are unreadable

/**
 * Put a drawing into `place`, as wide as the place. label: its description for screen readers; grips: from grips.js, to drag the
 * lengths with. Returns
 * - show(linkage, motion, options): draw the linkage {crank_mm, rod_mm, offset_mm}. motion: curves {crank_angle_deg,
 *   slider_position_mm} over a turn, evenly spaced from 0 deg; with transmission_angle_deg, the angle is labelled; with the forces of
 *   the API, they are drawn as arrows. options:
 *   - frame: from frame.js, to draw several linkages at one scale.
 *   - direction: 1 counter-clockwise, -1 clockwise.
 *   - dead_centres_deg: [inner, outer]; if missing, those of the curve.
 *   - slider_ends_mm: slider positions at the dead centres; if missing, the stroke is not dimensioned.
 *   - arc: crank angles between which the crank locks, deg.
 *   - largest_force: force of the longest arrow, N; if missing, the largest of the curves.
 *   - small: whether the picture is low and has no offset in words.
 *   - angle: crank angle to begin with, deg; if missing, the previous one.
 *   - turns: turns of the crank in a cycle, if not one. 0 means a swing; then all angles here are positions in the cycle, see
 *     charts/cycle.js.
 *   - outlines: of piston, cylinders, actuator and body on the crank, from the API.
 * - turn(angle, settled): set the crank to an angle in deg; settled: whether it stays there, so that labels can be updated.
 * - fade(yes): show that the drawn linkage is not the requested one.
 * - forces(yes): show the arrows.
 * - angleAt(x, y): the crank angle that points to a place on the screen.
 * - node: both pictures; handle: the element over the crank circle, by which the crank is turned.
 * - close().
 * @param {HTMLElement} place @param {{ label: string, grips?: Grips | null }} options
 */
export function drawing(place, { label, grips = null }) {
  const parts = movingParts();
  const words = svg("g"); // above the links
  const handle = svg("circle", { class: "handle" });
  // Fixed parts are a separate picture, so that they are not repainted in every frame.
  const [still, moving] = [
    svg("svg", { class: "still" }),
    svg("svg", { class: "moving" }, parts.nodes, words, handle, grips?.nodes),
  ];
  const node = h(
    "div",
    { class: "mechanism", role: grips ? "group" : "img", "aria-label": label },
    still,
    moving,
  );
  place.append(node);
  /** @type {{ linkage: Page.Lengths, motion: Api.Curves, options: Options } | null} */
  let current = null; // {linkage, motion, options}
  /** @type {View | null} */
  let view = null;
  /** @type {Frame | null} */
  let displayedFrame = null;
  let angle = 0;
  let arrowed = false;

  function arrange() {
    const width = Math.round(place.clientWidth);
    if (!current || width < 60) return;
    const { linkage, motion, options } = current;
    const { outlines } = options;
    const machineFrame = frameOf(linkage, motion, outlines);
    const { block, tall } = machineFrame;
    // While a grip is held, the scale changes only where the mechanism would leave the picture.
    displayedFrame =
      displayedFrame && grips?.isHeld()
        ? frameAround([displayedFrame, machineFrame])
        : machineFrame;
    view = fitFrame(options.frame ?? displayedFrame, width, options.small);
    for (const one of [still, moving])
      one.setAttribute("viewBox", `0 0 ${view.width} ${view.height}`);
    const link = Math.min(Math.max(0.05 * (linkage.crank_mm + linkage.rod_mm) * view.unit, 7), 20);
    const { turns = 1 } = options;
    const [lever, written] = [outlines?.lever, !options.small];
    fill(
      still,
      lever
        ? leverScenery({ linkage, lever, view, link, written })
        : scenery({
            linkage,
            ends: options.slider_ends_mm,
            centres: deadCentres(motion, options.dead_centres_deg, turns),
            view,
            block,
            tall,
            link,
            direction: options.direction ?? 1,
            written,
            swings: turns === 0,
            arc: options.arc,
            outlines,
            hasStrokeAngles: grips !== null,
          }),
    );
    // Those of a lever are turned with their dimensions.
    words.replaceChildren(...(lever ? [] : still.querySelectorAll("text")));
    measure(handle, { cx: view.x(0), cy: view.y(0), r: linkage.crank_mm * view.unit + 0.8 * link });
    parts.size({
      linkage,
      view,
      block,
      tall,
      outlines,
      link,
      written: written && !grips, // beside its field it need not be
      crossed: !lever && crossed(linkage, motion, turns),
    });
    parts.forces.size(motion, view, options.largest_force);
    // With a driving slider, the relevant angle is between rod and crank, not the marked one.
    parts.marked.toggleAttribute("hidden", Boolean(motion.drive_N || lever));
    turn(angle);
  }

  /** @param {number} to @param {boolean} settled */
  function turn(to, settled = true) {
    angle = to;
    if (!view || !current) return;
    const { linkage, motion, options } = current;
    const lever = options.outlines?.lever;
    if (lever) {
      const at = leverAt(
        linkage,
        lever,
        view,
        crankAt({ curves: motion, turns: options.turns ?? 1 }, angle),
      );
      parts.moveLever(at);
      if (arrowed) parts.forces.move(at.pivot, at.pin, at.base, angle);
      return;
    }
    const position = interpolatedValue(motion.slider_position_mm, angle);
    if (position === null) return; // the crank locks before
    const radians = (crankAt({ curves: motion, turns: options.turns ?? 1 }, angle) * Math.PI) / 180;
    const pin = /** @type {Page.Point} */ ([
      view.x(linkage.crank_mm * Math.cos(radians)),
      view.y(linkage.crank_mm * Math.sin(radians)),
    ]);
    const slider = /** @type {Page.Point} */ ([view.x(position), view.y(linkage.offset_mm)]);
    const pivot = /** @type {Page.Point} */ ([view.x(0), view.y(0)]);
    parts.move(
      pivot,
      pin,
      slider,
      motion.transmission_angle_deg && interpolatedValue(motion.transmission_angle_deg, angle),
      settled,
    );
    if (arrowed) parts.forces.move(pivot, pin, slider, angle);
    grips?.move(view, pin, slider, linkage);
  }

  const watcher = new ResizeObserver(
    () => Math.round(place.clientWidth) !== view?.width && arrange(),
  );
  watcher.observe(place);
  return {
    node,
    handle,
    /** @param {Page.Lengths} linkage @param {Api.Curves} motion @param {Options} options */
    show(linkage, motion, options = {}) {
      current = { linkage, motion, options };
      angle = options.angle ?? angle;
      arrange();
    },
    turn,
    /** @param {boolean} yes */
    fade: (yes) => node.classList.toggle("faded", yes),
    /** @param {boolean} yes */
    forces(yes) {
      arrowed = yes;
      parts.forces.node.toggleAttribute("hidden", !yes);
      turn(angle);
    },
    /** @param {number} x @param {number} y */
    angleAt(x, y) {
      if (!view) return angle;
      const [across, up] = placeIn(node, view, x, y);
      const pinAngle = current?.options.outlines?.lever?.pin_angle_deg ?? 0;
      return (Math.atan2(up, across) * 180) / Math.PI - pinAngle;
    },
    close: () => watcher.disconnect(),
  };
}

/** @param {Api.Curves} motion @param {Page.Point | undefined} angles @param {number} turns */
function deadCentres(motion, angles, turns) {
  const { low, high } = sliderRange(motion);
  const places = angles ?? [low.angle, high.angle];
  return places.map((angle) => ({
    angle: crankAt({ curves: motion, turns }, angle),
    position: interpolatedValue(motion.slider_position_mm, angle) ?? NaN,
  }));
}

/** Whether the slider is on the other side of the crank pin. @param {Page.Lengths} linkage @param {Api.Curves} motion @param {number} turns */
function crossed({ crank_mm: r }, motion, turns) {
  const place = turns === 2 ? 45 : 90;
  return (
    (interpolatedValue(motion.slider_position_mm, place) ?? 0) <
    r * Math.cos((crankAt({ curves: motion, turns }, place) * Math.PI) / 180) - 1e-9 * r
  );
}

/** Set numbers as attributes of an element. @type {(node: Element, numbers: Record<string, number>) => void} */
function measure(node, numbers) {
  for (const [name, number] of Object.entries(numbers)) node.setAttribute(name, String(number));
}

/** Moving parts; parts of a link are drawn in its coordinates, so that few elements move per frame. */
function movingParts() {
  const pin = () => svg("circle", { class: "pin" });
  const [crank, rod, block] = [
    svg("path", { class: "link crank" }),
    svg("path", { class: "link rod" }),
    svg("rect", { class: "slider", rx: 2 }),
  ];
  const pins = [pin(), pin(), pin()];
  const length = svg("text", { class: "length", "text-anchor": "middle" });
  const [more, actuator] = [attached(), cylinder()];
  const [crankGroup, rodGroup, sliderGroup] = [
    svg("g", {}, crank, more.body, pins[0], pins[1]),
    svg("g", {}, rod, pins[2], length),
    svg("g", {}, block),
  ];
  const normal = svg("path", { class: "transmission normal" });
  const arc = svg("path", { class: "transmission" });
  const value = svg("text", { class: "transmission" });
  const marked = svg("g", {}, normal, arc, value);
  const forces = arrows();
  let radius = 0; // of the arc
  let [beyond, inside] = [0, 0]; // places of the value: beyond the slider pin, or where that is 0 in the piston
  let lastWritten = 0; // time of the last written value
  let side = "";
  return {
    nodes: [more.rod, sliderGroup, rodGroup, actuator.node, crankGroup, marked, forces.node],
    forces,
    marked,
    /** @param {{ linkage: Page.Lengths, view: View, block: number, tall: number, outlines: Api.Outlines | undefined, link: number, written: boolean, crossed: boolean }} options */
    size({ linkage, view, block: size, tall, outlines, link, written, crossed }) {
      const [across, high] = [1.5 * size * view.unit, tall * view.unit];
      more.size(view, outlines, linkage.offset_mm);
      actuator.size(view, linkage, outlines?.lever, link);
      for (const one of [sliderGroup, rodGroup])
        one.toggleAttribute("hidden", Boolean(outlines?.lever));
      crank.setAttribute("d", bar(linkage.crank_mm * view.unit, link));
      rod.setAttribute("d", bar(linkage.rod_mm * view.unit, link));
      measure(block, { x: -across / 2, y: -high / 2, width: across, height: high });
      for (const one of pins) measure(one, { r: Math.max(2.5, 0.28 * link) });
      measure(pins[1], { cx: linkage.crank_mm * view.unit });
      measure(pins[2], { cx: linkage.rod_mm * view.unit });
      const long = linkage.rod_mm * view.unit;
      // In the rod, where the crank never covers it, and never upside down: on the crossed branch it points the other way.
      const words = `rod ${withUnit(linkage.rod_mm, "mm", 4)}`;
      const [from, wide] = [linkage.crank_mm * view.unit + link, 6.6 * words.length];
      length.textContent =
        written && link >= 13 && !outlines?.lever && from + wide < long - link ? words : "";
      length.setAttribute(
        "transform",
        `translate(${from + wide / 2} ${crossed ? -4 : 4})${crossed ? " rotate(180)" : ""}`,
      );
      const line = view.y(linkage.offset_mm);
      const room = Math.min(line, view.height - line) - 16; // above and below the slider line, with the value
      radius = Math.max(26, 0.54 * high + 14, Math.min(0.42 * long, 90, room)); // outside the guide
      side = "";
      [beyond, inside] = [outlines?.cylinders?.length ? 0 : across / 2 + 3, high / 2 - 9];
      value.toggleAttribute("hidden", beyond ? high < 14 : inside < link / 2 + 9);
    },
    /** @param {ReturnType<typeof leverAt>} at */
    moveLever({ pivot, pin, foot }) {
      crankGroup.setAttribute("transform", placed(pivot, pin));
      actuator.move(foot, pin);
    },
    /**
     * @param {Page.Point} pivot @param {Page.Point} crankPin @param {Page.Point} slider @param {number | null | undefined} degrees
     * @param {boolean} settled
     */
    move(pivot, crankPin, slider, degrees, settled) {
      crankGroup.setAttribute("transform", placed(pivot, crankPin));
      rodGroup.setAttribute("transform", placed(crankPin, slider));
      const there = `translate(${slider[0].toFixed(2)} ${slider[1].toFixed(2)})`;
      sliderGroup.setAttribute("transform", there);
      marked.setAttribute("transform", there);
      more.move(slider[0]);
      angleBetween([crankPin[0] - slider[0], crankPin[1] - slider[1]], degrees, settled);
    },
  };

  /**
   * Mark the angle between the rod and the normal of the slider line, on the rod's side. along: direction from the slider pin.
   * @param {Page.Point} along @param {number | null | undefined} degrees @param {boolean} settled
   */
  function angleBetween(along, degrees, settled) {
    const [away, up] = [along[0] < 0 ? 1 : -1, along[1] < 0 ? -1 : 1];
    const size = Math.hypot(...along) / radius;
    arc.setAttribute(
      "d",
      `M0 ${up * radius}A${radius} ${radius} 0 0 ${up * away > 0 ? 1 : 0} ${(along[0] / size).toFixed(1)} ${(along[1] / size).toFixed(1)}`,
    );
    if (side !== `${up} ${away}`) {
      side = `${up} ${away}`;
      normal.setAttribute("d", `M0 0v${up * (radius + 8)}`);
      // On the slider line, beyond the slider: no link, hatching or dimension is there. A piston has it in itself, off the rod.
      value.setAttribute(
        "transform",
        beyond ? `translate(${away * beyond} 4)` : `translate(0 ${4 - up * inside})`,
      );
      value.setAttribute("text-anchor", !beyond ? "middle" : away > 0 ? "start" : "end");
    }
    if (typeof degrees !== "number" || (!settled && performance.now() - lastWritten < EVERY))
      return;
    lastWritten = performance.now();
    value.textContent = `${text(degrees, "deg", 3)}°`;
  }
}
