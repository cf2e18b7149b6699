/** Allowable values that designs go beyond, in sentences. */

import { get } from "./api.js";
import { withUnit } from "./numbers.js";

/** @type {Promise<Api.Answer<"get", "quantities">> | null} */
let known = null;

/**
 * Return a sentence on each allowable value that is violated: "shear of the crank pin is 642 MPa, 440 MPa more than the allowed 202 MPa".
 * @param {Record<string, { value: Api.Row[string], by: number, verb?: string }>} violated by column: the value, and how far it is beyond
 * @returns {Promise<string[]>}
 */
export async function beyond(violated) {
  if (!Object.keys(violated).length) return [];
  known ??= get("quantities").catch((problem) => {
    known = null; // another time it may answer
    throw problem;
  });
  return (await known).quantities.filter(({ column }) => column in violated).map(({ column, title, unit, better, allowed_by: by }) => {
    const { value, by: far, verb = "is" } = violated[column];
    const low = better === "low";
    const allowed = Number(value) + (low ? -far : far);
    const limit = Number.isFinite(allowed) ? `the allowed ${withUnit(allowed, unit, 4)}` : "what is allowed";
    const cause = low || Number(value) > 0 ? "" : ": a pin as wide as its bar, or wider, leaves nothing of the bar";
    return `${title} ${verb} ${withUnit(value, unit, 4)}, ${withUnit(far, unit, 4)} ${low ? "more" : "less"} than ${limit} (${by})${cause}`;
  });
}
