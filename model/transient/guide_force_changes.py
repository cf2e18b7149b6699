"""Crank angles at which a guide force changes sides during a motion.

They depend on the motion. Two changes within one spacing of the points, where the force is almost zero, are ignored.
"""

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from .crank_equation import Span

Motion = Callable[[float], tuple[float, float]]
"""Speed, rad/s, and acceleration, rad/s^2, at a crank angle, rad."""
_CLOSE = 1e-12
"""rad; accuracy of the angles."""


def crank_angles_of_guide_side_changes(
    span: Span, motion: Motion, angles: Array, speeds: Array, accelerations: Array
) -> list[float]:
    """Return the crank angles within a span, rad, in the order of its points.

    angles: (n,), rad. speeds, accelerations: motion at these angles.
    """
    from scipy.optimize import brentq

    def guide_force(angle: float, cylinder: int) -> float:
        state = span.friction_state(*(np.array([number]) for number in (angle, *motion(angle))))
        return float(state.guides[cylinder, 0])

    values = span.friction_state(angles, speeds, accelerations).guides
    changes = np.nonzero(values[:, :-1] * values[:, 1:] < 0.0)
    return [
        float(brentq(guide_force, angles[i], angles[i + 1], args=(c,), xtol=_CLOSE))
        for c, i in zip(*changes, strict=True)
    ]
