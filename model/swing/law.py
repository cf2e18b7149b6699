"""Laws of motion between two positions at rest: fraction of the travel over fraction of the time."""

from typing import Any, get_args

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..kernel.arithmetic import analytic
from .swing_types import Law

_TURN = 2.0 * np.pi
_RAMP = 1.0 / 3.0
_TOP = 1.0 / (1.0 - _RAMP)
_STEEP = _TOP / _RAMP
_ROUNDING = 1e-9
_LAWS: tuple[Law, ...] = get_args(Law)
_TRAPEZOID, _HARMONIC, _CYCLOIDAL, _POLYNOMIAL, _TABLE = (_LAWS.index(law) for law in _LAWS[2:])


def law_code(law: Law) -> int:
    """Return the code of a law in kernels."""
    return _LAWS.index(law)


@analytic
def travel_and_derivatives_at(code: int, table: Any, t: Any, probe: Any) -> tuple[Any, Any, Any, Any]:
    """Return s, ds/dt, d2s/dt2 and d3s/dt3 for a law at fractions t of the time, from 0 to 1.

    table: pieces from `law_spline_pieces`, for a tabulated law. probe: a fraction on the same side of a corner as t.

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
        first, last = 1.0 * (probe < _RAMP), 1.0 * (probe > 1.0 - _RAMP)
        even = 1.0 - first - last
        return (
            first * (0.5 * _STEEP * t * t)
            + last * (1.0 - 0.5 * _STEEP * rest * rest)
            + even * _TOP * (t - 0.5 * _RAMP),
            first * _STEEP * t + last * _STEEP * rest + even * _TOP,
            first * _STEEP - last * _STEEP,
            0.0 * t,
        )
    if code == _TABLE:
        s, s_1, s_2, s_3 = 0.0 * t, 0.0 * t, 0.0 * t, 0.0 * t
        for i in range(table.shape[0]):
            in_piece = 1.0 * (probe >= table[i, 0]) * (1.0 * (probe < table[i, 1]))
            u, b, c, d = t - table[i, 2], table[i, 4], table[i, 5], table[i, 6]
            s = s + in_piece * (table[i, 3] + u * (b + u * (c + u * d)))
            s_1, s_2 = s_1 + in_piece * (b + u * (2.0 * c + 3.0 * u * d)), s_2 + in_piece * (2.0 * c + 6.0 * u * d)
            s_3 = s_3 + in_piece * (6.0 * d)
        return s, s_1, s_2, s_3
    return 1.0 * t, 1.0 + 0.0 * t, 0.0 * t, 0.0 * t


NO_TABLE = np.zeros((0, 7))


def law_spline_pieces(points: tuple[tuple[float, float], ...]) -> Array:
    """Return the cubic pieces (k, 7) through points (fractions of time and travel), at rest at both ends.

    Speed and acceleration are continuous. Each piece has the fractions from and up to which it counts, its origin, and
    its four coefficients. Raises `InputError` for points that are out of order, or if the motion reverses between them.
    Source: C. de Boor, A Practical Guide to Splines, chapter IV, complete cubic spline.
    """
    table = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    t, s = table.T
    _require_points(t, s)
    h, rise = np.diff(t), np.diff(s) / np.diff(t)
    # Slopes m at the knots, m = 0 at the ends: h_i m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_{i-1} m_{i+1} = 3 (...).
    inner = len(t) - 2
    matrix, right = np.zeros((inner, inner + 2)), np.zeros(inner)
    for i in range(inner):
        matrix[i, i : i + 3] = h[i + 1], 2.0 * (h[i] + h[i + 1]), h[i]
        right[i] = 3.0 * (h[i + 1] * rise[i] + h[i] * rise[i + 1])
    m = np.concatenate([[0.0], np.linalg.solve(matrix[:, 1:-1], right), [0.0]])
    lower, upper = np.concatenate([[-np.inf], t[1:-1]]), np.concatenate([t[1:-1], [np.inf]])
    second, third = (3.0 * rise - 2.0 * m[:-1] - m[1:]) / h, (m[:-1] + m[1:] - 2.0 * rise) / h**2
    pieces = np.stack([lower, upper, t[:-1], s[:-1], m[:-1], second, third], axis=1)
    for i in range(len(h)):
        u = np.linspace(0.0, h[i], 101)
        slow = m[i] + u * (2.0 * second[i] + 3.0 * u * third[i])
        if slow.min() < -_ROUNDING:
            raise InputError(
                "the curve through a table of a swing's motion must not reverse; it does near the fraction "
                f"{t[i] + u[int(np.argmin(slow))]:.4g} of the time; add points there, or make it smoother"
            )
    return pieces


def reversed_law_pieces(points: tuple[tuple[float, float], ...]) -> Array:
    """Return the pieces of the reversed motion, from its end to its start."""
    return law_spline_pieces(tuple((1.0 - t, 1.0 - s) for t, s in reversed(points))) if points else NO_TABLE


def _require_points(t: Array, s: Array) -> None:
    wrong = len(t) < 3 or not np.isfinite([t, s]).all() or (t[0], s[0], t[-1], s[-1]) != (0.0, 0.0, 1.0, 1.0)
    if wrong or (np.diff(t) <= 0.0).any() or (np.diff(s) < 0.0).any():
        listed = ", ".join(f"({a:.6g}, {b:.6g})" for a, b in zip(t[:6].tolist(), s[:6].tolist(), strict=True))
        raise InputError(
            "a table of a swing's motion must have at least three points, fractions of time and travel from 0 to "
            "1, with increasing times and non-decreasing travel; got "
            f"{listed or 'none'}{' ...' if len(t) > 6 else ''}; begin with 0, 0 and end with 1, 1"
        )


def travel_speed_acceleration(law: Law, share: Array, table: Array = NO_TABLE) -> tuple[Array, Array, Array]:
    """Return s, ds/dt and d2s/dt2 at fractions of the time, from 0 to 1; see `travel_and_derivatives_at`."""
    return travel_and_derivatives_at(law_code(law), table, share, share)[:3]


def time_fractions_at_travel(law: Law, s: Array, table: Array = NO_TABLE) -> Array:
    """Return the fractions of the time at which fractions of the travel are reached; by bisection, as s rises."""
    if law in ("slow", "constant"):
        return np.asarray(s, dtype=np.float64)
    low, high = np.zeros(np.shape(s)), np.ones(np.shape(s))
    for _ in range(60):
        middle = 0.5 * (low + high)
        is_below = travel_speed_acceleration(law, middle, table)[0] < s
        low, high = np.where(is_below, middle, low), np.where(is_below, high, middle)
    return np.asarray(0.5 * (low + high))


def corner_times(law: Law, table: Array = NO_TABLE) -> tuple[float, ...]:
    """Return the fractions of the time between the ends at which the acceleration has a jump or a kink."""
    if len(table):
        return tuple(table[1:, 2].tolist())
    return (_RAMP, 1.0 - _RAMP) if law == "trapezoid" else ()
