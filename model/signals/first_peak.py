"""Maxima of a signal over the cycle, and the crank angles reported for them."""

import numpy as np

from ..arrays import Array
from ..machine.cylinders_and_turns import TURN, cycle_turns
from ..machine.mechanism import Mechanism
from .panel_polynomials import index_of_first_maximum, wrap_into_cycle
from .peaks import find_peaks
from .signals import Signal

_MOST = 256  # peaks: more than 24 cylinders have at equal height


def first_peaks(mechanism: Mechanism, kind: Signal, designs: Array) -> tuple[Array, Array]:
    """Return the maxima (n,) of a signal over the cycle, and their first crank angles (n,), rad.

    Designs (n, 3 + k), values and angles are as in `find_peaks`.
    """
    peaks = find_peaks(mechanism, kind, designs, limit=_MOST)
    period = cycle_turns(mechanism) * TURN
    first = index_of_first_maximum(peaks.values, peaks.angles, period)
    angles = np.take_along_axis(peaks.angles, first[:, None], axis=1)[:, 0]
    return peaks.values[:, 0], np.array([wrap_into_cycle(angle, period) for angle in angles.tolist()])
