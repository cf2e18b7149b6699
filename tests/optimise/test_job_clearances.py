"""Clearances in a job file."""

from __future__ import annotations

from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.mechanism import Clearances
from slidercrank.optimise.job import parse_job
from slidercrank.service.text.job_in_words import problem_in_words


def job(**tolerances: Any) -> dict[str, Any]:
    return {
        "name": "small",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "tolerances": tolerances,
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["100 mm", "200 mm"], "offset": ["0 mm", "20 mm"]},
        "objectives": {"position_error": "minimise", "peak_torque": "minimise"},
    }


def test_clearances_are_read_with_their_units() -> None:
    clearances = {"crank_pivot": "20 µm", "crank_pin": "0.03 mm", "slider_pin": 4e-5, "guide": "0.002 inch"}
    problem = parse_job(job(clearances=clearances))
    found = problem.mechanism.tolerances.clearances
    assert found == Clearances(crank_pivot=2e-5, crank_pin=3e-5, slider_pin=4e-5, guide=5.08e-5)
    assert "radial clearance of the crank pin 0.03 mm" in problem_in_words(problem)["tolerances"]


def test_without_clearances_there_are_none() -> None:
    assert parse_job(job(crank="0.1 mm")).mechanism.tolerances.clearances == Clearances()


def test_clearances_alone_are_a_cause_of_a_position_error() -> None:
    assert parse_job(job(clearances={"guide": "0.1 mm"})).objectives
    with pytest.raises(JobError, match="a position error needs tolerances; got none"):
        parse_job(job(clearances={"guide": 0.0}))


@pytest.mark.parametrize(
    ("clearances", "parts"),
    [
        ({"crank_pin": "-0.1 mm"}, ["clearances.crank_pin", "zero or more", "-0.1 mm"]),
        ({"crank_pin": "0.1"}, ["clearances.crank_pin", "with its unit"]),
        ({"crank_pin": "0.1 deg"}, ["clearances.crank_pin", "a length", "an angle"]),
        ({"crank_pin": float("nan")}, ["clearances.crank_pin", "finite"]),
        ({"crankpin": "0.1 mm"}, ["clearances", "crankpin", "crank_pin"]),
        ("0.1 mm", ["clearances"]),
    ],
)
def test_wrong_clearances_are_refused(clearances: Any, parts: list[str]) -> None:
    with pytest.raises(JobError) as refused:
        parse_job(job(clearances=clearances))
    for part in parts:
        assert part in str(refused.value)
