"""Pieces of formulas where some of them tie: slopes in every direction, as a small step has them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from slidercrank.objectives.quantity import Quantity

from ..random_formulas import MACHINE, designs, formulas

STEP = 1e-7
CONVEX = (
    "max(peak_torque, 100 N * stroke)",
    "max(crank * 20 N, offset * 20 N) + peak_torque",
    "abs(offset - crank) * time_ratio",
    "max(2 * crank, rod / 3) * max(rod_to_crank, 5)",
    "-min(crank, offset) / stroke",
    "(max(crank, abs(offset)) / stroke)**2",
    "asin(max(crank, abs(offset)) / rod)",
)
MIXED = (
    "max(crank, offset) - max(crank, offset / 1.5)",
    "max(crank, offset) / max(stroke, 80 mm)",
    "min(crank, offset) * max(rod_to_crank, 5)",
    "(crank + -rod) * max(crank, offset)",
)


def tied(of: Quantity, seed: int, *, above: bool = True) -> Any:
    """Return designs (n, 4) between random ones, where the active piece changes from one to another."""
    ends = designs(400, seed)
    one, other = ends[:200], ends[200:]

    def active(x: np.ndarray) -> Any:
        found = of.pieces(MACHINE, x)
        found = found if above or found.opposite is None else found.opposite
        return np.floor(found.labels[:, 0] / 50.0)  # the argument; the angle of a peak moves by itself

    low, high = np.zeros(200), np.ones(200)
    first, last = active(one), active(other)
    for _ in range(60):
        middle = 0.5 * (low + high)
        same = active(one + middle[:, None] * (other - one)) == first
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    x = one + low[:, None] * (other - one)
    return x[first != last][:20]


@pytest.mark.parametrize("text", CONVEX)
def test_at_a_tie_the_slope_in_every_direction_is_the_greatest_of_the_pieces(text: str) -> None:
    of = formulas().quantity_of_text(text, "here")
    x = tied(of, 5)
    assert len(x) > 3
    found = of.pieces(MACHINE, x)
    assert found.opposite is None
    ties = found.values >= found.values[:, :1] - 1e-9 * np.abs(found.gradients[:, :1] * x[:, None]).max(axis=2)
    assert (ties.sum(axis=1) > 1).any()
    random = np.random.default_rng(6)
    for _ in range(10):
        way = random.normal(size=x.shape) * x * STEP
        slope = np.where(ties, np.einsum("npd,nd->np", found.gradients, way), -np.inf).max(axis=1)
        change = of.evaluate(MACHINE, x + way).values - of.evaluate(MACHINE, x).values
        size = np.abs(found.gradients[:, 0] * x).max(axis=1) * STEP
        assert np.abs(change - slope).max() < 2e-3 * size.max()


@pytest.mark.parametrize("text", MIXED)
def test_a_formula_with_kinks_of_both_kinds_is_known_from_both_sides(text: str) -> None:
    of = formulas().quantity_of_text(text, "here")
    x = designs(100, 7)
    found = of.pieces(MACHINE, x)
    values = of.evaluate(MACHINE, x).values
    assert found.opposite is not None
    np.testing.assert_allclose(found.values.max(axis=1), values, rtol=1e-14)
    np.testing.assert_allclose(found.opposite.values.min(axis=1), values, rtol=1e-14)
    # A step changes the value by no more than the greatest piece says, by no less than the least of the other side.
    way = np.random.default_rng(8).normal(size=x.shape) * x * 1e-3
    after = of.evaluate(MACHINE, x + way).values
    room = 2e-5 * np.abs(values)
    most = (found.values + np.einsum("npd,nd->np", found.gradients, way)).max(axis=1)
    least = (found.opposite.values + np.einsum("npd,nd->np", found.opposite.gradients, way)).min(axis=1)
    assert (after <= most + room).all()
    assert (after >= least - room).all()
