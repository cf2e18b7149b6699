"""Conditions as people write them."""

from __future__ import annotations

import math

import pytest

from slidercrank.model.errors import InputError
from slidercrank.service.designs.selection import parse_condition, select_rows
from slidercrank.service.runs.result import Row

ROWS: list[Row] = [
    {
        "crank_mm": 40.0,
        "slow_stroke": "inward",
        "least_transmission_angle_deg": angle,
        "peak_torque_Nm": torque,
        "rod_to_offset": ratio,
        "footprint_m2": 0.25,
        "peak_slider_acceleration_m_s2": 100.0,
        "slack_peak_torque_Nm": 5.0,
        "residual": 1e-9,
        "price_EUR": 10.0 * torque,
    }
    for angle, torque, ratio in ((39.0, 20.0, 3.2), (40.0 - 1e-8, 30.0, math.inf), (41.0, 40.0, math.nan))
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("transmission_angle >= 40 deg", [1, 2]),
        ("  transmission_angle>=40deg ", [1, 2]),
        ("transmission_angle ≥ 0.6981317007977318 rad", [1, 2]),
        ("least_transmission_angle_deg > 40", [2]),
        ("least_transmission_angle_deg <= 40", [0, 1]),
        ("transmission_angle < 40 deg", [0]),
        ("transmission_angle = 40 deg", [1]),
        ("transmission_angle == 40 deg", [1]),
        ("transmission_angle != 40 deg", [0, 2]),
        ("peak_torque <= 0.03 kN m", [0, 1]),
        ("peak_torque_Nm ≤ 3e1", [0, 1]),
        ("rod_to_offset >= 3.2", [0, 1]),
        ("rod_to_offset > 1e6", [1]),
        ("crank >= 4 cm", [0, 1, 2]),
        ("crank < 1.57 inch", []),
        ("crank_mm = 40 mm", [0, 1, 2]),
        ("footprint <= 2500 cm^2", [0, 1, 2]),
        ("peak_slider_acceleration < 90 m/s^2", []),
        ("slack_peak_torque > 4 N m", [0, 1, 2]),
        ("residual <= 1e-6", [0, 1, 2]),
        ("price <= 300 EUR", [0, 1]),
        ("price_EUR > 200", [1, 2]),
        ("slow_stroke = inward", [0, 1, 2]),
        ("slow_stroke != 'inward'", []),
    ],
)
def test_a_condition_selects(text: str, expected: list[int]) -> None:
    assert select_rows(ROWS, [text]) == expected


@pytest.mark.parametrize(("given", "unit"), [("300", "with its unit"), ("300 USD", "in EUR")])
def test_an_amount_of_a_catalogue_needs_its_own_unit(given: str, unit: str) -> None:
    with pytest.raises(InputError, match=rf"an amount in EUR.*got \"{given}\"; write it like \"100 EUR\"") as refused:
        select_rows(ROWS, [f"price <= {given}"])
    assert unit in str(refused.value)


def test_conditions_add_up() -> None:
    assert select_rows(ROWS, ["transmission_angle >= 40 deg", "peak_torque < 35 N m"]) == [1]


def test_no_condition_selects_all_and_no_designs_none() -> None:
    assert select_rows(ROWS, []) == [0, 1, 2]
    assert select_rows([], ["anything"]) == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "write it like"),
        ("transmission_angle", "write it like"),
        ("transmission_angle >= ", "write it like"),
        ("transmission_angle => 40 deg", "must have one of >= <= > < = !=; got"),
        ("40 deg <= transmission_angle", "write it like"),
        ("transmision_angle >= 40 deg", "did you mean transmission_angle"),
        ("no_such >= 1", "no quantity or column"),
        ("slack_transmission_angle >= 1 deg", r"'slack_transmission_angle'; did you mean (?!slack_trans)"),
        ("transmission_angle >= 40", "with its unit"),
        ("transmission_angle >= 40 mm", "which is a length"),
        ("transmission_angle >= nan", "finite"),
        ("least_transmission_angle_deg >= inf", "finite"),
        ("transmission_angle >= 40 deg; import os", "angle"),
        ("__import__('os') >= 1", "a function is one of sqrt, .* __import__ is not one of them"),
        ("crank + >= 100 mm", "missing at its end; .* write it like"),
        ("crank_mm >= 30 and rod_mm >= 3", "may only have one comparison; got .*; give two conditions"),
        ("slow_stroke >= inward", "words"),
        ("residual < small", "ratio"),
    ],
)
def test_a_wrong_condition_is_refused_with_the_reason(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        parse_condition(text, list(ROWS[0]), ROWS[0])
