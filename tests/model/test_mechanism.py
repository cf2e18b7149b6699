"""Refusals of a mechanism."""

from __future__ import annotations

import dataclasses
import math
import re
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances, Window
from tests.model.cases import random_machine


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"speed": math.nan}, "speed must be finite; got nan"),
        ({"acceleration": math.inf}, "acceleration must be finite; got inf"),
        ({"slider_mass": -1.0}, "the slider mass must be zero or more and finite; got -1 kg"),
        ({"slider_mass": math.nan}, "the slider mass must be zero or more and finite; got nan kg"),
        ({"gravity": (0.0, math.nan)}, "gravity must be finite"),
        (
            {"gravity": ("down", 0.0)},
            "gravity must consist of numbers in SI units; got 'down'; write text with a unit in",
        ),
        ({"speed": "300 rpm"}, "speed must be a number in SI units; got '300 rpm'; write text with a unit in"),
        (
            {"loads": ("600 N",)},
            r"loads must be a tuple of loads; got \('600 N',\); in a job, write \[\[load\]\]",
        ),
        ({"loads": 3}, "loads must be a tuple of loads; got 3"),
        ({"branch": "half-open"}, "branch must be 'open' or 'crossed'; got 'half-open'"),
    ],
)
def test_wrong_mechanism_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Mechanism(**values)


@pytest.mark.parametrize("name", ["absolute", "fraction"])
@pytest.mark.parametrize("value", [-1e-6, math.nan, math.inf])
def test_tolerance_is_zero_or_more(name: str, value: float) -> None:
    with pytest.raises(InputError, match=f"the {name} part of a tolerance must be zero or more and finite; got "):
        Tolerance(**{name: value})


def test_tolerance_of_the_crank_angle_is_no_share() -> None:
    with pytest.raises(InputError, match="must be an angle, not a fraction; give it in rad or deg"):
        Tolerances(crank_angle=Tolerance(fraction=0.01))


@pytest.mark.parametrize(("start", "end"), [(0.5, 0.5), (0.6, 0.4), (-0.1, 0.5), (0.2, 1.1), (math.nan, 1.0)])
def test_window_is_a_part_of_the_stroke(start: float, end: float) -> None:
    with pytest.raises(InputError, match="a part of the stroke must have 0 <= start < end <= 1"):
        Window(start=start, end=end)


def test_window_needs_a_known_stroke() -> None:
    with pytest.raises(InputError, match=r"during must be .*; got 'down'"):
        Window(during="down")  # type: ignore[arg-type]


def test_mechanism_is_immutable() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        Mechanism().speed = 3.0  # type: ignore[misc]


def loosened(part: Any) -> Any:
    """Return a part of a machine made anew, its tuples given as lists, those of numbers as arrays."""
    if isinstance(part, tuple):
        return np.array(part) if part and isinstance(part[0], float) else [loosened(each) for each in part]
    if not dataclasses.is_dataclass(part) or isinstance(part, type):
        return part
    return type(part)(**{field.name: loosened(getattr(part, field.name)) for field in dataclasses.fields(part)})


def test_lists_and_arrays_serve_as_tuples() -> None:
    random = np.random.default_rng(17)
    kinds = set()
    for _ in range(60):
        machine = random_machine(random)
        kinds |= {type(load).__name__ for load in machine.loads}
        assert loosened(machine) == machine
        assert hash(loosened(machine)) == hash(machine)
    assert {"AngleTable", "PositionTable"} <= kinds


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"rod": 0.5}, "rod of a Mechanism must be Bar or RigidLink; got 0.5; the tables of a job state it"),
        ({"crank": {"mass": 1.0}}, "crank of a Mechanism must be Bar or RigidLink; got {'mass': 1.0}"),
        ({"friction": 0.1}, "friction of a Mechanism must be Friction; got 0.1"),
        ({"tolerances": 1e-4}, "tolerances of a Mechanism must be Tolerances; got 0.0001"),
        ({"drive": 3.0}, "drive of a Mechanism must be Drive or None; got 3.0"),
        ({"varying": ("speed",)}, "varying of a Mechanism must be a tuple of Varying; got 'speed'"),
        ({"speed": None}, "speed must be a number in SI units; got None; leave it out for 0"),
        (
            {"gravity": 9.81},
            "gravity must have components along x and y, in m/s^2; got 9.81; for example, write (0.0, -9.81)",
        ),
        ({"gravity": (0.0, 0.0, -9.81)}, "gravity must have components along x and y, in m/s^2; got (0.0, 0.0, -9.81)"),
    ],
)
def test_a_part_of_another_kind_is_refused_at_once(wrong: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        Mechanism(**wrong)
