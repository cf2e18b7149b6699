/** Times as people say them. */

import { h } from "../lib/dom.js";

const STEPS = [["day", 86_400], ["hour", 3600], ["minute", 60]];
const relative = new Intl.RelativeTimeFormat("en", { numeric: "auto" });
const exact = new Intl.DateTimeFormat(undefined, { dateStyle: "medium", timeStyle: "medium" });

/** Return how long ago a time, in seconds since 1970, was: "3 minutes ago", exact when pointed at. */
export function ago(seconds) {
  const date = new Date(1000 * seconds);
  return h("time", { datetime: date.toISOString(), title: exact.format(date) }, agoText(seconds));
}

function agoText(seconds) {
  const passed = Math.max(0, Date.now() / 1000 - seconds);
  const [unit, length] = STEPS.find(([, length]) => passed >= length) ?? ["second", 1];
  if (unit === "second") return passed < 10 ? "just now" : "less than a minute ago";
  return relative.format(-Math.round(passed / length), unit);
}

/** Return the time of the day of an event. */
export function clock(seconds) {
  return new Date(1000 * seconds).toLocaleTimeString(undefined, { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}

/** Return a duration in words: "about 3 min". */
export function duration(seconds) {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 100) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}
