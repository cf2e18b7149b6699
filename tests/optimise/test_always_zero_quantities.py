"""Objectives that are zero for every design, and offsets that are rounding."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.model.kinematics.geometry import offset_without_rounding
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import RobustQuantity
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.contradictory_problems import require_nonzero_quantities
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.problem.requirements import Objective
from slidercrank.optimise.solve import solve

JOB: dict[str, Any] = {
    "name": "idle",
    "mechanism": {"speed": "300 rpm", "gravity": "9.81 m/s^2", "slider": {"mass": "2 kg"}, "rod": {"mass": "0.8 kg"}},
    "load": [{"force": "200 N", "direction": "inward"}],
    "tolerances": {"offset": "0.1 mm"},
    "variables": {"crank": ["20 mm", "60 mm"], "rod": ["150 mm", "300 mm"], "offset": ["-40 mm", "40 mm"]},
    "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
    "optimiser": {"designs": 8},
}


def job(objective: str, wish: Any = "minimise", **changes: Any) -> dict[str, Any]:
    return copy.deepcopy(JOB) | changes | {"objectives": {objective: wish, "transmission_angle": "maximise"}}


@pytest.mark.parametrize("wish", ["minimise", "maximise", {"target": 3.0}])
@pytest.mark.parametrize("objective", ["mean_torque", "mean_power"])
def test_a_mean_that_is_zero_for_every_design_is_no_objective(objective: str, wish: Any) -> None:
    with pytest.raises(JobError, match=f"objectives.{objective}: it needs work over a turn, which is zero"):
        parse_job(job(objective, wish))


def test_its_robust_form_and_a_problem_made_in_python_are_refused_too() -> None:
    data = job("peak_torque")
    data["robust"] = {"kind": "worst case", "quantities": ["peak_torque"]}
    problem = parse_job(data)
    for name in ("mean_torque", "mean_power"):
        robust = next(own for own in problem.own if own.name == "peak_torque_robust")
        assert isinstance(robust, RobustQuantity)
        own = (replace(robust, inner=QUANTITIES[name]),)
        for quantity in (name, own[0].name):
            wrong = replace(problem, own=own, objectives=(Objective(quantity=quantity, sense="minimise"),))
            with pytest.raises(InputError, match="use peak_"):
                solve(wrong)


def test_with_a_load_that_takes_work_the_remedy_holds() -> None:
    for more in (
        {"load": [{"force": "200 N", "opposes": "outward stroke"}]},
        {"friction": {"guide": 0.1}},
        {"load": [{"viscous": "20 N s/m"}]},
    ):
        assert parse_job(job("mean_torque", **more)).objectives[0].quantity in ("mean_torque", "transmission_angle")


def test_a_choice_of_machines_of_which_one_works_is_an_objective() -> None:
    problem = parse_job(job("peak_torque"))
    worked = replace(problem.mechanism, loads=(StrokeForce(outward=-200.0, inward=0.0),))

    def chosen(*machines: Mechanism) -> Problem:
        ranges: dict[str, Any] = {"crank": problem.crank, "rod": problem.rod, "offset": problem.offset}
        variants = tuple(Variant(labels=(str(n),), mechanism=machine, **ranges) for n, machine in enumerate(machines))
        objective = Objective(quantity="mean_torque", sense="minimise")
        return replace(problem, choices=("load",), variants=variants, objectives=(objective,))

    require_nonzero_quantities(chosen(problem.mechanism, worked))
    with pytest.raises(InputError, match="needs work over a turn"):
        require_nonzero_quantities(chosen(problem.mechanism, problem.mechanism))


def test_an_offset_that_is_rounding_is_none() -> None:
    for offset in (1e-20, -1e-20, 1e-17, -1e-300):
        linkage = Linkage(0.05, 0.16, offset)
        assert linkage.offset == 0.0
        assert linkage.slow_stroke() == "equal"
        row = analyse(Mechanism(speed=1.0), np.array([[0.05, 0.16, offset]])).iloc[0]
        assert row["offset_mm"] == 0.0
        assert row["slow_stroke"] == "equal"
        assert math.isinf(row["rod_to_offset"])
    assert Linkage(0.05, 0.16, 1e-9).offset == 1e-9
    found = offset_without_rounding(np.array([0.16, 0.16, 0.16]), np.array([1e-18, -1e-9, math.nan]))
    np.testing.assert_array_equal(found, [0.0, -1e-9, math.nan])


def test_designs_at_the_kink_of_the_offset_are_delivered_without_one() -> None:
    data = copy.deepcopy(JOB)
    data["objectives"] = {"stroke": "maximise", "transmission_angle": "maximise"}
    front = solve(parse_job(data))
    offsets, rods = front.dimensions[:, 2], front.dimensions[:, 1]
    assert ((offsets == 0.0) | (np.abs(offsets) > 1e-15 * rods)).all()
    assert (offsets == 0.0).any()
