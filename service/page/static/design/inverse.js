/** Crank angles that put the slider at a position, each with a button that turns the crank there. */

import { fill, h } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";
import { question } from "./question.js";

/**
 * Put the form into `place`. of: the question. positions: slider positions over the cycle, mm. turnTo(angle): turns the crank to an
 * angle, deg.
 * @param {HTMLElement} place @param {Api.Topic} of
 * @param {{ path: string, job: string, positions: (number | null)[], turnTo: (angle: number) => void, signal: AbortSignal }} options
 */
export function inverseForm(place, of, { path, job, positions, turnTo, signal }) {
  const defined = positions.filter((one) => one !== null);
  const [low, high] = [Math.min(...defined), Math.max(...defined)];
  /** @param {{ inverse: Api.Inverse }} answer @param {number} n */
  const action = ({ inverse }, n) => {
    const angle = inverse.solutions[n].crank_angle_deg;
    return h(
      "button",
      {
        type: "button",
        onclick: () => turnTo(angle),
        "aria-label": `Turn the crank to ${withUnit(angle, "deg", 6)}`,
      },
      "Turn there",
    );
  };
  const form = question(
    { ...of, title: "Crank angles" },
    {
      path: `${path}/${of.path}`,
      job,
      button: "Find crank angles",
      initial: { slider_position_mm: Number(((low + high) / 2).toPrecision(4)) },
      action,
      signal,
    },
  );
  fill(
    place,
    h("h2", {}, "From slider position to crank angle"),
    h(
      "div",
      { class: "panel" },
      form.node,
      h(
        "p",
        { class: "quiet hint" },
        `The slider of this design is between ${text(low, "mm")} and ${withUnit(high, "mm")} from the crank pivot. Enter a velocity to get the crank speed, and also an acceleration to get the crank acceleration. Slider values are positive along +x, as in the curves above; crank values are positive counter-clockwise.`,
      ),
    ),
  );
}
