"""Combinations of discrete values: how many there are, those that meet every requirement, and the nearest ones."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ..front.dominance import nondominated
from ..front.hypervolume import ReportProgress, ignore_progress
from ..problem.constraint_violation import (
    FEASIBLE,
    constraints_with_floors,
    greatest_violation,
    minimised_objectives,
    needs_computed_cycle,
    rotates_beyond_rounding,
)
from ..problem.problem import Problem, Variant
from ..problem.requirements import Range
from ..problem.robust_problem import has_robust_requirements

_BATCH, _ROBUST_BATCH = 1 << 15, 1 << 10  # combinations to judge between two progress reports


_HELD = 1 << 17  # maximum number of feasible combinations to store; only the best of more are kept
_EXPANDED = 256  # designs whose neighbours are found together: with eight numbers each has 6,561


@dataclass(frozen=True)
class Axes:
    """Possible values of a design's numbers in one variant of a problem.

    part: the variant. values: possible values for each number of a design (3 + v), None if it is free within a range.
    """

    part: Problem
    values: tuple[Array | None, ...]

    @classmethod
    def of_problem(cls, part: Problem) -> Axes:
        """Return the axes for a problem without choices; a fixed number has a single value."""
        discrete = {item.name: item for item in part.discrete}
        axes: list[Array | None] = []
        for name, ends in part.ranges.items():
            if ends.fixed:
                axes.append(np.array([ends.lower]))
            elif name in discrete:
                side = part.slow_side() if name == "offset" else None
                values = discrete[name].values_in(ends)
                axes.append(values if side is None else values[side * values > 0.0])
            else:
                axes.append(None)
        return cls(part, tuple(axes))

    @property
    def has_no_free_number(self) -> bool:
        """Whether every combination is a complete design, without free numbers."""
        return all(values is not None for values in self.values)

    @property
    def combination_count(self) -> int:
        """Number of combinations."""
        return math.prod(len(values) for values in self.values if values is not None)

    def combinations_between(self, begin: int, end: int) -> Array:
        """Return combinations (n, 3 + v) in order, with the last number changing fastest.

        NaN where a number is free.
        """
        return self.combinations_at_indices(np.arange(begin, min(end, math.prod(self._sizes))))

    def combinations_at_indices(self, numbers: IntArray) -> Array:
        """Return combinations (n, 3 + v) by their indices."""
        places = np.unravel_index(numbers, self._sizes)
        columns = [
            np.full(len(at), np.nan) if values is None else values[at]
            for values, at in zip(self.values, places, strict=True)
        ]
        return np.stack(columns, axis=1)

    def indices_of_neighbours(self, designs: Array) -> IntArray:
        """Return the indices (n, s) of the combinations at designs (n, 3 + v) and next to them.

        They include the design itself, which also replaces neighbours beyond the ends.
        """
        places = np.stack(self._value_indices(designs), axis=1)
        ways = np.array(list(itertools.product(*((-1, 0, 1) if size > 1 else (0,) for size in self._sizes))))
        neighbours_at = np.clip(places[:, None] + ways, 0, np.array(self._sizes) - 1)
        return np.asarray(np.ravel_multi_index(tuple(np.moveaxis(neighbours_at, 2, 0)), self._sizes), np.int64)

    def indices_of_combinations(self, designs: Array) -> IntArray:
        """Return the index of each combination (n, 3 + v), as `designs` counts them."""
        return np.asarray(np.ravel_multi_index(tuple(self._value_indices(designs)), self._sizes), np.int64)

    @property
    def _sizes(self) -> tuple[int, ...]:
        return tuple(1 if values is None else len(values) for values in self.values)

    def _value_indices(self, designs: Array) -> list[IntArray]:
        return [
            np.zeros(len(designs), np.int64) if values is None else np.searchsorted(values, column)
            for values, column in zip(self.values, designs.T, strict=True)
        ]


@dataclass(frozen=True)
class FeasibleDesigns:
    """Combinations that meet every requirement, and the nearest of the others.

    part: problem of the nearest one. dimensions: (n, 3 + v). values: (n, m), objectives as minimised. judged: number of
    combinations judged. nearest: the fully rotating design (3 + v,) with the least violation, or None. missed: its
    greatest relative violation.
    """

    part: Problem
    dimensions: Array
    values: Array
    judged: int
    nearest: Array | None
    missed: float

    @classmethod
    def empty(cls, part: Problem) -> FeasibleDesigns:
        """Return no designs."""
        return cls(part, np.zeros((0, len(part.ranges))), np.zeros((0, len(part.objectives))), 0, None, np.inf)

    def merge(self, others: FeasibleDesigns) -> FeasibleDesigns:
        """Return these designs together with others, and the nearer infeasible design of the two."""
        nearer = others if others.missed < self.missed else self
        return FeasibleDesigns(
            nearer.part,
            np.concatenate([self.dimensions, others.dimensions]),
            np.concatenate([self.values, others.values]),
            self.judged + others.judged,
            nearer.nearest,
            nearer.missed,
        )

    def nondominated(self) -> FeasibleDesigns:
        """Return only the combinations that no other dominates, because millions of them would take gigabytes."""
        rows = nondominated(self.values)
        return replace(self, dimensions=self.dimensions[rows], values=self.values[rows])


def best_of_all_combinations(
    axes: Axes, report: ReportProgress = ignore_progress, *, dimensions_only: bool = False
) -> FeasibleDesigns:
    """Judge all combinations of a variant without free numbers; return the best if there are too many.

    report: called after every few thousand. dimensions_only: whether to judge only requirements that need no cycle, and
    no objectives.
    """
    judged = FeasibleDesigns.empty(axes.part)
    step = _ROBUST_BATCH if has_robust_requirements(axes.part) and not dimensions_only else _BATCH
    for begin in range(0, axes.combination_count, step):
        report(begin, axes.combination_count)
        batch = designs_meeting_requirements(
            axes.part, axes.combinations_between(begin, begin + step), dimensions_only=dimensions_only
        )
        judged = judged.merge(batch)
        judged = judged.nondominated() if len(judged.values) > _HELD else judged
    return judged


def designs_meeting_requirements(part: Problem, designs: Array, *, dimensions_only: bool = False) -> FeasibleDesigns:
    """Return the designs (n, 3 + v) that meet every requirement, with their objectives."""
    turning = designs[rotates_beyond_rounding(designs)]
    constraints = constraints_with_floors(part)
    slow = [item for item in constraints if needs_computed_cycle(part.quantity(item.quantity))]
    worst = greatest_violation(part, turning, [item for item in constraints if item not in slow])
    rows = np.flatnonzero(worst <= FEASIBLE)
    if slow and not dimensions_only:
        worst[rows] = np.maximum(worst[rows], greatest_violation(part, turning[rows], slow))
        rows = rows[worst[rows] <= FEASIBLE]
    values = np.zeros((len(rows), len(part.objectives)))
    if len(rows) and not dimensions_only:
        values = minimised_objectives(part, part.evaluate(turning[rows]))
    has_values = np.isfinite(values).all(axis=1)
    nearest = int(np.argmin(worst)) if len(worst) and np.isfinite(worst).any() else None
    return FeasibleDesigns(
        part,
        turning[rows][has_values],
        values[has_values],
        len(designs),
        None if nearest is None else turning[nearest],
        np.inf if nearest is None else float(worst[nearest]),
    )


def combinations_around(axes: Axes, designs: Array, limit: int) -> Array:
    """Return combinations (n, 3 + v) around designs, NaN where a number is free; the nearest to each design first.

    The window around each design is as wide as `limit` allows, and contains at least the values on either side.
    """
    if not len(designs):
        return designs
    free = sum(values is not None and len(values) > 1 for values in axes.values)
    width = 2
    while free and (width + 2) ** free * len(designs) <= limit:
        width += 2
    windows = [_combinations_around(axes.values, design, width) for design in designs]
    ranks = np.concatenate([np.arange(len(part)) for part in windows])
    stacked = np.concatenate(windows)[np.argsort(ranks, kind="stable")]
    _, first = np.unique(np.nan_to_num(stacked, nan=0.0), axis=0, return_index=True)
    return np.asarray(stacked[np.sort(first)][:limit])


def best_near_designs(
    axes: Axes, designs: Array, window: int, limit: int, report: ReportProgress = ignore_progress
) -> tuple[FeasibleDesigns, IntArray]:
    """Return the best combinations around designs of a fully discrete variant, and the indices of all judged ones.

    First, it judges a window of at most `window` combinations around the designs. Then it judges the neighbours of the
    best so far, until none are left or `limit` combinations are judged.
    """
    best, judged_numbers = FeasibleDesigns.empty(axes.part), np.zeros(0, np.int64)
    fresh = np.unique(axes.indices_of_combinations(combinations_around(axes, designs, window)))
    while len(fresh):
        for begin in range(0, len(fresh), _BATCH):
            report(len(judged_numbers) + begin, limit)
            batch = designs_meeting_requirements(axes.part, axes.combinations_at_indices(fresh[begin : begin + _BATCH]))
            best = best.merge(batch.nondominated()).nondominated()
        judged_numbers = np.union1d(judged_numbers, fresh)
        fresh = np.zeros(0, np.int64)
        for begin in range(0, len(best.dimensions), _EXPANDED):
            report(len(judged_numbers), limit)
            next_numbers = axes.indices_of_neighbours(best.dimensions[begin : begin + _EXPANDED])
            fresh = np.union1d(fresh, np.setdiff1d(next_numbers, judged_numbers))
        fresh = fresh[: max(0, limit - len(judged_numbers))]
    return best, judged_numbers


def has_judged_neighbours(axes: Axes, designs: Array, judged_numbers: IntArray) -> Mask:
    """Return a mask of combinations (n, 3 + v) whose neighbours are all among the judged indices."""
    return np.array(
        [bool(np.isin(axes.indices_of_neighbours(row[None]), judged_numbers).all()) for row in designs], np.bool_
    )


def _combinations_around(axes: Sequence[Array | None], design: Array, width: int) -> Array:
    """Return the combinations of values next to a design, nearest first; distances are relative to the ranges."""
    ladders, ways = [], []
    for values, value in zip(axes, design.tolist(), strict=True):
        if values is None:
            ladders.append(np.array([np.nan]))
            ways.append(np.zeros(1))
            continue
        place = int(np.searchsorted(values, value))
        near = values[max(0, place - width // 2) : place + width // 2]
        near = near if len(near) else values[-1:]
        ladders.append(near)
        ways.append(np.abs(near - value) / max(float(np.ptp(near)), 1e-300))
    grid = np.stack([axis.ravel() for axis in np.meshgrid(*ladders, indexing="ij")], axis=1)
    way = sum(axis.ravel() for axis in np.meshgrid(*ways, indexing="ij"))
    return np.asarray(grid[np.argsort(way, kind="stable")])


def problem_with_combinations(problem: Problem, chosen: Sequence[tuple[int, Array]]) -> Problem:
    """Return a problem whose variants are combinations. chosen: index of each variant and its design (3 + v,).

    A number that is NaN stays free within its range.
    """
    variants = []
    parts = problem.parts()
    for index, design in chosen:
        part = parts[index]
        variant = problem.variants[index] if problem.variants else None
        ends = [
            range_ if math.isnan(value) else Range(lower=value, upper=value)
            for range_, value in zip((part.crank, part.rod, part.offset), design[:3].tolist(), strict=True)
        ]
        varying = tuple(
            item if math.isnan(value) else replace(item, lower=value, upper=value)
            for item, value in zip(part.mechanism.varying, design[3:].tolist(), strict=True)
        )
        variants.append(
            Variant(
                labels=variant.labels if variant else (),
                mechanism=replace(part.mechanism, varying=varying),
                crank=ends[0],
                rod=ends[1],
                offset=ends[2],
                limits=variant.limits if variant else (),
                slow_stroke=variant.slow_stroke if variant else None,
                amounts=variant.amounts if variant else (),
                notes=variant.notes if variant else (),
            )
        )
    return replace(problem, discrete=(), variants=tuple(variants))
