/** Recent gain of a search: hypervolume added by its last rounds. */

const ROUNDS = 10;

/**
 * Return the gain of the last rounds: {rounds, text}, such as 10 and "+0.02 %"; null before a comparison is possible.
 * @param {readonly (number | null)[]} hypervolumes of the rounds, in order
 */
export function growth(hypervolumes) {
  const volumes = hypervolumes.filter((one) => one !== null && one > 0).slice(-1 - ROUNDS);
  if (volumes.length < 2) return null;
  const percent = 100 * (Number(volumes[volumes.length - 1]) / Number(volumes[0]) - 1);
  const places = percent >= 10 ? 0 : percent >= 1 ? 1 : 2;
  return {
    rounds: volumes.length - 1,
    text:
      percent === 0
        ? "nothing"
        : percent < 0.005
          ? "under 0.01 %"
          : `+${percent.toFixed(places)} %`,
  };
}
