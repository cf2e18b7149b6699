"""Laws of motion between two rests: the share of the way over the share of the time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .words import Law

Array = NDArray[np.float64]

_TURN = 2.0 * np.pi
_RAMP = 1.0 / 3.0
_TOP = 1.0 / (1.0 - _RAMP)


def way(law: Law, share: Array) -> tuple[Array, Array, Array]:
    """Return s, ds/dt and d2s/dt2 at shares t of the time, from 0 to 1.

    Harmonic: s = (1 - cos(pi t)) / 2. Cycloidal: s = t - sin(2 pi t) / (2 pi). Polynomial: s = 10 t^3 - 15 t^4 + 6 t^5.
    Source: R. L. Norton, Design of Machinery, chapter 8, Cam design (double-dwell functions).
    """
    t = share
    if law == "harmonic":
        return 0.5 - 0.5 * np.cos(np.pi * t), 0.5 * np.pi * np.sin(np.pi * t), 0.5 * np.pi**2 * np.cos(np.pi * t)
    if law == "cycloidal":
        return t - np.sin(_TURN * t) / _TURN, 1.0 - np.cos(_TURN * t), _TURN * np.sin(_TURN * t)
    if law == "polynomial":
        return (
            t**3 * (10.0 - 15.0 * t + 6.0 * t * t),
            30.0 * t**2 * (1.0 - t) ** 2,
            60.0 * t * (1.0 - t) * (1.0 - 2.0 * t),
        )
    if law == "trapezoid":
        first, last = t < _RAMP, t > 1.0 - _RAMP
        steep = _TOP / _RAMP
        s = np.where(first, 0.5 * steep * t**2, _TOP * (t - 0.5 * _RAMP))
        s = np.where(last, 1.0 - 0.5 * steep * (1.0 - t) ** 2, s)
        speed = np.where(first, steep * t, np.where(last, steep * (1.0 - t), _TOP))
        return s, speed, np.where(first, steep, np.where(last, -steep, 0.0))
    return t.copy(), np.ones_like(t), np.zeros_like(t)


def share_of(law: Law, s: float) -> float:
    """Return the share of the time at which the share `s` of the way is made; bisection, as s rises."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if float(way(law, np.array(middle))[0]) < s:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def corners(law: Law) -> tuple[float, ...]:
    """Return the shares of the time at which the acceleration jumps between the ends."""
    return (_RAMP, 1.0 - _RAMP) if law == "trapezoid" else ()
