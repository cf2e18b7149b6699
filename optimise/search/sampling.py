"""Samples of a search: low-discrepancy points, some on faces, then points around sparse parts of the front.

The scrambled Sobol points equal those of `scipy.stats.qmc` without its import, which takes as long as a search:
I. M. Sobol, USSR Comput. Math. Math. Phys. 7(4), 1967; primitive polynomials and first direction numbers of S. Joe and
F. Y. Kuo, SIAM J. Sci. Comput. 30(5), 2008; scrambled by a random lower triangular matrix and a digital shift,
J. Matousek, J. Complexity 14, 1998.
"""

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array, IntArray
from ..front.choose_design import nearest_neighbours
from ..front.hypervolume import ideal_and_range

_BITS = 30
# For each dimension: inner coefficients of the polynomial as a number, and the first direction numbers.
_FIRST: tuple[tuple[int, tuple[int, ...]], ...] = (
    (0, (1,) * _BITS),
    (0, (1,)),
    (1, (1, 3)),
    (1, (1, 3, 1)),
    (2, (1, 1, 1)),
    (1, (1, 1, 3, 3)),
    (4, (1, 3, 5, 13)),
    (2, (1, 1, 5, 5, 17)),
    (4, (1, 1, 5, 5, 5)),
    (7, (1, 1, 7, 11, 19)),
)


def sobol_points(power: int, dimension: int, random: np.random.Generator) -> Array:
    """Return 2^power points in the unit box (n, k). random: spawns the generator that scrambles them."""
    if dimension > len(_FIRST):
        from scipy.stats import qmc

        return np.asarray(qmc.Sobol(dimension, rng=random).random_base2(power))
    random = random.spawn(1)[0]
    places = np.arange(_BITS, dtype=np.uint32)
    shift = random.integers(2, size=(dimension, _BITS), dtype=np.uint32) @ (np.uint32(1) << places)
    lower = np.tril(random.integers(2, size=(dimension, _BITS, _BITS), dtype=np.uint32), -1)
    lower += np.eye(_BITS, dtype=np.uint32)
    digits = _direction_numbers(dimension)[:, :, None] >> places[::-1] & 1  # most significant digit first
    mixed = np.einsum("dpk,djk->djp", lower, digits) & 1
    numbers = (mixed << places[::-1]).sum(axis=2, dtype=np.uint32)
    count = np.arange(1, 2**power)
    points = np.empty((2**power, dimension), dtype=np.uint32)
    points[0] = shift
    points[1:] = numbers.T[np.log2(count & -count).astype(np.int64)]  # the digit that changes in Gray code
    return np.asarray(np.bitwise_xor.accumulate(points) * 2.0**-_BITS)


def _direction_numbers(dimension: int) -> NDArray[np.uint32]:
    """Return the direction numbers (k, bits)."""
    rows = []
    for inner, first in _FIRST[:dimension]:
        numbers, degree = list(first), len(first)
        for j in range(degree, _BITS):
            new = numbers[j - degree] ^ numbers[j - degree] << degree
            for k in range(1, degree):
                new ^= (inner >> degree - 1 - k & 1) * numbers[j - k] << k
            numbers.append(new)
        rows.append([number << _BITS - 1 - j for j, number in enumerate(numbers)])
    return np.array(rows, dtype=np.uint32)


BOUNDARY_SHARE = 0.3
"""Probability that a sample's coordinate is snapped to one of its bounds, because optima lie on faces and edges."""

LEAST_DISTANCE = 0.1
"""Distance in the unit box between starts that should lead to different optima."""


def distant_rows(merits: Array, points: Array, branch: IntArray, count: int) -> IntArray:
    """Return rows of at most `count` points (n, k), `LEAST_DISTANCE` apart: least finite merit (n,) first.

    Points on different branches count as distant.
    """
    rows = np.argsort(merits, kind="stable")
    rows = rows[np.isfinite(merits[rows])]
    chosen: list[int] = []
    while len(rows) and len(chosen) < count:
        best = int(rows[0])
        chosen.append(best)
        far = np.abs(points[rows] - points[best]).max(axis=1, initial=0.0) >= LEAST_DISTANCE
        rows = rows[far | (branch[rows] != branch[best])]
    return np.array(chosen, dtype=np.int64)


def random_generator(seed: int, *stream: int) -> np.random.Generator:
    """Return the random generator for one stream of a seed; streams are independent and never shared."""
    return np.random.default_rng(np.random.SeedSequence([seed, *stream]))


def first_samples(
    count: int, dimension: int, seed: int, stream: int, *, boundary_share: float = BOUNDARY_SHARE
) -> Array:
    """Return about `count` points in the unit box (n, k), some of them on faces, edges and corners."""
    if dimension == 0:
        return np.zeros((1, 0))
    random = random_generator(seed, stream, 0)
    power = max(1, int(np.ceil(np.log2(max(2, count)))))
    points = sobol_points(power, dimension, random)[:count]
    snapped = random.random(points.shape) < boundary_share
    return np.asarray(np.where(snapped, np.round(points), points))


def sample_near_parents(parents: Array, values: Array, count: int, width: float, random: np.random.Generator) -> Array:
    """Return `count` points near parents (n, k), more of them near parents with distant neighbours on the front.

    values: objectives of the parents (n, m). width: standard deviation in the unit box. A coordinate on a bound usually
    stays there.
    """
    ideal, span = ideal_and_range(values)
    scaled = (values - ideal) / span
    nearest = min(len(parents), values.shape[1] + 1)
    if nearest > 1:
        distance, _ = nearest_neighbours(scaled, nearest)
        sparse = distance[:, 1:].mean(axis=1) + 1e-9
    else:
        sparse = np.ones(len(parents))
    chosen = draw_rows(sparse / sparse.sum(), count, random)
    base = parents[chosen]
    # Heavy tails: most children stay close, some jump.
    step = width * random.standard_normal(base.shape) * random.standard_exponential((count, 1))
    on_bound = (base == 0.0) | (base == 1.0)
    stays = on_bound & (random.random(base.shape) < 0.7)
    return np.asarray(np.clip(np.where(stays, base, base + step), 0.0, 1.0))


def draw_rows(chances: Array, count: int, random: np.random.Generator) -> IntArray:
    """Return `count` rows drawn with probabilities (n,), as `Generator.choice` draws them, in a third of its time."""
    upto = chances.cumsum()
    upto /= upto[-1]
    drawn = random.random(count)
    order = np.argsort(drawn)
    rows = np.empty(count, np.int64)
    # In order, each search begins where the last one ended.
    rows[order] = upto.searchsorted(drawn[order], side="right")
    return rows
