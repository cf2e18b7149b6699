/** Refusals by the service in the words of the page: with titles of fields, and values in display units. */

import { Problem } from "./api.js";
import { keyOf, withUnit } from "./numbers.js";
import { capitalised, inWords } from "./words.js";

const OF_A_FIELD = /^(?:body|query|path) ([\w.]+): (.+)$/s;
const VALUE = /\b(at least|at most|above|below|got) "?(-?\d[\d.]*(?:e[+-]?\d+)?)"?(?=;|$)/g;

/** Return an error as a sentence; refusals by the service in the words of the page. @type {(error: unknown) => string} */
export function sentenceOf(error) {
  return error instanceof Problem
    ? refusalInWords(error.message)
    : error instanceof Error
      ? error.message
      : String(error);
}

/** Return a refusal in words, each of its lines a sentence. @param {string} detail */
export function refusalInWords(detail) {
  return detail
    .split("\n")
    .map((line) => capitalised(inWords(ofField(line.trim()))))
    .join(". ");
}

/** @param {string} line */
function ofField(line) {
  const refusal = OF_A_FIELD.exec(line);
  if (!refusal) return line;
  const { name, unit } = keyOf(refusal[1]);
  const rule = refusal[2].replace(
    VALUE,
    (_, word, value) => `${word} ${withUnit(Number(value), unit, 7)}`,
  );
  return `${name.replaceAll("_", " ").replaceAll(".", ", ")}${/^(?:must|is) /.test(rule) ? "" : ":"} ${rule}`;
}
