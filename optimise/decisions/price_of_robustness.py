"""Comparison of fronts: several for the same objectives, and the robust front with the nominal one.

Several fronts have coverage, contribution, and distance from their union. All figures share one scaling: ideal and
range of the union front, which holds the non-dominated designs among all. If the union front has no range in an
objective, the range over all designs is used.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ...model.errors import InputError
from ..front.dominance import nondominated
from ..front.front import ParetoFront
from ..front.hypervolume import hypervolume, ideal_and_range
from ..front.saved_front import column_ranges
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.robust_problem import nominal_problem
from ..solve import solve


@dataclass(frozen=True)
class RobustCost:
    """A robust front and the nominal one; objectives (n, m) in display units.

    nominal: objectives of the nominal designs, as drawn. toleranced: objectives of the same designs within tolerances.
    robust: objectives of the robust designs within tolerances. keeps: number of nominal designs that meet all
    requirements within tolerances.
    """

    nominal: Array
    toleranced: Array
    robust: Array
    keeps: int

    def cost_of_robustness(self, column: int, *, maximised: bool) -> float:
        """Return by how much the robust front's best value falls short of the nominal best, in display units."""
        best = np.max if maximised else np.min
        away = float(best(self.nominal[:, column]) - best(self.robust[:, column]))
        return away if maximised else -away


def robust_cost(front: ParetoFront) -> RobustCost | None:
    """Return the price of a front's robustness; None if the nominal problem has no front. Solves that problem."""
    problem = front.problem
    plain = solve(nominal_problem(problem))
    if not len(plain) or not len(front):
        return None
    keeps = 0
    toleranced = np.zeros(plain.values.shape)
    for row in range(len(plain)):
        part = problem.part(plain.variants[row] if plain.variants else 0)
        toleranced[row] = _objective_values(part, plain.dimensions[row : row + 1])
        keeps += _meets_constraints(part, plain.dimensions[row : row + 1])
    names = [plain.problem.quantity(objective.quantity).field for objective in plain.objectives]
    fields = [problem.quantity(objective.quantity).field for objective in front.objectives]
    return RobustCost(plain.designs[names].to_numpy(float), toleranced, front.designs[fields].to_numpy(float), keeps)


def _objective_values(problem: Problem, design: Array) -> list[float]:
    quantities = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return [float(q.evaluate(problem.mechanism, design).values[0]) * q.unit.factor for q in quantities]


def _meets_constraints(problem: Problem, design: Array) -> bool:
    for constraint in problem.constraints:
        value = float(problem.quantity(constraint.quantity).evaluate(problem.mechanism, design).values[0])
        for bound, sign in ((constraint.lower, 1.0), (constraint.upper, -1.0)):
            if bound is not None and not sign * (value - bound) >= -FEASIBLE * (abs(bound) or 1.0):
                return False
    return True


TOLERANCE = 1e-6
"""Fraction of an objective's range within which values count as equal, about the accuracy of the designs."""


@dataclass(frozen=True)
class Comparison:
    """Comparison of k fronts.

    sizes: (k,), numbers of designs. ideal, span: (m,), the scaling, in the objectives' units. hypervolumes: (k,),
    hypervolume of each front, as a fraction of the box from the ideal to 1.1 ranges beyond it. union: hypervolume of
    all fronts together. shares: (k,), hypervolumes divided by that of the union. in_union: (k,), number of each front's
    designs that no design of any front dominates; a design in several fronts counts for each. coverage: (k, k), `[a,
    b]` is the fraction of b's designs that a weakly dominates. epsilon: (k, k), `[a, b]` is the least number that,
    added to all scaled objectives of b, lets a weakly dominate all of b; zero or less if a already does. dominates: (k,
    k), whether a weakly dominates all of b, and b not all of a. tolerance: fraction of the range that counts as equal
    in `in_union`, `coverage` and `dominates`.
    """

    sizes: IntArray
    ideal: Array
    span: Array
    hypervolumes: Array
    union: float
    shares: Array
    in_union: IntArray
    coverage: Array
    epsilon: Array
    dominates: Mask
    tolerance: float


def compare_fronts(fronts: Sequence[Array], *, tolerance: float = TOLERANCE) -> Comparison:
    """Compare fronts (n_k, m) by their minimised objective values.

    Coverage C(A, B) after E. Zitzler and L. Thiele, "Multiobjective evolutionary algorithms: a comparative case study
    and the strength Pareto approach", IEEE Trans. Evolutionary Computation 3(4), 1999; the additive epsilon indicator
    and "weakly dominates" after Zitzler et al., "Performance assessment of multiobjective optimizers: an analysis and
    review", ibid. 7(2), 2003. Two samples of the same front cover little of each other; the epsilon indicator then
    shows how close they are.

    Raises `InputError` for fewer than two fronts, an empty one, or different numbers of objectives.
    """
    if len(fronts) < 2:
        raise InputError(f"a comparison needs at least two fronts; got {len(fronts)}")
    if any(not len(front) for front in fronts):
        raise InputError("a front to compare must have designs; got an empty one; leave it out")
    if len({front.shape[1] for front in fronts}) > 1:
        raise InputError("fronts to compare must have the same objectives; got different numbers of them")
    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise InputError(f"the tolerance must be a fraction of the range, zero or more; got {tolerance:g}")
    everything = np.concatenate(list(fronts))
    ideal, span = _ideal_and_range(everything)
    scaled = [np.asarray((front - ideal) / span) for front in fronts]
    volumes = np.array([hypervolume(front, ideal, span) for front in fronts])
    union = hypervolume(everything, ideal, span)
    k = len(fronts)
    coverage, epsilon = np.ones((k, k)), np.zeros((k, k))
    for a in range(k):
        for b in range(k):
            # Excess of a's nearest design over each design in b, in the worst objective.
            excess = np.array([np.min(np.max(scaled[a] - point, axis=1)) for point in scaled[b]])
            coverage[a, b] = float(np.mean(excess <= tolerance))
            epsilon[a, b] = float(excess.max())
    covers_all = coverage == 1.0
    return Comparison(
        sizes=np.array([len(front) for front in fronts]),
        ideal=ideal,
        span=span,
        hypervolumes=volumes,
        union=union,
        shares=volumes / union,
        in_union=np.array([_count_undominated(front, scaled, tolerance) for front in scaled]),
        coverage=coverage,
        epsilon=epsilon,
        dominates=covers_all & ~covers_all.T,
        tolerance=tolerance,
    )


def _ideal_and_range(everything: Array) -> tuple[Array, Array]:
    """Return ideal and range of the union front; where it has no range, use the range of all designs."""
    best = everything[nondominated(everything)]
    best_range = column_ranges(best)
    return best.min(axis=0), np.where(best_range > 0.0, best_range, ideal_and_range(everything)[1])


def _count_undominated(front: Array, fronts: Sequence[Array], tolerance: float) -> int:
    """Return the number of designs that no other design dominates by more than the tolerance."""
    everything = np.concatenate(list(fronts))
    return sum(
        not bool(((everything <= point + tolerance).all(axis=1) & (everything < point - tolerance).any(axis=1)).any())
        for point in front
    )
