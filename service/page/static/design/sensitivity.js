/** Sensitivity of each objective to each dimension, as a tornado. */

import { tornado } from "../charts/bars.js";
import { fill, h } from "../lib/dom.js";
import { fromShown, inShown, unitOf } from "../lib/numbers.js";

const DIMENSIONS = ["crank", "rod", "offset"];
const MEASURES = [
  { key: "percent", title: () => "% of the objective for 1 % more of a dimension" },
  { key: "per_mm", title: () => `for 1 ${unitOf("mm")} more of a dimension` },
  { key: "tolerance", title: () => "for the tolerance of a dimension" },
];

/**
 * Put the tornado into `place`; quantities: of the API; objectives: of the job, shown first.
 * @param {HTMLElement} place @param {Api.Sensitivity} found @param {{ objectives: Api.Objective[], signal: AbortSignal }} given
 */
export function sensitivity(place, { quantities }, { objectives, signal }) {
  const wanted = objectives.map(({ quantity }) => quantity);
  const own = wanted.flatMap((name) => quantities.find((one) => one.quantity === name) ?? []);
  const rest = quantities.filter(
    (one) =>
      !wanted.includes(one.quantity) &&
      one.value !== null &&
      DIMENSIONS.some((name) => one[`${name}_per_mm`]),
  );
  const measures = MEASURES.filter(({ key }) =>
    own.concat(rest).some((one) => DIMENSIONS.some((name) => one[`${name}_${key}`])),
  );
  let measure = measures[0];
  let all = false;
  const bars = h("div", { class: "tornados" });
  const choice = h(
    "select",
    {
      onchange: (event) => {
        measure = measures[Number(event.currentTarget.value)];
        draw();
      },
    },
    measures.map((_, n) => h("option", { value: n })),
  );
  const whole = h("input", {
    type: "checkbox",
    onchange: () => {
      all = whole.checked;
      draw();
    },
  });
  fill(
    place,
    h(
      "div",
      { class: "row" },
      h("label", {}, "Change ", choice),
      h("label", {}, whole, " all quantities"),
    ),
    bars,
    h(
      "p",
      { class: "quiet hint" },
      "To first order, the other dimensions as they are. The longest bar matters most. Below and above: at a kink, the derivatives on either side of the dimension.",
    ),
  );

  function draw() {
    const shown = all ? [...own, ...rest] : own;
    const relative = measure.key === "percent";
    const more = measure.key === "per_mm" ? fromShown(1, "mm") : 1; // of a dimension, that the rates are for
    measures.forEach(({ title }, n) => (choice.options[n].textContent = title()));
    /** @param {Api.Sensitive} one @param {string} name @returns {number | null} */
    const value = (one, name) => rateOf(one[`${name}_${measure.key}`], more);
    /** @param {Api.Sensitive} one @param {string} name @returns {number | null} */
    const below = (one, name) =>
      rateOf(one[`${name}_${measure.key}_below`], more) ?? value(one, name);
    /** @param {Api.Sensitive} one @param {string} name */
    const size = (one, name) =>
      Math.max(Math.abs(value(one, name) ?? 0), Math.abs(below(one, name) ?? 0));
    const common = Math.max(...own.flatMap((one) => DIMENSIONS.map((name) => size(one, name))));
    fill(
      bars,
      shown.map((one) => {
        const objective = objectives.find(({ quantity }) => quantity === one.quantity);
        const largest =
          relative && objective ? common : Math.max(...DIMENSIONS.map((name) => size(one, name)));
        const unit = relative ? "%" : unitOf(one.unit);
        /** @type {(above: number, under: number) => boolean} */
        const kinked = (above, under) =>
          Math.abs(above - under) > 1e-9 * Math.max(Math.abs(above), Math.abs(under));
        /** @param {number | null} number */
        const text = (number) =>
          number === null
            ? "–"
            : `${signed(relative ? number : inShown(number, one.unit))} ${unit}`;
        /** @param {number} number */
        const good = (number) =>
          !objective || objective.sense === "target"
            ? null
            : number > 0 === (objective.sense === "maximise");
        /** @param {string} name */
        const row = (name) => {
          const [above, under] = [value(one, name), below(one, name)];
          return above !== null && under !== null && kinked(above, under)
            ? {
                title: name,
                value: Math.abs(under) > Math.abs(above) ? under : above,
                text: `below ${text(under)}, above ${text(above)}`,
                kink: true,
              }
            : { title: name, value: above, text: text(above) };
        };
        return tornado(DIMENSIONS.map(row), { largest, good, caption: one.title });
      }),
    );
  }

  draw();
  window.addEventListener("units", draw, { signal });
}

/** Return a rate of the API times the change that it is for; null for what is none. @param {Api.Row[string] | undefined} cell @param {number} change */
function rateOf(cell, change) {
  return typeof cell === "number" ? change * cell : null;
}

/** @param {number} number */
function signed(number) {
  if (number === 0) return "0";
  return `${number > 0 ? "+" : "−"}${Number(Math.abs(number).toPrecision(3))}`;
}
