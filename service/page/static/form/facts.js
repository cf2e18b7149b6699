/** Values that the ranges allow, beside the form, in the reader's units. */

import { isConstant } from "../lib/constant.js";
import { fill, h } from "../lib/dom.js";
import { capitalised, inWords } from "../lib/words.js";
import { inDisplayUnits, limitText, unitOf, withUnit } from "../lib/numbers.js";

/**
 * Fill a place with the findings of a preview. apply(change): called for a change that resolves a warning.
 * @param {HTMLElement} place @param {Api.Preview} preview @param {(change: Api.Change) => void} apply
 */
export function showFacts(place, { allowed, understood, swing, example }, apply) {
  const open = place.querySelector("details")?.open; // as the user left it
  const changes = [...(understood?.changes ?? []), ...(allowed?.changes ?? [])];
  /** @param {string} sentence */
  const warning = (sentence) => {
    const change = changes.find((one) => one.sentence === sentence);
    return h(
      "div",
      { class: "warning" },
      h("p", {}, `${capitalised(inWords(sentence))}.`),
      change &&
        h("button", { type: "button", onclick: () => apply(change) }, inDisplayUnits(change.label)),
    );
  };
  const warnings = [...(understood?.warnings ?? []), ...(allowed?.said ?? [])].map(warning);
  if (swing) {
    fill(
      place,
      warnings,
      h(
        "dl",
        { class: "terms" },
        row(
          Number(swing.to_deg) - Number(swing.from_deg) > 359 ? "rotates fully" : "makes the swing",
          share(swing.closing_share, Boolean(swing.example)),
          "of the ranges",
        ),
        row(
          `travel of the ${swing.example?.outlines ? "cylinder" : "slider"}`,
          between(swing.travel_mm, "mm"),
        ),
        row("meets everything", share(swing.feasible_share, swing.example?.feasible), tried(swing)),
      ),
      notesOf(swing.unchecked, understood, open),
    );
    return;
  }
  if (!allowed) {
    fill(
      place,
      h(
        "p",
        { class: "quiet" },
        "Give valid ranges of crank, rod and offset to see what they allow.",
      ),
    );
    return;
  }
  fill(
    place,
    warnings,
    h(
      "dl",
      { class: "terms" },
      row("rotates fully", share(allowed.turning_share, Boolean(example)), "of the ranges"),
      allowed.stroke_mm && row("strokes", between(allowed.stroke_mm, "mm")),
      allowed.time_ratio && row("time ratios", between(allowed.time_ratio, "")),
      allowed.transmission_angle_deg &&
        row("transmission angles", between(allowed.transmission_angle_deg, "deg")),
      row(
        allowed.unchecked.length ? "meets all checked" : "meets everything",
        share(allowed.feasible_share, example?.feasible),
        tried(allowed),
      ),
      allowed.slow_strokes.length ? row("slow stroke", allowed.slow_strokes.join(" or ")) : null,
    ),
    notesOf(allowed.unchecked, understood, open),
  );
}

/** @param {string} title @param {Dom.Child} value @param {string | null} note */
function row(title, value, note = null) {
  return [
    h("dt", {}, title),
    h("dd", {}, value, note ? h("span", { class: "quiet" }, ` ${note}`) : null),
  ];
}

/** @param {string[]} unchecked @param {Api.Understood | null} understood @param {boolean | undefined} open */
function notesOf(unchecked, understood, open) {
  return [
    unchecked.length
      ? h(
          "p",
          { class: "quiet" },
          `Checked only by the search: ${unchecked.map((name) => name.replaceAll("_", " ")).join(", ")}.`,
        )
      : null,
    (understood?.notes ?? []).map((sentence) =>
      h("p", { class: "note" }, `${capitalised(inWords(sentence))}.`),
    ),
    understood
      ? h(
          "details",
          { class: "more", open },
          h("summary", {}, "What was understood"),
          understanding(understood),
        )
      : null,
  ];
}

/** @param {Api.Understood} understood */
function understanding(understood) {
  /** @type {[string, string[]][]} */
  const parts = [
    ["Given", understood.given],
    ["Tolerances", understood.tolerances],
    ["Variables", understood.variables],
    ["Requirements", understood.rules],
    ["Objectives", understood.objectives],
    ["Search", [understood.search]],
  ];
  return parts
    .filter(([, lines]) => lines.length)
    .map(([title, lines]) => [
      h("h3", {}, title),
      h(
        "ul",
        {},
        lines.map((line) => h("li", {}, inDisplayUnits(line))),
      ),
    ]);
}

/** State which designs a fraction of feasible designs counts. @param {{ sampled: number, met_by_all: string[] }} sample */
function tried({ sampled, met_by_all }) {
  const names = met_by_all.map((name) => name.replaceAll("_", " "));
  return `of ${sampled} tried${names.length ? `, all with the requested ${inWords(names.join(" and "))}` : ""}`;
}

/** Format a fraction of samples. found: whether a feasible design is known. @param {number} value @param {boolean} [found] */
function share(value, found = false) {
  if ((value > 0 || found) && value < 0.01) return "under 1 %";
  return value > 0.99 && value < 1 ? "over 99 %" : `${Math.round(100 * value)} %`;
}

/** @param {readonly number[] | null} ends @param {string} unit */
function between(ends, unit) {
  if (!ends) return "none";
  const [low, high] = ends;
  if (isConstant(low, high)) return withUnit(low, unit);
  const sign = unitOf(unit);
  return `${limitText(low, unit, "up", 4)} to ${limitText(high, unit, "down", 4)}${sign && sign !== "°" ? "\u00a0" : ""}${sign}`;
}
