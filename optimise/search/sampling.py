"""Samples of a search: low-discrepancy points, some on faces, then points around sparse parts of the front."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, IntArray
from ..front.hypervolume import ideal_and_range
from ..front.neighbours import nearest_neighbours
from .sobol import sobol

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
    points = sobol(power, dimension, random)[:count]
    snapped = random.random(points.shape) < boundary_share
    return np.asarray(np.where(snapped, np.round(points), points))


def sample_near(parents: Array, values: Array, count: int, width: float, random: np.random.Generator) -> Array:
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
