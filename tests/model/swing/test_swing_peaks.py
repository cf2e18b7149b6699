"""Peaks over a swing: what a design has does not depend on the designs beside it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.peaks import SwingPeaks, peaks_of_negated_least_drive, swing_peaks
from slidercrank.model.swing.swing import Swing
from slidercrank.model.swing.swing_states import DRIVE, ERROR, POWER
from tests.case_count import case_count
from tests.model.cases import Array
from tests.model.swing.swings import random_swings

Search = Callable[[Mechanism, Swing, Array], SwingPeaks]
SEARCHES: dict[str, Search] = {
    "drive": lambda machine, swing, designs: swing_peaks(machine, swing, DRIVE, designs, gradients=True),
    "power": lambda machine, swing, designs: swing_peaks(machine, swing, POWER, designs, limit=1),
    "error": lambda machine, swing, designs: swing_peaks(machine, swing, ERROR, designs, gradients=True),
    "least": lambda machine, swing, designs: peaks_of_negated_least_drive(
        machine, swing, designs, back=True, gradients=True
    ),
}


@pytest.mark.parametrize("name", SEARCHES)
@pytest.mark.parametrize("friction", [False, True])
def test_a_design_alone_has_the_same_bits_as_among_others(name: str, friction: bool) -> None:
    """Searches cut batches by the time that they take: else a front would depend on the load of the machine."""
    random, search = np.random.default_rng(8), SEARCHES[name]
    for machine, linkage, swing in random_swings(case_count(9, 25), seed=9, friction=friction):
        middle = np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)])
        designs = middle * random.uniform(0.98, 1.02, (6, 3))
        together = search(machine, swing, designs)
        for row, design in enumerate(designs):
            alone = search(machine, swing, design[None])
            assert np.array_equal(alone.values[0], together.values[row], equal_nan=True)
            assert np.array_equal(alone.places[0], together.places[row], equal_nan=True)
            if together.gradients is not None and alone.gradients is not None:
                assert np.array_equal(alone.gradients[0], together.gradients[row], equal_nan=True)
