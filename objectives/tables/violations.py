"""Excesses of designs over allowable values."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ...model.machine.mechanism import Mechanism
from ..quantity import Array
from ..registry import QUANTITIES

_ROUNDING = 1e-8
"""Share of an allowable value: designs meet a constraint at the same value to this."""


def violations(mechanism: Mechanism, values_of: Callable[[str], ArrayLike | None]) -> dict[str, Array]:
    """Return the excess (n,) of designs over each allowable value, SI, by the name of its quantity.

    values_of: returns the values (n,) of a quantity by its name, SI; NaN for a design without one, None without any.
    Zero for a design within the allowable value; quantities that no design exceeds are left out.
    """
    excesses = {}
    for name, quantity in QUANTITIES.items():
        values = np.atleast_1d(np.asarray(values_of(name) if quantity.allowed_by else None, dtype=np.float64))
        if np.isnan(values).all():
            continue
        allowable = quantity.allowable(mechanism)
        excess = values - allowable if quantity.better == "low" else allowable - values
        excess = np.where(excess > _ROUNDING * abs(allowable), excess, 0.0)  # zero also without a value
        if excess.any():
            excesses[name] = excess
    return excesses
