/** Initial jobs of a form. */

/** Return a solvable job in the units of a system, "si" or "inch". @param {"si" | "inch"} system @returns {Form.Job} */
export function firstJob(system) {
  const inch = system === "inch";
  /** @param {number} mm @param {number} inches */
  const length = (mm, inches) => (inch ? `${inches} in` : `${mm} mm`);
  return {
    name: "New slider-crank",
    mechanism: {
      speed: "60 rpm",
      crank: { mass: inch ? "1 lb" : "0.5 kg" },
      rod: { mass: inch ? "2 lb" : "1 kg" },
      slider: { mass: inch ? "4 lb" : "2 kg" },
      gravity: inch ? "386.09 in/s^2" : "9.81 m/s^2",
    },
    load: [{ force: inch ? "50 lbf" : "200 N", opposes: "inward stroke" }],
    tolerances: {
      crank: length(0.05, 0.002),
      rod: length(0.05, 0.002),
      offset: length(0.05, 0.002),
      crank_angle: "0.1 deg",
    },
    variables: {
      crank: [length(20, 1), length(100, 4)],
      rod: [length(60, 2.5), length(400, 16)],
      offset: [length(0, 0), length(100, 4)],
    },
    constraints: { stroke: { equals: length(100, 4) }, transmission_angle: { min: "40 deg" } },
    objectives: {
      time_ratio: "maximise",
      peak_torque: "minimise",
      transmission_angle: "maximise",
      position_error: "minimise",
    },
    optimiser: { designs: 100, seed: 1 },
  };
}

/**
 * Return a job with ranges around a mechanism and with its stroke: crank, rod, offset and stroke, mm, and crank speed, rpm.
 * @param {"si" | "inch"} system @param {number[]} numbers @returns {Form.Job}
 */
export function jobAround(system, [crank, rod, offset, stroke, rpm]) {
  const job = firstJob(system);
  const [factor, unit] = system === "inch" ? [1 / 25.4, "in"] : [1, "mm"];
  /** @param {number} mm @param {number} [digits] */
  const length = (mm, digits = 4) => `${Number((factor * mm).toPrecision(digits))} ${unit}`;
  const nearest = Math.max(Math.abs(offset) - crank / 2, 0);
  const ends = [nearest, Math.abs(offset) + crank / 2].map((mm) => (offset < 0 ? -mm : mm));
  return {
    ...job,
    name: "Around one mechanism",
    mechanism: { .../** @type {Form.Job} */ (job.mechanism), speed: `${rpm} rpm` },
    variables: {
      crank: [length(crank / 2), length(1.5 * crank)],
      rod: [length(rod / 2), length(2 * rod)],
      offset: ends.sort((a, b) => a - b).map((mm) => length(mm)),
    },
    constraints: { stroke: { equals: length(stroke, 8) } },
  };
}
