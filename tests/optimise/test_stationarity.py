"""Residuals and multipliers against quadratic programmes solved otherwise, and by hand."""

from __future__ import annotations

from typing import Any

import cvxpy
import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.optimise.front.stationarity import multipliers_with_positive_weights, optimality_multipliers

Array = NDArray[np.float64]
cp: Any = cvxpy  # its own types know neither `sum` nor `norm`
NOTHING = np.zeros((0, 3))


def instance(seed: int) -> tuple[Array, NDArray[np.int64], Array]:
    """Return gradients of pieces, their owners, and gradients of active constraints."""
    random = np.random.default_rng(seed)
    goals = random.standard_normal((5, 3)) * 10.0 ** random.uniform(-1.0, 1.0, (5, 1))
    goals[:, 0] += 2.0 * (seed % 3)  # so that not every instance is stationary
    return goals, np.array([0, 0, 1, 2, 2]), random.standard_normal((seed % 4, 3))


def least(goals: Array, active: Array, groups: list[list[int]] | None) -> float:
    """Return the least norm by a cone programme. groups: pieces whose weights add to one or more, None: all to one."""
    convex = cp.Variable(len(goals), nonneg=True)
    pushing = cp.Variable(max(len(active), 1), nonneg=True)
    rest = goals.T @ convex + (active.T @ pushing if len(active) else 0.0)
    rules = [cp.sum(convex) == 1.0] if groups is None else [cp.sum(convex[group]) >= 1.0 for group in groups]
    return float(cp.Problem(cp.Minimize(cp.norm(rest)), rules).solve(solver=cp.CLARABEL))


@pytest.mark.parametrize("seed", range(12))
def test_the_residual_is_the_least_norm_of_a_cone_programme(seed: int) -> None:
    """The cone programme is solved to 1e-8 of the gradients' size."""
    goals, _, active = instance(seed)
    residual, convex, pushing = optimality_multipliers(goals, active)
    assert residual == pytest.approx(least(goals, active, None), abs=1e-6)
    assert convex.min() >= 0.0
    assert convex.sum() == pytest.approx(1.0, rel=1e-12)
    assert (pushing >= 0.0).all()
    assert np.linalg.norm(convex @ goals + pushing @ active) == pytest.approx(residual, abs=1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_the_strict_residual_lets_every_objective_carry_weight(seed: int) -> None:
    """The sums of weights are held by stiff rows. So the residual is right to 1e-6 of the gradients' size."""
    goals, owner, active = instance(seed)
    residual, weights, pushing = multipliers_with_positive_weights(goals, owner, active)
    groups = [np.flatnonzero(owner == name).tolist() for name in range(3)]
    size = np.linalg.norm(goals, axis=1).max()
    assert residual == pytest.approx(least(goals, active, groups), abs=1e-4 * size)
    for group in groups:
        assert weights[group].sum() >= 1.0 - 1e-4
    assert np.linalg.norm(weights @ goals + pushing @ active) == pytest.approx(residual, abs=1e-9 * size)


def test_one_free_gradient_is_its_own_residual() -> None:
    assert optimality_multipliers(np.array([[3.0, 4.0, 0.0]]), NOTHING)[0] == pytest.approx(5.0, rel=1e-14)


def test_an_active_constraint_takes_what_points_into_it() -> None:
    """Minimising along (3, 4) against a wall whose outward normal is (-1, 0): what is left is 4."""
    residual, _, pushing = optimality_multipliers(np.array([[3.0, 4.0]]), np.array([[-2.0, 0.0]]))
    assert residual == pytest.approx(4.0, rel=1e-14)
    assert pushing == pytest.approx([1.5], rel=1e-12)


def test_a_constraint_is_not_pulled() -> None:
    residual, _, pushing = optimality_multipliers(np.array([[3.0, 4.0]]), np.array([[2.0, 0.0]]))
    assert residual == pytest.approx(5.0, rel=1e-14)
    assert pushing == pytest.approx([0.0], abs=1e-14)


@pytest.mark.parametrize("size", [1e-12, 1e12])
def test_the_residual_scales_with_the_gradients_and_not_with_the_constraints(size: float) -> None:
    for seed in (1, 2, 4):
        goals, owner, active = instance(seed)
        plain, strict = (
            optimality_multipliers(goals, active)[0],
            multipliers_with_positive_weights(goals, owner, active)[0],
        )
        assert plain > 0.1
        assert optimality_multipliers(size * goals, active)[0] == pytest.approx(size * plain, rel=1e-9)
        assert optimality_multipliers(goals, size * active)[0] == pytest.approx(plain, rel=1e-9)
        assert multipliers_with_positive_weights(size * goals, owner, active)[0] == pytest.approx(
            size * strict, rel=1e-9
        )


def test_a_design_without_freedom_is_stationary() -> None:
    assert optimality_multipliers(np.zeros((2, 0)), np.zeros((0, 0)))[0] == 0.0


def test_vanishing_gradients_are_stationary() -> None:
    assert optimality_multipliers(np.zeros((2, 3)), NOTHING)[0] == 0.0
    assert multipliers_with_positive_weights(np.zeros((2, 3)), np.arange(2), NOTHING)[0] == 0.0
