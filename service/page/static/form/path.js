/** Places in a job: lists of keys, such as ["load", 0, "force"], and what stands there. */

/** Return what stands at a path of a job; undefined where there is nothing. */
export function at(job, path) {
  let part = job;
  for (const key of path) {
    if (part === null || typeof part !== "object") return undefined;
    part = part[key];
  }
  return part;
}

/** Put a value at a path of a job; undefined takes the key away, and the tables that are empty without it. */
export function put(job, path, value) {
  const [key, ...rest] = path;
  if (rest.length === 0) {
    if (value !== undefined) job[key] = value;
    else if (Array.isArray(job)) job.splice(key, 1);
    else delete job[key];
    return;
  }
  const inner = job[key];
  if (inner === null || typeof inner !== "object") {
    if (value === undefined) return;
    job[key] = typeof rest[0] === "number" ? [] : {};
  }
  put(job[key], rest, value);
  if (value === undefined && isEmpty(job[key]) && !Array.isArray(job)) delete job[key];
}

/** Return a path as the service writes it: "load #1.force". */
export function written(path) {
  return path.reduce((text, key) => (typeof key === "number" ? `${text} #${key + 1}` : text ? `${text}.${key}` : key), "");
}

/** Return the path that the service means. */
export function read(text) {
  const path = [];
  for (const [, key, place] of text.matchAll(/([^.\s"]+|"[^"]*")(?: #(\d+))?/g)) {
    path.push(key.replace(/^"|"$/g, ""));
    if (place) path.push(Number(place) - 1);
  }
  return path;
}

/** Return an id for the control of a path, the same each time that the form is drawn. */
export function idOf(path, part = "") {
  return `f-${[...path, part].filter((key) => key !== "").join("-").replace(/[^\w-]/g, "_")}`;
}

function isEmpty(part) {
  return part !== null && typeof part === "object" && Object.keys(part).length === 0;
}
