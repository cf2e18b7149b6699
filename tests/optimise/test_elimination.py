"""Eliminated requirements hold exactly, the others stay listed, and optima are those of the full problem."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from slidercrank.model.linkage.dimensions import DIMENSIONS
from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Sense
from slidercrank.optimise.search.elimination import EliminationBranch, elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve
from tests.optimise.independent import CLOSED, Array
from tests.optimise.problems import Bounds, Ends, degrees, problem

REQUIREMENTS = ("stroke", "rod_to_offset", "rod_to_crank", "time_ratio", "transmission_angle")
BASE = np.array([0.071, 0.193, 0.052])
"""The design that the requirements are taken from, so that all of them can be met at once."""
BOX = {"crank": (0.02, 0.2), "rod": (0.06, 0.6), "offset": (0.001, 0.2)}
OFFSETS = [(0.001, 0.2), (-0.2, -0.001), (-0.2, 0.15)]
MIRROR = np.array([1.0, 1.0, -1.0])


def combinations() -> list[tuple[str, ...]]:
    """Return every single, pair and triple of requirements and fixed dimensions, a dimension fixed at most twice."""
    every = (*REQUIREMENTS, *(f"fixed {name}" for name in DIMENSIONS))
    return [names for size in (1, 2, 3) for names in itertools.combinations(every, size)]


def held(names: tuple[str, ...], offset: tuple[float, float]) -> Problem:
    """Return the problem that asks of some quantities and dimensions what the base design has."""
    ranges: dict[str, Ends] = {**BOX, "offset": offset}
    for name in names:
        if name.startswith("fixed "):
            dimension = name.removeprefix("fixed ")
            value = float(BASE[DIMENSIONS.index(dimension)])
            ranges[dimension] = -value if dimension == "offset" and offset[1] < 0.0 else value
    asked = {name: float(CLOSED[name](BASE[None])[0]) for name in names if name in REQUIREMENTS}
    return problem(
        {"peak_torque": "minimise"}, asked, crank=ranges["crank"], rod=ranges["rod"], offset=ranges["offset"]
    )


def own_point(branch: EliminationBranch) -> Array:
    """Return the base design in the coordinates of a branch."""
    values = np.array([BASE[DIMENSIONS.index(name)] for name in branch.free])
    return np.asarray(((values - branch.lower) / (branch.upper - branch.lower))[None])


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("names", combinations(), ids="+".join)
def test_requirements_are_eliminated_exactly_or_listed(names: tuple[str, ...], offset: tuple[float, float]) -> None:
    """Eliminated ones hold to 1e-9 wherever the evaluator accepts; the base design itself is among what it accepts."""
    wanted = held(names, offset)
    asked = {constraint.quantity for constraint in wanted.constraints}
    fixed = sum(name.startswith("fixed ") for name in names)
    found = elimination_branches(wanted)
    signs = {1.0} if "fixed offset" in names and offset[1] > 0.0 else set(np.sign(offset))
    assert {branch.sign for branch in found} == signs
    for branch in found:
        left = {constraint.quantity for constraint in branch.remaining}
        assert left | set(branch.eliminated) == asked
        assert not left & set(branch.eliminated)
        assert len(branch.free) == max(3 - fixed - len(branch.steps), 0)
        evaluator = Evaluator(wanted, branch)
        u = np.concatenate([own_point(branch), np.random.default_rng(1).random((400, len(branch.free)))])
        designs = branch.designs_at_points(u)
        assert designs[0] == pytest.approx(BASE * (1.0, 1.0, branch.sign), rel=1e-12)
        good = evaluator.can_evaluate(u)
        assert good[0]
        for name in branch.eliminated:
            value = CLOSED[name](BASE[None])[0]
            assert CLOSED[name](designs[good]) == pytest.approx(np.full(good.sum(), value), rel=1e-9)
        for name in names:
            if name.startswith("fixed "):
                axis = DIMENSIONS.index(name.removeprefix("fixed "))
                assert np.abs(designs[:, axis]) == pytest.approx(np.full(len(u), BASE[axis]), rel=1e-15)


@pytest.mark.parametrize("offset", OFFSETS[:2])
@pytest.mark.parametrize("names", combinations(), ids="+".join)
def test_the_derivatives_of_eliminated_dimensions_match_differences(
    names: tuple[str, ...], offset: tuple[float, float]
) -> None:
    """Central differences with Richardson extrapolation at the base design: 1e-8 of the greatest derivative."""
    for branch in elimination_branches(held(names, offset)):
        u = own_point(branch)
        exact = branch.jacobian(u)[0]
        assert exact.shape == (3, len(branch.free))
        for column in range(len(branch.free)):
            step = np.zeros_like(u)
            step[0, column] = 1e-4
            near, far = (
                (branch.designs_at_points(u + n * step) - branch.designs_at_points(u - n * step))[0] for n in (1.0, 2.0)
            )
            slope = (8.0 * near - far) / 12e-4
            assert exact[:, column] == pytest.approx(slope, abs=1e-8 * np.abs(slope).max())


def test_as_many_requirements_as_possible_are_eliminated() -> None:
    """Those pairs and triples that formulas can give one after the other; of two that none covers, one remains."""
    left = {
        names: {constraint.quantity for constraint in elimination_branches(held(names, OFFSETS[0]))[0].remaining}
        for names in combinations()
        if not any(name.startswith("fixed ") for name in names)
    }
    assert all(not rest for names, rest in left.items() if len(names) == 1)
    whole = {names for names, rest in left.items() if len(names) == 2 and not rest}
    assert {("stroke", "rod_to_offset"), ("stroke", "time_ratio"), ("rod_to_crank", "time_ratio")} <= whole
    assert all(len(rest) <= 1 for names, rest in left.items() if len(names) == 2)
    assert all(len(rest) <= 1 for names, rest in left.items() if len(names) == 3)


def test_without_elimination_all_requirements_remain() -> None:
    for branch in elimination_branches(held(("stroke", "time_ratio"), (-0.2, 0.2)), eliminate=False):
        assert branch.eliminated == ()
        assert {constraint.quantity for constraint in branch.remaining} == {"stroke", "time_ratio"}
        assert set(branch.free) == set(DIMENSIONS)


def test_a_crank_whose_dead_centres_lie_on_both_sides_is_refused() -> None:
    """The relation of stroke and crank has a second root, where x_out + x_in is the stroke. S = 0.4, l = 0.21.

    There 4 l r < S^2. The formula gives a crank and the linkage turns, but its stroke is another.
    """
    asked: dict[str, Bounds] = {"stroke": 0.4}
    wanted = problem({"peak_torque": "minimise"}, asked, crank=(0.001, 0.2), rod=(0.2, 0.3), offset=(0.0, 0.1))
    branch = elimination_branches(wanted)[0]
    u = np.random.default_rng(5).random((2000, len(branch.free)))
    designs = branch.designs_at_points(u)
    r, l, e = designs.T
    with np.errstate(invalid="ignore"):
        turns = l > r + np.abs(e)
    spurious = turns.copy()
    spurious[turns] = np.abs(CLOSED["stroke"](designs[turns]) - 0.4) > 1e-6
    assert spurious.any()
    assert not Evaluator(wanted, branch).can_evaluate(u)[spurious].any()
    _, _, violation = Evaluator(wanted, branch).screen_designs_objectives_violation(u)
    assert np.isinf(violation[spurious]).all()


def test_computed_dimensions_outside_their_range_are_violations_relative_to_it() -> None:
    wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.2}, crank=(0.09, 0.098), offset=(0.0, 0.15))
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    u = np.random.default_rng(6).random((500, evaluator.dimension))
    designs, _, violation = evaluator.screen_designs_objectives_violation(u)
    for design, size in zip(designs, violation, strict=True):
        if math.isfinite(size) and not np.isnan(design).any() and design[1] > (design[0] + design[2]) / 0.8:
            beyond = max((design[0] - 0.098) / 0.098, (0.09 - design[0]) / 0.098, 0.0)
            assert size == pytest.approx(beyond, abs=1e-12)


def reference(wanted: Problem, score: Callable[[Array], float], starts: int) -> float:
    """Return the least score by SLSQP from many starts in crank, rod and offset, with closed forms as constraints."""
    low = np.array([bounds.lower for bounds in (wanted.crank, wanted.rod, wanted.offset)])
    high = np.array([bounds.upper for bounds in (wanted.crank, wanted.rod, wanted.offset)])

    def design(z: Array) -> Array:
        return np.asarray(low + z * (high - low))

    def safe(of: Callable[[Array], float]) -> Callable[[Array], float]:
        def evaluate(z: Array) -> float:
            x = design(z)
            return of(x) if x[1] > x[0] + abs(x[2]) else 10.0

        return evaluate

    def margin(z: Array) -> float:
        x = design(z)
        return float((x[1] - x[0] - abs(x[2])) / x[1]) - 1e-4

    rules: list[Any] = [{"type": "ineq", "fun": margin}]
    checks = []
    for constraint in wanted.constraints:
        bound = constraint.lower if constraint.lower is not None else constraint.upper
        assert bound is not None

        def gap(x: Array, *, name: str = constraint.quantity, bound: float = bound) -> float:
            return float(CLOSED[name](x[None])[0] / bound - 1.0)

        rules.append({"type": "eq" if constraint.equality else "ineq", "fun": safe(gap)})
        checks.append((constraint.equality, gap))
    random = np.random.default_rng(7)
    best = math.inf
    while starts:
        z = random.random(3)
        if margin(z) < 0.02:
            continue
        starts -= 1
        found = minimize(
            safe(score),
            z,
            bounds=[(0.0, 1.0)] * 3,
            constraints=rules,
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 300},
        )
        x = design(np.clip(found.x, 0.0, 1.0))
        if margin(found.x) > 0.0 and all((abs(gap(x)) if same else -gap(x)) < 1e-8 for same, gap in checks):
            best = min(best, score(x))
    return best


CASES: list[tuple[str, dict[str, Bounds]]] = [
    ("transmission_angle", {"stroke": 0.2, "rod_to_offset": 3.2, "time_ratio": (1.2, None)}),
    ("transmission_angle", {"rod_to_crank": 2.5, "time_ratio": 1.3, "stroke": 0.15}),
    ("transmission_angle", {"stroke": 0.2, "footprint": 0.12}),
    ("transmission_angle", {"rod_to_crank": 2.6, "footprint": 0.12}),
    ("time_ratio", {"transmission_angle": degrees(40.0), "stroke": 0.2}),
    ("time_ratio", {"rod_to_crank": 3.0, "footprint": 0.05, "transmission_angle": (degrees(15.0), None)}),
    ("footprint", {"time_ratio": 1.3, "stroke": 0.2, "transmission_angle": (degrees(20.0), None)}),
    ("footprint", {"rod_to_offset": 4.0, "transmission_angle": degrees(50.0)}),
    ("stroke", {"footprint": 0.1, "rod_to_offset": 3.2, "transmission_angle": (degrees(30.0), None)}),
]


@pytest.mark.parametrize(("name", "asked"), CASES)
@pytest.mark.parametrize("offset", [(0.0, 0.2), (-0.2, 0.0)])
def test_the_best_design_is_that_of_the_full_problem(
    name: str, asked: dict[str, Bounds], offset: tuple[float, float]
) -> None:
    """SLSQP in all three dimensions meets its constraints to 1e-8, which moves optima by about as much."""
    sense: Sense = "minimise" if name == "footprint" else "maximise"
    wanted = problem({name: sense}, asked, offset=offset)
    sign = 1.0 if sense == "minimise" else -1.0
    expected = reference(wanted, lambda x: sign * float(CLOSED[name](x[None])[0]), 10)
    assert math.isfinite(expected)
    front = solve(wanted)
    assert list(front.designs["status"]) == ["stationary"]
    assert front.values[0, 0] <= expected + 1e-7 * abs(expected)
    assert front.values[0, 0] == pytest.approx(expected, rel=1e-6)
    for constraint in wanted.constraints:
        if constraint.equality:
            assert CLOSED[constraint.quantity](front.dimensions)[0] == pytest.approx(constraint.lower, rel=FEASIBLE)
