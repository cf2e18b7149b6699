/** Formulas in a job: as requirements, as objectives, or with names. */

import { byId, fill, focused, h } from "../lib/dom.js";
import { bounds } from "./bounds.js";
import { completing } from "./completion.js";
import { plain } from "./controls.js";
import { field } from "./field.js";
import { objectiveField } from "./objective.js";
import { at, idOf, isTable, put, withRenamedKey, pathText } from "./path.js";
import { say } from "./typed_number.js";
import { join, kinds, usual } from "../lib/units.js";

const WHY =
  "A formula such as offset - 2 * crank or max(peak_torque, 3 N m). It may contain quantities, crank, rod, offset, extra variables, + - * / **, brackets and functions. Names are suggested as you type.";
const NAME = /^[a-z][a-z0-9_]*$/;

/** Return the formulas among the keys of a table of the job. @param {Form.Whole} form @param {string} table */
function formulasOf(form, table) {
  return Object.keys(form.at([table]) ?? {}).filter(
    (key) =>
      key !== "slow_stroke" &&
      !(
        form.quantities.has(key) &&
        (table === "constraints" || form.schema.property([table, key]))
      ),
  );
}

/** Return the rows of formulas in requirements, and a button that adds one. @param {Form.Whole} form */
export function formulaRequirements(form) {
  return rows(form, "constraints", { max: "" }, (spot, kind, label, again) => {
    const { keys, inputs, controls } = bounds(form, spot, { label, kind, again });
    return { controls, parts: keys.map((key, place) => ({ key, input: inputs[place] })) };
  });
}

/** Return the rows of formulas as objectives, and a button that adds one. @param {Form.Whole} form */
export function formulaObjectives(form) {
  return rows(form, "objectives", "minimise", (spot, kind, label, again) => {
    const controls = objectiveField(form, spot, { title: label, kind, again });
    const input = controls.find((one) => one instanceof HTMLInputElement);
    return { controls, parts: input ? [{ key: "target", input }] : [] };
  });
}

/**
 * @typedef {{ controls: HTMLElement[], parts: { key: string, input: HTMLElement }[] }} Asked
 *
 * @param {Form.Whole} form @param {string} table @param {unknown} first what a new one begins with
 * @param {(spot: Form.Spot, kind: string | null, label: string, again: () => void) => Asked} asked what is asked of it
 */
function rows(form, table, first, asked) {
  const keys = formulasOf(form, table);
  const what = table === "constraints" ? "requirement" : "objective";
  const add = h(
    "button",
    {
      type: "button",
      id: `add-${what}-formula`,
      onclick: () => {
        if (!keys.includes("")) form.put([table, ""], structuredClone(first));
        form.redraw(idOf([table, "formula", formulasOf(form, table).indexOf("")], "c"));
      },
    },
    `Add a formula as ${what === "objective" ? "an" : "a"} ${what}`,
  );
  return [
    keys.length
      ? h(
          "div",
          { class: "fields formulas" },
          keys.map((key, place) => row(form, table, key, place, asked, what)),
        )
      : null,
    h("p", {}, add),
  ];
}

/**
 * @param {Form.Whole} form @param {string} table @param {string} key @param {number} place
 * @param {(spot: Form.Spot, kind: string | null, label: string, again: () => void) => Asked} asked @param {string} what
 */
function row(form, table, key, place, asked, what) {
  const id = [table, "formula", place];
  /** @type {Form.Spot} */
  const spot = { path: [table, key], id };
  const label = `formula ${place + 1}, ${what}`;
  const input = h("input", {
    type: "text",
    id: idOf(id, "c"),
    value: key,
    autocomplete: "off",
    class: "formula",
    placeholder: "offset - 2 * crank",
    oninput: () => {
      delete input.dataset.wrong;
      delete input.dataset.said;
      const typed = input.value.trim().replace(/^=\s*/, "");
      const before = String(spot.path[1]);
      if (typed === before) return form.put(spot.path, form.at(spot.path));
      if (/^\d*$/.test(typed) && typed)
        input.dataset.wrong = "A formula must contain a name, such as crank.";
      else if (typed in /** @type {object} */ (form.at([table]) ?? {}))
        input.dataset.wrong = `“${typed}” is already an objective or has a bound; change that entry.`;
      else {
        form.rename([table], before, typed, node);
        spot.path = [table, typed];
        return;
      }
      form.put(spot.path, form.at(spot.path)); // to have it checked again
    },
  });
  const below = h("div", { class: "field-controls asked" });
  let kind = kindAt(form, spot.path);
  /** @type {Set<string>} */
  const early = new Set(); // bounds typed before the formula's kind was known
  /** Give a number typed without a unit the default unit of its field. @param {string} key @param {string} now */
  const withUnit = (key, now) => {
    const bound = form.at([...spot.path, key]);
    if (typeof bound === "number") form.put([...spot.path, key], join(String(bound), usual(now)));
  };
  const draw = () => {
    const focus = focused(below)?.id;
    form.forget((one) => below.contains(one.node));
    const begun = form.at(spot.path);
    const changed = () =>
      Object.entries(form.at(spot.path) ?? {}).forEach(
        ([bound, value]) => value !== at(begun, [bound]) && early.add(bound),
      );
    const { controls, parts } = asked(spot, kind, label, draw);
    fill(
      below,
      controls,
      parts.map(({ key: part, input: of }) => {
        const error = h("p", { class: "error", id: `${of.id}-error`, hidden: true });
        const path = [...spot.path, part];
        form.register({ path, key: pathText(path), node: of, controls: [of], error });
        if (kind === null) of.addEventListener("input", changed);
        return error;
      }),
      drop,
    );
    if (focus) byId(focus)?.focus();
  };
  const drop = h(
    "button",
    {
      type: "button",
      "aria-label": `Remove ${label}`,
      onclick: () => {
        form.put(spot.path, undefined);
        form.redraw(`add-${what}-formula`);
      },
    },
    "Remove",
  );
  const node = field(form, spot.path, label, [completing(input, form)], WHY, { wide: true });
  node.querySelector(".field-controls")?.after(below);
  draw();
  watch(
    form,
    node,
    input,
    () => spot.path,
    (now) => {
      if (now === kind) return;
      if (kind === null && now !== null) for (const key of early) withUnit(key, now);
      kind = now;
      early.clear();
      draw();
    },
  );
  return node;
}

/**
 * Show the unit of a formula below it after each check by the service; changed(kind): called with the kind of its values.
 * @param {Form.Whole} form @param {HTMLElement} made @param {HTMLInputElement} input @param {() => Form.Path} path @param {(kind: string | null) => void} changed
 */
function watch(form, made, input, path, changed) {
  const tell = () => {
    const checkedFormula = form.said?.formulas.find((one) => one.path === pathText(path()));
    if (checkedFormula?.kind)
      input.dataset.said = !checkedFormula.unit
        ? "a number without a unit"
        : kinds().includes(checkedFormula.kind)
          ? `${checkedFormula.kind}, in ${checkedFormula.unit}`
          : checkedFormula.kind;
    else delete input.dataset.said;
    say(input);
    if (checkedFormula) changed(kindAt(form, path()));
  };
  const formulaField = form.fields.find(({ node }) => node === made);
  if (formulaField) formulaField.tell = tell;
  tell();
}

/**
 * Return the kind of a formula's values as reported by the service; null while unknown, and for a kind without units in forms.
 * @param {Form.Whole} form @param {Form.Path} path
 */
function kindAt(form, path) {
  const checkedFormula = form.said?.formulas.find((one) => one.path === pathText(path));
  return checkedFormula?.kind && kinds().includes(checkedFormula.kind) ? checkedFormula.kind : null;
}

/** Return the fields of named formulas, and a button that adds one. @param {Form.Whole} form */
export function namedFormulas(form) {
  const all = Object.entries(form.at(["quantity"]) ?? {})
    .filter(([, part]) => isTable(part) && "formula" in part)
    .map(([name]) => name);
  const add = h(
    "button",
    {
      type: "button",
      id: "add-named-formula",
      onclick: () => {
        const taken = Object.keys(form.at(["quantity"]) ?? {});
        const name =
          Array.from({ length: taken.length + 1 }, (_, n) => `formula_${n + 1}`).find(
            (one) => !taken.includes(one),
          ) ?? "formula";
        form.put(["quantity", name], { formula: "" });
        form.redraw(idOf(["quantity", all.length, "name"], "c"));
      },
    },
    "Add a formula with a name",
  );
  return [all.map((name, place) => named(form, name, place)), h("p", { class: "wide" }, add)];
}

/** Return the names of the named formulas. @param {Form.Whole} form */
export function namesGiven(form) {
  return Object.entries(form.at(["quantity"]) ?? {})
    .filter(([, part]) => isTable(part) && "formula" in part)
    .map(([name, part]) => String(at(part, ["title"]) ?? name));
}

/** @param {Form.Whole} form @param {string} name @param {number} place */
function named(form, name, place) {
  const path = ["quantity", name];
  const label = `formula with a name ${place + 1}`;
  const called = h("input", {
    type: "text",
    id: idOf(["quantity", place, "name"], "c"),
    value: name,
    autocomplete: "off",
    spellcheck: "false",
    onchange: () => {
      const typed = called.value.trim();
      delete called.dataset.wrong;
      if (!NAME.test(typed))
        called.dataset.wrong =
          "A name must have lower-case letters, digits and underscores, and begin with a letter.";
      else if (typed !== name && typed in /** @type {object} */ (form.at(["quantity"]) ?? {}))
        called.dataset.wrong = `Another formula is already called “${typed}”.`;
      if (called.dataset.wrong) return form.put(path, form.at(path));
      if (typed === name) return;
      setTimeout(() => {
        // after the focus has moved, so that a clicked control is not redrawn before its click
        renameFormula(form, name, typed);
        form.redraw();
      });
    },
  });
  const input = h("input", {
    type: "text",
    id: idOf(["quantity", place, "formula"], "c"),
    value: String(form.at([...path, "formula"]) ?? ""),
    autocomplete: "off",
    class: "formula",
    placeholder: "offset - crank",
    oninput: ({ currentTarget }) =>
      form.put([...path, "formula"], currentTarget.value.trim().replace(/^=\s*/, "")),
  });
  const formulaField = field(
    form,
    [...path, "formula"],
    "formula",
    [completing(input, form)],
    WHY,
    {
      wide: true,
    },
  );
  watch(
    form,
    formulaField,
    input,
    () => [...path, "formula"],
    () => {},
  );
  const drop = h(
    "button",
    {
      type: "button",
      "aria-label": `Remove ${label}`,
      onclick: () => {
        form.put(path, undefined);
        form.redraw("add-named-formula");
      },
    },
    "Remove",
  );
  return h(
    "fieldset",
    { class: "inner" },
    h("legend", {}, label),
    h(
      "div",
      { class: "fields" },
      field(
        form,
        path,
        "name",
        [called],
        "Its name in objectives, requirements and other formulas.",
      ),
      plain(form, [...path, "title"], {
        control: "text",
        label: "title",
        why: "Title in tables and figures; the name if left out.",
      }),
      plain(form, [...path, "unit"], {
        control: "text",
        label: "shown in",
        why: "A unit such as mm; if left out, the usual unit for this kind of quantity is used.",
      }),
      formulaField,
    ),
    h("p", {}, drop),
  );
}

/** Rename a formula wherever the job uses it. @param {Form.Whole} form @param {string} before @param {string} after */
function renameFormula(form, before, after) {
  const word = new RegExp(`(?<![\\w.])${before}(?![\\w.(])`, "g");
  /** @param {unknown} part @returns {unknown} */
  const inside = (part) =>
    typeof part === "string"
      ? part.replace(word, after)
      : isTable(part) && !Array.isArray(part)
        ? Object.fromEntries(Object.entries(part).map(([key, value]) => [key, inside(value)]))
        : part;
  for (const table of ["constraints", "objectives"]) {
    const entries = form.at([table]);
    if (isTable(entries))
      put(
        form.job,
        [table],
        Object.fromEntries(
          Object.entries(entries).map(([key, value]) => [
            form.quantities.has(key) ? key : key.replace(word, after),
            inside(value),
          ]),
        ),
      );
  }
  for (const [name, part] of Object.entries(form.at(["quantity"]) ?? {}))
    if (isTable(part) && typeof part.formula === "string")
      put(form.job, ["quantity", name, "formula"], part.formula.replace(word, after));
  put(
    form.job,
    ["quantity"],
    withRenamedKey(/** @type {Record<string, unknown>} */ (form.at(["quantity"])), before, after),
  );
  form.put(["quantity", after], form.at(["quantity", after]));
}
