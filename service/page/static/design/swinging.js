/** The swing of a design: what drives it, its ends and energies, and the extremes of its curves. */

import { get, isAbort } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { readySystem, text, unitOf, valueOf } from "../lib/numbers.js";
import { extremeRows, HEADS, numbersTable } from "./extremes.js";
import { sentenceOf } from "../lib/refusals.js";
import { capital } from "../lib/words.js";
import { headedRow, numberCell, scrolled } from "../lib/table.js";

/** @type {Record<string, string>} */
const TITLES = {
  start_crank_angle: "crank angle at the start",
  end_crank_angle: "crank angle at the end",
  start_slider_position: "slider position at the start",
  end_slider_position: "slider position at the end",
};
const LEFT_OUT = ["crank_mm", "rod_mm", "offset_mm", "duration_s"];

/**
 * Put the numbers of the swing into `place`; its record is what the API has for the job's own swing.
 * @param {HTMLElement} place @param {{ job: string, number: number, signal: AbortSignal }} given
 */
export async function swinging(place, { job, number, signal }) {
  const body = h(
    "div",
    { class: "panel" },
    h("p", { class: "quiet busy", role: "status" }, "Computing …"),
  );
  fill(place, h("h2", {}, "The swing"), body);
  try {
    const [{ swing }] = await Promise.all([
      get(`jobs/${job}/designs/${number}/swing`, {}, signal),
      readySystem(),
    ]);
    const found = /** @type {Api.Swing} */ (/** @type {unknown} */ (swing));
    const draw = () =>
      fill(
        body,
        how(found),
        scrolled("Numbers of the swing", numbers(found)),
        h("h3", {}, "Extremes over both ways"),
        scrolled(
          "Extremes of every curve",
          numbersTable("Extremes of every curve", HEADS, extremeRows(found.extremes)),
        ),
        found.notes.map((note) => h("p", { class: "quiet hint" }, `${capital(note)}.`)),
      );
    draw();
    window.addEventListener("units", draw, { signal });
  } catch (error) {
    if (!isAbort(error)) fill(body, h("p", { class: "error" }, sentenceOf(error)));
  }
}

/** @param {Api.Swing} found */
function how({ driver, law, duration_s: seconds, holds_by_friction: holds }) {
  const moves = law === "slow" ? "slowly" : `law ${law}, ${text(seconds, "s")} s each way`;
  return h(
    "p",
    {},
    `Driven at the ${driver}, ${moves}. ${holds ? "Friction alone holds it, all over." : ""}`,
  );
}

/** @param {Api.Swing} found */
function numbers(found) {
  const rows = Object.entries(found).flatMap(([key, value]) => {
    if (
      typeof value !== "number" ||
      LEFT_OUT.includes(key) ||
      key.includes("_at_crank_angle") ||
      key.includes("_at_slider_position")
    )
      return [];
    const name = nameOf(key);
    const { unit } = valueOf(found, name);
    const at = found[`${name}_at_crank_angle_deg`];
    const way = found[`${name}_way`];
    const where =
      typeof at === "number"
        ? `${typeof way === "string" ? `${way}, ` : ""}at ${text(at, "deg", 4)}°`
        : "";
    return [
      headedRow(
        TITLES[name] ?? name.replaceAll("_", " "),
        numberCell(key, value, text(value, unit)),
        h("td", { class: "quiet" }, unitOf(unit)),
        h("td", { class: "quiet" }, where),
      ),
    ];
  });
  return numbersTable("Numbers of the swing", ["Number", "value", "Unit", "Where"], rows);
}

/** Return a key without its unit. @param {string} key */
function nameOf(key) {
  return key.replace(/_(deg|mm|N|Nm|W|J)$/, "");
}
