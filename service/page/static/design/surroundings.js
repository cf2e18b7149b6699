/** What surrounds a design: the values of the whole front, and the names of quantities. */

import { get } from "../lib/api.js";

const PAGE = 1000; // designs that the API gives at once

/** Return the objectives of all designs of a front, as rows by column. */
export async function loadFront(job, front, signal) {
  const columns = front.objectives.map(({ column }) => column).join(",");
  const starts = Array.from({ length: Math.ceil(front.count / PAGE) }, (_, n) => n * PAGE);
  const pages = await Promise.all(starts.map((offset) => get(`jobs/${job}/designs`, { columns, offset, limit: PAGE }, signal)));
  return pages.flatMap(({ designs }) => designs);
}

/** Return the names of quantities by the columns of their values, for links to their help. */
export async function loadNames(signal) {
  try {
    const { quantities } = await get("quantities", {}, signal);
    return Object.fromEntries(quantities.map(({ name, column }) => [column, name]));
  } catch (error) {
    if (error.name === "AbortError") throw error;
    return {};
  }
}
