/** Allowable values that the designs of a view go beyond. */

import { isAbort } from "../lib/api.js";
import { beyond } from "../lib/beyond.js";
import { fill, h } from "../lib/dom.js";
import { sayProblem } from "../lib/notices.js";

/** @type {WeakMap<HTMLElement, Page.Machine[]>} */
const latest = new WeakMap();

/**
 * Say in `place` which allowable values designs violate, and by how much; of several designs, whose they are.
 * @param {HTMLElement} place @param {Page.Machine[]} designs
 */
export async function showBeyond(place, designs) {
  latest.set(place, designs);
  try {
    const lines = await Promise.all(designs.map(async ({ name, row, violated }) => {
      const found = Object.fromEntries(Object.entries(violated).map(([key, by]) => [key, { value: row[key], by: Number(by) }]));
      return (await beyond(found)).map((sentence) => `${name}, beyond what is allowed: ${sentence}.`);
    }));
    if (latest.get(place) === designs) fill(place, lines.flat().map((line) => h("p", { class: "error" }, line)));
  } catch (problem) {
    if (!isAbort(problem)) sayProblem(problem);
  }
}
