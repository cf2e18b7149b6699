"""Methods for one objective against the default, which shares no solver with them, and against closed forms."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.methods.local import by_slsqp, starting_samples
from slidercrank.optimise.methods.scalar_objective import Form, Programme
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve
from tests.optimise.independent import excess, value
from tests.optimise.methods.asking import asking
from tests.optimise.problems import MACHINE, Bounds, degrees, problem

pytestmark = pytest.mark.usefixtures("little")

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(35.0), None)}
PROBLEMS: dict[str, Problem] = {
    "a torque between two peaks": problem({"peak_torque": "minimise"}, HELD),
    "a ratio at the limit of an angle": problem({"time_ratio": "maximise"}, HELD),
    "an error with the stroke in a range": problem(
        {"position_error": "minimise"}, {"stroke": (0.15, 0.25), "time_ratio": (1.1, None)}
    ),
    "a footprint with offsets of either sign": problem(
        {"footprint": "minimise"},
        {"stroke": 0.2, "time_ratio": (1.1, None), "peak_torque": (None, 60.0)},
        offset=(-0.1, 0.1),
    ),
    "a target within reach": problem({"time_ratio": 1.2}, HELD),
}
EQUALITY = problem({"transmission_angle": "maximise"}, {"stroke": 0.2, "peak_slider_speed": 4.0})
METHODS = ("slsqp", "trust_constr", "differential_evolution", "shgo")
# The slow methods, seconds each, share out the problems; each has one with a limit that binds, or a target.
PAIRS = [("slsqp", name) for name in PROBLEMS]
PAIRS += [(method, "a torque between two peaks") for method in METHODS if method != "slsqp"]
PAIRS += [("trust_constr", "a target within reach")]
PAIRS += [("differential_evolution", name) for name in list(PROBLEMS)[3:]]
PAIRS += [("shgo", name) for name in list(PROBLEMS)[1:3]]
BUDGETS = {"trust_constr": {"evaluations": 1}, "shgo": {"evaluations": 300}}  # one start; a third of the default


@cache
def default(name: str) -> float:
    """Return the optimum that the default method finds."""
    front = solve(PROBLEMS[name])
    assert front.status == "done", front.message
    return float(front.values[0, 0])


@cache
def best_on_the_equality() -> float:
    """Return the optimum that the default method finds on an equality that no rule eliminates."""
    return float(solve(EQUALITY).values[0, 0])


def violation(front: ParetoFront) -> float:
    """Return the greatest relative violation of a front's constraints, recomputed."""
    given = front.problem
    return max(
        float(excess(constraint, value(given, constraint.quantity, front.dimensions)).max())
        for constraint in given.constraints
    )


@pytest.mark.parametrize(("method", "name"), PAIRS)
def test_every_method_finds_what_the_default_finds(method: str, name: str) -> None:
    front = solve(asking(PROBLEMS[name], method, **BUDGETS.get(method, {})))
    assert front.status == "done", front.message
    assert len(front) == 1
    # Nobody promises more than 1e-6; a target is met to 1e-8 of its value.
    assert front.values[0, 0] == pytest.approx(default(name), rel=1e-6, abs=1e-8)
    assert violation(front) <= 1e-8


@pytest.mark.parametrize("method", ["slsqp", "differential_evolution", "shgo"])
def test_the_longest_rod_without_offset_transmits_best(method: str) -> None:
    """As in the test of the default: cos(mu) = S / (2 l) with the longest rod."""
    given = problem({"transmission_angle": "maximise"}, {"stroke": 0.28}, rod=(0.2, 0.6), offset=(0.0, 0.1))
    front = solve(asking(given, method))
    assert math.cos(-front.values[0, 0]) == pytest.approx(0.14 / 0.6, rel=1e-7)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_equality_that_no_rule_eliminates_is_met(seed: int) -> None:
    front = solve(asking(EQUALITY, "slsqp", seed=seed))
    speed = QUANTITIES["peak_slider_speed"].evaluate(MACHINE, front.dimensions).values
    assert speed == pytest.approx(np.array([4.0]), rel=1e-8)
    assert front.values[0, 0] == pytest.approx(best_on_the_equality(), rel=1e-8)


def test_any_start_descends_to_the_optimum_on_an_equality() -> None:
    """Not the best of many starts by luck: every one of a dozen ends where the default does."""
    given = EQUALITY
    evaluators = [Evaluator(given, branch) for branch in elimination_branches(given)]
    begun = starting_samples(given, evaluators)
    best = best_on_the_equality()
    for row in begun.leading_rows(0, 12):
        programme = Programme(evaluators[0], Form.of_single_objective(1, 0), np.zeros(1), np.ones(1))
        found = by_slsqp(programme, begun.u[row])
        assert found is not None
        assert programme.objectives(found) == pytest.approx(best, rel=1e-8)


@pytest.mark.parametrize("method", ["slsqp", "differential_evolution"])
def test_the_same_seed_gives_the_same_design_bit_for_bit(method: str) -> None:
    given = asking(PROBLEMS["a torque between two peaks"], method)
    assert solve(given).dimensions.tobytes() == solve(given).dimensions.tobytes()


@pytest.mark.parametrize("method", METHODS)
def test_all_dimensions_given_leave_one_design(method: str) -> None:
    front = solve(asking(problem({"peak_torque": "minimise"}, crank=0.1, rod=0.3, offset=0.05), method))
    assert front.dimensions.tolist() == [[0.1, 0.3, 0.05]]


@pytest.mark.parametrize("method", ["slsqp", "differential_evolution"])
def test_cancelling_keeps_what_was_found(method: str) -> None:
    told: list[object] = []
    given = asking(PROBLEMS["a torque between two peaks"], method)
    front = solve(given, progress=told.append, cancelled=lambda: len(told) >= 3)
    assert front.status == "cancelled"
    assert len(front) == 1
    assert len(told) <= 4


def test_evolution_keeps_to_its_budget() -> None:
    """Designs that were found are evaluated a few times more for the front."""
    front = solve(asking(PROBLEMS["a torque between two peaks"], "differential_evolution", evaluations=2_000))
    assert front.evaluations <= 2_000 + 100
