"""Distance of a front from the true one: bounded by branch and bound on the whole design box.

The statement proven, for an epsilon e and objectives scaled by their range over the front: **for every feasible design,
some design of the set is worse by at most e of the range in every objective**. Hence no design that the job permits can
beat all designs of the set by more than e. The set is the front as delivered, or the front completed by designs that
the search for the proof adds: a front of few designs leaves gaps between neighbours, and no proof can be better than
the widest gap. The certificate has both numbers, and the design that shows the widest gap.

A box of designs is closed when none of them can be feasible, or when one design of the set covers the box's lower
corner (`cover`): it then covers every feasible design of the box. Other boxes are halved, those of the largest excess
first, so that at any time the largest excess of the open boxes is a proven epsilon. Where a box is small enough that a
feasible design of its own covers its corner, and no other does, that design is added.

The proof relies on bounds as in `boxes`, which account for rounding, and on the values of the set's designs as the
model computes them. Requirements count as met to 1e-9 of their size, as everywhere else.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError
from ..discrete.combinations import Axes, with_values
from ..problem.problem import Problem
from .certificate import Certificate, Step
from .defaults import EPSILON, SECONDS
from .search import Search

MOST_COMBINATIONS = 1_000
"""Combinations of listed values, each of which has boxes of its own."""


def certify_designs(
    problem: Problem,
    dimensions: Array,
    *,
    variants: Sequence[int] = (),
    epsilon: float = EPSILON,
    seconds: float = SECONDS,
    progress: Callable[[Step], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Certificate:
    """Return a proof of the greatest distance of a set of designs from the true front.

    dimensions: (n, 3 + v), crank, rod, offset, m, and the extra variables, SI, of designs that meet the job's
    requirements. variants: the variant of each in a problem with choices. epsilon: requested epsilon, a fraction of the
    objectives' ranges over these designs. seconds: time limit, s; returns what is proven so far. progress: called
    between rounds. cancelled: called between rounds. Each combination of listed values is a variant of its own. Raises
    `InputError` without designs, for too many combinations, and for objectives that cannot be bounded over a range of
    designs (`boundable.unbounded_reason`).
    """
    if not len(dimensions):
        raise InputError("a certificate needs a front with designs; this one is empty; its message says why")
    if not 0.0 < epsilon < 1.0:
        raise InputError(f"epsilon must be a fraction of the objectives' ranges, above 0 and below 1; got {epsilon:g}")
    if not seconds > 0.0:
        raise InputError(f"the budget must be longer than zero; got {seconds:g} s")
    chosen = np.array(variants if len(variants) else [0] * len(dimensions), dtype=np.int64)
    if problem.discrete:
        problem, chosen = _enumerated(problem, chosen)
    search = Search(problem, dimensions, chosen, epsilon, seconds, cancelled)
    search.run(progress)
    return search.certificate()


def _enumerated(problem: Problem, variants: IntArray) -> tuple[Problem, IntArray]:
    """Return a problem with a variant for each combination of listed values, and variants for designs of the old ones.

    A design's variant is any combination of its choices: its values come from the design itself.
    """
    axes = [Axes.of_problem(part) for part in problem.parts()]
    counts = [axis.count for axis in axes]
    if sum(counts) > MOST_COMBINATIONS:
        raise InputError(
            f"a certificate takes at most {MOST_COMBINATIONS:,} combinations of listed values; got {sum(counts):,} of "
            f"{', '.join(item.name for item in problem.discrete)}; list fewer, or certify the job with ranges"
        )
    rows = [(index, row) for index, axis in enumerate(axes) for row in axis.designs(0, axis.count)]
    return with_values(problem, rows), np.cumsum([0, *counts[:-1]])[variants]
