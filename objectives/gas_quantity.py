"""Quantities that follow from the gas cycle of a machine's cylinders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..model.cycle.gas_cycle import GasCycle, gas_cycle
from ..model.machine.mechanism import Mechanism
from .quantity import Array, Quantity, Values


@dataclass(frozen=True, kw_only=True)
class GasQuantity(Quantity):
    """A number of the `GasCycle`, in closed form. of: gives it."""

    of: Callable[[GasCycle], Any] = field(repr=False)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); NaN without a cylinder that it is of; see `Quantity`."""
        if self.lacks(mechanism, "undefined"):
            none = np.full(np.shape(dimensions), np.nan)
            return Values(none[:, 0], none if gradients else None)
        return Values(*gas_cycle(mechanism, dimensions, self.of, gradients=gradients))
