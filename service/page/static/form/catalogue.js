/** Choices between options, such as gearmotors from a catalogue: a pasted table with one option per row. */

import { h } from "../lib/dom.js";
import { plain } from "./controls.js";
import { field } from "./field.js";
import { at, idOf, isTable } from "./path.js";

const MOST_NAMES = 6; // names of options
const EXAMPLE = "name,peak_torque max (N m),price (EUR),maker\nGM 40,40,310,A\nGM 90,90,450,B";
const WHY =
  "One row per option. The first line names the columns: name, then limits such as “peak_torque max (N m)”, numbers of the job such as “mechanism.slider.mass (kg)”, and values to store with each design, such as “price (EUR)” or a maker. Stored numbers may be objectives or requirements. An empty cell sets no limit. Columns that begin with # are skipped.";

/** Return the fields of the choices and a button that adds one. @param {Form.Whole} form */
export function choices(form) {
  const jobValue = form.at(["choice"]);
  const all = Array.isArray(jobValue) ? jobValue : [];
  const add = h(
    "button",
    {
      type: "button",
      id: "add-choice",
      onclick: () => {
        form.put(["choice", all.length], { name: `catalogue ${all.length + 1}`, table: "" });
        form.redraw(idOf(["choice", all.length, "table"], "c"));
      },
    },
    all.length ? "Add another catalogue" : "Add a catalogue",
  );
  return [all.map((one, place) => row(form, one, place, all)), h("p", { class: "wide" }, add)];
}

/** Return the choices in one line. @param {Form.Whole} form */
export function choicesGiven(form) {
  const jobValue = form.at(["choice"]);
  return (Array.isArray(jobValue) ? jobValue : [])
    .map((one) => `${at(one, ["name"])}: ${counted(one)}`)
    .join(", ");
}

/** Return how many rows or options a choice has, in words. @param {unknown} one */
function counted(one) {
  const table = at(one, ["table"]);
  const lines =
    typeof table === "string" ? table.split("\n").filter((line) => line.trim()).length - 1 : 0;
  const options = optionsOf(one).length;
  const [count, word] = options ? [options, "option"] : [Math.max(lines, 0), "row"];
  return `${count} ${word}${count === 1 ? "" : "s"}`;
}

/** @param {unknown} one @returns {unknown[]} */
function optionsOf(one) {
  const options = at(one, ["option"]);
  return Array.isArray(options) ? options : [];
}

/** @param {Form.Whole} form @param {unknown} one @param {number} place @param {unknown[]} all */
function row(form, one, place, all) {
  const path = ["choice", place];
  const names = optionsOf(one).map((option) => String(at(option, ["name"])));
  const more = names.length > MOST_NAMES ? ` and ${names.length - MOST_NAMES} more` : "";
  const has = h("p", { class: "quiet wide", role: "status" });
  /** @param {unknown} choice */
  const say = (choice) =>
    has.replaceChildren(
      `${counted(choice)}${names.length ? `: ${names.slice(0, MOST_NAMES).join(", ")}${more}` : ""}.`,
    );
  say(one);
  const text = h("textarea", {
    id: idOf([...path, "table"], "c"),
    rows: 5,
    class: "points",
    spellcheck: "false",
    placeholder: EXAMPLE,
    oninput: () => {
      const now = form.at(path);
      if (text.value === begun && at(now, ["table"]) === at(one, ["table"])) return; // unchanged: still the table of its file
      names.length = 0;
      const {
        option: _,
        rows: __,
        file: ___,
        ...rest
      } = /** @type {Record<string, unknown>} */ (isTable(now) ? now : {});
      const choice = { ...rest, table: text.value };
      form.put(path, choice);
      say(choice);
    },
  });
  text.value = String(at(one, ["table"]) ?? "");
  const tableField = field(
    form,
    [...path, "table"],
    names.length ? "a table in place of these" : "table",
    [text],
    WHY,
    { wide: true },
  );
  const begun = text.value; // browsers normalise line ends
  const drop = h(
    "button",
    {
      type: "button",
      "aria-label": `Remove catalogue ${place + 1}`,
      onclick: () => {
        form.put(
          ["choice"],
          all.length > 1 ? all.filter((_, other) => other !== place) : undefined,
        );
        form.redraw("add-choice");
      },
    },
    "Remove",
  );
  return h(
    "fieldset",
    { class: "inner" },
    h("legend", {}, `Catalogue ${place + 1}`),
    h(
      "div",
      { class: "fields" },
      plain(form, [...path, "name"], {
        control: "text",
        label: "what is chosen",
        why: "Letters, digits, spaces, - and _; the heading of its column in the table of designs.",
      }),
      has,
      tableField,
    ),
    h("p", {}, drop),
  );
}
