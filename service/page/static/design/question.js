/** Question about a design: a form with its inputs, and its answer as sentences, tables and figure. */

import { address, get, isAbort, post, statusOf } from "../lib/api.js";
import { link } from "../lib/address.js";
import { blocks } from "../lib/blocks.js";
import { fill, formOf, h, numberField } from "../lib/dom.js";
import { apiSystem, inDisplayUnit, readySystem, text, unitOf } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { sentenceOf } from "../lib/refusals.js";

/** @typedef {Pick<Api.Topic, "title" | "inputs" | "figure"> & { posted?: boolean }} Asked */

/**
 * Values of inputs by path and key, in API units, kept for the next time that a view is shown.
 * @type {Map<string, string | number | string[] | null>}
 */
const entered = new Map();
window.addEventListener("hashchange", () => entered.clear());

/**
 * Return {node, ask}. ask(lengths): asks for the design, or for one with other lengths. path: path in the API. job: job to edit if it
 * lacks something. button: title of the button. initial: values of inputs in API units. action(answer, n): last cell of row n in the
 * tables.
 * @param {Asked} of
 * @param {{ path: string, job: string, button?: string, initial?: Record<string, number>, action?: (answer: any, n: number) => Dom.Child, signal: AbortSignal }} options
 */
export function question(
  { title, inputs, figure, posted = false },
  { path, job, button = "Compute", initial = {}, action, signal },
) {
  const fields = inputs.map((input) => ({
    ...input,
    field: fieldOf(input, entered.get(`${path} ${input.key}`) ?? initial[input.key] ?? null),
  }));
  const answer = h("div", { "aria-live": "polite" });
  let turn = 0;
  /** @type {Page.Numbers | null} */
  let lengths = null;

  /** Return the values of the inputs by key in API units, null for defaults. Throws an Error for an invalid one. */
  const read = () =>
    Object.fromEntries(
      fields.map(({ key, unit, words, several, required, example, title: name, field }) => {
        const {
          value = null,
          wrong,
          empty,
        } = words.length
          ? { value: field.value || null, wrong: "", empty: false }
          : several
            ? { value: listOf(field.value), wrong: "", empty: !field.value.trim() }
            : parseQuantity(field.value, unit);
        if (wrong) throw new Error(wrong);
        if (empty && required) throw new Error(`${name}: a value is needed, such as ${example}.`);
        entered.set(`${path} ${key}`, value);
        return [key, value];
      }),
    );

  /** @param {Page.Numbers | null} [other] */
  async function ask(other = lengths) {
    lengths = other;
    const request = (turn += 1);
    fill(answer, h("p", { class: "quiet busy", role: "status" }, "Computing …"));
    try {
      const query = { ...lengths, units: apiSystem() };
      const options = { ...query, ...(posted ? {} : read()) };
      const [found] = await Promise.all([
        posted
          ? post(/** @type {`jobs/${string}/designs/${number}/like`} */ (path), read(), {
              query: { units: query.units },
              signal,
            })
          : get(
              /** @type {`jobs/${string}/designs/${string}/trade-offs`} */ (path),
              options,
              signal,
            ),
        readySystem(),
      ]);
      if (request !== turn) return;
      const picture =
        figure && h("img", { src: address(`${path}.svg`, options), alt: `Figure: ${title}` });
      const nodes = blocks(found.blocks, title, action && ((n) => action(found, n)));
      fill(answer, h("div", { class: "answer" }, h("div", {}, nodes), picture));
      if (picture) await picture.decode().catch(() => picture.remove());
    } catch (error) {
      if (request !== turn || isAbort(error)) return;
      const lacks = statusOf(error) === 422;
      fill(
        answer,
        h(
          "p",
          { class: lacks ? "quiet" : "error", role: inputs.length ? "alert" : null },
          sentenceOf(error).replace(/\.?$/, ". "),
          lacks && h("a", { href: link(["new"], { from: job }) }, "Change the job"),
        ),
      );
    }
  }

  const form = formOf(
    ask,
    fields.map(({ title: name, help, field, unit }) =>
      h(
        "label",
        { title: help },
        `${name} `,
        field,
        h("span", { class: "quiet" }, unit && ` ${unitOf(unit)}`),
      ),
    ),
    h("button", {}, button),
  );
  form.classList.add("row");
  return { node: h("div", { class: "question" }, inputs.length > 0 && form, answer), ask };
}

/** Return the texts between semicolons. @param {string} typed */
function listOf(typed) {
  return typed
    .split(";")
    .map((text) => text.trim())
    .filter(Boolean);
}

/** @param {Api.Topic["inputs"][number]} input @param {string | number | string[] | null} value in the unit of the API */
function fieldOf({ key, unit, usual, example, words, several }, value) {
  if (several)
    return h("input", {
      type: "text",
      name: key,
      placeholder: example.replaceAll('"', ""),
      autocomplete: "off",
      value: Array.isArray(value) ? value.join("; ") : "",
    });
  return words.length
    ? h(
        "select",
        { name: key },
        !usual && h("option", { value: "" }, "as in the job"),
        words.map((word) => h("option", { selected: word === (value ?? usual) }, word)),
      )
    : numberField({
        name: key,
        placeholder: unit
          ? text(parseQuantity(usual || example, unit).value ?? "", unit)
          : usual || example,
        value:
          value === null ? "" : String(Number(inDisplayUnit(Number(value), unit).toPrecision(8))),
      });
}
