/** What surrounds a design: the values of the whole front. */

import { get } from "../lib/api.js";

const PAGE = 1000; // designs that the API gives at once

/** Return the objectives of all designs of a front, as rows by column. */
export async function loadFront(job, front, signal) {
  const columns = front.objectives.map(({ column }) => column).join(",");
  const starts = Array.from({ length: Math.ceil(front.count / PAGE) }, (_, n) => n * PAGE);
  const pages = await Promise.all(starts.map((offset) => get(`jobs/${job}/designs`, { columns, offset, limit: PAGE }, signal)));
  return pages.flatMap(({ designs }) => designs);
}
