"""Offsets that are only rounding errors: such a linkage is in-line."""

from __future__ import annotations

from typing import Any

import numpy as np

_ROUNDING = 1e-15
"""Fraction of the rod. An offset this small changes closed-form values and positions only within rounding."""


def is_in_line(rod: Any, offset: Any) -> Any:
    """Return whether linkages have no offset beyond rounding, |e| <= 1e-15 l; arguments in m, broadcast."""
    return np.abs(offset) <= _ROUNDING * np.asarray(rod)


def offset_without_rounding(rod: Any, offset: Any) -> Any:
    """Return offsets, m, with those below rounding set to zero; arguments broadcast."""
    return np.where(is_in_line(rod, offset), 0.0, offset)
