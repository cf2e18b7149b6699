"""The polish on analytic problems whose Pareto sets are known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.optimise.evaluation import Rows
from slidercrank.optimise.polish import polish

Array = NDArray[np.float64]


class Quadratics:
    """Squared distances to given points of the unit square, each row an owner; optionally one linear constraint."""

    def __init__(self, centres: Array, owner: list[int], constraint: tuple[Array, float] | None = None) -> None:
        self.centres = centres
        self.owner = np.array(owner)
        self.constraint = constraint

    def valid(self, u: Array) -> NDArray[np.bool_]:
        return np.ones(len(u), dtype=bool)

    def exact(self, u: Array) -> tuple[Rows, Rows]:
        apart = u[:, None, :] - self.centres[None]
        labels = np.broadcast_to(np.arange(len(self.centres), dtype=float), apart.shape[:2])
        goals = Rows((apart**2).sum(axis=2), 2.0 * apart, labels.copy(), self.owner)
        n, k = u.shape
        if self.constraint is None:
            return goals, Rows(np.zeros((n, 0)), np.zeros((n, 0, k)), np.zeros((n, 0)), np.zeros(0, np.int64))
        normal, bound = self.constraint
        slopes = np.broadcast_to(normal, (n, 1, k)).copy()
        return goals, Rows((u @ normal - bound)[:, None], slopes, np.zeros((n, 1)), np.zeros(1, np.int64))


STARTS = np.random.default_rng(2).random((40, 2))


def test_designs_reach_the_segment_between_two_centres() -> None:
    # The Pareto set of two squared distances is the segment between their centres.
    found = polish(Quadratics(np.array([[0.2, 0.3], [0.8, 0.7]]), [0, 1]), STARTS, np.ones(2))
    direction = np.array([0.6, 0.4]) / np.hypot(0.6, 0.4)
    off = (found.u - [0.2, 0.3]) @ np.array([-direction[1], direction[0]])
    assert np.abs(off).max() <= 1e-6
    assert found.residual.max() <= 1e-6


def test_a_kink_is_found_as_a_minimax() -> None:
    # The greatest of two squared distances is least half-way, where both tie.
    found = polish(Quadratics(np.array([[0.2, 0.3], [0.8, 0.7]]), [0, 0]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([0.5, 0.5], (40, 1)), abs=1e-6)
    assert found.residual.max() <= 1e-6
    assert all(len(goals[0]) == 2 for goals in found.goals)


def test_a_constraint_holds_and_an_infeasible_start_is_led_back() -> None:
    # Least distance to (0.9, 0.9) with x + y <= 1 is at (0.5, 0.5).
    evaluator = Quadratics(np.array([[0.9, 0.9]]), [0], (np.array([1.0, 1.0]), 1.0))
    found = polish(evaluator, STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([0.5, 0.5], (40, 1)), abs=1e-6)
    assert found.violation.max() <= 1e-9


def test_the_box_holds() -> None:
    found = polish(Quadratics(np.array([[1.5, 0.4]]), [0]), STARTS, np.ones(1))
    assert found.u == pytest.approx(np.tile([1.0, 0.4], (40, 1)), abs=1e-7)
