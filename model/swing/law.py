"""Laws of motion between two rests: the share of the way over the share of the time."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from ..arrays import Array
from ..kernel.arithmetic import analytic
from .words import Law

_TURN = 2.0 * np.pi
_RAMP = 1.0 / 3.0
_TOP = 1.0 / (1.0 - _RAMP)
_STEEP = _TOP / _RAMP
_LAWS: tuple[Law, ...] = get_args(Law)
_TRAPEZOID, _HARMONIC, _CYCLOIDAL, _POLYNOMIAL = (_LAWS.index(law) for law in _LAWS[2:])


def code_of(law: Law) -> int:
    """Return the number of a law in kernels."""
    return _LAWS.index(law)


@analytic
def way_at(code: int, t: Any, inside: Any) -> tuple[Any, Any, Any, Any]:
    """Return s, ds/dt, d2s/dt2 and d3s/dt3 of a law at shares t of the time, from 0 to 1.

    inside: a share that tells on which side of a corner t lies.

    Harmonic: s = (1 - cos(pi t)) / 2. Cycloidal: s = t - sin(2 pi t) / (2 pi). Polynomial: s = 10 t^3 - 15 t^4 + 6 t^5.
    Source: R. L. Norton, Design of Machinery, chapter 8, Cam design (double-dwell functions).
    """
    rest = 1.0 - t
    if code == _HARMONIC:
        sine, cosine = np.sin(np.pi * t), np.cos(np.pi * t)
        return 0.5 - 0.5 * cosine, 0.5 * np.pi * sine, 0.5 * np.pi**2 * cosine, -0.5 * np.pi**3 * sine
    if code == _CYCLOIDAL:
        sine, cosine = np.sin(_TURN * t), np.cos(_TURN * t)
        return t - sine / _TURN, 1.0 - cosine, _TURN * sine, _TURN**2 * cosine
    if code == _POLYNOMIAL:
        return (
            t * t * t * (10.0 - 15.0 * t + 6.0 * t * t),
            30.0 * (t * rest) * (t * rest),
            60.0 * t * rest * (1.0 - 2.0 * t),
            60.0 - 360.0 * t * rest,
        )
    if code == _TRAPEZOID:
        first, last = 1.0 * (inside < _RAMP), 1.0 * (inside > 1.0 - _RAMP)
        even = 1.0 - first - last
        return (
            first * (0.5 * _STEEP * t * t)
            + last * (1.0 - 0.5 * _STEEP * rest * rest)
            + even * _TOP * (t - 0.5 * _RAMP),
            first * _STEEP * t + last * _STEEP * rest + even * _TOP,
            first * _STEEP - last * _STEEP,
            0.0 * t,
        )
    return 1.0 * t, 1.0 + 0.0 * t, 0.0 * t, 0.0 * t


def way(law: Law, share: Array) -> tuple[Array, Array, Array]:
    """Return s, ds/dt and d2s/dt2 at shares of the time, from 0 to 1; see `way_at`."""
    return way_at(code_of(law), share, share)[:3]


def share_of(law: Law, s: float) -> float:
    """Return the share of the time at which the share `s` of the way is made."""
    return float(shares_of(law, np.array([s]))[0])


def shares_of(law: Law, s: Array) -> Array:
    """Return the shares of the time at which shares of the way are made; bisection, as s rises."""
    if law in ("slow", "constant"):
        return np.asarray(s, dtype=np.float64)
    low, high = np.zeros(np.shape(s)), np.ones(np.shape(s))
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = way(law, middle)[0] < s
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray(0.5 * (low + high))


def corners(law: Law) -> tuple[float, ...]:
    """Return the shares of the time at which the acceleration jumps between the ends."""
    return (_RAMP, 1.0 - _RAMP) if law == "trapezoid" else ()
