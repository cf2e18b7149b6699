"""Hypervolume, non-dominance, choice and stationarity against brute force and other formulations."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import Bounds, LinearConstraint, minimize

from slidercrank.optimise.hypervolume import REFERENCE, choose, hypervolume, nondominated, scaling
from slidercrank.optimise.stationarity import multipliers, strict_multipliers

Array = NDArray[np.float64]
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


def test_nondominated_agrees_with_comparing_all_pairs() -> None:
    values = np.random.default_rng(4).integers(0, 6, (120, 3)).astype(float)
    keep = []
    for i, row in enumerate(values):
        better = (values <= row).all(axis=1) & (values < row).any(axis=1)
        same_before = (values[:i] == row).all(axis=1).any()
        if not better.any() and not same_before:
            keep.append(i)
    assert nondominated(values).tolist() == keep


def test_choice_is_the_greedy_one_and_keeps_what_must_stay() -> None:
    values = np.random.default_rng(5).random((25, 3))
    values = values[nondominated(values)]
    ideal, span = scaling(values)
    picked = [0]
    while len(picked) < 6:
        gains = [
            hypervolume(values[[*picked, i]], ideal, span) if i not in picked else -1.0 for i in range(len(values))
        ]
        picked.append(int(np.argmax(gains)))
    assert choose(values, 6, always=(0,)).tolist() == sorted(picked)


@pytest.mark.parametrize("seed", range(10))
def test_residual_is_the_least_norm_that_slsqp_finds(seed: int) -> None:
    random = np.random.default_rng(seed)
    goals, active = random.standard_normal((4, 3)), random.standard_normal((2, 3))
    goals += np.array([1.5, 0.0, 0.0])  # mostly away from zero, so that the residual is not trivial
    residual, convex, pushing = multipliers(goals, active)
    assert np.all(convex >= 0.0)
    assert convex.sum() == pytest.approx(1.0)
    assert np.all(pushing >= 0.0)
    assert np.linalg.norm(convex @ goals + pushing @ active) == pytest.approx(residual, abs=1e-12)
    rows = np.concatenate([goals, active])

    def size(weights: Array) -> float:
        return float(np.sum((weights @ rows) ** 2))

    start = np.array([0.25, 0.25, 0.25, 0.25, 0.0, 0.0])
    whole = LinearConstraint(np.array([[1.0, 1.0, 1.0, 1.0, 0.0, 0.0]]), 1.0, 1.0)
    bounds = Bounds(np.zeros(6), np.full(6, np.inf))
    found = minimize(size, start, bounds=bounds, constraints=whole, method="SLSQP", options={"ftol": 1e-15})
    # SLSQP resolves the squared norm to about 1e-10.
    assert residual == pytest.approx(np.sqrt(found.fun), abs=1e-5)


def test_opposing_objectives_alone_do_not_make_a_design_strictly_stationary() -> None:
    # The first two oppose each other; the third could still be had for nothing.
    goals = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]])
    assert multipliers(goals, np.zeros((0, 2)))[0] == pytest.approx(0.0, abs=1e-12)
    assert strict_multipliers(goals, np.arange(3), np.zeros((0, 2)))[0] == pytest.approx(1.0, rel=1e-5)
    held = np.array([[0.0, -1.0]])  # ... unless a constraint holds it
    assert strict_multipliers(goals, np.arange(3), held)[0] == pytest.approx(0.0, abs=1e-9)
