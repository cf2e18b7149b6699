"""Average torques: root mean square (what heats a motor) and mean (what the work costs) over the cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..model.averages import average_torque
from ..model.mechanism import Mechanism
from .quantity import NEWTON_METRE, Array, Pieces, Unit, Values


@dataclass(frozen=True)
class AverageTorque:
    """Mean or root-mean-square drive torque over the cycle."""

    name: str
    field: str
    title: str
    which: Literal["mean", "rms"]
    unit: Unit = NEWTON_METRE

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3); see `Quantity`."""
        averages = average_torque(mechanism, dimensions, gradients=gradients)
        if self.which == "mean":
            return Values(averages.mean, averages.mean_gradients)
        return Values(averages.rms, averages.rms_gradients)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as its only piece; see `Quantity`."""
        found = self.evaluate(mechanism, dimensions, gradients=True)
        assert found.gradients is not None
        return Pieces(found.values[:, None], found.gradients[:, None], np.zeros((len(dimensions), 1)))


RMS_TORQUE = AverageTorque("rms_torque", "rms_torque_Nm", "RMS torque", "rms")
MEAN_TORQUE = AverageTorque("mean_torque", "mean_torque_Nm", "mean torque", "mean")
