"""Formulas in conditions, orders and picks of stored designs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from slidercrank.model.errors import InputError
from slidercrank.service.designs.row_formulas import RowFormula, find_formula
from slidercrank.service.designs.selection import no_match_message, parse_condition, select_rows
from slidercrank.service.runs.result import Result

ROWS: list[dict[str, Any]] = [
    {"crank_mm": 40.0, "offset_mm": 42.0, "peak_torque_Nm": 90.0, "slider_mass_kg": 2.0, "slow_stroke": "outward"},
    {"crank_mm": 50.0, "offset_mm": 42.0, "peak_torque_Nm": 80.0, "slider_mass_kg": 1.0, "slow_stroke": "inward"},
    {"crank_mm": 60.0, "offset_mm": 65.0, "peak_torque_Nm": None, "slider_mass_kg": 1.0, "slow_stroke": "inward"},
]
STORED = cast(Result, SimpleNamespace(designs=ROWS))
INCH: list[dict[str, Any]] = [{"crank_in": 1.0, "offset_in": 1.5, "peak_torque_lbf_in": 800.0}]


@pytest.mark.parametrize(
    ("condition", "chosen"),
    [
        ("offset - crank >= 1 mm", [0, 2]),
        ("offset-crank>=2 mm", [0, 2]),
        ("offset - crank = 0.2 cm", [0]),
        ("peak_torque / crank > 2 kN", [0]),
        ("mechanism.slider.mass * 9.81 m/s^2 <= 10 N", [1, 2]),
        ("min(crank, offset) < 42 mm", [0]),
        ("crank / offset >= 1", [1]),
        ("offset_mm - crank >= 1 mm", [0, 2]),
        ("slow_stroke = inward", [1, 2]),
    ],
)
def test_conditions_take_formulas_of_columns(condition: str, chosen: list[int]) -> None:
    assert select_rows(ROWS, [condition]) == chosen


def test_formulas_read_columns_of_either_system_of_units() -> None:
    assert select_rows(INCH, ["offset - crank >= 0.5 inch"]) == [0]
    assert select_rows(INCH, ["offset - crank > 12.8 mm"]) == []
    assert select_rows(INCH, ["peak_torque / crank <= 801 lbf"]) == [0]


def test_a_formula_that_has_a_column_is_that_column() -> None:
    keys = ["crank_mm", "offset_mm", "offset_minus_crank_mm"]
    found = find_formula("offset -crank", keys)
    assert not isinstance(found, RowFormula)
    assert found.key == "offset_minus_crank_mm"
    assert found.plain is None  # a number needs its unit: the formula does not say it


@pytest.mark.parametrize(
    ("condition", "said"),
    [
        ("offst - crank >= 1 mm", "there is no quantity or column 'offst'; did you mean offset"),
        ("offset - crank >= 1 N", 'must be a length; got "1 N", which is a force'),
        ("offset - crank >= 1", "must be a length with its unit"),
        ("offset - peak_torque >= 1 mm", "subtracts mm and N m"),
        ("offset - slow_stroke >= 1 mm", "a column of words|subtracts mm and no unit"),
        ("2 * 3 >= 1", r"got 2 \* 3, which is the same for every design"),
        ("offset - >= 1 mm", "missing at its end"),
        ("offset - crank", "a condition must have a quantity or a formula, then one of"),
        ("crank < offset + 3 mm", r'compare the difference, like "crank - \(offset \+ 3 mm\) < 0 mm"'),
        ("3 mm <= crank", 'write it like "crank >= 3 mm"'),
        ("10 mm <= crank <= 50 mm", "may only have one comparison; got .*; give two conditions"),
        ("mechanism.speed > 3 rpm", "there is no column 'mechanism.speed': only variables have one; leave it out"),
    ],
)
def test_a_wrong_formula_in_a_condition_is_refused(condition: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        select_rows(ROWS, [condition])


def test_a_condition_that_is_not_defined_is_not_met() -> None:
    condition = parse_condition("sqrt(1 - crank / offset) >= 0", list(ROWS[0]), ROWS[0])
    assert [condition.holds(row) for row in ROWS] == [True, False, True]


@pytest.mark.parametrize("condition", ["crank / 0 > 5 mm", "1 m / (crank - crank) < 5", "sqrt(-crank / offset) > 0"])
def test_a_formula_without_a_value_is_met_by_none_and_said_so(condition: str) -> None:
    assert select_rows(ROWS, [condition]) == []
    said = no_match_message(STORED, [condition])
    assert "none of the 3 designs meets" in said
    assert said.endswith(" has no value for any of them")


def test_a_word_that_no_design_has_is_answered_with_those_that_there_are() -> None:
    said = no_match_message(STORED, ["slow_stroke = outwards"])
    assert said.endswith("; slow_stroke is inward or outward there")
    assert no_match_message(STORED, ["crank > 1 m"]).endswith("meets crank > 1 m")
