"""One rule says what is constant, in Python and on the page, and a last bit changes no answer."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from slidercrank.optimise.front.choose_design import knee_row, lexicographic, scale_by_range, topsis
from slidercrank.optimise.front.hypervolume import hypervolume, ideal_and_range, ignore_progress
from slidercrank.optimise.front.saved_front import SAME, column_ranges, is_constant
from slidercrank.optimise.front.stationarity import slack_of
from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.requirements import Constraint
from slidercrank.optimise.search.assemble_front import columns_of_designs
from tests.optimise.problems import problem

PAGE = Path(__file__).parents[2] / "service" / "page" / "static" / "lib" / "constant.js"


@pytest.mark.parametrize(
    ("values", "size", "constant"),
    [
        ([280.0, 280.00000000000006], 0.0, True),
        ([280.0, 280.0 * (1.0 + 0.9e-9)], 0.0, True),
        ([280.0, 280.0 * (1.0 + 2e-9)], 0.0, False),
        ([-1e-15, 1e-15], 0.0, False),
        ([-1e-15, 1e-15], 1.0, True),
        ([0.0, 0.0], 0.0, True),
        ([5.0, np.nan, 5.0], 0.0, True),
        ([5.0, np.inf, 6.0], 0.0, False),
        ([np.nan, np.nan], 0.0, True),
        ([], 0.0, True),
    ],
)
def test_numbers_are_constant_that_differ_by_rounding(values: list[float], size: float, constant: bool) -> None:
    assert bool(is_constant(values, size=size)) is constant


def test_the_page_has_the_same_rule() -> None:
    found = re.search(r"SAME = ([\d.e-]+);", PAGE.read_text(encoding="utf-8"))
    assert found is not None
    assert float(found[1]) == SAME


def noisy(random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return objectives with a constant third one, and the same with last bits of it that differ."""
    angle = np.sort(random.uniform(0.0, 0.5 * np.pi, count))
    values = np.column_stack([1.0 - np.cos(angle), 1.0 - np.sin(angle), np.full(count, 0.28)])
    bits = values.copy()
    bits[:, 2] += np.spacing(0.28) * random.integers(-3, 4, count)
    return values, bits


def test_a_last_bit_of_a_constant_objective_changes_no_choice() -> None:
    random = np.random.default_rng(5)
    for _ in range(100):
        values, bits = noisy(random, int(random.integers(2, 30)))
        order = [(2, 0.0, 0.0), (0, 0.0, 0.3), (1, 0.0, 0.0)]
        assert knee_row(bits) == knee_row(values)
        assert topsis(bits, [1.0, 2.0, 3.0]) == topsis(values, [1.0, 2.0, 3.0])
        assert lexicographic(bits, order) == lexicographic(values, order)
        assert (scale_by_range(bits)[:, 2] == 0.0).all()
        assert hypervolume(bits, *ideal_and_range(bits)) == pytest.approx(
            hypervolume(values, *ideal_and_range(values)), rel=1e-8
        )


def test_distances_from_a_target_that_is_met_are_rounding() -> None:
    values = np.array([[3e-16, 1.0], [0.0, 2.0], [1e-16, 0.5]])
    assert knee_row(values, size=[0.28, 0.0]) == 2
    assert column_ranges(values, size=[0.28, 0.0]).tolist() == [0.0, 1.5]


def test_what_has_no_value_is_never_the_best() -> None:
    assert knee_row(np.array([[np.inf, 1.0], [5.0, 1.0]])) == 1


@pytest.mark.parametrize("bits", [-40, -1, 0, 1, 40])
def test_a_slack_of_rounding_is_zero(bits: int) -> None:
    """A fixed linkage whose rules hold but for some last bits."""
    given = problem({"peak_torque": "minimise"}, crank=0.1, rod=0.3, offset=0.05)
    design = np.array([[0.1, 0.3, 0.05]])
    stroke = float(given.quantity("stroke").evaluate(given.mechanism, design).values[0])
    bound = stroke + bits * np.spacing(stroke)
    for held in ((bound, bound), (bound, None), (None, bound), (bound, 2.0 * bound)):
        asked = problem({"peak_torque": "minimise"}, {"stroke": held}, crank=0.1, rod=0.3, offset=0.05)
        table = columns_of_designs(asked, np.zeros(1, dtype=np.int64), design, ignore_progress)
        assert table["slack_stroke_mm"].tolist() == [0.0]
        assert len(constraints_with_floors(asked)) == 2
    apart = replace(
        given, constraints=problem({"peak_torque": "minimise"}, {"stroke": (stroke - 1e-7, None)}).constraints
    )
    table = columns_of_designs(apart, np.zeros(1, dtype=np.int64), design, ignore_progress)
    assert table["slack_stroke_mm"][0] == pytest.approx(1e-4, rel=1e-6)


def test_the_slack_of_what_is_infinite_is_infinite_and_of_what_has_no_value_none() -> None:
    values = np.array([math.inf, math.nan, 5.0, 3.0])
    least, most = Constraint(quantity="rod_to_offset", lower=3.0), Constraint(quantity="rod_to_offset", upper=3.0)
    np.testing.assert_array_equal(slack_of(least, values), [math.inf, math.nan, 2.0, 0.0])
    np.testing.assert_array_equal(slack_of(most, values), [-math.inf, math.nan, -2.0, 0.0])
    equal = Constraint(quantity="rod_to_offset", lower=3.0, upper=3.0)
    np.testing.assert_array_equal(slack_of(equal, values), [-math.inf, math.nan, -2.0, 0.0])
    asked = problem({"peak_torque": "minimise"}, {"rod_to_offset": (3.0, None)}, crank=0.1, rod=0.3)
    designs = np.array([[0.1, 0.3, 0.0], [0.1, 0.3, 0.1]])
    table = columns_of_designs(asked, np.zeros(2, dtype=np.int64), designs, ignore_progress)
    assert table["slack_rod_to_offset"].tolist() == [math.inf, 0.0]
