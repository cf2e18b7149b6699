"""Self-locking margin: by how much the transmission angle stays above the angles of friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.cycle.self_locking import varied_margin
from ..model.machine.mechanism import Mechanism
from .quantity import DEGREE, Array, Pieces, Unit, Values


@dataclass(frozen=True)
class ClosedFormMargin:
    """The least transmission angle minus the angles of friction; -inf where the pins alone lock (no such angle)."""

    name: str = "self_locking_margin"
    field: str = "self_locking_margin_deg"
    title: str = "self-locking margin"
    unit: Unit = DEGREE

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = varied_margin(mechanism, dimensions, gradients=gradients)
        return Values(values, slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as its only piece; see `Quantity`."""
        values, slopes = varied_margin(mechanism, dimensions, gradients=True)
        assert slopes is not None
        return Pieces(values[:, None], slopes[:, None], np.zeros((len(values), 1)))


SELF_LOCKING_MARGIN = ClosedFormMargin()
