/** The loads on the slider: each of one of six kinds, told apart by a key. */

import { h } from "../lib/dom.js";
import { byschema } from "./controls.js";
import { field } from "./field.js";
import { idOf, isTable } from "./path.js";

const KINDS = [
  { key: "opposes", title: "force against a stroke or the motion", first: { force: "100 N", opposes: "outward stroke" } },
  { key: "direction", title: "force in one direction", first: { force: "100 N", direction: "inward" } },
  { key: "stiffness", title: "spring", first: { stiffness: "1 N/mm", free_position: "0 mm", measured_from: "inner dead centre" } },
  { key: "viscous", title: "damper", first: { viscous: "10 N s/m" } },
  { key: "positions", title: "table of forces over the slider position", first: { positions: ["0 mm", "50 mm"], forces: ["0 N", "-100 N"], measured_from: "inner dead centre" } },
  { key: "crank_angles", title: "table of forces over the crank angle", first: { crank_angles: ["0 deg", "180 deg"], forces: ["0 N", "-100 N"] } },
];

/** Return the fields of all loads, with buttons to add and to remove one. @param {Form.Whole} form */
export function loads(form) {
  const given = form.at(["load"]);
  const all = Array.isArray(given) ? given : [];
  const add = h("button", { type: "button", id: "add-load" }, all.length ? "Add another load" : "Add a load");
  add.addEventListener("click", () => {
    form.put(["load"], [...all, structuredClone(KINDS[0].first)]);
    form.redraw(idOf(["load", all.length, "kind"]));
  });
  return [all.map((load, place) => one(form, load, place, all)), h("p", {}, add)];
}

/** @param {Form.Whole} form @param {unknown} load @param {number} place @param {unknown[]} all */
function one(form, load, place, all) {
  const path = ["load", place];
  const kind = KINDS.find(({ key }) => isTable(load) && key in load) ?? KINDS[0];
  const select = h("select", { id: idOf([...path, "kind"]) }, KINDS.map(({ key, title }) => h("option", { value: key, selected: key === kind.key }, title)));
  select.addEventListener("change", () => {
    form.put(path, structuredClone((KINDS.find(({ key }) => key === select.value) ?? KINDS[0]).first));
    form.redraw();
  });
  const drop = h("button", { type: "button", "aria-label": `Remove load ${place + 1}` }, "Remove");
  drop.addEventListener("click", () => {
    form.put(["load"], all.length > 1 ? all.filter((_, other) => other !== place) : undefined);
    form.redraw("add-load");
  });
  const whose = tableOf(form.schema, kind.key);
  const fields = Object.keys(whose.properties ?? {}).map((key) => byschema(form, [...path, key], { required: whose.required?.includes(key) }));
  return h(
    "fieldset",
    { class: "inner" },
    h("legend", {}, `Load ${place + 1}`),
    h("div", { class: "fields" }, field(form, path, "kind of load", [select]), fields),
    h("p", {}, drop),
  );
}

/** Return the table of the schema whose loads have a key. @param {Form.Whole["schema"]} schema @param {string} key */
function tableOf(schema, key) {
  const tables = schema.property(["load"])?.items?.oneOf ?? [];
  return tables.map(schema.resolve).find((table) => table.properties?.[key]) ?? {};
}
