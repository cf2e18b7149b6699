/** A question to a design: a form made from what it may be asked with, and its answer as sentences, tables and figure. */

import { address, get, isAbort, statusOf } from "../lib/api.js";
import { link } from "../lib/address.js";
import { blocks } from "../lib/blocks.js";
import { fill, formOf, h, numberField } from "../lib/dom.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { apiSystem, readySystem, unitOf } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

/** @typedef {Pick<Api.Topic, "title" | "inputs" | "figure">} Asked */

/**
 * Return {node, ask}. ask(lengths): asks for the design, or one with other lengths. path: of the API; job: that can be changed where it
 * lacks something; button: what it says.
 * @param {Asked} of @param {{ path: string, job: string, button?: string, signal: AbortSignal }} given
 */
export function question({ title, inputs, figure }, { path, job, button = "Compute", signal }) {
  const fields = inputs.map((one) => ({ ...one, field: fieldOf(one), after: h("span", {}) }));
  const answer = h("div", {});
  let turn = 0;
  /** @type {Page.Numbers | null} */
  let lengths = null;

  /** Return what was typed, by key in the units of the API, null for what is usual; or what is wrong with it. */
  function given() {
    const typed = fields.map(({ key, unit, words, required, example, title: name, field }) => {
      if (words.length) return { key, value: field.value || null };
      const { value = null, wrong, empty } = parseQuantity(field.value, unit);
      const lacks = empty && required && `${name}: a value is needed, such as ${example}.`;
      return { key, value, wrong: wrong || lacks };
    });
    const wrong = typed.map((one) => one.wrong).find(Boolean);
    return { wrong, values: Object.fromEntries(typed.map(({ key, value }) => [key, value])) };
  }

  /** @param {Page.Numbers | null} [other] */
  async function ask(other = lengths) {
    lengths = other;
    const own = (turn += 1);
    const { values, wrong } = given();
    if (wrong) return fill(answer, h("p", { class: "bad", role: "alert" }, wrong));
    fill(answer, h("p", { class: "quiet busy", role: "status" }, "Computing …"));
    const options = { ...lengths, units: apiSystem(), ...values };
    try {
      const [found] = await Promise.all([
        get(/** @type {`jobs/${string}/designs/${string}/trade-offs`} */ (path), options, signal),
        readySystem(),
      ]);
      if (own !== turn) return;
      const picture =
        figure && h("img", { src: address(`${path}.svg`, options), alt: `Figure: ${title}` });
      fill(
        answer,
        h("div", { class: "answer" }, h("div", {}, blocks(found.blocks, title)), picture),
      );
      if (picture) await picture.decode().catch(() => picture.remove());
    } catch (error) {
      if (own !== turn || isAbort(error)) return;
      const lacks = statusOf(error) === 422;
      fill(
        answer,
        h(
          "p",
          { class: lacks ? "quiet" : "error" },
          `${sentenceOf(error)}. `,
          lacks && h("a", { href: link(["new"], { from: job }) }, "Change the job"),
        ),
      );
    }
  }

  const sayUnits = () =>
    fields.forEach(({ unit, after }) => (after.textContent = unit && ` ${unitOf(unit)}`));
  sayUnits();
  window.addEventListener(
    "units",
    () => {
      sayUnits();
      if (turn) ask();
    },
    { signal },
  );
  const form = formOf(
    ask,
    fields.map((one) => h("label", { title: one.help }, `${one.title} `, one.field, one.after)),
    h("button", {}, button),
  );
  form.classList.add("row");
  return { node: h("div", { class: "question" }, inputs.length > 0 && form, answer), ask };
}

/** @param {Api.Topic["inputs"][number]} input */
function fieldOf({ key, usual, example, words }) {
  return words.length
    ? h(
        "select",
        { name: key },
        !usual && h("option", { value: "" }, "as in the job"),
        words.map((word) => h("option", { selected: word === usual }, word)),
      )
    : numberField({ name: key, placeholder: usual || example });
}
