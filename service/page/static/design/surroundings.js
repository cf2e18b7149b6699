/** Surroundings of a design: the values of the whole front. */

import { get } from "../lib/api.js";

/**
 * Return the objectives of all designs of a front, as rows by column.
 * @param {string} job @param {Api.Front} front @param {AbortSignal} signal @returns {Promise<Api.Row[]>}
 */
export async function loadFront(job, front, signal) {
  const keys = front.objectives.map(({ column }) => column);
  const { values, count } = await get(`jobs/${job}/columns`, { columns: keys.join(",") }, signal);
  return Array.from({ length: count }, (_, n) =>
    Object.fromEntries(keys.map((key) => [key, values[key][n]])),
  );
}
