/** Mechanism stated in an address: three lengths and a speed. */

import { system } from "../lib/numbers.js";

/** @typedef {Page.Lengths & { rpm: number }} Stated */

/** @type {Record<"si" | "inch", Stated>} */
const FIRST = {
  si: { crank_mm: 50, rod_mm: 150, offset_mm: 40, rpm: 60 },
  inch: { crank_mm: 50.8, rod_mm: 152.4, offset_mm: 38.1, rpm: 60 },
};

/**
 * Return {stated, unread} of an address: its numbers, with defaults for missing ones, and invalid texts by key.
 * @param {URLSearchParams} query @returns {{ stated: Stated, unread: { [key in keyof Stated]?: string } }}
 */
export function statedIn(query) {
  const stated = { ...FIRST[system()] };
  /** @type {{ [key in keyof Stated]?: string }} */
  const unread = {};
  for (const key of /** @type {(keyof Stated)[]} */ (Object.keys(stated))) {
    const text = query.get(key)?.trim();
    const value = Number(text);
    if (!text) continue;
    if (Number.isFinite(value) && (value > 0 || key === "offset_mm" || (key === "rpm" && value)))
      stated[key] = value;
    else unread[key] = text;
  }
  return { stated, unread };
}

/** Return the job for a check by the service. @param {Stated} stated */
export function jobOf({ crank_mm, rod_mm, offset_mm, rpm }) {
  return {
    mechanism: { speed: `${rpm} rpm` },
    variables: { crank: `${crank_mm} mm`, rod: `${rod_mm} mm`, offset: `${offset_mm} mm` },
  };
}
