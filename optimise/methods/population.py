"""Generation after generation: breed, evaluate at once, keep, remember. What a run has kept, it can go on from.

A method says only how a brood is bred from the generations before it. Every brood has random numbers of its own, seeded
by the run's seed and its number, and depends on nothing but the generations that were kept: a run that goes on from
them gives the designs that it would have given without the interruption, bit for bit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...model.errors import InputError
from ..evaluation import FEASIBLE, Evaluator
from ..problem import Problem
from ..search import Archive, Run
from ..stationarity import Array
from .generation import Brood, Generation
from .registry import budget

_SAME = 1e-9
"""Of the unit box and of objectives: another processor may round otherwise, another method or job differs by more."""

BAND = 0.01
"""Relative violation that counts as none where an equality is left, which no sample meets; the delivery removes it."""


class Breed(Protocol):
    """How a method finds the next points."""

    def __call__(self, past: Sequence[Generation]) -> Brood:
        """Return the brood that follows these generations, which depends on nothing but them."""
        ...


def evolve(problem: Problem, evaluators: list[Evaluator], run: Run, breed: Breed, *, size: int) -> Archive:
    """Return the archive of the non-dominated feasible designs of all generations that the budget allows.

    size: of a generation, for the progress. Generations that the run brings along are not evaluated again; raises
    `InputError` if they are not those of this problem.
    """
    allowed = budget(problem)
    run.rounds = max(1, allowed // size)
    seen = _Seen(problem, evaluators)
    past: list[Generation] = []
    for generation in run.past:
        seen.take(generation)
        past.append(generation)
    if past:
        _require_own(problem, seen, past, breed)
        run.tell("resumed", evaluators, seen.archive)
    count = sum(len(generation) for generation in past)
    while not run.stop():
        brood = breed(past) if seen.dimension else _only(len(evaluators))
        if count + len(brood) > allowed and past:
            break
        generation = seen.evaluate(brood)
        past.append(generation)
        count += len(generation)
        if run.keep is not None:
            run.keep(generation)
        run.tell("evolving", evaluators, seen.archive)
        if not seen.dimension:
            break
    return seen.archive


class _Seen:
    """Every point that was evaluated, so that none is evaluated twice, and the archive of the best."""

    def __init__(self, problem: Problem, evaluators: list[Evaluator]) -> None:
        self.evaluators = evaluators
        self.dimension = max(evaluator.dimension for evaluator in evaluators)
        self.objectives = len(problem.objectives)
        self.archive = Archive.empty(self.objectives)
        self.archive.band = self.band = BAND if any(evaluator.loose for evaluator in evaluators) else 0.0
        self.known: dict[tuple[int, bytes], tuple[Array, float]] = {}

    def evaluate(self, brood: Brood) -> Generation:
        """Return what the points of a brood are, each sheet's new ones evaluated in one batch."""
        keys = self._keys(brood)
        fresh = {key: row for row, key in enumerate(keys) if key not in self.known}
        for index, evaluator in enumerate(self.evaluators):
            own = [(key, row) for key, row in fresh.items() if key[0] == index]
            if own:
                u = brood.u[[row for _, row in own], : evaluator.dimension]
                values, violation = screened(evaluator, u, self.band)
                self.known.update({key: (values[i], violation[i]) for i, (key, _) in enumerate(own)})
                self._archive(index, u, values, violation)
        return Generation(
            brood.sheet,
            brood.u,
            brood.parents,
            np.array([self.known[key][0] for key in keys]),
            np.array([self.known[key][1] for key in keys]),
        )

    def take(self, generation: Generation) -> None:
        """Take in a generation that was evaluated before."""
        known = set(generation.sheet.tolist()) <= set(range(len(self.evaluators)))
        if not known or generation.values.shape[1] != self.objectives or generation.u.shape[1] != self.dimension:
            raise InputError(_OTHER)
        keys = self._keys(generation)
        fresh = {key: row for row, key in enumerate(keys) if key not in self.known}
        for index, evaluator in enumerate(self.evaluators):
            rows = [row for key, row in fresh.items() if key[0] == index]
            values, violation = generation.values[rows], generation.violation[rows]
            self._archive(index, generation.u[rows, : evaluator.dimension], values, violation)
            evaluator.evaluations += len(rows)
        self.known.update({key: (generation.values[row], generation.violation[row]) for key, row in fresh.items()})

    def _keys(self, brood: Brood) -> list[tuple[int, bytes]]:
        u = brood.u + 0.0  # no negative zeros
        return [
            (index, point[: self.evaluators[index].dimension].tobytes())
            for index, point in zip(brood.sheet.tolist(), u, strict=True)
        ]

    def _archive(self, index: int, u: Array, values: Array, violation: Array) -> None:
        good = violation <= FEASIBLE
        self.archive.feasible += 0 if self.band else int(good.sum())
        if good.any():
            self.archive.take(index, u[good], values[good])


def screened(evaluator: Evaluator, u: Array, band: float = 0.0) -> tuple[Array, Array]:
    """Return objectives (n, m) and violation beyond a band (n,) of points.

    Whatever is not feasible has NaN objectives, and what has one that is not finite counts as infinitely violated.
    """
    _, values, violation = evaluator.screen(u, band=band)
    violation = np.maximum(violation - band, 0.0) if band else violation
    undefined = (violation <= FEASIBLE) & ~np.isfinite(values).all(axis=1) | np.isnan(violation)
    violation = np.where(undefined, np.inf, violation)
    return np.where((violation <= FEASIBLE)[:, None], values, np.nan), violation


def _only(sheets: int) -> Brood:
    """Return the only point that each sheet has where nothing is free."""
    return Brood(np.arange(sheets), np.zeros((sheets, 0)), np.zeros(0, np.int64))


def _require_own(problem: Problem, seen: _Seen, past: list[Generation], breed: Breed) -> None:
    """Raise `InputError` unless the last generation comes out again: bred from those before, and evaluated."""
    last = past[-1]
    if seen.dimension:
        again = breed(past[:-1])
        same = len(again) == len(last) and np.array_equal(again.sheet, last.sheet)
        if not (same and np.allclose(again.u, last.u, rtol=0.0, atol=_SAME)):
            raise InputError(_OTHER)
    for index, evaluator in enumerate(seen.evaluators):
        rows = np.flatnonzero(last.sheet == index)
        if len(rows):
            before = evaluator.evaluations
            values, violation = screened(evaluator, last.u[rows, : evaluator.dimension], seen.band)
            evaluator.evaluations = before
            if not (_alike(violation, last.violation[rows]) and _alike(values, last.values[rows])):
                raise InputError(_OTHER)


def _alike(one: Array, two: Array) -> bool:
    """Return whether numbers differ by rounding only, of the size of the greatest."""
    size = float(np.max(np.abs(two[np.isfinite(two)]), initial=0.0))
    return np.allclose(one, two, rtol=0.0, atol=_SAME * size, equal_nan=True)


_OTHER = (
    "a run goes on only from its own generations; those given come out otherwise with this job, method, seed and these "
    "versions; start the run anew"
)
