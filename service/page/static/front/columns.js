/** Titles of columns of a table of designs where the service does not give them. */

import { link } from "../lib/address.js";
import { titleOf, unitOf, withUnit } from "../lib/numbers.js";

// Endings of keys with their units, longer endings first.
/** @type {[string, string][]} */
const ENDINGS = [
  ["_m_s3", "m/s^3"],
  ["_m_s2", "m/s^2"],
  ["_m_s", "m/s"],
  ["_kg_m2", "kg m^2"],
  ["_kg_m3", "kg/m^3"],
  ["_kg", "kg"],
  ["_rad_s2", "rad/s^2"],
  ["_rpm", "rpm"],
  ["_Ns2_per_m2", "N s^2/m^2"],
  ["_Ns_per_m", "N s/m"],
  ["_N_per_m", "N/m"],
  ["_m2", "m^2"],
  ["_Nm", "N m"],
  ["_mm", "mm"],
  ["_deg", "deg"],
  ["_N", "N"],
  ["_W", "W"],
  ["_MPa", "MPa"],
];

/** Return {key, title, unit} of a key such as "peak_torque_Nm". Titles of the service need `readySystem`. @param {string} key @returns {Api.Column} */
export function columnOf(key) {
  const [ending, unit] = ENDINGS.find(([ending]) => key.endsWith(ending)) ?? ["", ""];
  return {
    key,
    title: titleOf(key) ?? key.slice(0, key.length - ending.length).replaceAll("_", " "),
    unit,
  };
}

/** Return the link to the help on a column; a slack is explained with its quantity. @param {string} key */
export function helpLink(key) {
  return link(["help", key.replace(/^slack_/, "")]);
}

/**
 * Return a value of a column with its title and unit: "peak torque 3.12 N m".
 * @param {string} key @param {Api.Row[string]} value @param {number} digits
 */
export function named(key, value, digits = 4) {
  const { title, unit } = columnOf(key);
  return `${title} ${withUnit(value, unit, digits)}`;
}

/** Return a title with the unit that the reader chose, on one line. @param {Page.Heading} column */
export function headed(column) {
  const unit = unitOf(column.unit)?.replaceAll(" ", "\u00a0");
  return unit ? `${column.title},\u00a0${unit}` : column.title; // no line break within or before a unit
}
