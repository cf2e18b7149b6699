"""A crank speed that a job leaves out: allowed where nothing that it asks for follows the speed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.text.job_in_words import problem_in_words

TABLES: dict[str, Any] = {
    "name": "Pusher",
    "mechanism": {"slider": {"mass": "2 kg"}, "gravity": "9.81 m/s^2"},
    "variables": {"crank": ["20 mm", "50 mm"], "rod": ["100 mm", "300 mm"], "offset": ["0 mm", "40 mm"]},
    "constraints": {"transmission_angle": {"min": "40 deg"}, "rod - crank": {"min": "60 mm"}},
    "objectives": {"stroke": "maximise", "footprint": "minimise"},
    "optimiser": {"designs": 4, "samples": 256},
}


@pytest.mark.slow
def test_dimensions_are_sized_without_a_speed_and_the_check_says_so() -> None:
    problem = parse_job(TABLES)
    assert problem.mechanism.speed == 0.0
    assert "no crank speed: static" in problem_in_words(problem)["given"]
    other = parse_job(TABLES | {"mechanism": TABLES["mechanism"] | {"speed": "200 rpm"}})
    np.testing.assert_array_equal(solve(problem).dimensions, solve(other).dimensions)


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"objectives": {"peak_torque": "minimise"}}, "peak_torque"),
        ({"constraints": {"peak_slider_speed": {"max": "3 m/s"}}}, "peak_slider_speed"),
        ({"constraints": {"peak_torque / stroke": {"max": "300 N"}}}, "peak_torque / stroke"),
        ({"constraints": {"slow_stroke": "outward"}}, "slow_stroke"),
        ({"constraints": {"outward_to_inward_time_ratio": {"min": 1.1}}}, "outward_to_inward_time_ratio"),
        ({"mechanism": {"direction": "clockwise"}}, "direction"),
        ({"mechanism": {"speed_profile": {"cosines": [0.0, 0.05]}}}, "speed_profile"),
    ],
)
def test_the_first_of_what_follows_the_speed_is_named_where_it_is_missing(changes: dict[str, Any], name: str) -> None:
    with pytest.raises(JobError, match=r"mechanism\.speed: is missing, but required unless") as told:
        parse_job(TABLES | changes)
    assert f"; {name} depends on it; for example, add speed = " in str(told.value)


def test_a_quantity_follows_the_speed_where_its_values_at_random_speeds_differ() -> None:
    load = StrokeForce(outward=-200.0, inward=0.0)
    machine = Mechanism(crank=RigidLink(mass=0.4), rod=RigidLink(mass=0.6), slider_mass=2.0, loads=(load,))
    draw = np.random.default_rng(35)
    designs = draw.uniform([0.02, 0.15, -0.05], [0.06, 0.3, 0.05], (20, 3))
    for name, of in QUANTITIES.items():
        if of.undefined_because([machine]):
            continue
        speeds = [0.0, *draw.uniform(-300.0, 300.0, 3)]
        values = np.array([of.evaluate(replace(machine, speed=speed), designs).values for speed in speeds])
        spread = np.ptp(values, axis=0) > 1e-9 * abs(values).max(axis=0)
        assert of.depends_on_speed(machine) == spread.any(), name
