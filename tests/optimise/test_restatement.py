"""Formulas that are equivalent to a known quantity: eliminated, bounded and screened like that quantity."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.restatement import restate_constraint
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve

STROKE = "sqrt((rod + crank)**2 - offset**2) - sqrt((rod - crank)**2 - offset**2)"
EXCESS = "asin(min(1, abs(offset) / (rod - crank))) - asin(min(1, abs(offset) / (rod + crank)))"
RATIO = f"(180 deg + ({EXCESS})) / (180 deg - ({EXCESS}))"


def job(constraints: dict[str, Any], **changes: Any) -> Problem:
    """Return a feeder with friction in its guide; changes: of its tables."""
    bar = {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"}
    given: dict[str, Any] = {
        "name": "in other words",
        "mechanism": {"speed": "30 rpm", "crank": bar, "rod": bar, "slider": {"mass": "2 kg"}},
        "load": [{"force": "200 N", "opposes": "outward stroke"}],
        "friction": {"guide": 0.47},
        "variables": {"crank": ["20 mm", "250 mm"], "rod": ["260 mm", "900 mm"], "offset": ["0 mm", "400 mm"]},
        "constraints": constraints,
        "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
        "optimiser": {"designs": 12, "samples": 512},
    }
    return parse_job(given | changes)


SAME: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"stroke * 2": {"equals": "500 mm"}}, {"stroke": {"equals": "250 mm"}}),
    ({"10 mm - stroke": {"equals": "-240 mm"}}, {"stroke": {"equals": "250 mm"}}),
    ({STROKE: {"equals": "250 mm"}}, {"stroke": {"equals": "250 mm"}}),
    ({"time_ratio - 1": {"min": 0.2}}, {"time_ratio": {"min": 1.2}}),
    ({"3 - time_ratio": {"max": 1.8}}, {"time_ratio": {"min": 1.2}}),
    ({RATIO: {"min": 1.2}}, {"time_ratio": {"min": 1.2}}),
    ({EXCESS: {"min": "20 deg"}}, {"time_ratio": {"min": 200.0 / 160.0}}),
    ({"(crank + abs(offset)) / rod": {"max": float(np.cos(0.6))}}, {"transmission_angle": {"min": 0.6}}),
    (
        {"acos((crank + offset) / rod) - atan(0.47)": {"min": "5 deg"}},
        {"transmission_angle": {"min": float(np.arctan(0.47) + np.radians(5.0))}},
    ),
    ({"tan(transmission_angle)": {"min": float(np.tan(0.6))}}, {"transmission_angle": {"min": 0.6}}),
    ({"crank / rod": {"max": 0.4}}, {"rod_to_crank": {"min": 2.5}}),
    ({"2 * peak_torque + 1 N m": {"max": "101 N m"}}, {"peak_torque": {"max": "50 N m"}}),
]


@pytest.mark.parametrize(("formula", "plain"), SAME, ids=[next(iter(formula)) for formula, _ in SAME])
def test_a_formula_that_is_a_quantity_in_other_words_is_searched_as_the_quantity(
    formula: dict[str, Any], plain: dict[str, Any]
) -> None:
    one, other = job(formula), job(plain)
    assert [branch.free for branch in elimination_branches(one)] == [
        branch.free for branch in elimination_branches(other)
    ]
    ours, theirs = (
        {c.quantity: c for c in Evaluator(of, elimination_branches(of)[0]).constraints} for of in (one, other)
    )
    assert ours.keys() == theirs.keys()
    for name, found in ours.items():
        ends = [[c.lower or 0.0, c.upper or 0.0] for c in (found, theirs[name])]
        np.testing.assert_allclose(ends[0], ends[1], rtol=1e-7)
    assert not {"transmission_angle", "self_locking_margin"} - {
        restate_constraint(one, c).quantity for c in constraints_with_floors(one)
    }, "floors hold once, by the job or by default"


DIFFERENT = [
    "max(transmission_angle, 12 deg)",
    "abs(stroke - 100 mm)",
    "stroke + 1e-6 * crank",
    "stroke**2 / crank",
    "peak_torque / stroke",
    "rms_torque + peak_torque",
    "sqrt((rod + crank)**2 - offset**2) - sqrt((rod - crank)**2 - 1.000001 * offset**2)",
]


@pytest.mark.parametrize("formula", DIFFERENT)
def test_a_formula_that_only_resembles_a_quantity_stays_itself(formula: str) -> None:
    unit = {"max(transmission_angle, 12 deg)": "40 deg", "peak_torque / stroke": "90 N"}.get(formula, "50 N m")
    unit = "300 mm" if "stroke +" in formula or "abs" in formula or "sqrt" in formula else unit
    problem = job({formula: {"max": "900 mm" if "**2 / crank" in formula else unit}})
    asked = next(item for item in problem.constraints)
    assert restate_constraint(problem, asked) is asked


def test_the_front_of_a_job_in_formulas_is_that_of_the_job_in_quantities() -> None:
    plain = {"stroke": {"equals": "250 mm"}, "time_ratio": {"min": 1.2}, "peak_torque": {"max": "60 N m"}}
    words = {"stroke * 2": {"equals": "500 mm"}, "time_ratio": {"min": 1.2}, "peak_torque - 0 N m": {"max": "60 N m"}}
    one, other = solve(job(words)), solve(job(plain))
    assert len(one) > 1
    assert one.evaluations == other.evaluations
    np.testing.assert_allclose(one.values, other.values, rtol=1e-9)
    assert set(one.designs.columns) >= {"slack_stroke_times_2_mm"}


def test_an_infeasible_job_in_formulas_evaluates_no_more_and_says_what_was_asked() -> None:
    plain = solve(job({"stroke": {"equals": "250 mm"}, "time_ratio": {"min": 1.6}}))
    words = solve(job({STROKE: {"equals": "250 mm"}, "time_ratio - 1": {"min": 0.6}}))
    assert plain.status == words.status == "infeasible"
    assert "time ratio at least 1.6 is asked, at most 1.42616" in plain.message
    assert "time_ratio - 1 at least 0.6 is asked, at most 0.42616" in words.message
    assert words.evaluations <= plain.evaluations


def test_what_a_formula_asks_of_a_quantity_is_refused_as_early() -> None:
    angle = {"transmission_angle": {"min": "30.17 deg"}, "stroke": {"equals": "250 mm"}}
    with pytest.raises(
        JobError, match=r"time_ratio.*at most 1\.4.*equivalent to what .*time_ratio - 1.* requires in other words"
    ):
        job({"time_ratio - 1": {"min": 0.9}, **angle})
    with pytest.raises(JobError, match=r"stroke.* 250 mm.*leave out one of them|stroke.*0\.25"):
        job({"stroke * 2": {"equals": "500 mm"}, "stroke": {"max": "200 mm"}})
    with pytest.raises(JobError, match="cannot also be an objective;"):
        job({"stroke * 2": {"equals": "500 mm"}}, objectives={"stroke": "maximise", "peak_torque": "minimise"})


def test_along_a_speed_profile_a_ratio_of_crank_angles_is_no_time_ratio() -> None:
    bar = {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"}
    uneven = {
        "speed": "30 rpm",
        "speed_profile": {"cosines": [0.3]},
        "crank": bar,
        "rod": bar,
        "slider": {"mass": "2 kg"},
    }
    problem = job({RATIO: {"min": 1.2}}, mechanism=uneven)
    assert restate_constraint(problem, problem.constraints[0]) is problem.constraints[0]
