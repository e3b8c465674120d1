// The grid behind the motion. No part of the page is needed here, so that a test can run it alone.

const SCALES = [1e-12, 1e12];  // pixels per m

export const bounded = (scale) => Math.min(SCALES[1], Math.max(SCALES[0], scale));

/** 1, 2 or 5 times a power of ten: the distance of lines that are at least `wanted` apart. */
export function gridUnit(wanted) {
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= wanted);
}

/**
 * The multiples of a unit between two numbers, at most 1,000: far from the origin, adding a unit may not
 * change a number.
 */
export function gridLines(low, high, unit) {
  const first = Math.ceil(low / unit);
  const count = Math.min(1000, Math.ceil(high / unit) - first);
  return count > 0 ? Array.from({length: count}, (_, k) => (first + k) * unit) : [];
}
