"""Compiled least squares, neighbours and trade-off rates against scipy's, on random and degenerate problems."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog, nnls

from slidercrank.optimise.front.choose_design import nearest_neighbours
from slidercrank.optimise.front.front import _losses_of_cheapest_gain
from slidercrank.optimise.front.nonnegative_least_squares import nonnegative_least_squares
from tests.optimise.independent import Array


def problems(kind: str, random: np.random.Generator) -> tuple[Array, Array]:
    m, n = int(random.integers(1, 14)), int(random.integers(1, 35))
    matrix, target = random.standard_normal((m, n)), random.standard_normal(m)
    first, second = random.integers(n, size=2)
    if kind == "ties":
        matrix, target = np.round(matrix), np.round(target)
    if kind == "zero column":
        matrix[:, first] = 0.0
    if kind == "opposed":
        matrix[:, first] = -matrix[:, second] * (1.0 + 1e-14 * random.standard_normal())
    if kind == "twice the same":
        matrix[:, first] = matrix[:, second]
    if kind == "sizes":
        matrix *= 10.0 ** random.uniform(-8.0, 8.0, n)
    if kind == "one row asked":
        target[:-1] = 0.0
    return matrix, target


KINDS = ("random", "ties", "zero column", "opposed", "twice the same", "sizes", "one row asked")


@pytest.mark.parametrize("kind", KINDS)
def test_least_squares_are_as_near_as_scipys(kind: str) -> None:
    random = np.random.default_rng(KINDS.index(kind))
    for _ in range(400):
        matrix, target = problems(kind, random)
        found = nonnegative_least_squares(matrix, target)
        assert found is not None
        assert (found >= 0.0).all()
        _, distance = nnls(matrix, target, maxiter=1000)
        assert np.linalg.norm(matrix @ found - target) == pytest.approx(distance, rel=1e-9, abs=1e-9)
        # The gradient is zero where x is positive, and points outwards elsewhere.
        slope = matrix.T @ (target - matrix @ found)
        size = np.linalg.norm(matrix, axis=0) * np.linalg.norm(target) + 1e-300
        assert (slope <= 1e-9 * size).all()
        assert (np.abs(slope) <= 1e-7 * size)[found > 0.0].all()


@pytest.mark.parametrize("nonsense", [np.nan, np.inf])
def test_least_squares_of_nonsense_end(nonsense: float) -> None:
    random = np.random.default_rng(5)
    for _ in range(50):
        matrix, target = problems("random", random)
        matrix[random.integers(len(matrix)), random.integers(matrix.shape[1])] = nonsense
        nonnegative_least_squares(matrix, target)
    assert nonnegative_least_squares(np.eye(2), np.array([-1.0, np.nan])) is not None


def test_neighbours_are_those_of_brute_force() -> None:
    random = np.random.default_rng(6)
    for case in range(300):
        n, m = int(random.integers(1, 60)), int(random.integers(1, 6))
        points = random.random((n, m))
        if case % 3 == 0:
            points = np.round(3.0 * points) / 3.0
        if case % 7 == 0:
            points[:] = points[0]
        count = int(random.integers(1, n + 1))
        distance, rows = nearest_neighbours(points, count)
        apart = np.linalg.norm(points[:, None] - points, axis=2)
        np.testing.assert_allclose(distance, np.sort(apart, axis=1)[:, :count], atol=1e-15)
        np.testing.assert_allclose(np.take_along_axis(apart, rows, axis=1), distance, atol=1e-15)
        assert (rows[:, 0] == np.arange(n)).all()
        assert all(len(set(row)) == count for row in rows.tolist())


def by_linprog(slopes: Array, owner: Array, active: Array, gaining: int, m: int) -> Array | None:
    """Return losses (m,) of the move d of least sum that gains one unit of an objective."""
    k = slopes.shape[1]
    own = owner == gaining
    pays = np.where(own, 0.0, 1.0)[:, None] * (owner[:, None] == np.arange(m))
    rows = np.concatenate([np.hstack([slopes, -pays]), np.hstack([active, np.zeros((len(active), m))])])
    limits = np.concatenate([np.where(own, -1.0, 0.0), np.zeros(len(active))])
    bounds = [(None, None)] * k + [(0.0, None)] * m
    found = linprog(np.concatenate([np.zeros(k), np.ones(m)]), rows, limits, bounds=bounds)
    return None if found.x is None else np.asarray(found.x[k:])


def test_the_cheapest_direction_costs_what_a_linear_programme_says() -> None:
    random, none = np.random.default_rng(7), 0
    for case in range(400):
        m, k = int(random.integers(2, 6)), int(random.integers(1, 6))
        owner = np.concatenate([np.arange(m), random.integers(0, m, int(random.integers(0, 4)))]).astype(np.float64)
        slopes = random.standard_normal((len(owner), k)) * 10.0 ** random.uniform(-1.0, 1.0, (len(owner), 1))
        active = random.standard_normal((int(random.integers(0, 4)), k))
        if case % 3 == 0:  # stationary: no direction gains for nothing
            slopes[-1] = -(random.random(len(owner) - 1) @ slopes[:-1])
        gaining = int(random.integers(m))
        found, expected = (ask(slopes, owner, active, gaining, m) for ask in (_losses_of_cheapest_gain, by_linprog))
        assert (found is None) == (expected is None)
        if found is not None and expected is not None:
            assert found.sum() == pytest.approx(expected.sum(), rel=1e-6, abs=1e-6)
        none += found is None
    assert none > 5
