"""The minimax by sequential convex programming, against the default search and against what it must satisfy itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.methods.minimax.minimax import MinimaxResult, minimise_peak
from slidercrank.optimise.methods.minimax.scp import Descent, residual_of
from slidercrank.optimise.problem.problem import Problem, Settings
from slidercrank.optimise.solve import solve
from tests.optimise.convex.random_problems import random_problem
from tests.optimise.independent import feasible
from tests.optimise.problems import Bounds, degrees, problem
from tests.optimise.test_polish import STARTS, Analytic, Function, squared

STROKE: dict[str, Bounds] = {"stroke": (0.08, 0.09), "transmission_angle": (degrees(40.0), None)}


def value_at(wanted: Problem, found: MinimaxResult) -> float:
    """Return the objective of a result's design, evaluated anew."""
    quantity = QUANTITIES[wanted.objectives[0].quantity]
    return float(quantity.evaluate(wanted.mechanism, found.dimensions[None]).values[0])


@pytest.mark.parametrize("seed", [13, 21, 28])
def test_it_agrees_with_the_default_search_on_the_least_peak_torque(seed: int) -> None:
    """To 1e-6 of the torque; the multipliers leave less than 1e-6 of the gradients. Seeds: one to three peaks tie."""
    wanted = random_problem(seed)
    found, front = minimise_peak(wanted), solve(wanted)
    assert found.value == pytest.approx(front.values[0, 0], rel=1e-6)
    assert found.residual <= 1e-6
    assert found.optimal
    assert value_at(wanted, found) == pytest.approx(found.value, rel=1e-12)
    assert feasible(wanted, found.dimensions[None], slack=1e-8).all()


def test_two_peaks_tie_where_the_torque_is_least() -> None:
    wanted = problem({"peak_torque": "minimise"}, STROKE)
    found = minimise_peak(wanted)
    assert len(found.active_angles) == 2
    assert sum(piece.weight for piece in found.pieces) == pytest.approx(1.0, abs=1e-9)
    peaks = QUANTITIES["peak_torque"].pieces(wanted.mechanism, found.dimensions[None])
    assert peaks.values[0, 1] == pytest.approx(peaks.values[0, 0], rel=1e-9)
    assert sorted(found.active_angles) == pytest.approx(sorted(peaks.labels[0, :2]), abs=1e-9)


@pytest.mark.parametrize("quantity", ["position_error", "peak_pivot_force"])
def test_any_quantity_can_be_minimised(quantity: str) -> None:
    wanted = problem({quantity: "minimise"}, {"time_ratio": (1.2, None)}, crank=(0.03, 0.2))
    found = minimise_peak(wanted)
    assert found.value == pytest.approx(solve(wanted).values[0, 0], rel=1e-6)
    assert found.residual <= 1e-6


@pytest.mark.parametrize(
    ("name", "held"),
    [
        ("time_ratio", {"stroke": 0.1, "time_ratio": (1.2, None)}),
        ("peak_guide_force", {"stroke": 0.1, "time_ratio": (1.2, None), "peak_guide_force": (None, 128.0)}),
        ("rod", {"stroke": 0.1, "time_ratio": (1.2, None)}),
    ],
)
def test_rates_predict_what_a_bound_costs(name: str, held: dict[str, Bounds]) -> None:
    """Central difference of optima over a bound moved by 1e-4 of itself. Its error is of second order, 1e-6 or so."""

    def least(share: float) -> float:
        if name == "rod":
            return minimise_peak(problem({"peak_torque": "minimise"}, held, rod=(0.06, 0.15 * share))).value
        moved = tuple(None if end is None else share * end for end in ends)
        return minimise_peak(problem({"peak_torque": "minimise"}, {**held, name: (moved[0], moved[1])})).value

    bounds = held.get(name, (None, 0.15))
    ends = bounds if isinstance(bounds, tuple) else (bounds, bounds)
    size = next(end for end in ends if end is not None)
    rate = (least(1.0001) - least(0.9999)) / (2e-4 * size)
    rod = (0.06, 0.15) if name == "rod" else (0.06, 0.6)
    found = minimise_peak(problem({"peak_torque": "minimise"}, held, rod=rod))
    assert found.rates[name] == pytest.approx(rate, rel=1e-4)


def test_a_kink_of_three_pieces_is_found_in_the_plane() -> None:
    """The greatest of x, y and 1 - x - y is least where all are 1/3. Each piece weighs a third."""
    pieces: list[Function] = [lambda x, y: x, lambda x, y: y, lambda x, y: 1.0 - x - y]
    descent = Descent(Analytic([pieces]), 1.0)
    for start in STARTS[:3]:
        end = descent.run(start)
        assert end.u == pytest.approx([1.0 / 3.0, 1.0 / 3.0], abs=1e-9)
        assert end.step is not None
        assert end.step.goals == pytest.approx([1.0 / 3.0] * 3, abs=1e-7)


def test_a_smooth_optimum_is_reached_as_fast_as_a_kink() -> None:
    """Rosenbrock's valley has one piece for two unknowns: first-order steps alone would creep."""

    def valley(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        x, y = 3.0 * x - 1.0, 3.0 * y - 1.0
        return np.asarray((1.0 - x) ** 2 + 100.0 * (y - x * x) ** 2)

    descent = Descent(Analytic([[valley]]), 1.0)
    ends = [descent.run(start) for start in STARTS[:3]]
    assert max(end.residual for end in ends) <= 1e-6
    assert [end.u for end in ends] == [pytest.approx([2.0 / 3.0, 2.0 / 3.0], abs=1e-6)] * 3


def test_curved_constraints_hold_from_infeasible_starts() -> None:
    """Greatest x + 2 y on a disc, from outside too. Along the edge the second-order correction is what moves it."""
    disc = Analytic([[lambda x, y: -x - 2.0 * y]], [lambda x, y: x * x + y * y - 0.5])
    descent = Descent(disc, 1.0)
    for start in STARTS[:4]:
        end = descent.run(start)
        assert end.u == pytest.approx(np.array([1.0, 2.0]) * np.sqrt(0.1), abs=1e-6)
        assert end.violation <= 1e-9
        assert end.residual <= 1e-6


def test_a_start_that_is_no_optimum_has_a_residual() -> None:
    """The residual is no formality: one step away from the optimum the multipliers leave what the gradient is."""
    descent = Descent(Analytic([[squared(0.5, 0.5)]]), 1.0)
    point = descent._at(np.array([0.6, 0.5]))
    step, _ = descent._programme(point, np.zeros((2, 2)), 0.01, 10.0)
    assert step is not None
    assert residual_of(point, step) >= 0.1


def test_it_can_be_asked_for_as_a_method() -> None:
    wanted = problem({"peak_torque": "minimise"}, STROKE)
    front = solve(replace(wanted, settings=Settings(method="minimax", seed=1)))
    assert front.status == "done"
    assert len(front) == 1
    assert front.values[0, 0] == pytest.approx(minimise_peak(wanted).value, rel=1e-9)
    assert front.designs["residual"][0] <= 1e-6
    small = solve(replace(wanted, settings=Settings(method="minimax", evaluations=4000, seed=1)))
    assert small.evaluations <= 4500  # the descent that is under way ends
    assert small.values[0, 0] == pytest.approx(front.values[0, 0], rel=1e-6)


def test_several_objectives_and_what_cannot_be_met_are_refused() -> None:
    with pytest.raises(InputError, match="the minimax takes one objective; got peak_torque, time_ratio"):
        minimise_peak(problem({"peak_torque": "minimise", "time_ratio": "maximise"}))
    with pytest.raises(InputError, match="no design of 'test' that meets all requirements was found"):
        minimise_peak(problem({"peak_torque": "minimise"}, {"stroke": (0.9, None)}))


def test_nothing_left_to_choose_is_its_own_optimum() -> None:
    found = minimise_peak(problem({"peak_torque": "minimise"}, crank=0.05, rod=0.2, offset=0.02))
    assert found.dimensions == pytest.approx([0.05, 0.2, 0.02])
    assert found.residual == 0.0
    assert len(found.pieces) == 1
