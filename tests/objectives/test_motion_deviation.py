"""Motion deviations: pieces, exact gradients, and the recovery of linkages from their motion."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from slidercrank.model.kinematics.target_motion import Freedom
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.objectives.motion_deviation import MotionDeviation, motion_deviations
from slidercrank.objectives.tables.all_quantities import analyse
from tests.model.cases import Array, random_designs
from tests.model.test_target_motion import ANGLES, target
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

DESIGNS = random_designs(150, seed=22)
MACHINES: dict[Branch, Mechanism] = {"open": Mechanism(), "crossed": Mechanism(branch="crossed")}
CASES = [
    pytest.param(quantity, branch, id=f"{quantity.measure}-{phase}-{shift}-{branch}")
    for phase, shift in itertools.product(("fixed", "free"), repeat=2)
    for quantity in motion_deviations(target(phase, shift))  # type: ignore[arg-type]
    for branch in ("open", "crossed")
]


@pytest.mark.parametrize(("quantity", "branch"), CASES)
def test_gradient_is_that_of_extrapolated_differences(quantity: MotionDeviation, branch: Branch) -> None:
    machine = MACHINES[branch]

    def values(designs: Array, _: object) -> Array:
        return quantity.evaluate(machine, designs).values

    first = np.minimum(steps_to_the_nearest_edge(DESIGNS, kink_without_offset=False), 1e-3)
    expected, _ = derivatives(values, DESIGNS, first)
    gradients = quantity.evaluate(machine, DESIGNS, gradients=True).gradients
    assert gradients is not None
    error = np.abs(gradients - expected).max(axis=1) / np.abs(expected).max(axis=1)
    assert error.max() < 1e-7


@pytest.mark.parametrize(("quantity", "branch"), CASES)
def test_quantity_is_the_greatest_of_its_pieces(quantity: MotionDeviation, branch: Branch) -> None:
    machine = MACHINES[branch]
    pieces = quantity.pieces(machine, DESIGNS)
    n, k = pieces.values.shape
    assert pieces.gradients.shape == (n, k, 3)
    assert pieces.labels.shape == (n, k)
    assert np.all(pieces.values[:, 1:] <= pieces.values[:, :-1])
    assert np.all(np.isfinite(pieces.gradients))
    assert np.all(np.isfinite(pieces.labels))
    # The pieces come from another formula than the values, through the crossing of two deviations.
    np.testing.assert_allclose(pieces.values[:, 0], quantity.evaluate(machine, DESIGNS).values, rtol=1e-12)


def test_pieces_below_the_greatest_take_over_as_they_say() -> None:
    """Beyond the nearest kinks the quantity is what the pieces promise together."""
    quantity = motion_deviations(target("free", "free"))[0]
    here = quantity.pieces(Mechanism(), DESIGNS)
    gap = here.values[:, 0] - here.values[:, 1]
    toward = here.gradients[:, 1] - here.gradients[:, 0]
    for row in np.argsort(gap / np.linalg.norm(toward, axis=1))[:6]:
        # As far past the kink as it lies ahead.
        move = 2.0 * gap[row] * toward[row] / (toward[row] @ toward[row])
        there = quantity.evaluate(Mechanism(), DESIGNS[row : row + 1] + move).values[0]
        promised = here.values[row] + here.gradients[row] @ move
        assert promised.max() - promised[0] > 0.9 * gap[row]
        assert there == pytest.approx(promised.max(), abs=0.05 * gap[row])


def test_deviation_that_is_rounding_has_no_slope() -> None:
    crank, rod, offset = DESIGNS[3]
    positions = Linkage(crank, rod, offset).at(ANGLES).slider_position
    found = motion_deviations(target(positions=positions))[1].evaluate(Mechanism(), DESIGNS[3:4], gradients=True)
    assert found.values[0] < 1e-15
    assert np.all(found.gradients == 0.0)


@pytest.mark.parametrize(("phase", "shift"), list(itertools.product(("fixed", "free"), repeat=2)))
def test_table_says_phase_and_shift_where_they_are_free(phase: Freedom, shift: Freedom) -> None:
    table = analyse(Mechanism(), DESIGNS[:4], custom=motion_deviations(target(phase, shift)))
    assert {"motion_deviation_mm", "motion_deviation_rms_mm"} <= set(table.columns)
    assert ("motion_phase_deg" in table) == ("motion_phase_rms_deg" in table) == (phase == "free")
    assert ("motion_shift_mm" in table) == ("motion_shift_rms_mm" in table) == (shift == "free")
    assert "motion_deviation_mm" not in analyse(Mechanism(), DESIGNS[:4])
