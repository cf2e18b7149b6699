/** The job that an empty form begins with. */

/** Return a job that can be solved, in the reader's units: system is "si" or "inch". @param {"si" | "inch"} system @returns {Form.Job} */
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
      gravity: "9.81 m/s^2",
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
