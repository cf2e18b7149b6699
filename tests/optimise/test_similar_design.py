"""A design like a given one with more asked of it: feasible, stationary, undominated, and the nearest of its front."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.decisions.similar_design import Ends, distance_to_design, extend_problem, like
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.hypervolume import ideal_and_range
from slidercrank.optimise.problem.problem import Settings
from slidercrank.optimise.problem.requirements import Constraint, Sense
from slidercrank.optimise.solve import solve
from tests.optimise.problems import Bounds, degrees, problem

pytestmark = pytest.mark.usefixtures("little")

HELD: dict[str, Bounds] = {"stroke": 0.2, "transmission_angle": (degrees(30.0), None)}
TORQUE: dict[str, Sense] = {"peak_torque": "minimise", "time_ratio": "maximise"}
SHAPE: dict[str, Sense] = {"time_ratio": "maximise", "transmission_angle": "maximise"}


@lru_cache(maxsize=2)
def front(torque: bool) -> ParetoFront:
    """Return a front with or without a torque among its objectives."""
    return solve(problem(TORQUE if torque else SHAPE, HELD, samples=512))


CASES: dict[str, tuple[bool, tuple[Constraint, ...], Mapping[str, Ends]]] = {
    "less slope": (True, (Constraint(quantity="transmission_angle", lower=degrees(50.0)),), {}),
    "one crank": (False, (), {"crank": (0.092, 0.092)}),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_it_is_the_nearest_of_the_front_that_the_conditions_leave(case: str) -> None:
    """A front of 30 designs comes within a spacing of it, and never nearer by more than rounding."""
    torque, constraints, ranges = CASES[case]
    given = front(torque)
    row = len(given) // 2
    found = like(given, row, *constraints, ranges=ranges)
    span = ideal_and_range(given.values)[1]
    assert len(found) == 1
    assert found.designs["residual"][0] <= 1e-6
    assert found.designs["status"][0] == "stationary"
    for constraint in found.problem.constraints:
        value = QUANTITIES[constraint.quantity].evaluate(found.problem.mechanism, found.dimensions).values[0]
        assert constraint.lower is None or value >= constraint.lower * (1.0 - 1e-8)
        assert constraint.upper is None or value <= constraint.upper * (1.0 + 1e-8)
    for column, name in enumerate(("crank", "rod", "offset")):
        least, greatest = ranges.get(name, (None, None))
        assert least is None or found.dimensions[0, column] >= least - 1e-10
        assert greatest is None or found.dimensions[0, column] <= greatest + 1e-10
    dense = solve(replace(found.problem, settings=Settings(designs=30, samples=512)))
    here, there = found.values / span, dense.values / span
    assert not ((there <= here).all(axis=1) & (there < here - 1e-7).any(axis=1)).any()
    mine = float(distance_to_design(found.values, given.values[row], span)[0])
    nearest = float(distance_to_design(dense.values, given.values[row], span).min())
    assert mine > 1e-3
    assert mine <= nearest + 1e-6
    spacing = float(np.min(np.linalg.norm(there - here, axis=1)))
    assert nearest <= mine + spacing + 1e-9
    assert spacing < 0.05


def test_conditions_join_those_of_the_problem() -> None:
    asked, contradiction = extend_problem(
        front(False).problem,
        (
            Constraint(quantity="transmission_angle", upper=degrees(60.0)),
            Constraint(quantity="rod_to_crank", lower=3.0),
        ),
        {"rod": (0.1, None), "crank": (None, 0.15)},
    )
    assert contradiction is None
    held = {item.quantity: (item.lower, item.upper) for item in asked.constraints}
    assert held["transmission_angle"] == (degrees(30.0), degrees(60.0))
    assert held["rod_to_crank"] == (3.0, None)
    assert held["stroke"] == (0.2, 0.2)
    assert (asked.rod.lower, asked.rod.upper, asked.crank.lower, asked.crank.upper) == (0.1, 0.6, 0.02, 0.15)


def test_what_contradicts_the_problem_outright_is_said() -> None:
    given = front(False)
    found = like(given, 3, Constraint(quantity="stroke", lower=0.25), ranges={"rod": (0.7, 0.8)})
    assert (found.status, len(found)) == ("infeasible", 0)
    assert "stroke at least 250 mm, where exactly 200 mm is already required" in found.message
    remedy = "choose other values, or change constraints.stroke and variables.rod in the job and solve it again"
    assert found.message.endswith(remedy)
    assert (
        "rod at least 700 mm and at most 800 mm, where at least 60 mm and at most 600 mm is its range" in found.message
    )


def test_what_no_design_can_meet_is_diagnosed() -> None:
    """A crank of 150 mm makes a stroke of 300 mm or more."""
    found = like(front(False), 3, ranges={"crank": (0.15, None)})
    assert (found.status, len(found)) == ("infeasible", 0)
    assert "stroke exactly 200 mm is asked" in found.message


def test_what_asks_for_nothing_new_is_refused() -> None:
    given = front(False)
    with pytest.raises(InputError, match="nothing differs from the given design"):
        like(given, 0)
    with pytest.raises(InputError, match="already meets the added conditions"):
        like(given, 0, Constraint(quantity="transmission_angle", lower=degrees(20.0)))
    with pytest.raises(InputError, match="crank, rod or offset; got 'speed'"):
        like(given, 0, ranges={"speed": (1.0, None)})
    with pytest.raises(InputError, match="the range of crank must be ascending; got 50 mm to 40 mm"):
        like(given, 0, ranges={"crank": (0.05, 0.04)})
