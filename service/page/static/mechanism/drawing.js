/** A mechanism that moves: drawn once, then only moved. */

import { between, extremes } from "../charts/cycle.js";
import { fill, svg } from "../lib/dom.js";
import { text } from "../lib/numbers.js";
import { arrows } from "./arrows.js";
import { fitted, frameOf } from "./frame.js";
import { bar, placed, scenery } from "./scenery.js";

/**
 * Put a drawing into `place`; label: what a screen reader says of it. It fills the width of its place and returns
 * - show(linkage, motion, options): draw {crank_mm, rod_mm, offset_mm}; motion: curves {crank_angle_deg, slider_position_mm} over a
 *   turn from 0 deg, evenly spaced; with transmission_angle_deg its angle is written, with the forces of the API they are arrows.
 *   options: frame (of frame.js, to draw several at one scale), direction (1 counter-clockwise, -1 clockwise), dead_centres_deg
 *   ([inner, outer]; without them those of the curve), largest_force (N, drawn as the longest arrow; without it the greatest of the curves).
 * - turn(angle): set the crank to an angle in deg. - fade(yes): show that it is not what was asked for.
 * - forces(yes): show the arrows. - angleAt(x, y): the crank angle that points to a place on the screen. - node: the SVG. - close().
 */
export function drawing(place, { label }) {
  const node = svg("svg", { class: "mechanism", role: "img", "aria-label": label });
  const still = svg("g");
  const parts = movingParts();
  node.append(still, ...parts.nodes);
  place.append(node);
  let shown = null; // {linkage, motion, options}
  let view = null;
  let angle = 0;
  let arrowed = false;

  function arrange() {
    const width = Math.round(place.clientWidth);
    if (!shown || width < 60) return;
    const { linkage, motion, options } = shown;
    const own = frameOf(linkage, motion);
    view = fitted(options.frame ?? own, width);
    node.setAttribute("viewBox", `0 0 ${view.width} ${view.height}`);
    const link = Math.min(Math.max(0.05 * (linkage.crank_mm + linkage.rod_mm) * view.unit, 7), 20);
    fill(still, scenery({ linkage, centres: deadCentres(motion, options.dead_centres_deg), view, block: own.block, link, direction: options.direction ?? 1 }));
    parts.size({ linkage, view, block: own.block, link });
    parts.forces.size(motion, view, options.largest_force);
    turn(angle);
  }

  function turn(to) {
    angle = to;
    if (!view) return;
    const { linkage, motion } = shown;
    const position = between(motion.slider_position_mm, angle);
    const radians = (angle * Math.PI) / 180;
    const pin = [view.x(linkage.crank_mm * Math.cos(radians)), view.y(linkage.crank_mm * Math.sin(radians))];
    const slider = [view.x(position), view.y(linkage.offset_mm)];
    parts.move([view.x(0), view.y(0)], pin, slider, motion.transmission_angle_deg && between(motion.transmission_angle_deg, angle));
    if (arrowed) parts.forces.move([view.x(0), view.y(0)], pin, slider, angle);
  }

  const watcher = new ResizeObserver(() => Math.round(place.clientWidth) !== view?.width && arrange());
  watcher.observe(place);
  return {
    node,
    show(linkage, motion, options = {}) {
      shown = { linkage, motion, options };
      arrange();
    },
    turn,
    fade: (yes) => node.classList.toggle("faded", yes),
    forces(yes) {
      arrowed = yes;
      parts.forces.node.toggleAttribute("hidden", !yes);
      turn(angle);
    },
    angleAt(x, y) {
      const box = node.getBoundingClientRect();
      const factor = view.width / box.width;
      return (Math.atan2(view.y(0) - (y - box.top) * factor, (x - box.left) * factor - view.x(0)) * 180) / Math.PI;
    },
    close: () => watcher.disconnect(),
  };
}

function deadCentres(motion, angles) {
  const { low, high } = extremes(motion.slider_position_mm);
  const found = angles ?? [low.angle, high.angle];
  return found.map((angle) => ({ angle, position: between(motion.slider_position_mm, angle) }));
}

function movingParts() {
  const crank = svg("path", { class: "link crank" });
  const rod = svg("path", { class: "link rod" });
  const block = svg("rect", { class: "slider", rx: 2 });
  const pins = [0, 1, 2].map(() => svg("circle", { class: "pin" }));
  const normal = svg("path", { class: "transmission normal" });
  const arc = svg("path", { class: "transmission" });
  const value = svg("text", { class: "transmission" });
  const forces = arrows();
  let radius = 0; // of the arc
  return {
    nodes: [block, rod, crank, ...pins, normal, arc, value, forces.node],
    forces,
    size({ linkage, view, block: height, link }) {
      const size = height * view.unit;
      crank.setAttribute("d", bar(linkage.crank_mm * view.unit, link));
      rod.setAttribute("d", bar(linkage.rod_mm * view.unit, link));
      for (const [name, number] of Object.entries({ x: -0.75 * size, y: -0.5 * size, width: 1.5 * size, height: size })) block.setAttribute(name, number);
      for (const pin of pins) pin.setAttribute("r", Math.max(2.5, 0.28 * link));
      radius = Math.min(Math.max(0.42 * linkage.rod_mm * view.unit, 26), 90);
    },
    move(pivot, pin, slider, degrees) {
      crank.setAttribute("transform", placed(pivot, pin));
      rod.setAttribute("transform", placed(pin, slider));
      block.setAttribute("transform", `translate(${slider[0].toFixed(2)} ${slider[1].toFixed(2)})`);
      [pivot, pin, slider].forEach(([x, y], n) => pins[n].setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`));
      angleBetween(pin, slider, degrees);
    },
  };

  /** Mark the angle between the rod and the normal of the slider line, at the slider pin, on the rod's side. */
  function angleBetween(pin, slider, degrees) {
    const up = pin[1] < slider[1] ? -1 : 1;
    const away = pin[0] < slider[0] ? 1 : -1;
    const size = Math.hypot(pin[0] - slider[0], pin[1] - slider[1]);
    const end = [slider[0] + (radius * (pin[0] - slider[0])) / size, slider[1] + (radius * (pin[1] - slider[1])) / size];
    normal.setAttribute("d", `M${slider[0].toFixed(1)} ${slider[1].toFixed(1)}v${(up * (radius + 8)).toFixed(1)}`);
    const sweep = up * away > 0 ? 1 : 0;
    arc.setAttribute("d", `M${slider[0].toFixed(1)} ${(slider[1] + up * radius).toFixed(1)}A${radius} ${radius} 0 0 ${sweep} ${end[0].toFixed(1)} ${end[1].toFixed(1)}`);
    if (typeof degrees !== "number") return;
    value.textContent = `${text(degrees, "deg", 3)}°`;
    value.setAttribute("x", (slider[0] + away * 6).toFixed(1));
    value.setAttribute("y", (slider[1] + up * (radius + 2) + 4).toFixed(1));
    value.setAttribute("text-anchor", away > 0 ? "start" : "end");
  }
}
