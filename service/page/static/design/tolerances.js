/** Effect of tolerances on the slider's position: spread of random machines, worst case, and its sources. */

import { histogram, tornado } from "../charts/bars.js";
import { fill, h } from "../lib/dom.js";
import { grouped, inShown, text, unitOf, withUnit } from "../lib/numbers.js";

/** Put the numbers of the API into `place`. @param {HTMLElement} place @param {Api.Tolerances} found @param {{ signal: AbortSignal }} given */
export function tolerances(place, found, { signal }) {
  const chart = h("div", {});
  const facts = h("div", {});
  const sources = h("div", {});
  fill(place, h("div", { class: "tolerance-columns" }, h("div", {}, chart, facts), sources));
  /** @type {{ close: () => void } | null} */
  let drawn = null;

  function draw() {
    drawn?.close();
    drawn = spread(chart, found);
    fill(facts, numbers(found));
    fill(sources, contributions(found));
  }

  draw();
  window.addEventListener("units", draw, { signal });
  signal.addEventListener("abort", () => drawn?.close(), { once: true });
}

/** @param {HTMLElement} place @param {Api.Tolerances} found */
function spread(
  place,
  { monte_carlo: simulated, worst_case_mm: worst, root_sum_square_mm: square },
) {
  const { histogram: bins, samples, stuck } = simulated;
  if (!bins) {
    fill(
      place,
      h(
        "p",
        { class: "quiet" },
        "None of the random machines turns fully: lengthen the rod, or narrow the tolerances.",
      ),
    );
    return { close() {} };
  }
  /** @param {number} value */
  const shown = (value) => inShown(value, "mm");
  const marks = [
    { value: shown(square), title: "root sum square" },
    { value: shown(worst), title: "worst case" },
    ...Object.entries(simulated.percentiles_greatest_mm)
      .slice(1, 2)
      .map(([percent, value]) => ({ value: shown(value), title: `${percent} % within` })),
  ];
  const holder = h("div", {});
  fill(
    place,
    h(
      "h3",
      {},
      `Greatest position error of ${grouped(samples - stuck)} random machines (${unitOf("mm")})`,
    ),
    holder,
  );
  const label = `Histogram of the greatest position error of random machines: half of them within ${withUnit(simulated.percentiles_greatest_mm["50"], "mm", 3)}, worst case ${withUnit(worst, "mm", 3)}.`;
  return histogram(holder, { edges: bins.edges_mm.map(shown), counts: bins.counts, marks, label });
}

/** @param {Api.Tolerances} found */
function numbers(found) {
  const {
    exact_worst_case_mm: exact,
    exact_worst_case_angle_deg: where,
    monte_carlo: { percentiles_greatest_mm: percentiles, stuck },
    yields,
  } = found;
  /** @param {number} size @param {number} angle */
  const at = (size, angle) => `${withUnit(size, "mm", 4)} at ${text(angle, "deg", 4)}°`;
  const rows = [
    ["worst case, first order", at(found.worst_case_mm, found.worst_case_angle_deg)],
    [
      "worst case, exact",
      exact === null || where === null
        ? "a linkage within the tolerances does not turn fully"
        : at(exact, where),
    ],
    ["root sum square", at(found.root_sum_square_mm, found.root_sum_square_angle_deg)],
    ...Object.entries(percentiles).map(([percent, value]) => [
      `${percent} % of the machines within`,
      withUnit(value, "mm", 4),
    ]),
    ...yields.map((one) => [
      `yield at ${withUnit(one.limit_mm, "mm", 4)} (${one.limit})`,
      `${one.yield_percent.toFixed(2)} %, between ${one.yield_low_percent.toFixed(2)} and ${one.yield_high_percent.toFixed(2)} %`,
    ]),
    ...(stuck ? [["do not turn fully", grouped(stuck)]] : []),
  ];
  return h(
    "dl",
    { class: "facts" },
    rows.map(([title, value]) => [h("dt", {}, title), h("dd", {}, value)]),
  );
}

/** @param {Api.Tolerances} found */
function contributions({ contributions: parts }) {
  /** @param {Api.Contribution} part */
  const limit = (part) =>
    part.limit_mm === null
      ? `${text(part.limit_deg, "deg", 3)}°`
      : withUnit(part.limit_mm, "mm", 3);
  /** @param {"share_of_worst_case_percent" | "share_of_variance_percent"} key @param {string} caption */
  const table = (key, caption) =>
    tornado(
      parts.map((part) => ({
        title: `${part.source}, ±${limit(part)}`,
        value: part[key],
        text: `${part[key].toFixed(1)} %`,
      })),
      {
        largest: Math.max(...parts.map((part) => part[key])),
        good: () => null,
        caption,
        signed: false,
      },
    );
  return [
    h("h3", {}, "What it comes from"),
    table("share_of_worst_case_percent", "of the worst case"),
    table("share_of_variance_percent", "of the variance"),
  ];
}
