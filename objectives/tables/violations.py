"""Violations of allowable values by designs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ...model.machine.mechanism import Mechanism
from ..quantity import Array
from ..registry import QUANTITIES

_ROUNDING = 1e-8
"""Relative tolerance: a design within this fraction of an allowable value meets it."""


def violations(mechanism: Mechanism, values_of: Callable[[str], ArrayLike | None]) -> dict[str, Array]:
    """Return the violation (n,) of each allowable value by designs, SI, by the name of the quantity.

    values_of: returns the values (n,) of a quantity by name, SI; NaN for a design without a value, None if no design
    has one. Zero for a design within the allowable value; quantities that no design violates are left out.
    """
    excesses = {}
    for name, quantity in QUANTITIES.items():
        values = np.atleast_1d(np.asarray(values_of(name) if quantity.allowed_by else None, dtype=np.float64))
        if np.isnan(values).all():
            continue
        allowable = quantity.allowable_value(mechanism)
        excess = values - allowable if quantity.better == "low" else allowable - values
        excess = np.where(excess > _ROUNDING * abs(allowable), excess, 0.0)  # zero also without a value
        if excess.any():
            excesses[name] = excess
    return excesses
