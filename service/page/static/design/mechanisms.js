/** Mechanisms that move together, with their controls: play, speed, crank angle, forces. */

import { interpolatedValue, crankAt, positionOfAngle } from "../charts/cycle.js";
import { fill, h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { ARROWS, forceAt, largestForce, scaleOf } from "../mechanism/arrows.js";
import { drawing } from "../mechanism/drawing.js";
import { lengthsOf } from "./loading.js";
import { frameAround, frameOf } from "../mechanism/frame.js";

/**
 * @import { Grips } from "../mechanism/grips.js"
 * @import { playback as playbackOf } from "../mechanism/playback.js"
 */

const EVERY = 100; // ms between two readouts of forces while it moves
/** Labels of the cycle's slider and its units, by the revolutions per cycle. */
const WORDS = [
  [
    "Back and forth",
    "Drag the crank, or use the arrow keys or Page Up and Page Down to move it back and forth.",
  ],
  [
    "Crank angle",
    "Drag the crank, or change the crank angle with the arrow keys (1°) or Page Up and Page Down (10°).",
  ],
  [
    "Crank angle",
    "Drag the crank, or change the crank angle with the arrow keys (2°) or Page Up and Page Down (20°); a cycle is two turns.",
  ],
];
const GRIPS =
  "Drag the crank pin, the slider or the guide, or select one with Tab and use the arrow keys or Page Up and Page Down.";
/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }; // deg

/**
 * Put mechanisms into `place`, and their playback controls into `strip`. Returns show(machines), faded(yes) and close(). machines: {name,
 * series, row, curves, centres, sliderEnds} of each, drawn at one scale; readouts are for the first. turns: crank revolutions per cycle,
 * 0 for a swing. grips: grips for dragging the lengths of a single mechanism without forces.
 * @param {HTMLElement} place @param {HTMLElement} strip @param {ReturnType<typeof playbackOf>} turning @param {number} turns
 * @param {Grips | null} [grips]
 */
export function mechanismsPanel(place, strip, turning, turns, grips = null) {
  const [named, hint] = WORDS[turns];
  const drawn = h("div", { class: "machines" });
  /** @type {Page.Machine[]} */
  let machines = [];
  /** @type {ReturnType<typeof drawing>[]} */
  let drawings = [];
  const toggle = h(
    "button",
    {
      type: "button",
      class: "primary play",
      onclick: () => (turning.playing ? turning.pause() : turning.play()),
    },
    "Play",
  );
  const angle = h("input", {
    type: "range",
    min: 0,
    max: 360,
    step: 1,
    "aria-label": named,
    onkeydown: byKey,
    oninput: (event) => hold(Number(event.currentTarget.value)),
  });
  const angleText = h("output", { class: "number angle" });
  const where = h("output", { class: "number where" });
  const pace = h(
    "select",
    { onchange: (event) => turning.choose(turning.paces[Number(event.currentTarget.value)]) },
    turning.paces.map((one, n) =>
      h("option", { value: n, selected: one === turning.pace }, one.title),
    ),
  );
  const forces = h("input", { type: "checkbox", onchange: showForces });
  const sizes = ARROWS.map(() => h("span", { class: "number" }));
  const legend = h(
    "ul",
    { class: "legend forces", hidden: true },
    ARROWS.map(({ name, title }, n) => h("li", { class: name }, `${title} `, sizes[n])),
  );
  const largest = h("span", { class: "quiet" });
  fill(
    place,
    drawn,
    h(
      "div",
      { class: "row controls" },
      h("label", {}, "Playback ", pace),
      !grips && h("label", {}, forces, " Forces"),
      largest,
    ),
    legend,
    h("p", { class: "quiet hint" }, grips ? GRIPS : hint),
  );

  fill(
    strip,
    toggle,
    h("label", { class: "crank-angle" }, h("span", {}, named), angle),
    angleText,
    where,
  );

  /** @param {number} to */
  function hold(to) {
    turning.pause();
    turning.set(to);
  }

  /** @param {KeyboardEvent} event */
  function byKey(event) {
    const step = KEYS[event.key];
    if (!step) return;
    event.preventDefault();
    hold(Math.round(turning.angle) + step);
  }

  function showForces() {
    legend.toggleAttribute("hidden", !forces.checked);
    for (const picture of drawings) picture.forces(forces.checked);
    const greatest = Math.max(...machines.map(({ curves }) => largestForce(curves)));
    fill(largest, forces.checked ? scaleOf(greatest) : "");
    showSizes(turning.angle);
  }

  /** Write the forces of the first mechanism, including those too small for an arrow. @param {number} at */
  function showSizes(at) {
    if (!forces.checked || !machines.length) return;
    ARROWS.forEach(
      (arrow, n) =>
        (sizes[n].textContent = withUnit(forceAt(arrow, machines[0].curves, at), "N", 4)),
    );
  }

  /** @param {Page.Machine[]} shown */
  function show(shown) {
    const again = shown.length === drawings.length;
    machines = shown;
    if (!again) {
      drawings.forEach((one) => one.close());
      const places = machines.map(() => h("div", { class: "machine" }));
      fill(drawn, places);
      drawings = places.map((each, n) =>
        draggable(drawing(each, { label: "", grips }), (at) =>
          hold(positionOfAngle(machines[n], at, turning.angle)),
        ),
      );
    }
    [...legend.children].forEach((item, n) =>
      item.toggleAttribute(
        "hidden",
        !ARROWS[n].along.some((key) => key && machines[0].curves[key]),
      ),
    );
    const frame = frameAround(
      machines.map(({ row, curves, outlines }) => frameOf(lengthsOf(row), curves, outlines)),
    );
    const greatest = Math.max(...machines.map(({ curves }) => largestForce(curves)));
    machines.forEach(({ name, series, row, curves, centres, sliderEnds, arc, outlines }, n) => {
      const picture = drawings[n];
      const holder = /** @type {HTMLElement} */ (picture.node.parentElement);
      holder.dataset.series = String(series);
      picture.node.setAttribute(
        "aria-label",
        `${name}: crank ${withUnit(row.crank_mm, "mm", 4)}, rod ${withUnit(row.rod_mm, "mm", 4)}, offset ${withUnit(row.offset_mm, "mm", 4)}`,
      );
      if (machines.length > 1) {
        const title =
          holder.querySelector(".machine-name") ??
          holder.insertBefore(h("p", { class: "machine-name" }), picture.node);
        title.textContent = name;
      }
      picture.show(lengthsOf(row), curves, {
        frame: machines.length > 1 ? frame : undefined,
        direction: turning.direction,
        dead_centres_deg: centres,
        slider_ends_mm: sliderEnds,
        arc,
        largest_force: greatest,
        turns,
        outlines,
      });
      picture.turn(turning.angle);
    });
    showForces();
    updateControls(turning);
  }

  /** @param {{ angle: number, playing: boolean }} state */
  function updateControls({ angle: at, playing }) {
    for (const picture of drawings) picture.turn(at, !playing);
    if (!machines.length) return;
    angle.value = String(at);
    const words = `${Math.round(crankAt(machines[0], at)) % (turns === 2 ? 720 : 360)}°`.replace(
      "-",
      "−",
    );
    if (angleText.textContent !== words) angleText.textContent = words;
    const position = interpolatedValue(machines[0].curves.slider_position_mm, at);
    const slider = `${machines[0].outlines?.lever ? "cylinder" : "slider at"} ${withUnit(position, "mm", 4)}`;
    where.textContent = slider;
    const now = performance.now();
    if (playing && now - since < EVERY) return;
    since = now;
    showSizes(at);
    if (playing) return;
    angle.setAttribute("aria-valuetext", `${words}, ${slider}`);
  }

  /** @type {boolean | null} */
  let was = null;
  let since = 0;
  turning.listen((state) => {
    updateControls(state);
    if (state.playing === was) return;
    was = state.playing;
    toggle.textContent = was ? "Pause" : "Play";
  });
  return {
    show,
    fade: (/** @type {boolean} */ yes) => drawings.forEach((one) => one.fade(yes)),
    close: () => drawings.forEach((one) => one.close()),
  };
}

/**
 * Make the crank of a drawing draggable; hold(angle): called with each angle.
 * @param {ReturnType<typeof drawing>} one @param {(angle: number) => void} hold
 */
function draggable(one, hold) {
  const { handle } = one;
  let isDragged = false;
  one.node.classList.add("draggable");
  handle.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    handle.setPointerCapture(event.pointerId);
    isDragged = true;
    hold(one.angleAt(event.clientX, event.clientY));
  });
  handle.addEventListener(
    "pointermove",
    (event) => isDragged && hold(one.angleAt(event.clientX, event.clientY)),
  );
  for (const end of ["pointerup", "pointercancel"])
    handle.addEventListener(end, () => (isDragged = false));
  return one;
}
