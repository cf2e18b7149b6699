/** Times in everyday words. */

import { h } from "../lib/dom.js";

const MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
const LEAST = 0.1; // s; minimum of a displayed duration
const [MINUTE, HOUR, DAY] = [60, 3600, 86_400]; // s

/** Return when a job ended and how long its search took, or since when it runs or waits; the tooltip is exact. @param {Api.JobRow} job */
export function moment({ state, submitted, started, finished, summary }) {
  if (state === "running" && started) return ["started ", ago(started)];
  if (!finished) return ["submitted ", ago(submitted)];
  const seconds = summary?.seconds ?? finished - (started ?? finished);
  return [ago(finished), seconds >= LEAST ? `, after ${duration(seconds)}` : null];
}

/** Return a time, s since 1970, as "3 minutes ago"; the tooltip is exact. @param {number} seconds */
export function ago(seconds) {
  const date = new Date(1000 * seconds);
  /** @param {{ currentTarget: HTMLElement }} event */
  const exact = (event) => {
    // Only when needed: browsers take 50 ms to prepare date formatting.
    event.currentTarget.title = date.toLocaleString(undefined, {
      dateStyle: "medium",
      timeStyle: "medium",
    });
  };
  return h(
    "time",
    { datetime: date.toISOString(), onpointerenter: exact },
    agoText(date, new Date()),
  );
}

/** Update all displayed times. */
export function renewTimes() {
  for (const shown of document.querySelectorAll("time"))
    shown.textContent = agoText(new Date(shown.dateTime), new Date());
}

/**
 * Return a time relative to now: minutes within the hour, otherwise the time of day, or the date on other days.
 * @param {Date} date @param {Date} now
 */
export function agoText(date, now) {
  const passed = (now.getTime() - date.getTime()) / 1000;
  if (passed < MINUTE) return "just now";
  if (passed < HOUR)
    return Math.round(passed / MINUTE) === 1
      ? "1 minute ago"
      : `${Math.round(passed / MINUTE)} minutes ago`;
  const time = [date.getHours(), date.getMinutes()]
    .map((part) => String(part).padStart(2, "0"))
    .join(":");
  if (date.toDateString() === now.toDateString()) return `today ${time}`;
  if (date.toDateString() === new Date(now.getTime() - 1000 * DAY).toDateString())
    return `yesterday ${time}`;
  const day = `${date.getDate()} ${MONTHS[date.getMonth()]}`;
  return date.getFullYear() === now.getFullYear()
    ? `${day} ${time}`
    : `${day} ${date.getFullYear()}`;
}

/** Return the time of day of an event. @param {number} seconds */
export function clock(seconds) {
  return new Date(1000 * seconds).toLocaleTimeString(undefined, {
    hour: "2-digit",
    minute: "2-digit",
    second: "2-digit",
    hourCycle: "h23",
  });
}

/** Return a duration in words: "about 3 min". @param {number} seconds */
export function duration(seconds) {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 100) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}
