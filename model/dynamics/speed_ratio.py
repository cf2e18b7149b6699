"""Crank speed over its angle, for kernels: a fraction of the mean, with its derivatives."""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernel.arithmetic import analytic
from ..kernel.kernel import Row, Table
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_machine
from ..machine.speed_profile import Harmonics

_TURN = 2.0 * math.pi


class SpeedRatio(NamedTuple):
    """A profile p(theta) of the crank speed, with mean 1: harmonics, or the pieces of a periodic cubic spline.

    cosines, sines: (h,). knots: (k + 1,), increasing, spanning a turn, rad; none for harmonics. pieces: (4, k), by
    descending power of the distance from the preceding knot.
    """

    cosines: Row
    sines: Row
    knots: Row
    pieces: Table


@memoise_by_machine
def speed_ratio_of(mechanism: Mechanism) -> SpeedRatio:
    """Return the profile of a machine; if it has none, 1 throughout."""
    profile, empty = mechanism.speed_profile, np.zeros(0)
    if profile is None:
        return SpeedRatio(empty, empty, empty, np.zeros((4, 0)))
    if isinstance(profile, Harmonics):
        pairs = np.array(profile.coefficient_pairs).reshape(-1, 2)
        return SpeedRatio(np.ascontiguousarray(pairs[:, 0]), np.ascontiguousarray(pairs[:, 1]), empty, np.zeros((4, 0)))
    return SpeedRatio(empty, empty, *profile.spline_pieces)


@analytic
def speed_ratio_at(theta: Any, pace: SpeedRatio) -> Any:
    """Return p and its first three derivatives at a shaft crank angle, rad."""
    p, first, second, third = 1.0, 0.0, 0.0, 0.0
    for i in range(pace.cosines.shape[0]):
        k = i + 1.0
        a, b = pace.cosines[i], pace.sines[i]
        c, s = math.cos(k * theta), math.sin(k * theta)
        even, odd = a * c + b * s, b * c - a * s
        p, first, second, third = p + even, first + k * odd, second - k * k * even, third - k * k * k * odd
    count = pace.pieces.shape[1]
    if count > 0:
        at = theta - _TURN * math.floor((theta - pace.knots[0]) / _TURN)
        low, high = 0, count
        while high - low > 1:
            middle = (low + high) // 2
            if pace.knots[middle] <= at:
                low = middle
            else:
                high = middle
        x = at - pace.knots[low]
        a, b, c, s = pace.pieces[0, low], pace.pieces[1, low], pace.pieces[2, low], pace.pieces[3, low]
        p, first = ((a * x + b) * x + c) * x + s, (3.0 * a * x + 2.0 * b) * x + c
        second, third = 6.0 * a * x + 2.0 * b, 6.0 * a
    return p, first, second, third
