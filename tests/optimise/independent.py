"""Computations by the tests themselves: closed forms, sampling, dominance, stationarity. Nothing of the optimiser's.

Crank r, rod l, offset e, m; a = |e|. The slider stands farthest out where crank and rod are in line, at
x_out = sqrt((l + r)^2 - e^2), and nearest where they overlap, at x_in = sqrt((l - r)^2 - e^2).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint

Array = NDArray[np.float64]


def _reach(designs: Array, side: float) -> Array:
    r, l, e = designs.T
    return np.asarray(np.sqrt((l + side * r) ** 2 - e * e))


def stroke(designs: Array) -> Array:
    """Return x_out - x_in, m."""
    return _reach(designs, 1.0) - _reach(designs, -1.0)


def time_ratio(designs: Array) -> Array:
    """Return the slower over the faster stroke. The crank turns 180 deg + b in one and 180 deg - b in the other.

    b is the angle between the crank's lines at the two dead centres, seen from the pivot: atan2(a, x) of each.
    """
    a = np.abs(designs[:, 2])
    b = np.arctan2(a, _reach(designs, -1.0)) - np.arctan2(a, _reach(designs, 1.0))
    return np.asarray((np.pi + b) / (np.pi - b))


def transmission_angle(designs: Array) -> Array:
    """Return the least angle between rod and normal, rad. The crank pin stands farthest off the line at r + a."""
    r, l, e = designs.T
    reach = r + np.abs(e)
    return np.asarray(np.arctan2(np.sqrt(l * l - reach * reach), reach))


def footprint(designs: Array) -> Array:
    """Return the area of the rectangle around the paths of crank pin, pivot and slider, m^2."""
    r, _, e = designs.T
    return np.asarray((_reach(designs, 1.0) + r) * (r + np.maximum(r, np.abs(e))))


def rod_to_offset(designs: Array) -> Array:
    """Return l / a, infinite without offset."""
    with np.errstate(divide="ignore"):
        return np.asarray(designs[:, 1] / np.abs(designs[:, 2]))


CLOSED: dict[str, Callable[[Array], Array]] = {
    "stroke": stroke,
    "time_ratio": time_ratio,
    "transmission_angle": transmission_angle,
    "footprint": footprint,
    "rod_to_offset": rod_to_offset,
    "rod_to_crank": lambda designs: designs[:, 1] / designs[:, 0],
}


def value(problem: Problem, name: str, designs: Array) -> Array:
    """Return a quantity, SI, by a closed form of this module where there is one."""
    if name in CLOSED:
        return CLOSED[name](designs)
    return QUANTITIES[name].evaluate(problem.mechanism, designs).values


def crank_of_stroke(wanted: Array, l: Array, e: Array) -> Array:
    """Return the crank that gives a stroke S; NaN where there is none.

    From x_out^2 - x_in^2 = 4 l r and x_out - x_in = S: x_out = 2 l r / S + S / 2, which squared is (l + r)^2 - e^2;
    hence r^2 (4 l^2 / S^2 - 1) = l^2 - e^2 - S^2 / 4.
    """
    with np.errstate(invalid="ignore"):
        r = np.sqrt((l * l - e * e - 0.25 * wanted**2) / (4.0 * l * l / wanted**2 - 1.0))
        return np.asarray(np.where(l > r + np.abs(e), r, np.nan))


def objectives(problem: Problem, designs: Array) -> Array:
    """Return the objectives (n, m) as they are minimised, SI."""
    columns = []
    for objective in problem.objectives:
        values = value(problem, objective.quantity, designs)
        if objective.target is not None:
            values = np.abs(values - objective.target)
        columns.append(-values if objective.sense == "maximise" else values)
    return np.stack(columns, axis=1)


def excess(constraint: Constraint, values: Array) -> Array:
    """Return by how much a constraint is violated, relative to its bound; negative where it holds."""
    sides = [np.full(len(values), -np.inf)]
    if constraint.upper is not None:
        sides.append((values - constraint.upper) / abs(constraint.upper))
    if constraint.lower is not None:
        sides.append((constraint.lower - values) / abs(constraint.lower))
    return np.asarray(np.max(sides, axis=0))


def feasible(problem: Problem, designs: Array, *, slack: float = 0.0) -> NDArray[np.bool_]:
    """Return which designs turn fully, lie within the ranges and meet the constraints; cheap ones first."""
    r, l, e = designs.T
    with np.errstate(invalid="ignore"):
        good = l > r + np.abs(e)
        for bounds, column in zip((problem.crank, problem.rod, problem.offset), designs.T, strict=True):
            size = slack * max(abs(bounds.lower), abs(bounds.upper))
            good &= (column >= bounds.lower - size) & (column <= bounds.upper + size)
    for constraint in sorted(problem.constraints, key=lambda c: c.quantity not in CLOSED):
        rows = np.flatnonzero(good)
        good[rows] = excess(constraint, value(problem, constraint.quantity, designs[rows])) <= slack
    return np.asarray(good)


def dominated(values: Array, others: Array, span: Array) -> list[int]:
    """Return rows of values (n, m) dominated by others: better by more than 1e-9 of the range, nowhere worse."""
    found = []
    for row, own in enumerate(values):
        gain = (own - others) / span
        if ((gain >= 0.0).all(axis=1) & (gain > 1e-9).any(axis=1)).any():
            found.append(row)
    return found


def differences(quantity: Callable[[Array], Array], design: Array, steps: Array) -> Array:
    """Return the derivatives (..., 3) of a quantity at a design, per step: central, with Richardson extrapolation.

    The error is of fourth order in the step, a few 1e-4 of a dimension: 1e-12 relative, as is rounding.
    """
    columns = []
    for axis in range(3):
        move = np.zeros(3)
        move[axis] = 1.0
        near, far = (
            quantity((design + h * move * steps)[None])[0] - quantity((design - h * move * steps)[None])[0]
            for h in (1.0, 2.0)
        )
        columns.append((8.0 * near - far) / 12.0)
    return np.stack(columns, axis=-1)


def pieces_of(problem: Problem, name: str, design: Array, steps: Array, *, tie: float) -> tuple[Array, Array]:
    """Return values (p,) and derivatives per step (p, 3) of the pieces of a quantity that tie for the greatest.

    tie: how far below the greatest, SI. A piece is followed from design to design by its crank angle.
    """
    quantity = QUANTITIES[name]
    here = quantity.pieces(problem.mechanism, design[None])
    rows = np.flatnonzero(here.values[0] >= here.values[0].max() - tie)

    def follow(designs: Array) -> Array:
        there = quantity.pieces(problem.mechanism, designs)
        apart = np.abs((there.labels[:, None, :] - here.labels[0][rows][None, :, None] + np.pi) % (2 * np.pi) - np.pi)
        apart = np.where(np.isfinite(there.values)[:, None, :], apart, np.inf)
        return np.take_along_axis(there.values, np.argmin(apart, axis=2), axis=1)

    return here.values[0][rows], differences(follow, design, steps)


def residual(goals: Array, limits: Array, equal: Array) -> float:
    """Return how far a design is from Pareto-stationary: the greatest component of what remains, by a linear programme.

    min t over lambda, mu >= 0, nu free with |goals' lambda + limits' mu + equal' nu|_inf <= t and sum(lambda) = 1.
    """
    p, q, s, k = len(goals), len(limits), len(equal), goals.shape[1]
    size = np.linalg.norm(np.concatenate([limits, equal]), axis=1)
    columns = np.concatenate([goals, limits / size[:q, None], equal / size[q:, None]]).T
    one = np.ones((k, 1))
    found = linprog(
        np.concatenate([np.zeros(p + q + s), [1.0]]),
        A_ub=np.block([[columns, -one], [-columns, -one]]),
        b_ub=np.zeros(2 * k),
        A_eq=np.concatenate([np.ones(p), np.zeros(q + s + 1)])[None],
        b_eq=[1.0],
        bounds=[(0.0, None)] * (p + q) + [(None, None)] * s + [(0.0, None)],
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    assert found.status == 0
    assert found.fun is not None
    return float(found.fun)
