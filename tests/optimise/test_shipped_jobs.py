"""The shipped jobs: what they deliver is feasible, stationary, and dominated by nothing that can be found otherwise."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.problem.problem import Problem
from tests.case_count import case_count
from tests.optimise.independent import (
    CLOSED,
    Array,
    crank_of_stroke,
    differences,
    dominated,
    excess,
    feasible,
    objectives,
    pieces_of,
    residual,
    value,
)
from tests.optimise.problems import JOBS, shipped, shipped_front

pytestmark = pytest.mark.parametrize("job", JOBS)
RANDOM = case_count(5_000, 20_000)


def spans(job: str) -> Array:
    return np.asarray(np.ptp(shipped_front(job).values, axis=0))


def test_as_many_designs_as_asked_are_delivered_and_all_are_stationary(job: str) -> None:
    front = shipped_front(job)
    assert front.status == "done"
    assert len(front) == shipped(job).settings.designs
    assert set(front.designs["status"]) == {"stationary"}


def test_every_design_meets_every_constraint_and_range_to_1e_8(job: str) -> None:
    problem, front = shipped(job), shipped_front(job)
    for constraint in problem.constraints:
        violation = excess(constraint, value(problem, constraint.quantity, front.dimensions))
        assert violation.max() <= 1e-8, constraint
    assert feasible(problem, front.dimensions, slack=1e-8).all()


def test_the_table_shows_objectives_constraints_and_slacks_as_recomputed(job: str) -> None:
    """Closed forms of two formulations differ by rounding times the cancellation in the dead centres: 1e-11."""
    problem, front = shipped(job), shipped_front(job)
    assert front.values == pytest.approx(objectives(problem, front.dimensions), rel=1e-9, abs=1e-12)
    for name in [*CLOSED, *(objective.quantity for objective in problem.objectives)]:
        quantity = QUANTITIES[name]
        shown = value(problem, name, front.dimensions) * quantity.unit.factor
        assert front.designs[quantity.field].to_numpy() == pytest.approx(shown, rel=1e-11)
    for constraint in problem.constraints:
        quantity = QUANTITIES[constraint.quantity]
        values = value(problem, constraint.quantity, front.dimensions)
        sides = [np.full(len(values), np.inf)]
        sides += [values - constraint.lower] if constraint.lower is not None else []
        sides += [constraint.upper - values] if constraint.upper is not None else []
        slack = np.min(sides, axis=0) * quantity.unit.factor
        shown = front.designs[f"slack_{quantity.field}"].to_numpy()
        assert shown == pytest.approx(slack, abs=1e-9 * quantity.unit.factor)


def test_every_design_is_stationary_in_all_three_dimensions(job: str) -> None:
    """Without elimination: equalities carry multipliers of either sign, ranges and active inequalities positive ones.

    Gradients by differences of values; objectives scaled by their range over the front, dimensions by their ranges.
    Pieces count as tied, constraints as active, within 1e-7 of the range: ten times what the solver calls active.
    """
    problem, front, span = shipped(job), shipped_front(job), spans(job)
    ranges = (problem.crank, problem.rod, problem.offset)
    widths = np.array([bounds.upper - bounds.lower for bounds in ranges])
    steps = 1e-4 * widths
    worst = 0.0
    for design in front.dimensions:
        goals, limits, equal = [], [], []
        for column, objective in enumerate(problem.objectives):
            sign = -1.0 if objective.sense == "maximise" else 1.0
            if objective.quantity in CLOSED and objective.quantity != "footprint":
                values = CLOSED[objective.quantity](design[None])
                slopes = differences(CLOSED[objective.quantity], design, steps)[None]
            else:
                values, slopes = pieces_of(problem, objective.quantity, design, steps, tie=1e-7 * span[column])
            if objective.target is not None:
                away = values - objective.target
                sides = [1.0] if away.max() > 1e-7 * span[column] else [-1.0]
                sides = [1.0, -1.0] if abs(away.max()) <= 1e-7 * span[column] else sides
            else:
                sides = [sign]
            goals += [side * slope / span[column] / 1e-4 for side in sides for slope in slopes]
        for constraint in problem.constraints:
            name = constraint.quantity
            if name in CLOSED:
                values, slopes = CLOSED[name](design[None]), differences(CLOSED[name], design, steps)[None]
            else:
                values, slopes = pieces_of(problem, name, design, steps, tie=1e-7 * abs(constraint.upper or 1.0))
            if constraint.equality:
                equal += list(slopes)
                continue
            for bound, side in ((constraint.upper, 1.0), (constraint.lower, -1.0)):
                if bound is not None and side * (values.max() - bound) >= -1e-7 * abs(bound):
                    limits += [side * slope for slope in slopes]
        for axis, bounds in enumerate(ranges):
            edge = np.eye(3)[axis]
            limits += [edge] if design[axis] >= bounds.upper - 1e-7 * widths[axis] else []
            limits += [-edge] if design[axis] <= bounds.lower + 1e-7 * widths[axis] else []
        found = residual(np.array(goals), np.array(limits).reshape(-1, 3), np.array(equal).reshape(-1, 3))
        worst = max(worst, found)
    assert worst <= 1e-6


def anywhere(problem: Problem, count: int, random: np.random.Generator) -> Array:
    """Return random feasible designs: rod, offset and stroke at random, a part on their bounds, the crank from them.

    Without a range of stroke in the job, the one that its ranges of crank allow. With rod = k offset, both follow.
    """
    held = {constraint.quantity: constraint for constraint in problem.constraints}
    found = np.zeros((0, 3))
    while len(found) < count:
        shares = random.random((4 * count, 3))
        shares = np.where(random.random(shares.shape) < 0.15, np.round(shares), shares)
        low = np.array([problem.rod.lower, problem.offset.lower, held["stroke"].lower])
        high = np.array([problem.rod.upper, problem.offset.upper, held["stroke"].upper])
        l, e, s = (low + shares * (high - low)).T
        if "rod_to_offset" in held:
            l = e * float(held["rod_to_offset"].lower or 0.0)
        designs = np.stack([crank_of_stroke(s, l, e), l, e], axis=1)
        designs = designs[feasible(problem, designs, slack=1e-13)]
        found = np.concatenate([found, designs])
    return found[:count]


def test_no_design_is_dominated_by_random_feasible_ones(job: str) -> None:
    problem, front = shipped(job), shipped_front(job)
    designs = anywhere(problem, RANDOM, np.random.default_rng(3))
    assert dominated(front.values, objectives(problem, designs), spans(job)) == []


def test_no_design_is_dominated_by_its_feasible_neighbours(job: str) -> None:
    """Neighbours move in stroke, rod and offset within what the job allows, by 1e-1 down to 1e-6 of the ranges."""
    problem, front = shipped(job), shipped_front(job)
    held = {constraint.quantity: constraint for constraint in problem.constraints}
    random = np.random.default_rng(4)
    low = np.array([held["stroke"].lower, problem.rod.lower, problem.offset.lower], dtype=float)
    high = np.array([held["stroke"].upper, problem.rod.upper, problem.offset.upper], dtype=float)
    _, l, e = front.dimensions.T
    own = np.stack([CLOSED["stroke"](front.dimensions), l, e], axis=1)
    beaten = []
    for row, start in enumerate(own):
        sizes = 10.0 ** -random.integers(1, 7, (120, 1))
        moved = start + sizes * (high - low) * random.standard_normal((120, 3)) * (random.random((120, 3)) < 0.7)
        s, l, e = np.clip(moved, low, high).T
        if "rod_to_offset" in held:
            l = e * float(held["rod_to_offset"].lower or 0.0)
        designs = np.stack([crank_of_stroke(s, l, e), l, e], axis=1)
        designs = designs[feasible(problem, designs, slack=1e-13)]
        if dominated(front.values[row : row + 1], objectives(problem, designs), spans(job)):
            beaten.append(row)
    assert beaten == []


def test_no_design_is_dominated_by_a_scaled_copy_of_itself(job: str) -> None:
    problem, front = shipped(job), shipped_front(job)
    factors = np.concatenate([1.0 - np.geomspace(1e-6, 0.3, 30), 1.0 + np.geomspace(1e-6, 0.3, 30)])
    copies = front.dimensions[None] * factors[:, None, None]
    beaten = []
    for row in range(len(front)):
        designs = copies[:, row][feasible(problem, copies[:, row], slack=1e-13)]
        if len(designs) and dominated(front.values[row : row + 1], objectives(problem, designs), spans(job)):
            beaten.append(row)
    assert beaten == []
