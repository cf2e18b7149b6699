"""Textbook approximations of one design against the exact model: two-mass rod, series, k F tan(alpha)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.classical.comparison import Errors
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

_OFFSETS = 5


def over_offset(mechanism: Mechanism, linkage: Linkage, *, count: int = _OFFSETS) -> Errors:
    """Return the errors at offsets from zero to the design's own, or to (rod - crank) / 2 if greater."""
    import numpy as np

    from ....model.classical.comparison import errors_over_offset

    own = float(linkage.offset)
    far = max(abs(own), 0.5 * (float(linkage.rod) - float(linkage.crank)))
    return errors_over_offset(mechanism, linkage, math.copysign(1.0, own) * np.linspace(0.0, far, count))


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return for each approximation its peak, its error at this design, and its error over offset.

    Errors: the greatest difference over the cycle as a share of the exact peak, in per cent; None where all is zero.
    Of inertia alone, at constant speed. Raises `InputError` without a crank speed.
    """
    import numpy as np

    from ....model.classical.comparison import compare, relative_error
    from ....model.classical.lumped import rotating_and_reciprocating

    found = compare(mechanism, linkage, np.linspace(0.0, 2.0 * math.pi, 1440, endpoint=False))
    rotating, reciprocating = rotating_and_reciprocating(mechanism, linkage)
    offsets = over_offset(mechanism, linkage)

    def entry(name: str, curve: Any, exact: Any, errors: Any, unit: str) -> dict[str, Any]:
        return {
            "name": name,
            f"peak_{unit}": float(np.abs(curve).max()),
            "error_percent": _percent(relative_error(curve, exact)),
            "error_over_offset_percent": [_percent(value) for value in errors.tolist()],
        }

    return {
        "rotating_mass_kg": rotating,
        "reciprocating_mass_kg": reciprocating,
        "exact_peak_acceleration_m_s2": float(np.abs(found.acceleration).max()),
        "exact_peak_torque_Nm": float(np.abs(found.torque).max()),
        "offset_mm": (1e3 * offsets.offset).tolist(),
        "accelerations": [
            entry(name, curve, found.acceleration, offsets.accelerations[name], "acceleration_m_s2")
            for name, curve in found.accelerations.items()
        ],
        "torques": [
            entry(name, curve, found.torque, offsets.torques[name], "torque_Nm")
            for name, curve in found.torques.items()
        ],
    }


def _percent(share: float) -> float | None:
    return 100.0 * share if math.isfinite(share) else None
