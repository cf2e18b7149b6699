"""Greatest values of a signal over the cycle, and the crank angles that name them."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..machine.mechanism import Mechanism
from ..machine.two_turns import TURN, cycle_turns
from .first_of_equal import first_of_equal, named_angle
from .peaks import find_peaks
from .signals import Signal

_MOST = 256  # peaks: more than 24 cylinders have of one height


def first_peaks(mechanism: Mechanism, kind: Signal, designs: Array) -> tuple[Array, Array]:
    """Return the greatest values (n,) of a signal over the cycle, and the crank angles (n,), rad, that name them.

    Designs (n, 3 + k), values and angles are those of `find_peaks`.
    """
    found = find_peaks(mechanism, kind, designs, kept=_MOST)
    period = cycle_turns(mechanism) * TURN
    first = first_of_equal(found.values, found.angles, period)
    angles = np.take_along_axis(found.angles, first[:, None], axis=1)[:, 0]
    return found.values[:, 0], np.array([named_angle(angle, period) for angle in angles.tolist()])
