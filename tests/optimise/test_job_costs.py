"""[costs] in a job file: what becomes of it, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.tolerance_costs import Cost, Costs

SMALL: dict[str, Any] = {
    "name": "Small",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": "40 mm", "rod": ["100 mm", "200 mm"], "offset": 0},
    "objectives": {"peak_torque": "minimise"},
}
GOOD = {"cost": 8.0, "at": "0.05 mm"}


def test_without_costs_a_problem_has_none() -> None:
    assert parse_job(SMALL).costs is None


def test_costs_are_read_in_si() -> None:
    costs = {
        "crank": {"cost": 8, "at": "0.05 mm", "fixed": 5.0, "min": "5 µm", "max": "0.2 mm"},
        "crank_angle": {"cost": 10.0, "at": "0.1 deg", "exponent": 2.0, "max": "1 deg"},
    }
    assert parse_job(SMALL | {"costs": costs}).costs == Costs(
        crank=Cost(cost=8.0, at=5e-5, fixed=5.0, least=5e-6, greatest=2e-4),
        crank_angle=Cost(cost=10.0, at=math.radians(0.1), exponent=2.0, greatest=math.radians(1.0)),
    )


@pytest.mark.parametrize(
    ("costs", "words"),
    [
        ({}, ["costs: must name at least one of crank, rod", "for example, add crank ="]),
        ({"crank": {"at": "1 mm"}}, ["costs.crank.cost: is missing", "for example, add cost = 8.0"]),
        ({"crank": {"cost": 8.0}}, ["costs.crank.at: is missing", '"0.05 mm"']),
        ({"crank": GOOD | {"at": "0.1 deg"}}, ["costs.crank.at", "is an angle"]),
        ({"crank_angle": GOOD}, ["costs.crank_angle.at", "is a length"]),
        ({"crank": GOOD | {"cost": 0}}, ["costs.crank.cost", "positive"]),
        ({"crank": GOOD | {"exponent": 7.0}}, ["costs.crank", "from 0.25 to 4; got 7"]),
        ({"crank": GOOD | {"min": "1 mm", "max": "0.5 mm"}}, ["costs.crank", "below the greatest"]),
        ({"crank": GOOD | {"reciprocal": 1}}, ["costs.crank.reciprocal: unknown key", "possible here: "]),
        ({"cranc": GOOD}, ["costs.cranc: unknown key", "did you mean crank?"]),
    ],
)
def test_bad_costs_are_refused_in_one_clear_message(costs: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(JobError) as caught:
        parse_job(SMALL | {"costs": costs})
    message = str(caught.value)
    assert all(word in message for word in words), message
    assert len(message.splitlines()) == 1
