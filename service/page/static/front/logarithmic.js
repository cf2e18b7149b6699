/** Which axes of a front are logarithmic. */

import { mayBeLog } from "../charts/scale.js";

/** @import { Explorer } from "./explorer.js" */

/** Whether the axis of a column may be logarithmic. @param {Explorer} explorer @param {string} key */
export function mayBeLogarithmic({ data }, key) {
  return data.has(key) && !data.words(key) && mayBeLog(data.range(key));
}

/** Whether the axis of a column is logarithmic. @param {Explorer} explorer @param {string} key */
export function isLogarithmic(explorer, key) {
  return explorer.chosen.log.includes(key) && mayBeLogarithmic(explorer, key);
}

/** Make the axes of a column logarithmic, or linear again. @param {Explorer} explorer @param {string} key */
export function setLogarithmic(explorer, key) {
  const { log } = explorer.chosen;
  explorer.change(
    { log: log.includes(key) ? log.filter((other) => other !== key) : [...log, key] },
    "all",
  );
}
