"""Quantities that the motion of a job does not have are told with the reason, wherever they are named."""

from __future__ import annotations

import tomllib
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.problem.problem import Problem

SUPPORT, DESIGN = "runs/support.toml", [1.4, 1.8, -0.05]


def by_places() -> Problem:
    tables = tomllib.loads(Path(SUPPORT).read_text(encoding="utf-8"))
    motion = {"kind": "swing", "slider_from": "3.1 m", "slider_to": "0.8 m", "driver": "slider"}
    return parse_job({**tables, "motion": motion, "constraints": {}})


@pytest.mark.parametrize(
    ("kind", "name", "words"),
    [
        ("places", "actuator_travel", r"\[motion\] fixes it by slider_from and slider_to"),
        ("angles", "swing_angle", r"\[motion\] fixes it by from and to"),
        ("angles", "peak_actuator_torque", 'got driver = "slider"; use peak_actuator_force'),
        ("angles", "peak_actuator_power", r"give \[motion\] a law and a duration"),
        ("turns", "swing_energy", "needs a swinging crank; this crank rotates fully"),
    ],
)
def test_a_quantity_that_a_motion_does_not_have_is_told_with_the_reason(kind: str, name: str, words: str) -> None:
    problem = by_places() if kind == "places" else load_job("runs/feeder.toml" if kind == "turns" else SUPPORT)
    design = [0.04, 0.1, 0.02] if kind == "turns" else DESIGN
    for ask in (
        partial(problem.evaluate, [design], [name]),
        partial(problem.quantity, name),
        partial(problem.analyse(design).__getitem__, name),
    ):
        with pytest.raises(InputError, match=f"{name}: .*{words}"):
            ask()


def test_a_quantity_of_a_full_turn_is_not_one_of_a_swing() -> None:
    found = load_job(SUPPORT).analyse(DESIGN)
    with pytest.raises(InputError, match="stroke needs a rotating crank; this crank swings"):
        found["stroke"]
    with pytest.raises(InputError, match="no quantity is called 'strok'"):
        found["strok"]


def test_every_quantity_of_a_full_turn_is_refused_for_a_swing_and_every_other_is_a_number() -> None:
    problem = load_job(SUPPORT)
    own = {of.name for of in problem.own}
    assert own
    for name in (*QUANTITIES, *own):
        if problem.quantity(name).turning:
            with pytest.raises(InputError, match=f"{name} needs a crank that rotates fully"):
                problem.evaluate([DESIGN], [name])
        elif not problem.quantity(name).undefined_because([problem.mechanism]):
            assert np.isfinite(problem.evaluate([DESIGN], [name])).all(), name


def test_cylinders_at_one_place_are_told_as_such() -> None:
    job = tomllib.loads(Path("runs/compressor.toml").read_text(encoding="utf-8"))
    job["mechanism"]["cylinders"] = {"phases": ["0 deg", "180 deg"], "places": ["0 mm", "0 mm"]}
    job["objectives"] = {"peak_rocking_couple": "minimise"}
    with pytest.raises(InputError, match="got no places, or all forces at one"):
        parse_job(job)
