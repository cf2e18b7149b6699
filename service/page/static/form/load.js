/** Loads on the slider, each of a kind from the schema, identified by a key. */

import { h } from "../lib/dom.js";
import { byschema } from "./controls.js";
import { field } from "./field.js";
import { appliesToMotion } from "./motion.js";
import { idOf, isTable } from "./path.js";
import { points } from "./points.js";
import { describe, words } from "./schema.js";
import { inDisplayUnits } from "../lib/numbers.js";
import { capitalised } from "../lib/words.js";

/**
 * Return the fields of all loads, with buttons to add and to remove one.
 * @param {Form.Whole} form
 */
export function loads(form) {
  const jobValue = form.at(["load"]);
  const all = Array.isArray(jobValue) ? jobValue : [];
  const add = h(
    "button",
    {
      type: "button",
      id: "add-load",
      onclick: () => {
        form.put(
          ["load"],
          [
            ...all,
            structuredClone(kinds(form).filter((kind) => appliesToMotion(form, kind))[0].first),
          ],
        );
        form.redraw(idOf(["load", all.length, "kind"]));
      },
    },
    all.length ? "Add another load" : "Add a load",
  );
  return [all.map((load, place) => one(form, load, place, all)), h("p", {}, add)];
}

/** @param {Form.Whole} form @param {unknown} load @param {number} place @param {unknown[]} all */
function one(form, load, place, all) {
  const path = ["load", place];
  const every = kinds(form);
  const kind = every.find(({ key }) => isTable(load) && key in load) ?? every[0];
  const fitting = every.filter((one) => one === kind || appliesToMotion(form, one));
  const select = h(
    "select",
    {
      id: idOf([...path, "kind"]),
      onchange: () => {
        form.put(
          path,
          structuredClone((fitting.find(({ key }) => key === select.value) ?? fitting[0]).first),
        );
        form.redraw();
      },
    },
    fitting.map(({ key, title }) => h("option", { value: key, selected: key === kind.key }, title)),
  );
  const drop = h(
    "button",
    {
      type: "button",
      "aria-label": `Remove load ${place + 1}`,
      onclick: () => {
        form.put(["load"], all.length > 1 ? all.filter((_, other) => other !== place) : undefined);
        form.redraw("add-load");
      },
    },
    "Remove",
  );
  const { properties, required } = kind.table;
  const columns = Object.entries(properties ?? {})
    .filter(([, node]) => node.type === "array")
    .map(([key, node]) => ({
      key,
      label: words(key),
      kind: describe(form.schema.resolve(node.items ?? {})).kind ?? null,
    }));
  const [first, second] = columns;
  const table =
    first && second
      ? points(
          form,
          path,
          [first, second],
          form.schema.property([...path, first.key])?.description ?? "",
          { steps: true },
        )
      : null;
  const rest = Object.keys(properties ?? {})
    .filter((key) => key !== "source")
    .filter((key) => !table || !columns.some((one) => one.key === key));
  const chosen = field(form, path, "kind of load", [select], "", { tell: () => say() });
  /** Show below the kind how the service understood the load. */
  function say() {
    const loads = form.said?.understood?.loads ?? [];
    const line = chosen.querySelector(".understood");
    if (!(line instanceof HTMLElement)) return;
    line.hidden = loads.length !== all.length;
    line.textContent = line.hidden ? "" : capitalised(inDisplayUnits(loads[place]));
  }
  say();
  const fields = [
    table,
    rest.map((key) => byschema(form, [...path, key], { required: required?.includes(key) })),
  ];
  return h(
    "fieldset",
    { class: "inner" },
    h("legend", {}, `Load ${place + 1}`),
    h("div", { class: "fields" }, chosen, fields),
    h("p", {}, drop),
  );
}

/**
 * Return the kinds of load: key, title, initial values, type of motion, and table of the schema.
 * @param {Form.Whole} form
 */
function kinds(form) {
  const tables = form.schema.property(["load"])?.items?.oneOf ?? [];
  return tables
    .map(form.schema.resolve)
    .map((table) => ({ key: "", title: "", first: {}, motion: "", ...table["x-load"], table }))
    .filter(({ key }) => key); // a load from a file has no kind: its points are read into another kind
}
