/** The sketch beside the form: a linkage within the ranges, moving. */

import { h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { drawing } from "../mechanism/drawing.js";

const TURN = 4000; // ms of a turn

/** Return {node, show(example), swing(preview)}; show(null) takes the linkage away. swing: between its two ends, which stand still. @param {AbortSignal} signal */
export function sketch(signal) {
  const place = h("div", { class: "sketch" });
  const caption = h("p", { class: "quiet" });
  const button = h("button", {
    type: "button",
    hidden: true,
    onclick: () => {
      moving = !moving;
      label();
      if (moving) start();
      else drawn.turn(angle);
    },
  });
  const node = h("div", {}, place, h("div", { class: "row" }, caption, button));
  const drawn = drawing(place, { label: "A linkage within the ranges" });
  let moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  let way = 1;
  let angle = 40;
  /** @type {number | null} */
  let before = null;
  let shown = false;
  /** @type {[number, number] | null} */
  let ends = null; // of a swing, deg
  let share = 0; // of its ways forth and back
  const label = () => (button.textContent = moving ? "Pause" : "Move");
  label();
  /** @param {number} now */
  function step(now) {
    if (!moving || !shown || signal.aborted) {
      before = null;
      return;
    }
    if (before !== null && ends) {
      share = (share + (now - before) / TURN) % 1;
      angle = ends[0] + (ends[1] - ends[0]) * (0.5 - 0.5 * Math.cos(2 * Math.PI * share));
    } else if (before !== null) angle = (angle + (way * 360 * (now - before)) / TURN + 360) % 360;
    before = now;
    drawn.turn(angle, false);
    requestAnimationFrame(step);
  }
  const start = () => {
    if (before === null) requestAnimationFrame(step);
  };
  signal.addEventListener("abort", () => drawn.close());
  return {
    node,
    /** @param {Api.Example | null} example */
    show(example) {
      if (ends) [ends, angle] = [null, 40];
      node.classList.remove("swinging");
      shown = example !== null;
      place.hidden = button.hidden = !shown;
      if (!example) {
        caption.textContent = "No linkage of these ranges turns fully.";
        return;
      }
      way = example.clockwise ? -1 : 1;
      caption.textContent = example.feasible
        ? "One that meets all that was checked"
        : "One that turns, but does not meet every requirement";
      const { crank_mm, rod_mm, offset_mm, motion, slider_ends_mm } = example;
      drawn.show({ crank_mm, rod_mm, offset_mm }, motion, {
        direction: way,
        slider_ends_mm,
        angle,
      });
      drawn.fade(!example.feasible);
      drawn.turn(angle);
      if (moving) start();
    },
    /** @param {Api.SwingPreview} preview */
    swing({ example, from_deg, to_deg }) {
      shown = example !== null;
      place.hidden = button.hidden = !shown;
      if (!example || from_deg === null || to_deg === null) {
        caption.textContent = "No linkage of these ranges makes the swing.";
        return;
      }
      if (!ends || ends[0] !== from_deg || ends[1] !== to_deg) [angle, share] = [from_deg, 0];
      ends = [from_deg, to_deg];
      node.classList.add("swinging");
      const { crank_mm, rod_mm, offset_mm, motion, feasible, travel_mm, slider_ends_mm } = example;
      caption.textContent = `${feasible ? "One that meets all that was checked" : "One that makes the swing, but does not meet every requirement"}: from ${withUnit(from_deg, "deg")} to ${withUnit(to_deg, "deg")}, the slider travels ${withUnit(travel_mm, "mm")}`;
      drawn.show({ crank_mm, rod_mm, offset_mm }, motion, {
        direction: 0,
        dead_centres_deg: [from_deg, to_deg],
        slider_ends_mm,
        angle,
      });
      drawn.fade(!feasible);
      drawn.turn(angle);
      if (moving) start();
    },
  };
}
