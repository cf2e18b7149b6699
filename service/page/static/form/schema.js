/** The schema of jobs: what belongs at each place, as a form needs to know it. */

import { kindOf } from "./units.js";

/** Return a reader of a JSON Schema: property(path) and describe(node). */
export function reader(schema) {
  const resolve = (node) => (node?.$ref ? { ...schema.$defs[node.$ref.split("/").pop()], ...without(node, "$ref") } : node);

  /** Return what belongs at a path of the job; for a choice between tables, the one that has the next key. */
  function property(path) {
    let node = schema;
    for (const key of path) {
      node = resolve(node);
      const tables = (node.oneOf ?? node.anyOf ?? [node]).map(resolve);
      node = typeof key === "number" ? node.items : tables.find((table) => table.properties?.[key])?.properties[key];
      if (!node) return null;
    }
    return resolve(node);
  }

  return { property, describe, table: (name) => schema.$defs[name], resolve };
}

/**
 * Return what control a node needs: {control, kind, percent, options, description, fallback, keys}.
 * control: "quantity", "choice", "whole", "ratio", "text", "list", "table", or "other", which only the job file can say.
 */
export function describe(node) {
  const description = node.description ?? "";
  const common = { description, fallback: node.default, example: node.examples?.[0] };
  if (node.enum) return { ...common, control: "choice", options: node.enum };
  if (node.properties) return { ...common, control: "table", keys: Object.keys(node.properties), required: node.required ?? [] };
  if (node.type === "integer") return { ...common, control: "whole" };
  if (node.type === "number") return { ...common, control: "ratio" };
  if (node.type === "string") return { ...common, control: "text" };
  if (node.type === "array") return { ...common, control: "list" };
  const texts = (node.anyOf ?? []).filter((one) => one.type === "string");
  if (texts.length && (node.anyOf ?? []).every((one) => ["string", "number"].includes(one.type))) {
    const unit = String(common.example ?? "").replace(/^[^a-zA-Zµ%]*/, "");
    return { ...common, control: "quantity", kind: kindOf(unit), percent: texts.some((one) => one.pattern?.includes("%")) };
  }
  return { ...common, control: "other" };
}

/** Return a key as words: "crank_angle" is "crank angle". */
export function words(key) {
  return String(key).replaceAll("_", " ");
}

function without(object, key) {
  const { [key]: _, ...rest } = object;
  return rest;
}
