"""Limits are rounded to the side where everything is possible, and survive being typed."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.units import kind_of_symbol, to_si
from slidercrank.optimise.feasibility.relaxation import Side, isolated_value_in_full_digits, round_to_safe_side

UNITS = sorted({(quantity.unit.symbol, quantity.unit.factor) for quantity in QUANTITIES.values()})


@given(st.floats(1e-7, 1e5), st.sampled_from(UNITS), st.sampled_from(["down", "up"]), st.sampled_from([-1.0, 1.0]))
def test_a_limit_typed_again_lies_on_its_safe_side_and_hardly_gives_anything_away(
    size: float, unit: tuple[str, float], side: Side, sign: float
) -> None:
    symbol, factor = unit
    value = sign * size / factor
    text = round_to_safe_side(value * factor, side)
    kind = kind_of_symbol(symbol)
    again = to_si(f"{text} {symbol}" if symbol else text, kind)
    beyond = (again - value) * (1.0 if side == "down" else -1.0)
    assert beyond <= 1.01e-10 * abs(value)
    assert beyond >= -1e-5 * abs(value)


@pytest.mark.parametrize(
    ("value", "side", "text"),
    [
        (42.80780986, "down", "42.8078"),
        (42.80776, "down", "42.8077"),
        (42.80772, "up", "42.8078"),
        (239.99999999999997, "down", "240"),
        (240.00000000000003, "up", "240"),
        (-3.0000001, "down", "-3.00001"),
        (0.0, "up", "0"),
        (1234567.8, "up", "1234570"),
        (0.000123456789, "down", "0.000123456"),
        (3.5e-7, "up", "3.5e-7"),
        (2.5e12, "down", "2.5e+12"),
    ],
)
def test_limits_read_as_people_write_numbers(value: float, side: Side, text: str) -> None:
    assert round_to_safe_side(value, side) == text


def test_a_value_that_is_possible_alone_is_told_to_rounding() -> None:
    value = 1e3 * (math.sqrt(0.4**2 - 0.05**2) - math.sqrt(0.2**2 - 0.05**2))
    assert float(isolated_value_in_full_digits(value)) == pytest.approx(value, rel=1e-11)
    assert isolated_value_in_full_digits(240.0) == "240"
