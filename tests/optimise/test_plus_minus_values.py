"""Ranges that are stated as a middle and half a width: "180 mm +- 0.5 mm"."""

from __future__ import annotations

import random
from typing import Any

import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.objectives.kinds import LENGTH
from slidercrank.objectives.units import plus_minus_ends, to_si
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.requirements import Range

TABLES: dict[str, Any] = {
    "name": "Pusher",
    "mechanism": {"speed": "60 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": "10 mm"},
    "objectives": {"peak_torque": "minimise"},
}


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("180 mm +- 0.5 mm", ("179.5 mm", "180.5 mm")),
        ("180 mm ± 0.5 mm", ("179.5 mm", "180.5 mm")),
        ("180±0.5 mm", ("179.5 mm", "180.5 mm")),
        ("180 mm +/- 0.5", ("179.5 mm", "180.5 mm")),
        ("1 in +- 2.54 mm", ("0.9 in", "1.1 in")),
        ("-5 mm +- 1 mm", ("-6.0 mm", "-4.0 mm")),
        ("300 1/min +- 5 1/min", ("295.0 1/min", "305.0 1/min")),
        ("180 mm", None),
        ("crank + rod", None),
        (180, None),
    ],
)
def test_a_middle_and_half_a_width_are_read_as_two_ends(text: object, ends: tuple[str, str] | None) -> None:
    assert plus_minus_ends(text) == ends


def test_the_ends_are_those_of_sums_and_differences_of_the_values() -> None:
    draw = random.Random(9)
    for _ in range(200):
        middle, half = round(draw.uniform(-500.0, 500.0), 3), round(draw.uniform(0.0, 5.0), 4)
        one, other = draw.choice(["mm", "m", "in", "µm"]), draw.choice(["mm", "in", "cm"])
        ends = plus_minus_ends(f"{middle} {one} {draw.choice(['+-', '±', '+/-'])} {half} {other}")
        assert ends is not None
        at, by = to_si(f"{middle} {one}", LENGTH), to_si(f"{half} {other}", LENGTH)
        assert [to_si(end, LENGTH) for end in ends] == pytest.approx([at - by, at + by], rel=1e-14, abs=1e-16)


def test_half_a_width_of_another_kind_is_refused() -> None:
    with pytest.raises(InputError, match="both parts of a range must have units of one kind"):
        plus_minus_ends("180 mm +- 2 deg")


def test_a_variable_a_requirement_and_another_number_of_the_job_take_such_a_range() -> None:
    lengths = {"crank": "40 mm +- 5 mm", "mechanism.slider.mass": "2 kg ± 100 g"}
    asked = {"stroke": {"equals": "80 mm +- 0.5 mm"}, "rod - crank": {"equals": "0.2 m ± 20 mm"}}
    tables = TABLES | {"variables": TABLES["variables"] | lengths, "constraints": asked}
    problem = parse_job(tables, require_feasible=False)
    assert problem.crank == Range(lower=0.035, upper=0.045)
    (mass,) = problem.mechanism.varying
    assert (mass.lower, mass.upper) == pytest.approx((1.9, 2.1), rel=1e-15)
    assert [(of.lower, of.upper) for of in problem.constraints] == [
        pytest.approx((0.0795, 0.0805), rel=1e-15),
        pytest.approx((0.18, 0.22), rel=1e-15),
    ]
    assert problem.warnings == ()


def test_a_range_stands_for_no_single_number() -> None:
    with pytest.raises(JobError, match=r"mechanism\.speed: must be .*, a single value; got .*, which is a range"):
        parse_job(TABLES | {"mechanism": {"speed": "60 rpm +- 1 rpm"}})
