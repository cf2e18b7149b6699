/** Choices between options, such as gearmotors of a catalogue: a table to paste, a row an option. */

import { isAbort, post } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { plain } from "./controls.js";
import { field } from "./field.js";
import { at, idOf, isTable } from "./path.js";
import { sentenceOf } from "../lib/refusals.js";

const WAIT = 400; // ms after the last letter until the table is read
const SHOWN = 6; // names of options
const EXAMPLE = "name,peak_torque max (N m),mechanism.slider.mass (kg)\nGM 40,40,1.2\nGM 90,90,1.6";
const WHY = "One row an option, the first line its columns: name, then limits such as “peak_torque max (N m)” or numbers of the job such as “mechanism.slider.mass (kg)”. Columns that begin with # are passed over. Rows that another one beats in everything are left out.";

/** Return the fields of the choices, and a button for another one. @param {Form.Whole} form */
export function choices(form) {
  const given = form.at(["choice"]);
  const all = Array.isArray(given) ? given : [];
  const add = h("button", { type: "button", id: "add-choice" }, all.length ? "Add another catalogue" : "Add a catalogue");
  add.addEventListener("click", () => {
    form.put(["choice", all.length], { name: `catalogue ${all.length + 1}`, option: [] });
    form.redraw(idOf(["choice", all.length, "option"], "c"));
  });
  return [all.map((one, place) => row(form, one, place, all)), h("p", { class: "wide" }, add)];
}

/** Return what there is to choose from, in a line. @param {Form.Whole} form */
export function choicesGiven(form) {
  const given = form.at(["choice"]);
  return (Array.isArray(given) ? given : []).map((one) => `${at(one, ["name"])}: ${counted(optionsOf(one).length)}`).join(", ");
}

/** @param {number} count */
function counted(count) {
  return count === 1 ? "1 option" : `${count} options`;
}

/** @param {unknown} one @returns {unknown[]} */
function optionsOf(one) {
  const options = at(one, ["option"]);
  return Array.isArray(options) ? options : [];
}

/** @param {Form.Whole} form @param {unknown} one @param {number} place @param {unknown[]} all */
function row(form, one, place, all) {
  const path = ["choice", place];
  const options = optionsOf(one);
  const rows = at(one, ["rows"]);
  const names = options.map((option) => String(at(option, ["name"])));
  const more = names.length > SHOWN ? ` and ${names.length - SHOWN} more` : "";
  const has = h("p", { class: "quiet wide", role: "status" }, options.length ? `${counted(options.length)}${rows === undefined ? "" : ` of ${rows} rows`}: ${names.slice(0, SHOWN).join(", ")}${more}.` : "No options yet.");
  const text = h("textarea", { id: idOf([...path, "option"], "c"), rows: 5, class: "points", spellcheck: "false", placeholder: EXAMPLE });
  const made = field(form, [...path, "option"], options.length ? "another table in place of these" : "table", [text], WHY, { wide: true });
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @type {AbortController | null} */
  let asked = null;
  text.addEventListener("input", () => {
    clearTimeout(timer);
    asked?.abort();
    delete text.dataset.wrong;
    if (text.value.trim()) timer = setTimeout(read, WAIT);
  });
  const read = async () => {
    const mine = (asked = new AbortController());
    try {
      const own = Object.keys(form.at(["quantity"]) ?? {});
      const found = await post("catalogue", { table: text.value.trim(), own }, { signal: mine.signal });
      if (!text.isConnected) return;
      form.put(path, { ...(isTable(one) ? one : {}), option: found.option, rows: found.rows });
      form.redraw();
    } catch (problem) {
      if (isAbort(problem) || !text.isConnected) return;
      text.dataset.wrong = sentenceOf(problem).replace(/^The table,? ?/, "");
      form.put([...path, "option"], form.at([...path, "option"])); // so that it is said
    }
  };
  const drop = h("button", { type: "button", "aria-label": `Remove catalogue ${place + 1}` }, "Remove");
  drop.addEventListener("click", () => {
    form.put(["choice"], all.length > 1 ? all.filter((_, other) => other !== place) : undefined);
    form.redraw("add-choice");
  });
  return h("fieldset", { class: "inner" }, h("legend", {}, `Catalogue ${place + 1}`), h("div", { class: "fields" }, plain(form, [...path, "name"], { control: "text", label: "what is chosen", why: "Letters, digits, spaces, - and _; the table of designs has it." }), has, made), h("p", {}, drop));
}
