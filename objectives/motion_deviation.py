"""Motion deviation: how far the slider's motion is from a wanted one given as points.

These quantities exist for a target motion only; a `Problem` has them among its own quantities.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.kinematics.target_motion import Fit, Measure, TargetMotion, fit
from ..model.kinematics.target_pieces import fit_pieces
from ..model.machine.loads import require_word
from ..model.machine.mechanism import Mechanism
from .quantity import DEGREE, MILLIMETRE, Array, Pieces, Unit, Values

DEVIATIONS: dict[str, tuple[str, Measure]] = {
    "motion_deviation": ("motion deviation, greatest", "greatest"),
    "motion_deviation_rms": ("motion deviation, root mean square", "rms"),
}
"""Title and measure of the quantities, by name."""


@dataclass(frozen=True)
class MotionDeviation:
    """The deviation from a target motion, greatest or root mean square; phase and shift at their best where free."""

    name: str
    field: str
    title: str
    unit: Unit
    target: TargetMotion
    measure: Measure

    def __post_init__(self) -> None:
        require_word("measure", self.measure, Measure)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3) or more columns; see `Quantity`."""
        if not gradients:
            return Values(fit(self.target, _sign(mechanism), self.measure, dimensions[:, :3]).values, None)
        found = self.pieces(mechanism, dimensions)
        return Values(found.values[:, 0], found.gradients[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the greatest of smooth pieces; see `Quantity`."""
        found = fit_pieces(self.target, _sign(mechanism), self.measure, dimensions[:, :3])
        more = dimensions.shape[1] - 3  # what varies beside the dimensions does not move the slider
        return Pieces(found.values, np.pad(found.gradients, ((0, 0), (0, 0), (0, more))), found.labels)

    def settings(self, mechanism: Mechanism, dimensions: Array) -> dict[str, Array]:
        """Return phase (deg) and shift (mm) of the best fit for designs (n, 3), each if it is free, by column."""
        found: Fit = fit(self.target, _sign(mechanism), self.measure, dimensions[:, :3])
        columns = {}
        suffix = "_rms" if self.measure == "rms" else ""
        if self.target.phase == "free":
            columns[f"motion_phase{suffix}_deg"] = DEGREE.factor * found.phase
        if self.target.shift == "free":
            columns[f"motion_shift{suffix}_mm"] = MILLIMETRE.factor * found.shift
        return columns


def motion_deviations(target: TargetMotion) -> tuple[MotionDeviation, ...]:
    """Return the quantities that a target motion makes."""
    return tuple(
        MotionDeviation(name, f"{name}_mm", title, MILLIMETRE, target, measure)
        for name, (title, measure) in DEVIATIONS.items()
    )


def _sign(mechanism: Mechanism) -> float:
    return 1.0 if mechanism.branch == "open" else -1.0
