"""Allowable values that designs go beyond, and by how much."""

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
    """Return by how much (n,) designs go beyond each allowable value, SI, by the name of its quantity.

    values_of: gives the values (n,) of a quantity by its name, SI, NaN for a design without one, None where there are
    none. Zero where a design does not go beyond; quantities of which none does are left out.
    """
    excesses = {}
    for name, quantity in QUANTITIES.items():
        values = np.atleast_1d(np.asarray(values_of(name) if quantity.allowed_by else None, dtype=np.float64))
        if np.isnan(values).all():
            continue
        allowable = quantity.allowable(mechanism)
        excess = values - allowable if quantity.better == "low" else allowable - values
        excess = np.where(excess > _ROUNDING * abs(allowable), excess, 0.0)  # zero too for what has no value
        if excess.any():
            excesses[name] = excess
    return excesses
