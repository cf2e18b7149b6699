/** Job schema, as needed by the form. */

import { kindOf } from "../lib/units.js";

/** Return a reader of a JSON Schema: property(path) and resolve(node). @param {Form.Schema} schema */
export function reader(schema) {
  /** @param {Form.Schema} node @returns {Form.Schema} */
  const resolve = ({ $ref, ...node }) =>
    $ref ? { ...schema.$defs?.[$ref.slice($ref.lastIndexOf("/") + 1)], ...node } : node;

  /**
   * Return the schema node at a path of the job; for a choice between tables, the one with the next key.
   * @param {Form.Path} path @returns {Form.Schema | null}
   */
  function property(path) {
    let node = resolve(schema);
    for (const key of path) {
      const tables = (node.oneOf ?? node.anyOf ?? [node]).map(resolve);
      const inner =
        typeof key === "number"
          ? node.items
          : tables.map((table) => table.properties?.[key]).find(Boolean);
      if (!inner) return null;
      node = resolve(inner);
    }
    return node;
  }

  return { property, resolve };
}

/**
 * Return the control for a node: {control, kind, percent, options, description, fallback, keys}. control: "quantity", "choice", "whole",
 * "ratio", "text", "list", "table", or "other", which only the job file can state.
 * @param {Form.Schema} node @returns {Form.Described}
 */
export function describe(node) {
  const description = node.description ?? "";
  const common = { description, fallback: node.default, example: node.examples?.[0] };
  if (node.enum) return { ...common, control: "choice", options: node.enum };
  if (node.properties) return { ...common, control: "table", keys: Object.keys(node.properties) };
  if (node.type === "integer") return { ...common, control: "whole" };
  if (node.type === "number") return { ...common, control: "ratio" };
  if (node.type === "string") return { ...common, control: "text" };
  if (node.type === "array") return { ...common, control: "list" };
  const texts = (node.anyOf ?? []).filter((one) => one.type === "string");
  if (
    texts.length &&
    (node.anyOf ?? []).every((one) => one.type === "string" || one.type === "number")
  ) {
    const unit = String(common.example ?? "").replace(/^[^a-zA-Zµ%]*/, "");
    return {
      ...common,
      control: "quantity",
      kind: kindOf(unit),
      percent: texts.some((one) => one.pattern?.includes("%")),
    };
  }
  return { ...common, control: "other" };
}

/** Return a key as words: "crank_angle" is "crank angle". @param {string | number | boolean} key */
export function words(key) {
  return String(key).replaceAll("_", " ");
}
