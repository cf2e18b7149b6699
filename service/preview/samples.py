"""Samples of the designs that a job allows; equalities are met exactly, as is a value in each narrow band."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...model.errors import InputError
from ...model.swing.ends import start_column
from ...objectives.registry import QUANTITIES
from ...optimise.job.possible_values import Box
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint
from ...optimise.search.elimination import elimination_branches
from ...optimise.search.evaluation import Evaluator
from ...optimise.search.sampling import first_samples

Array = NDArray[np.float64]

SAMPLES = 512
BATCH = 64
_MOMENT = 0.06  # s, for the designs of quantities that take a cycle
_BAND = 0.5  # of what the ranges allow of a quantity: wider bands are met by samples of the whole box
_VALUES = 8  # within bands, each with as many samples as the others


def designs_of(problem: Problem, count: int) -> Array:
    """Return designs (n, 3) in the box that meet the eliminable equalities; some may not be linkages.

    Designs of a swing with a variable start have the start as a fourth number.
    """
    parts = []
    for index, branch in enumerate(elimination_branches(problem)):
        parts.append(branch.dimensions(first_samples(count, len(branch.free), 1, index))[:, _length_columns(problem)])
    return np.concatenate(parts)


def _length_columns(problem: Problem) -> list[int]:
    """Return the shown columns of designs: the three lengths, and the start of a swing if it varies."""
    column = start_column(problem.mechanism)
    return [0, 1, 2, *([] if column is None else [column])]


def screened(problem: Problem) -> tuple[Array, Array]:
    """Return designs as in `designs_of` and their greatest relative violation (n,), as many as a short time allows."""
    end = time.monotonic() + _MOMENT
    columns = _length_columns(problem)
    designs, violations = [np.zeros((0, len(columns)))], [np.zeros(0)]
    parts = _exact_parts(problem)
    for place, part in enumerate(parts):
        for index, branch in enumerate(elimination_branches(part)):
            evaluator = Evaluator(part, branch)
            points = first_samples(SAMPLES // len(parts), evaluator.dimension, 1, index + 10 * place)
            for begin in range(0, len(points), BATCH):
                screened_designs, _, violation = evaluator.screen(points[begin : begin + BATCH])
                designs.append(screened_designs[:, columns])
                violations.append(violation)
                if time.monotonic() > end:
                    break
    return np.concatenate(designs), np.concatenate(violations)


def _exact_parts(problem: Problem) -> list[Problem]:
    """Return problems that require single values within the bands of a problem; itself if it has no bands.

    A band is a quantity between two values that can be eliminated. Its values are spread over what the ranges allow of
    it: samples of the whole box would hardly meet a thin band, while those of an exact value meet it always.
    """
    bands, box = [], Box.from_problem(problem)
    for constraint in problem.constraints if box.turns else ():
        quantity = QUANTITIES.get(constraint.quantity)
        if constraint.lower is None or constraint.upper is None or quantity is None or quantity.bounds is None:
            continue
        least, greatest = box.possible(quantity)
        lower, upper = max(constraint.lower, least), min(constraint.upper, greatest)
        is_band = lower < upper and upper - lower < _BAND * (greatest - least)
        if is_band and _can_be_eliminated(problem, replace(constraint, lower=lower, upper=lower)):
            bands.append((constraint, lower, upper))
    if not bands:
        return [problem]
    parts = []
    for shares in first_samples(_VALUES, len(bands), 1, 0):
        exact = {
            band.quantity: replace(band, lower=value, upper=value)
            for (band, lower, upper), share in zip(bands, shares, strict=True)
            for value in [lower + float(share) * (upper - lower)]
        }
        parts.append(replace(problem, constraints=tuple(exact.get(c.quantity, c) for c in problem.constraints)))
    return parts


def _can_be_eliminated(problem: Problem, exact: Constraint) -> bool:
    """Return whether an exact value in place of a band leaves it to no sample whether it is met."""
    constraints = tuple(exact if c.quantity == exact.quantity else c for c in problem.constraints)
    with suppress(InputError):
        branches = elimination_branches(replace(problem, constraints=constraints))
        return all(exact.quantity in branch.eliminated for branch in branches)
    return False
