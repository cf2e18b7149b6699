/** How much a search still gains: what its last rounds added to the hypervolume of the front. */

const ROUNDS = 10;

/**
 * Return what the last rounds added: {rounds, text}, such as 10 and "+0.02 %"; null before there is anything to compare.
 * @param {readonly (number | null)[]} hypervolumes of the rounds, in order
 */
export function growth(hypervolumes) {
  const known = hypervolumes.filter((one) => one !== null && one > 0).slice(-1 - ROUNDS);
  if (known.length < 2) return null;
  const percent = 100 * (Number(known[known.length - 1]) / Number(known[0]) - 1);
  const places = percent >= 10 ? 0 : percent >= 1 ? 1 : 2;
  return {
    rounds: known.length - 1,
    text:
      percent === 0
        ? "nothing"
        : percent < 0.005
          ? "under 0.01 %"
          : `+${percent.toFixed(places)} %`,
  };
}
