/** Small pictures of fronts in a list of runs. Their points come when a row is seen: those of all rows seen at once in one request. */

import { thumbnail } from "../charts/thumbnail.js";
import { get } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { counted } from "../lib/numbers.js";

const MOST = 100; // runs that the service takes in one request

/**
 * Return {picture, forget}. picture(job): an element with the front of a job, as far as it is known; what is not, or is so no longer, is asked
 * for when the element is seen. forget(number): the points of a run that is not in the list any more. `signal` ends it all.
 * @param {AbortSignal} signal
 */
export function pictures(signal) {
  /** @type {Map<number, { events: number, points: Api.FrontPoints["points"] }>} */
  const loadedPoints = new Map(); // by the number of a run; events: how many it had
  /** @type {WeakMap<Element, Api.JobRow>} */
  const awaited = new WeakMap();
  /** @type {Set<Element>} */
  const seen = new Set();
  let asking = false;
  const observer = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) seen.add(target);
      else seen.delete(target);
    }
    ask();
  });
  signal.addEventListener("abort", () => observer.disconnect());

  /** @param {Api.JobRow} job */
  function picture(job) {
    const before = loadedPoints.get(job.id);
    const node = drawn(before?.points ?? []);
    if (before?.events !== job.events) {
      awaited.set(node, job);
      observer.observe(node);
    }
    return node;
  }

  /** Ask for what is seen, one request at a time: what is scrolled past meanwhile is not asked for. */
  async function ask() {
    if (asking || !seen.size) return;
    asking = true;
    const nodes = [...seen].slice(0, MOST);
    for (const node of nodes) {
      seen.delete(node);
      observer.unobserve(node);
    }
    try {
      const jobs = nodes.flatMap((node) => awaited.get(node) ?? []);
      const { fronts } = await get(
        "front-points",
        { job: jobs.map(({ id }) => String(id)) },
        signal,
      );
      const pointsOf = new Map(fronts.map(({ job, points }) => [job, points]));
      for (const [index, { id, events }] of jobs.entries()) {
        const points = pointsOf.get(id) ?? [];
        loadedPoints.set(id, { events, points });
        nodes[index].replaceWith(drawn(points));
      }
    } catch {
      // Nothing to say: the list says what is wrong, and its rows ask again when they are drawn anew, within a minute.
    }
    asking = false;
    if (!signal.aborted) ask();
  }

  return { picture, forget: (/** @type {number} */ number) => loadedPoints.delete(number) };
}

/** @param {Api.FrontPoints["points"]} points */
function drawn(points) {
  return points.length
    ? thumbnail(points, `the front: ${counted(points.length, "design")}`)
    : h("span", { class: "thumbnail" });
}
