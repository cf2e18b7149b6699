/** Parsing of typed quantities into API units: "37,5", "2*19", "1 1/2 in". */

import { fromDisplayUnit, plainUnitOf, unitOf } from "./numbers.js";
import { parseNumber } from "./number_text.js";
import { kindOf, measureOf } from "./units.js";

/** @typedef {{ value: number, said: string | null, wrong?: undefined, empty?: undefined } | { wrong: string, value?: undefined, empty?: undefined } | { empty: true, value?: undefined, wrong?: undefined }} Measured */

/**
 * Return {value, said} with the value in the API unit and an explanation unless it is obvious; {wrong} with a sentence; or {empty}. A
 * number without a unit is in the display unit.
 * @param {string} typed @param {string} unit of the API @returns {Measured}
 */
export function parseQuantity(typed, unit) {
  const displayUnit = plainUnitOf(unit);
  const kind = kindOf(displayUnit);
  const parsed = parseNumber(typed, { unit: displayUnit, ...measureOf(kind) });
  if (parsed.empty) return { empty: true };
  const value =
    parsed.number !== undefined && parsed.unit === displayUnit
      ? fromDisplayUnit(Number(parsed.number), unit)
      : NaN;
  if (parsed.number !== undefined && Number.isFinite(value)) return { value, said: parsed.said };
  return {
    wrong:
      parsed.wrong ??
      `“${typed.trim()}” is not a valid ${kind ?? "number"}; write a number${displayUnit ? `, in ${unitOf(unit)} or with its unit` : ""}.`,
  };
}
