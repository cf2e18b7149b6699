/** Times as people say them. */

import { h } from "../lib/dom.js";

/** @type {[string, number][]} */
const STEPS = [["day", 86_400], ["hour", 3600], ["minute", 60]];

/** Return how long ago a time, in seconds since 1970, was: "3 minutes ago", exact when pointed at. @param {number} seconds */
export function ago(seconds) {
  const date = new Date(1000 * seconds);
  /** @param {{ currentTarget: HTMLElement }} event */
  const exact = (event) => {
    // Only then: a browser takes 50 ms to make itself ready to write dates.
    event.currentTarget.title = date.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" });
  };
  return h("time", { datetime: date.toISOString(), onpointerenter: exact }, agoText(seconds));
}

/** @param {number} seconds */
function agoText(seconds) {
  const passed = Math.max(0, Date.now() / 1000 - seconds);
  const [unit, length] = STEPS.find(([, length]) => passed >= length) ?? ["second", 1];
  if (unit === "second") return passed < 10 ? "just now" : "less than a minute ago";
  const count = Math.round(passed / length);
  return `${count} ${unit}${count === 1 ? "" : "s"} ago`;
}

/** Return the time of the day of an event. @param {number} seconds */
export function clock(seconds) {
  return new Date(1000 * seconds).toLocaleTimeString(undefined, { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}

/** Return a duration in words: "about 3 min". @param {number} seconds */
export function duration(seconds) {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 100) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}
