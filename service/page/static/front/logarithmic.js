/** Which axes of a front are logarithmic. */

import { mayBeLog } from "../charts/scale.js";

/** @import { Explorer } from "./explorer.js" */

/** Whether the axis of a column may be logarithmic. @param {Explorer} explorer @param {string} key */
export function mayBeLogged({ data }, key) {
  return data.has(key) && !data.words(key) && mayBeLog(data.range(key));
}

/** Whether the axis of a column is logarithmic. @param {Explorer} explorer @param {string} key */
export function logged(explorer, key) {
  return explorer.chosen.log.includes(key) && mayBeLogged(explorer, key);
}

/** Make the axes of a column logarithmic, or linear again. @param {Explorer} explorer @param {string} key */
export function logAxis(explorer, key) {
  const { log } = explorer.chosen;
  explorer.change(
    { log: log.includes(key) ? log.filter((other) => other !== key) : [...log, key] },
    "all",
  );
}
