"""Hypervolume and choice against brute force."""

from __future__ import annotations

import moocore
import numpy as np
import pytest

from slidercrank.optimise.front.dominance import nondominated
from slidercrank.optimise.front.hypervolume import (
    REFERENCE,
    GainBounds,
    choose_designs_by_hypervolume,
    hypervolume,
    ideal_and_range,
)

UNIT = (np.zeros(3), np.ones(3))


def test_hypervolume_of_one_design_is_its_box() -> None:
    value = hypervolume(np.array([[0.2, 0.5, 0.1]]), *UNIT)
    assert value == pytest.approx(0.9 * 0.6 * 1.0 / REFERENCE**3, rel=1e-12)


def test_hypervolume_agrees_with_counting_random_points() -> None:
    random = np.random.default_rng(3)
    designs = random.random((30, 3))
    points = random.uniform(0.0, REFERENCE, (200_000, 3))
    covered = np.zeros(len(points), dtype=bool)
    for design in designs:
        covered |= (points >= design).all(axis=1)
    # Three standard deviations of a share counted among 200,000 points.
    assert hypervolume(designs, *UNIT) == pytest.approx(covered.mean(), abs=3.0 * 0.5 / np.sqrt(200_000))


def test_choice_is_the_greedy_one_and_keeps_what_must_stay() -> None:
    values = np.random.default_rng(5).random((25, 3))
    values = values[nondominated(values)]
    ideal, span = ideal_and_range(values)
    picked = [0]
    while len(picked) < 6:
        gains = [
            hypervolume(values[[*picked, i]], ideal, span) if i not in picked else -1.0 for i in range(len(values))
        ]
        picked.append(int(np.argmax(gains)))
    assert choose_designs_by_hypervolume(values, 6, always=(0,)).tolist() == sorted(picked)


@pytest.mark.parametrize("objectives", [2, 3, 4, 6])
def test_no_design_gains_more_than_its_bound(objectives: int) -> None:
    random = np.random.default_rng([7, objectives])
    values = random.random((60, objectives))
    values = values[nondominated(values)]
    ideal, span = ideal_and_range(values)
    scaled, bounds = (values - ideal) / span, GainBounds((values - ideal) / span)
    chosen: list[int] = []
    for index in random.permutation(len(values))[:12].tolist():
        chosen.append(index)
        found = bounds.add_selected_design(index)
        before = moocore.hypervolume(scaled[chosen], ref=REFERENCE)
        gains = [moocore.hypervolume(scaled[[*chosen, row]], ref=REFERENCE) - before for row in range(len(values))]
        assert (found >= gains).all()
        if len(chosen) <= 2:  # of two boxes inclusion and exclusion is the whole truth
            np.testing.assert_allclose(found, gains, atol=1e-11)
