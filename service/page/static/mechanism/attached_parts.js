/** Parts attached to the linkage: cylinders around pistons, the actuator of the slider, a body on the crank. */

import { svg } from "../lib/dom.js";

/** @import { View } from "./frame.js" */

const SHARE = 0.3; // thickness of the actuator's rod, of its barrel

/** Return bore and head of a cylinder, open at its other end. @param {View} view @param {Api.Outlines["cylinders"][0]} of @param {number} e */
export function walls({ x, y }, { bore_mm: bore, foot_mm: foot, head_mm: head }, e) {
  const [low, high] = [y(e - bore / 2), y(e + bore / 2)].map((at) => at.toFixed(2));
  return svg("path", {
    class: "cylinder",
    d: `M${x(foot).toFixed(2)} ${low}H${x(head).toFixed(2)}V${high}H${x(foot).toFixed(2)}`,
  });
}

/** Return the barrel of an actuator. @param {View} view @param {NonNullable<Api.Outlines["actuator"]>} of @param {number} e */
export function barrel({ x, y, unit }, { face_mm: face, foot_mm: foot, width_mm: width }, e) {
  const left = Math.min(face, foot);
  return svg("rect", {
    class: "actuator",
    x: x(left),
    y: y(e + width / 2),
    width: unit * Math.abs(foot - face),
    height: unit * width,
    rx: 2,
  });
}

/** Parts that move with the links: the actuator's rod, behind the slider, and the body on the crank. */
export function attached() {
  const rod = svg("rect", { class: "actuator" });
  const square = svg("rect", { class: "body", rx: 2 });
  const cross = svg("path", { class: "body" });
  const body = svg("g", { class: "body" }, square, cross);
  /** @type {(x: number) => void} */
  let push = () => {};
  return {
    /** Draw before the slider. */
    rod,
    /** In the coordinates of the crank. */
    body,
    /** @param {View} view @param {Api.Outlines | undefined} outlines @param {number} e */
    size(view, outlines, e) {
      const { actuator, body: carried } = outlines ?? {};
      rod.toggleAttribute("hidden", !actuator);
      body.toggleAttribute("hidden", !carried);
      push = () => {};
      if (actuator) {
        const [face, thick] = [view.x(actuator.face_mm), SHARE * actuator.width_mm * view.unit];
        rod.setAttribute("y", String(view.y(e) - thick / 2));
        rod.setAttribute("height", String(thick));
        push = (x) => {
          rod.setAttribute("x", Math.min(x, face).toFixed(2));
          rod.setAttribute("width", Math.abs(face - x).toFixed(2));
        };
      }
      if (!carried) return;
      // On the screen y points down.
      const [u, v, half] = [carried.along_mm, -carried.across_mm, carried.side_mm / 2].map(
        (mm) => mm * view.unit,
      );
      for (const [name, number] of Object.entries({
        x: u - half,
        y: v - half,
        width: 2 * half,
        height: 2 * half,
      }))
        square.setAttribute(name, String(number));
      const [mark, hole] = [half / 2, 0.3 * half];
      cross.setAttribute(
        "d",
        `${outlines?.lever ? `M0 0L${u} ${v}` : ""}M${u - mark} ${v}h${2 * mark}M${u} ${v - mark}v${2 * mark}M${u - hole} ${v}a${hole} ${hole} 0 1 0 ${2 * hole} 0a${hole} ${hole} 0 1 0 ${-2 * hole} 0`,
      );
    },
    /** Move with the slider pin, in pixels. @param {number} x */
    move: (x) => push(x),
  };
}
