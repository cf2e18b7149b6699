"""Levers under tolerances: worst cases and percentiles against machines that are drawn one by one."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import slidercrank as sc
from slidercrank.objectives.lever_quantity import LeverQuantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import RobustQuantity, Side
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from tests.objectives.test_robust_quantity import COARSE, DESIGNS, of
from tests.objectives.test_robust_quantity import machines as toleranced
from tests.optimise.problems import LEVER, SHAPER

Floats = NDArray[np.float64]

LIMITS = np.array([0.5e-3, 1e-3, 0.5e-3])
TOLERANCES = {"crank": "0.5 mm", "rod": "1 mm", "offset": "0.5 mm"}
CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
CASES = [
    pytest.param(LEVER, [[0.35, 0.9, 0.02], [0.36, 0.89, 0.03]], id="lever"),
    pytest.param(SHAPER, [[0.12, 0.3, 0.015], [0.3, 0.13, 0.01]], id="shaper"),
]
SIDES: tuple[Side, Side] = ("high", "low")


def problem_and_quantities(tables: dict[str, Any]) -> tuple[Problem, list[LeverQuantity]]:
    """Return the problem of a job with tolerances, and those of its quantities that these change."""
    problem = parse_job(tables | {"tolerances": TOLERANCES})
    candidates = [item for item in problem.own if isinstance(item, LeverQuantity) and not item.about_tolerances]
    return problem, [item for item in candidates if not item.undefined_because([problem.mechanism])]


def machines(points: Floats, design: Floats) -> Floats:
    """Return machines (q, 3) at points in units of the limits."""
    return np.asarray(design + points * LIMITS)


@pytest.mark.parametrize(("tables", "designs"), CASES)
def test_no_machine_is_worse_than_the_worst_case_and_one_is_as_bad(
    tables: dict[str, Any], designs: list[list[float]]
) -> None:
    problem, quantities = problem_and_quantities(tables)
    drawn, array = np.random.default_rng(3).uniform(-1.0, 1.0, (40, 3)), np.array(designs)
    assert len(quantities) > 12
    for quantity, (place, side) in itertools.product(quantities, enumerate(SIDES)):
        robust = RobustQuantity(inner=quantity, side=side, case="worst case")
        found = robust.evaluate(problem.mechanism, array).values
        for design, value in zip(array, found, strict=True):
            values = quantity.evaluate(problem.mechanism, machines(np.concatenate([CORNERS, drawn]), design)).values
            assert value == pytest.approx((values.max(), values.min())[place], rel=1e-12), quantity.name


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "order"), [("worst case", 1), ("worst case", 2), ("percentile", 2)])
@pytest.mark.parametrize(("tables", "designs"), CASES)
def test_gradients_are_those_of_extrapolated_differences(
    tables: dict[str, Any], designs: list[list[float]], kind: str, order: int
) -> None:
    problem, quantities = problem_and_quantities(tables)
    array, within = np.array(designs), 2e-5 if kind == "percentile" else 1e-7
    for quantity, side in itertools.product(quantities, SIDES):
        robust = RobustQuantity(inner=quantity, side=side, case=kind, order=order)  # type: ignore[arg-type]
        found = robust.evaluate(problem.mechanism, array, gradients=True).gradients
        assert found is not None
        slopes = np.zeros(found.shape)
        for column, step in itertools.product(range(3), (1.0, 2.0)):
            moved = step * 2e-6 * np.eye(3)[column]
            high, low = (robust.evaluate(problem.mechanism, array + way * moved).values for way in (1.0, -1.0))
            slopes[:, column] += (4.0 if step == 1.0 else -1.0) / 3.0 * (high - low) / (2.0 * step * 2e-6)
        assert np.abs(found - slopes).max() <= within * max(np.abs(slopes).max(), 1e-12), quantity.name


@pytest.mark.parametrize(("tables", "designs"), CASES)
@pytest.mark.parametrize("name", ["extension_ratio", "lever_pin_force", "cylinder_length_margin", "arm_time_ratio"])
def test_a_percentile_is_met_by_that_share_of_machines(
    tables: dict[str, Any], designs: list[list[float]], name: str
) -> None:
    """Also without an offset, where the length of a cylinder is even in it."""
    problem, quantities = problem_and_quantities(tables)
    quantity = next((item for item in quantities if item.name == name), None)
    if quantity is None:
        return
    drawn = np.random.default_rng(5).normal(scale=1.0 / 3.0, size=(20_000, 3))
    for design in (np.array(designs[0]), np.array([*designs[0][:2], 0.0])):
        values = quantity.evaluate(problem.mechanism, machines(drawn, design)).values
        for side in SIDES:
            robust = RobustQuantity(inner=quantity, side=side)
            value = robust.evaluate(problem.mechanism, design[None]).values[0]
            met = (values <= value if side == "high" else values >= value).mean()
            assert met == pytest.approx(0.99, abs=5.0 * np.sqrt(0.99 * 0.01 / len(drawn)))


def test_a_lever_that_some_machine_cannot_swing_is_infinitely_bad() -> None:
    """Within the tolerances, the offset may exceed the distance from the pin to the cylinder's pivot."""
    problem, quantities = problem_and_quantities(LEVER)
    design = np.array([[0.35, 0.9, 0.6701]])  # that distance is 670.74 mm at -20 deg
    by_name = {item.name: item for item in quantities}
    for name, side, worst in (("peak_cylinder_push", "high", np.inf), ("buckling_margin", "low", -np.inf)):
        for order in (1, 2):
            robust = RobustQuantity(inner=by_name[name], side=side, case="worst case", order=order)  # type: ignore[arg-type]
            assert robust.evaluate(problem.mechanism, design).values[0] == worst


def test_a_quantity_that_is_the_least_of_its_pieces_is_worst_at_a_corner() -> None:
    quantity = QUANTITIES["force_transmission"]
    for side, worst in (("high", np.max), ("low", np.min)):
        found = of(quantity.name, side, "worst case").evaluate(COARSE, DESIGNS).values  # type: ignore[arg-type]
        corners = [worst(quantity.evaluate(COARSE, toleranced(CORNERS, design)).values) for design in DESIGNS]
        assert found == pytest.approx(corners, rel=1e-12)


@pytest.mark.slow
def test_a_job_keeps_its_requirement_in_every_machine() -> None:
    tables = LEVER | {
        "tolerances": TOLERANCES,
        "robust": {"kind": "worst case"},
        "variables": LEVER["variables"] | {"offset": "0 mm"},
        "constraints": {"cylinder_length_margin": {"min": "1 mm"}},
        "objectives": {"peak_cylinder_force": "minimise", "cylinder_travel": "minimise"},
        "optimiser": {"designs": 3, "samples": 64, "seed": 1},
    }
    front = sc.solve(sc.problem(tables))
    assert front.status == "done"
    problem, quantities = problem_and_quantities(LEVER)
    margin = next(item for item in quantities if item.name == "cylinder_length_margin")
    for design in front.dimensions:
        least = margin.evaluate(problem.mechanism, machines(CORNERS, design)).values.min()
        assert least >= 1e-3 * (1.0 - 1e-6)
    assert (front.columns["slack_cylinder_length_margin_robust_mm"] < 1e-6).any()
