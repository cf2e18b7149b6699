"""Samples of the designs that a job allows; equalities are met exactly, as is a value in each narrow band.

Half of them are spread uniformly, and fractions count these alone. The others lie on faces and edges of the box too,
where extremes are.
"""

import math
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.swing.end_angles import swing_start_column
from ...objectives.registry import QUANTITIES
from ...optimise.job.reachable_values import Box
from ...optimise.problem.constraint_violation import FEASIBLE
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint
from ...optimise.search.elimination import EliminationBranch, elimination_branches
from ...optimise.search.evaluation import Evaluator
from ...optimise.search.sampling import first_samples

SAMPLES = 512
BATCH = 64
_MOMENT = 0.06  # s for designs whose quantities need a whole cycle
_BAND = 0.5  # fraction of a quantity's possible range: samples of the whole box meet wider bands
_VALUES = 8  # number of values within bands, each with equally many samples


@dataclass(frozen=True)
class Screening:
    """Designs (n, 3) with minimised objectives (n, m) and greatest relative violation (n,).

    is_uniform: whether each is one of the uniform samples. met_by_all: names of the exact values and narrow bands.
    """

    designs: Array
    objectives: Array
    violation: Array
    is_uniform: NDArray[np.bool_]
    met_by_all: tuple[str, ...]

    @property
    def is_feasible(self) -> NDArray[np.bool_]:
        """Whether each design meets every requirement."""
        return np.asarray(self.violation <= FEASIBLE)

    @property
    def uniform_sample_count(self) -> int:
        """Number of uniform samples."""
        return int(self.is_uniform.sum())

    @property
    def feasible_fraction(self) -> float:
        """Fraction of the uniform samples that meet every requirement."""
        return float(self.is_feasible[self.is_uniform].mean()) if self.uniform_sample_count else 0.0


def sampled_designs(problem: Problem) -> tuple[Array, NDArray[np.bool_]]:
    """Return designs (n, 3) in the box that meet the eliminable equalities, and whether each is a uniform sample.

    Some may not be linkages. Designs of a swing with a variable start have the start as a fourth number.
    """
    branches = elimination_branches(problem)
    parts = list(_points_of_branches(branches, SAMPLES, 0))
    designs = [branches[index].designs_at_points(points)[:, _length_columns(problem)] for index, points, _ in parts]
    return np.concatenate(designs), np.repeat([part[2] for part in parts], [len(points) for points in designs])


def _points_of_branches(
    branches: Sequence[EliminationBranch], count: int, stream: int
) -> Iterator[tuple[int, Array, bool]]:
    """For each branch, yield its index, points, and whether they are uniform.

    The number of uniform points is proportional to the width of the offset range, if all branches search offsets.
    """
    ranges = [branch.bounds["offset"] for branch in branches]
    by_width = all("offset" in branch.free for branch in branches)
    widths = [item.upper - item.lower if by_width else 1.0 for item in ranges]
    for index, branch in enumerate(branches):
        dimension, uniform = len(branch.free), math.ceil(count * widths[index] / max(widths))
        yield index, first_samples(uniform, dimension, 1, stream + index, boundary_share=0.0), True
        if dimension:
            yield index, first_samples(count, dimension, 1, stream + index), False


def _length_columns(problem: Problem) -> list[int]:
    """Return the displayed columns of designs: the three lengths, and the start of a swing if it varies.

    All columns for a lever.
    """
    if problem.mechanism.lever is not None:
        return list(range(3 + len(problem.mechanism.varying)))
    column = swing_start_column(problem.mechanism)
    return [0, 1, 2, *([] if column is None else [column])]


def screened_samples(problem: Problem) -> Screening:
    """Return designs as in `sampled_designs` with their violations, as many as a short time allows."""
    end = time.monotonic() + _MOMENT
    columns = _length_columns(problem)
    designs, violations, uniform = [np.zeros((0, len(columns)))], [np.zeros(0)], [np.zeros(0, dtype=bool)]
    objectives = [np.zeros((0, len(problem.objectives)))]
    parts = _problems_with_exact_bands(problem)
    for place, part in enumerate(parts):
        branches = elimination_branches(part)
        evaluators = [Evaluator(part, branch) for branch in branches]
        for index, points, is_uniform in _points_of_branches(branches, SAMPLES // len(parts), 10 * place):
            if not is_uniform and time.monotonic() > end:
                continue
            for begin in range(0, len(points), BATCH):
                screened_designs, values, violation = evaluators[index].screen_designs_objectives_violation(
                    points[begin : begin + BATCH]
                )
                designs.append(screened_designs[:, columns])
                objectives.append(values)
                violations.append(violation)
                uniform.append(np.full(len(violation), is_uniform))
                if time.monotonic() > end:
                    break
    return Screening(
        np.concatenate(designs),
        np.concatenate(objectives),
        np.concatenate(violations),
        np.concatenate(uniform),
        elimination_branches(parts[0])[0].eliminated,
    )


def _problems_with_exact_bands(problem: Problem) -> list[Problem]:
    """Return problems that require single values within the bands of a problem; itself if it has no bands.

    A band is a range for a quantity that can be eliminated. Its values are spread over the possible range of the
    quantity: samples of the whole box would rarely meet a thin band, whereas samples of an exact value always do.
    """
    bands, box = [], Box.from_problem(problem)
    for constraint in problem.constraints if box.may_rotate_fully else ():
        quantity = QUANTITIES.get(constraint.quantity)
        if constraint.lower is None or constraint.upper is None or quantity is None or quantity.bounds is None:
            continue
        least, greatest = box.bounds_on_quantity(quantity)
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
    """Return whether an exact value within a band guarantees that every sample meets the band."""
    constraints = tuple(exact if c.quantity == exact.quantity else c for c in problem.constraints)
    with suppress(InputError):
        branches = elimination_branches(replace(problem, constraints=constraints))
        return all(exact.quantity in branch.eliminated for branch in branches)
    return False
