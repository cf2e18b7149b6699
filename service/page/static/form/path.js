/** Paths in a job: lists of keys, such as ["load", 0, "force"], and the values there. */

import { isRange } from "../lib/number_text.js";

/** Return the value at a path of a job, or undefined. @param {unknown} job @param {Form.Path} path @returns {unknown} */
export function at(job, path) {
  let part = job;
  for (const key of path) {
    if (!isTable(part)) return undefined;
    part = part[key];
  }
  return part;
}

/**
 * Set the value at a path of a job; undefined removes the key, and tables that become empty.
 * @param {Record<string | number, unknown>} job @param {Form.Path} path @param {unknown} value
 */
export function put(job, path, value) {
  const [key, ...rest] = path;
  if (rest.length === 0) {
    if (value !== undefined) job[key] = value;
    else if (Array.isArray(job)) job.splice(Number(key), 1);
    else delete job[key];
    return;
  }
  let inner = job[key];
  if (!isTable(inner)) {
    if (value === undefined) return;
    inner = job[key] = typeof rest[0] === "number" ? [] : {};
  }
  put(/** @type {Record<string | number, unknown>} */ (inner), rest, value);
  if (
    value === undefined &&
    !Object.keys(/** @type {object} */ (inner)).length &&
    !Array.isArray(job)
  )
    delete job[key];
}

const LONGEST = 60;

/** Return a path in the notation of the service: "load #1.force"; keys that are formulas are in quotes. @param {Form.Path} path @returns {string} */
export function pathText(path) {
  return path
    .map((key, place) =>
      typeof key === "number" ? ` #${key + 1}` : (place ? "." : "") + quoted(key),
    )
    .join("");
}

/** Return the path for a text in the notation of the service. @param {string} text @returns {Form.Path} */
export function parsedPath(text) {
  return [...text.matchAll(/ #(\d+)|"(?:[^"\\]|\\.)*"|[A-Za-z_]\w*/g)].map(([part, number]) =>
    number ? Number(number) - 1 : part.startsWith('"') ? JSON.parse(part) : part,
  );
}

/** @param {string} key */
function quoted(key) {
  if (/^[A-Za-z_]\w*$/.test(key) && key.length <= LONGEST) return key;
  return JSON.stringify(key.length <= LONGEST ? key : `${key.slice(0, LONGEST)}...`);
}

/**
 * Return a table with one key renamed in place.
 * @param {Record<string, unknown>} table @param {string} before @param {string} after
 */
export function withRenamedKey(table, before, after) {
  return Object.fromEntries(
    Object.entries(table).map(([key, value]) => [key === before ? after : key, value]),
  );
}

/** Return an id for the control of a path that stays the same when the form is redrawn. @param {Form.Path} path @param {string | number} part */
export function idOf(path, part = "") {
  return `f-${[...path, part]
    .filter((key) => key !== "")
    .join("-")
    .replace(/[^\w-]/g, "_")}`;
}

/** Whether a part of a job is a table, or a list. @type {(part: unknown) => part is Record<string | number, unknown>} */
export function isTable(part) {
  return part !== null && typeof part === "object";
}

/**
 * Return the value of a name in a job: a fixed length, or a requirement with a single value; null for anything else.
 * @param {{ at: (path: Form.Path) => unknown }} form @param {string} name @returns {string | number | null}
 */
export function valueOf(form, name) {
  const value = [form.at(["constraints", name, "equals"]), form.at(["variables", name])].find(
    (one) => typeof one === "number" || (typeof one === "string" && one !== "" && !isRange(one)),
  );
  return typeof value === "string" || typeof value === "number" ? value : null;
}
