"""The minimax by sequential convex programming, against the default search and against what it must satisfy itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.methods.minimax.minimax import descent_starts
from slidercrank.optimise.methods.minimax.scp import Descent, Point, lagrangian_residual
from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem, Settings
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.sample_and_zoom import sample_and_zoom
from slidercrank.optimise.solve import solve
from tests.optimise.convex.random_problems import random_problem
from tests.optimise.independent import feasible
from tests.optimise.problems import Bounds, degrees, problem
from tests.optimise.test_polish import STARTS, Analytic, Function, squared

STROKE: dict[str, Bounds] = {"stroke": (0.08, 0.09), "transmission_angle": (degrees(40.0), None)}


def best_end(wanted: Problem) -> tuple[Evaluator, Point, float]:
    """Return the best feasible end of the descents, its evaluator, and the scale of the objective."""
    evaluators = [Evaluator(wanted, branch) for branch in elimination_branches(wanted)]
    scale, begin = descent_starts(wanted, evaluators, sample_and_zoom(wanted, evaluators))
    descents = [Descent(evaluator, scale) for evaluator in evaluators]
    ends = [(evaluators[index], descents[index].descend_from(u)) for index, u in begin]
    evaluator, end = min(
        (item for item in ends if item[1].violation <= FEASIBLE), key=lambda item: item[1].greatest_piece
    )
    return evaluator, end, scale


def least(wanted: Problem) -> float:
    """Return the least value of the objective."""
    _, end, scale = best_end(wanted)
    return end.greatest_piece * scale


@pytest.mark.parametrize("seed", [13, 21, 28])
def test_it_agrees_with_the_default_search_on_the_least_peak_torque(seed: int) -> None:
    """To 1e-6 of the torque; the multipliers leave less than 1e-6 of the gradients. Seeds: one to three peaks tie."""
    wanted = random_problem(seed)
    evaluator, end, scale = best_end(wanted)
    assert end.greatest_piece * scale == pytest.approx(solve(wanted).values[0, 0], rel=1e-6)
    assert end.residual <= 1e-6
    dimensions = evaluator.branch.designs_at_points(end.u)
    again = QUANTITIES[wanted.objectives[0].quantity].evaluate(wanted.mechanism, dimensions).values[0]
    assert again == pytest.approx(end.greatest_piece * scale, rel=1e-12)
    assert feasible(wanted, dimensions, slack=1e-8).all()


def test_two_peaks_tie_where_the_torque_is_least() -> None:
    wanted = problem({"peak_torque": "minimise"}, STROKE)
    evaluator, end, _ = best_end(wanted)
    assert end.step is not None
    tied = end.step.goals > 1e-7
    assert tied.sum() == 2
    assert end.step.goals.sum() == pytest.approx(1.0, abs=1e-9)
    peaks = QUANTITIES["peak_torque"].pieces(wanted.mechanism, evaluator.branch.designs_at_points(end.u))
    assert peaks.values[0, 1] == pytest.approx(peaks.values[0, 0], rel=1e-9)
    assert sorted(end.goals.labels[tied]) == pytest.approx(sorted(peaks.labels[0, :2]), abs=1e-9)


@pytest.mark.parametrize("quantity", ["position_error", "peak_pivot_force"])
def test_any_quantity_can_be_minimised(quantity: str) -> None:
    wanted = problem({quantity: "minimise"}, {"time_ratio": (1.2, None)}, crank=(0.03, 0.2))
    _, end, scale = best_end(wanted)
    assert end.greatest_piece * scale == pytest.approx(solve(wanted).values[0, 0], rel=1e-6)
    assert end.residual <= 1e-6


@pytest.mark.parametrize(
    ("name", "held"),
    [
        ("time_ratio", {"stroke": 0.1, "time_ratio": (1.2, None)}),
        ("peak_guide_force", {"stroke": 0.1, "time_ratio": (1.2, None), "peak_guide_force": (None, 128.0)}),
        ("rod", {"stroke": 0.1, "time_ratio": (1.2, None)}),
    ],
)
def test_multipliers_predict_what_a_bound_costs(name: str, held: dict[str, Bounds]) -> None:
    """Central difference of optima over a bound moved by 1e-4 of itself. Its error is of second order, 1e-6 or so."""

    def moved(share: float) -> float:
        if name == "rod":
            return least(problem({"peak_torque": "minimise"}, held, rod=(0.06, 0.15 * share)))
        ends = tuple(None if end is None else share * end for end in bounds)
        return least(problem({"peak_torque": "minimise"}, {**held, name: (ends[0], ends[1])}))

    given = held.get(name, (None, 0.15))
    bounds = given if isinstance(given, tuple) else (given, given)
    size = next(end for end in bounds if end is not None)
    rate = (moved(1.0001) - moved(0.9999)) / (2e-4 * size)
    rod = (0.06, 0.15) if name == "rod" else (0.06, 0.6)
    evaluator, end, scale = best_end(problem({"peak_torque": "minimise"}, held, rod=rod))
    assert end.step is not None
    if name == "rod":
        column = evaluator.branch.free.index("rod")
        price = -end.step.upper_multipliers[column] / (evaluator.branch.upper[column] - evaluator.branch.lower[column])
    else:  # constraints are relative to their bound; a least value that rises costs, a greatest one saves
        owner = [constraint.quantity for constraint in evaluator.constraints].index(name)
        sign = 1.0 if bounds[1] is None else -1.0
        price = sign * end.step.limits[end.limits.owner == owner].sum() / size
    assert price * scale == pytest.approx(rate, rel=1e-4)


def test_a_kink_of_three_pieces_is_found_in_the_plane() -> None:
    """The greatest of x, y and 1 - x - y is least where all are 1/3. Each piece weighs a third."""
    pieces: list[Function] = [lambda x, y: x, lambda x, y: y, lambda x, y: 1.0 - x - y]
    descent = Descent(Analytic([pieces]), 1.0)
    for start in STARTS[:3]:
        end = descent.descend_from(start)
        assert end.u == pytest.approx([1.0 / 3.0, 1.0 / 3.0], abs=1e-9)
        assert end.step is not None
        assert end.step.goals == pytest.approx([1.0 / 3.0] * 3, abs=1e-7)


def test_a_smooth_optimum_is_reached_as_fast_as_a_kink() -> None:
    """Rosenbrock's valley has one piece for two unknowns: first-order steps alone would creep."""

    def valley(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        x, y = 3.0 * x - 1.0, 3.0 * y - 1.0
        return np.asarray((1.0 - x) ** 2 + 100.0 * (y - x * x) ** 2)

    descent = Descent(Analytic([[valley]]), 1.0)
    ends = [descent.descend_from(start) for start in STARTS[:3]]
    assert max(end.residual for end in ends) <= 1e-6
    assert [end.u for end in ends] == [pytest.approx([2.0 / 3.0, 2.0 / 3.0], abs=1e-6)] * 3


def test_curved_constraints_hold_from_infeasible_starts() -> None:
    """Greatest x + 2 y on a disc, from outside too. Along the edge the second-order correction is what moves it."""
    disc = Analytic([[lambda x, y: -x - 2.0 * y]], [lambda x, y: x * x + y * y - 0.5])
    descent = Descent(disc, 1.0)
    for start in STARTS[:4]:
        end = descent.descend_from(start)
        assert end.u == pytest.approx(np.array([1.0, 2.0]) * np.sqrt(0.1), abs=1e-6)
        assert end.violation <= 1e-9
        assert end.residual <= 1e-6


def test_a_start_that_is_no_optimum_has_a_residual() -> None:
    """The residual is no formality: one step away from the optimum the multipliers leave what the gradient is."""
    descent = Descent(Analytic([[squared(0.5, 0.5)]]), 1.0)
    point = descent._point_at(np.array([0.6, 0.5]))
    step, _ = descent._step_and_penalty(point, np.zeros((2, 2)), 0.01, 10.0)
    assert step is not None
    assert lagrangian_residual(point, step) >= 0.1


def test_it_can_be_asked_for_as_a_method() -> None:
    wanted = problem({"peak_torque": "minimise"}, STROKE)
    front = solve(replace(wanted, settings=Settings(method="minimax", seed=1)))
    assert front.status == "done"
    assert len(front) == 1
    assert front.values[0, 0] == pytest.approx(least(wanted), rel=1e-9)
    assert front.designs["residual"][0] <= 1e-6
    small = solve(replace(wanted, settings=Settings(method="minimax", evaluations=4000, seed=1)))
    assert small.evaluations <= 4500  # the descent that is under way ends
    assert small.values[0, 0] == pytest.approx(front.values[0, 0], rel=1e-6)


def test_nothing_left_to_choose_is_its_own_optimum() -> None:
    wanted = problem({"peak_torque": "minimise"}, crank=0.05, rod=0.2, offset=0.02)
    front = solve(replace(wanted, settings=Settings(method="minimax", seed=1)))
    assert front.dimensions == pytest.approx(np.array([[0.05, 0.2, 0.02]]))
    assert front.designs["residual"][0] == 0.0
