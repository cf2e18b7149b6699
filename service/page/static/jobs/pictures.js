/** Thumbnails of fronts in a list of runs. Points are requested when a row becomes visible, one request for all visible rows. */

import { thumbnail } from "../charts/thumbnail.js";
import { get } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { counted } from "../lib/numbers.js";

const MOST = 100; // maximum number of runs per request

/**
 * Return {picture, forget}. picture(job): an element with the known front of a job; missing or outdated points are requested when it
 * becomes visible. forget(number): drops the points of a run that has left the list. `signal` ends all requests.
 * @param {AbortSignal} signal
 */
export function pictures(signal) {
  /** @type {Map<number, { events: number, points: Api.FrontPoints["points"] }>} */
  const loadedPoints = new Map(); // by run number; events: number of its events at that time
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

  /** Request the points of visible rows, one request at a time; rows scrolled past are skipped. */
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
      // The list reports the failure, and its rows request again when they are redrawn, within a minute.
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
