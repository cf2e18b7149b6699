"""Choosing one design: TOPSIS against its book, ranked objectives against brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.front.choose_design import Priority, knee_row, lexicographic, topsis, topsis_closeness
from tests.optimise.independent import Array
from tests.service import fronts

# Hwang and Yoon, "Multiple Attribute Decision Making" (1981), the choice of a fighter aircraft: speed (Mach), ferry
# range (NM), payload (pounds), cost (M$), reliability and manoeuvrability (scales of 1 to 9). Cost is minimised.
AIRCRAFT = np.array(
    [
        [2.0, 1500.0, 20000.0, 5.5, 5.0, 9.0],
        [2.5, 2700.0, 18000.0, 6.5, 3.0, 5.0],
        [1.8, 2000.0, 21000.0, 4.5, 7.0, 7.0],
        [2.2, 1800.0, 20000.0, 5.0, 5.0, 5.0],
    ]
) * np.array([-1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
WEIGHTS = (0.2, 0.1, 0.1, 0.1, 0.2, 0.3)


def random_front(seed: int, n: int = 40, m: int = 3) -> Array:
    """Return points on a sphere's lower corner, none of which dominates another, in units of very different size."""
    points = np.abs(np.random.default_rng(seed).standard_normal((n, m)))
    points = 1.0 - points / np.linalg.norm(points, axis=1)[:, None]
    return np.asarray(points * 10.0 ** np.arange(m) + 5.0)


def test_closeness_is_that_of_the_book() -> None:
    """Printed as 0.643, 0.268, 0.613, 0.312, from intermediate results of four digits: 1e-3 is theirs."""
    found = topsis_closeness(AIRCRAFT, WEIGHTS, normalisation="vector")
    assert found == pytest.approx([0.643, 0.268, 0.613, 0.312], abs=1e-3)
    assert topsis(AIRCRAFT, WEIGHTS, normalisation="vector") == 0


def test_closeness_is_one_at_the_ideal_and_zero_at_the_worst() -> None:
    """By hand: ranges 10 and 4. The middle is 0.5 and 0.25 of them from the best, with weights 3/4 and 1/4."""
    values = np.array([[0.0, 1.0], [5.0, 2.0], [10.0, 5.0]])
    best, worst = math.hypot(0.375, 0.0625), math.hypot(0.375, 0.1875)
    assert topsis_closeness(values, (3.0, 1.0)) == pytest.approx([1.0, worst / (best + worst), 0.0], rel=1e-14)


@pytest.mark.parametrize("normalisation", ["range", "vector"])
@pytest.mark.parametrize("column", range(3))
def test_all_weight_on_one_objective_picks_its_best(column: int, normalisation: str) -> None:
    for seed in range(5):
        values = random_front(seed)
        weights = [float(index == column) for index in range(3)]
        assert topsis(values, weights, normalisation=normalisation) == np.argmin(values[:, column])  # type: ignore[arg-type]


def test_a_tie_goes_to_the_better_in_the_other_objectives() -> None:
    values = np.array([[0.0, 5.0], [0.0, 3.0], [1.0, 2.0]])
    assert topsis(values, (1.0, 0.0)) == 1
    assert lexicographic(values, [(0, 0.0, 0.0)]) == 1


def test_topsis_by_range_does_not_depend_on_units_or_zero() -> None:
    values = random_front(3)
    moved = values * np.array([2.0, 1e-6, 1e6]) + np.array([-1e3, 7.0, 0.0])
    assert topsis_closeness(moved, (1.0, 2.0, 3.0)) == pytest.approx(
        topsis_closeness(values, (1.0, 2.0, 3.0)), rel=1e-9
    )
    assert topsis_closeness(values, (2.0, 4.0, 6.0)) == pytest.approx(
        topsis_closeness(values, (1.0, 2.0, 3.0)), rel=1e-12
    )


def test_more_weight_never_picks_a_worse_value_of_two_objectives() -> None:
    values = random_front(5, m=2)
    picked = [values[topsis(values, (weight, 1.0)), 0] for weight in (0.0, 0.2, 0.5, 1.0, 2.0, 5.0, 50.0)]
    assert (np.diff(picked) <= 0.0).all()
    assert picked[0] > picked[-1]


def brute_force(values: Array, order: list[tuple[int, float, float]]) -> set[int]:
    """Return the rows that survive every objective in turn, one after the other, by plain loops."""
    rows = list(range(len(values)))
    for place, (column, absolute, share) in enumerate(order):
        everywhere = [float(row[column]) for row in values]
        least = min(float(values[row, column]) for row in rows)
        room = absolute + share * (max(everywhere) - min(everywhere))
        if place == len(order) - 1:
            room = 0.0
        rows = [row for row in rows if values[row, column] <= least + room + 1e-12]
    return set(rows)


def test_ranked_objectives_agree_with_brute_force() -> None:
    random = np.random.default_rng(11)
    left = set()
    for seed in range(60):
        values = random_front(seed, n=30)
        columns = random.permutation(3)[: 1 + seed % 3].tolist()
        tolerances = [(column, float(random.random() * 10.0**column * 0.1), float(random.random() * 0.4))
                      for column in columns]  # fmt: skip
        expected = brute_force(values, tolerances)
        assert lexicographic(values, tolerances) in expected
        assert len(expected) == 1
        left.add(lexicographic(values, tolerances) == np.argmin(values[:, columns[0]]))
    assert left == {True, False}


def test_no_tolerance_lets_the_first_objective_decide_and_all_of_it_the_last() -> None:
    values = random_front(2)
    assert lexicographic(values, [(1, 0.0, 0.0), (0, 0.0, 0.0)]) == np.argmin(values[:, 1])
    assert lexicographic(values, [(1, 0.0, 1.0), (0, 0.0, 0.0)]) == np.argmin(values[:, 0])


def test_a_front_is_picked_by_the_names_of_its_objectives() -> None:
    front = fronts.front(designs=30)
    torque, angle = 1, 2
    assert front.topsis({"peak_torque": 3.0}) == np.argmin(front.values[:, torque])
    assert front.topsis({"transmission_angle": 1.0, "peak_torque": 2.0}) == topsis(front.values, (0.0, 2.0, 1.0, 0.0))
    assert front.knee() == knee_row(front.values)
    row = front.lexicographic(Priority(quantity="peak_torque", share=0.2), "transmission_angle")
    assert row in brute_force(front.values, [(torque, 0.0, 0.2), (angle, 0.0, 0.0)])
    near = front.lexicographic(Priority(quantity="peak_torque", absolute=1.0), "transmission_angle")
    assert front.values[near, torque] <= front.values[:, torque].min() + 1.0


def test_what_cannot_be_picked_by_is_said() -> None:
    front = fronts.front()
    with pytest.raises(InputError, match=r"one of the objectives time_ratio, peak_torque, .*; got 'stroke'"):
        front.topsis({"stroke": 1.0})
    with pytest.raises(InputError, match="objectives must have a weight, all zero or more"):
        front.topsis({"peak_torque": 0.0})
    with pytest.raises(InputError, match="got 0, -1, 0, 0"):
        front.topsis({"peak_torque": -1.0})
    with pytest.raises(InputError, match="at least one objective, each once"):
        front.lexicographic()
    with pytest.raises(InputError, match="at least one objective, each once"):
        front.lexicographic("peak_torque", "peak_torque")
    with pytest.raises(InputError, match="tolerance of peak_torque must be a number, zero or more; got -1"):
        Priority(quantity="peak_torque", absolute=-1.0)
    empty = fronts.empty_front("infeasible", "nothing")
    with pytest.raises(InputError, match="the front is empty"):
        empty.topsis({"peak_torque": 1.0})
