"""Distance from a front to the true one, bounded by branch and bound over the whole design box.

The statement proven, for an epsilon e and objectives scaled by their range over the front: **for every feasible design,
some design of the set is worse by at most e of the range in every objective**. So no permitted design can beat all
designs in the set by more than e. The set is the front as delivered, or the front completed by designs that the proof
search adds. A front with few designs leaves gaps, and no proof can be better than the widest gap. The certificate
states both numbers, and the design that shows the widest gap.

A box of designs is closed when none of its designs can be feasible. It is also closed when one design in the set covers
the box's lower corner (`covering_designs`), and thus every feasible design in the box. Other boxes are halved, largest
excess first, so at any time the largest excess among open boxes is a proven epsilon. In a small box, a feasible design
from the box itself may cover its corner when no other design does; that design is added.

The proof relies on the bounds from `box_bounds`, which account for rounding, and on the model's values for the designs
in the set. Requirements count as met to a relative 1e-9, as everywhere else.
"""

from collections.abc import Callable, Sequence

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError
from ..discrete.combinations import Axes, problem_with_combinations
from ..problem.problem import Problem
from .certificate import Certificate, Step
from .certificate_search import Search
from .defaults import EPSILON, SECONDS

MOST_COMBINATIONS = 1_000
"""Maximum number of combinations of listed values; each has its own boxes."""


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
    """Return a proof of the greatest distance from a set of designs to the true front.

    dimensions: (n, 3 + v), crank, rod, offset, m, and the extra variables, SI, of designs that meet the job's
    requirements. variants: the variant of each in a problem with choices. epsilon: requested epsilon, as a fraction of
    the objectives' ranges over these designs. seconds: time limit, s; returns what is proven so far. progress,
    cancelled: called between rounds. Each combination of listed values is a separate variant. Raises `InputError` if
    there are no designs, if there are too many combinations, or if an objective cannot be bounded over a range of
    designs (`boundable.unbounded_reason`).
    """
    if not len(dimensions):
        raise InputError("a certificate needs a front with designs; this one is empty; see its message")
    if not 0.0 < epsilon < 1.0:
        raise InputError(f"epsilon must be a fraction of the objectives' ranges, above 0 and below 1; got {epsilon:g}")
    if not seconds > 0.0:
        raise InputError(f"the budget must be above zero; got {seconds:g} s")
    chosen = np.array(variants if len(variants) else [0] * len(dimensions), dtype=np.int64)
    if problem.discrete:
        problem, chosen = _with_variant_per_combination(problem, chosen)
    search = Search(problem, dimensions, chosen, epsilon, seconds, cancelled)
    search.run(progress)
    return search.build_certificate()


def _with_variant_per_combination(problem: Problem, variants: IntArray) -> tuple[Problem, IntArray]:
    """Return a problem with a variant for each combination of listed values, and each design's variant in that problem.

    A design's variant may be any combination of its choices: the design itself holds their values.
    """
    axes = [Axes.of_problem(part) for part in problem.parts()]
    counts = [axis.combination_count for axis in axes]
    if sum(counts) > MOST_COMBINATIONS:
        raise InputError(
            f"a certificate can cover at most {MOST_COMBINATIONS:,} combinations of listed values; got "
            f"{sum(counts):,} of {', '.join(item.name for item in problem.discrete)}; list fewer, or certify the "
            "job with ranges"
        )
    rows = [
        (index, row) for index, axis in enumerate(axes) for row in axis.combinations_between(0, axis.combination_count)
    ]
    return problem_with_combinations(problem, rows), np.cumsum([0, *counts[:-1]])[variants]
