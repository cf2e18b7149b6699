/** Round numbers for a design: a step for each length, the best rounded neighbours and what each of them costs. */

import { isAbort, post } from "../lib/api.js";
import { link } from "../lib/address.js";
import { fill, h } from "../lib/dom.js";
import { system, unitOf, withUnit } from "../lib/numbers.js";
import { read } from "../lib/typed.js";
import { rankOf } from "./objectives.js";
import { difference, scrolled } from "./numbers.js";
import { sentenceOf } from "../lib/refusals.js";

/** @type {[keyof Page.Lengths, string][]} */
const LENGTHS = [["crank_mm", "Crank"], ["rod_mm", "Rod"], ["offset_mm", "Offset"]];
const USUAL = { si: "0.5", inch: "1/64" }; // mm, in: what drawings and stock are made to
const COUNT = 5;

/**
 * Put the steps into `place`. base: row of the design; ranges: of the API, fixed lengths have both ends alike. Returns {draw()}: anew,
 * in other units.
 * @param {HTMLElement} place
 * @param {{
 *   job: string, number: number, base: Api.Row, requirements: Api.Requirements, objectives: Api.Objective[], signal: AbortSignal,
 * }} given
 */
export function rounding(place, { job, number, base, requirements, objectives, signal }) {
  const { ranges, names } = requirements;
  const titles = new Map(requirements.requirements.map(({ column, title }) => [names[column] ?? column, title]));
  const free = LENGTHS.filter(([key]) => ranges[key] && ranges[key][0] < ranges[key][1]);
  const fields = h("div", { class: "steps" });
  const wrong = h("p", { class: "bad", role: "alert", hidden: true });
  const answer = h("div", { "aria-live": "polite" });
  const button = h("button", {}, "Find round numbers");
  const form = h("form", { novalidate: true, onsubmit: (event) => { event.preventDefault(); ask(); } }, fields, button, wrong);
  fill(place, h("h2", {}, "Round it"),
    h("p", { class: "quiet hint" }, "The best designs of round numbers near this one that keep every requirement. Without a step a length stays as it is."), form, answer);
  place.hidden = free.length === 0;
  /** @type {{ key: keyof Page.Lengths, name: string, input: HTMLInputElement, said: HTMLElement }[]} */
  let inputs = [];
  let turn = 0;

  function draw() {
    inputs = free.map(([key, title]) => {
      const id = `step-${key}`;
      const said = h("p", { class: "bad", id: `${id}-wrong` });
      /** @type {HTMLInputElement} */
      const input = h("input", { id, type: "text", inputmode: "decimal", class: "number", autocomplete: "off", value: USUAL[system()], "aria-describedby": `${id}-wrong`, oninput: () => say(input, said, "") });
      return { key, name: title, input, said };
    });
    fill(fields, inputs.map(({ name, input, said }) => h("div", { class: "step" }, h("label", { for: input.id }, `${name}, step`), input, h("span", { class: "quiet" }, unitOf("mm")), said)));
    fill(answer);
    refuse("");
  }

  /** Say what is wrong with all of it; nothing with an empty sentence. @param {string} sentence */
  function refuse(sentence) {
    wrong.textContent = sentence;
    wrong.hidden = sentence === "";
  }

  /** @param {HTMLInputElement} input @param {HTMLElement} place @param {string} sentence */
  function say(input, place, sentence) {
    place.textContent = sentence;
    if (sentence) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
  }

  /** Return the steps as the service takes them; null where a field is wrong. @returns {string[] | null} */
  function steps() {
    let fine = true;
    const found = inputs.flatMap(({ key, input, said, name }) => {
      const typed = read(input.value, { unit: unitOf("mm"), factors: { mm: 1, in: 25.4 } });
      if (typed.empty) return [];
      const value = Number(typed.number);
      const unit = typed.number === undefined ? "" : typed.unit;
      const sentence = typed.wrong ?? (value > 0 && Number.isFinite(value) ? "" : `The step of the ${name.toLowerCase()} is a length above 0, such as ${USUAL[system()]}; leave it empty to keep the length.`);
      say(input, said, sentence);
      if (sentence && fine) input.focus();
      fine &&= !sentence;
      return [`${key.replace("_mm", "")}=${typed.number} ${unit}`];
    });
    return fine ? found : null;
  }

  async function ask() {
    const to = steps();
    fill(answer);
    refuse(to?.length === 0 ? "No length has a step; write one of them." : "");
    if (!to?.length) return;
    const own = (turn += 1);
    button.disabled = true;
    try {
      const found = await post(`jobs/${job}/designs/${number}/rounded`, { to, count: COUNT }, { signal });
      if (own === turn) tell(/** @type {Api.Rounded} */ (/** @type {unknown} */ (found.rounded)));
    } catch (error) {
      if (own !== turn || isAbort(error)) return;
      refuse(`${sentenceOf(error).replace(/^To must/, "A step must")}.`);
      fill(answer);
    } finally {
      if (own === turn) button.disabled = false;
    }
  }

  /** @param {Api.Rounded} found */
  function tell(found) {
    const heads = ["", ...LENGTHS.map(([, title]) => title), ...objectives.map(({ title }) => title), "Requirements"];
    const lines = found.designs.map((row, n) => h("tr", {},
      h("td", {}, h("a", { class: "button", href: link(["jobs", job, "designs", number], Object.fromEntries(LENGTHS.map(([key]) => [key, Number(row[key])]))), "aria-label": `Apply round numbers ${n + 1}` }, "Apply")),
      LENGTHS.map(([key]) => h("td", { class: "number", "data-key": key, "data-value": String(row[key]) }, withUnit(row[key], "mm", 7))),
      objectives.map((objective) => cost(row, objective)),
      h("td", {}, judged(row))));
    fill(answer, h("p", { class: found.met ? null : "bad" }, `${found.message.charAt(0).toUpperCase()}${found.message.slice(1)}.`),
      found.designs.length > 0 && scrolled("Round numbers and what they cost", h("table", {}, h("caption", { class: "hidden" }, "Round numbers and what they cost"),
        h("thead", {}, h("tr", {}, heads.map((title, n) => h("th", { scope: "col", class: n && n < heads.length - 1 ? "number" : null }, title || h("span", { class: "hidden" }, "Apply"))))), h("tbody", {}, lines))));
  }

  /** @param {Api.RoundedRow} row @param {Api.Objective} objective */
  function cost(row, objective) {
    const [before, after] = [base[objective.column], row[objective.column]];
    const gain = rankOf(before, objective) - rankOf(after, objective);
    const by = difference(after, before);
    return h("td", { class: "number", "data-key": objective.column, "data-value": String(after) }, withUnit(after, objective.unit), h("div", { class: by === "=" || !gain ? "quiet" : gain > 0 ? "good" : "bad" }, by));
  }

  /** @param {Api.RoundedRow} row */
  function judged({ missed, tightest }) {
    /** @param {string} name */
    const title = (name) => titles.get(name) ?? name.replaceAll("_", " ");
    if (missed.length) return h("span", { class: "bad" }, `misses ${missed.map(title).join(" and ")}`);
    return h("span", { class: "quiet" }, tightest ? `tightest: ${title(tightest)}` : "all kept");
  }

  draw();
  return { draw };
}
