/** Drawn cases: the same ones each time, from a seed. */

/** Return a source of numbers in [0, 1): mulberry32, by Tommy Ettinger (public domain). */
export function source(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Return draws from a seed: number(low, high), whole(low, high), one(of), and size(low, high), a signed power of ten. */
export function draws(seed) {
  const next = source(seed);
  const number = (low, high) => low + (high - low) * next();
  const whole = (low, high) => Math.floor(number(low, high + 1));
  return {
    number,
    whole,
    one: (of) => of[whole(0, of.length - 1)],
    size: (low, high) => (next() < 0.5 ? -1 : 1) * 10 ** number(low, high),
  };
}
