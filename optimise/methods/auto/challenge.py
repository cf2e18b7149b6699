"""Challenges to polished designs: fresh samples that may dominate them, and the gaps between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...front.hypervolume import Stand, choose, nondominated
from ...front.stationarity import Array
from ...problem.problem import Problem
from ...search.candidates import Finished, stacked
from ...search.evaluation import Evaluator
from ...search.sampling import around, first_samples, generator
from ...search.search import FIRST, SAMPLES, Archive, share

_WIDTH = 0.02  # of the unit box: spread of fresh samples around polished designs
_POOL = 2000  # designs of the archive that gaps are filled from
_CLEAR = 1e-6  # of the objectives' range: a domination that is more than rounding
_GAIN = 1e-3  # of the same: a gain that is worth a loss of `_CLEAR`, for example by another choice for the same lengths
_NEIGHBOURS = 2  # an objective, between which gaps are looked for


def challengers(
    problem: Problem, evaluators: list[Evaluator], archive: Archive, finished: Finished, attempt: int, stand: Stand
) -> list[tuple[int, Array]]:
    """Return points by sheet for further polish; none if the front is as good and full as asked.

    First those that dominate a polished design. Then, where designs are wanting, those that no polished design
    dominates, and points half-way between neighbours. stand: called many times a second.
    """
    best = finished[finished.best(stand)]
    front = best.values / best.span
    _sample(problem, evaluators, archive, best, attempt)
    screened = archive.values / best.span
    beating, uncovered = _against(screened, front)
    # Samples within a band around the constraints prove nothing.
    rows = np.flatnonzero(beating & archive.met)[:_POOL]
    wanting = problem.settings.designs - len(front) if front.shape[1] > 1 else 0
    starts = archive[_few(screened, rows, front, max(wanting, 32), stand)].by_sheet(evaluators)
    if wanting > 0:
        rows = np.flatnonzero(uncovered & ~beating)
        rows = _few(screened, rows[:: 1 + len(rows) // _POOL], front, wanting, stand)
        starts += archive[rows].by_sheet(evaluators)
        starts += _half_way(evaluators, best, wanting)
    return starts


def _sample(problem: Problem, evaluators: list[Evaluator], archive: Archive, best: Finished, attempt: int) -> None:
    """Screen points everywhere, and the polished designs, what is around them, and all that on other sheets."""
    seed, k = problem.settings.seed, len(evaluators)
    random = generator(seed, 2000, attempt)
    for index, evaluator in enumerate(evaluators):
        count = share(problem.settings.samples or FIRST, evaluators)
        archive.screen(index, evaluator, first_samples(count, evaluator.dimension, seed, 200 + k * attempt + index))
        count = -(-(problem.settings.samples or SAMPLES) // k)
        parents = stacked(np.zeros((0, evaluator.dimension)), best.u)[:, : evaluator.dimension]
        near = around(parents, best.values, count, _WIDTH, random)
        images = parents[best.sheet != index]
        archive.screen(index, evaluator, np.concatenate([near, images]))


def _against(screened: Array, front: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which screened designs dominate one of the front, and which none of the front dominates."""
    kept = np.zeros(len(front) + len(screened), dtype=bool)
    kept[nondominated(np.concatenate([front, screened]))] = True
    beating = np.zeros(len(screened), dtype=bool)
    for values in front:
        apart = screened - values
        worst, gain = apart.max(axis=1), -apart.min(axis=1)
        beating |= (worst <= 0.0) & (gain > _CLEAR) | (worst <= _CLEAR) & (gain > _GAIN)
    return beating, kept[len(front) :]


def _few(screened: Array, rows: NDArray[np.int64], front: Array, count: int, stand: Stand) -> NDArray[np.int64]:
    """Return at most `count` of some rows: those that add most to the hypervolume of the front."""
    if len(rows) <= count:
        return rows
    if front.shape[1] == 1:
        return rows[np.argsort(screened[rows, 0], kind="stable")[:count]]
    union = np.concatenate([front, screened[rows]])
    picked = choose(union, len(front) + count, always=tuple(range(len(front))), stand=stand)
    return rows[picked[picked >= len(front)] - len(front)]


def _half_way(evaluators: list[Evaluator], best: Finished, count: int) -> list[tuple[int, Array]]:
    """Return the middles between neighbours on the front, the farthest apart first."""
    scaled = best.values / best.span
    n, m = scaled.shape
    if n < 2:
        return []
    from scipy.spatial import cKDTree

    nearest = cKDTree(scaled).query(scaled, k=min(n, 1 + _NEIGHBOURS * m))[1]
    both = np.stack(np.broadcast_arrays(np.arange(n)[:, None], nearest), axis=-1).reshape(-1, 2)
    pairs = np.unique(np.sort(both), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    pairs = pairs[best.sheet[pairs[:, 0]] == best.sheet[pairs[:, 1]]]
    gap = np.linalg.norm((best.values[pairs[:, 0]] - best.values[pairs[:, 1]]) / best.span, axis=1)
    pairs = pairs[np.argsort(-gap, kind="stable")[:count]]
    middle = 0.5 * (best.u[pairs[:, 0]] + best.u[pairs[:, 1]])
    return replace(best[pairs[:, 0]], u=middle).by_sheet(evaluators)
