"""Closure of many linkages over a swing, and the transmission angle at the driven side, with derivatives.

If the crank drives, the linkage ceases to close when |e - r sin(theta)| reaches l. The transmission angle is that
between the rod and the normal of the slider line, cos(mu) = |e - r sin(theta)| / l. Its minimum is at an end of the
swing or where the crank is normal to the slider line. If the slider drives, it is the angle between rod and crank,
sin(mu) = sin(theta
- phi), with the sign that it has in the middle of the swing: negative beyond a dead point. Its minimum is at an end, or
  where the rod turns as fast as the crank, x = 0.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, Mask
from ..kernel.arithmetic import STEP
from ..kinematics.position import motion
from ..machine.mechanism import Mechanism
from .end_angles import Ends, swing_ends
from .forces import pin_distance_from_crank_line
from .swing import Swing

_FLAT = 1e-12
_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class DrivenAngles:
    """Angles at the locations of a possible minimum, rad.

    values: (n, m), inf where absent. slopes: (n, m, 3 + k), by the numbers of the designs.
    """

    values: Array
    slopes: Array


def closes_over_swing(mechanism: Mechanism, swing: Swing, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) close over the whole swing."""
    return _closes_over_ends(designs, swing_ends(mechanism, swing, designs))


def swings_without_dead_point(mechanism: Mechanism, swing: Swing, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) close and, if the slider drives, pass no dead point."""
    ends = swing_ends(mechanism, swing, designs)
    passing = _closes_over_ends(designs, ends)
    if swing.driver == "slider" and passing.any():
        sign = _branch_sign(mechanism)
        passing &= ~_has_dead_point(ends, sign, designs)
        passing_ends = ends.select(passing)
        passing[passing] = (
            _transmission_angle_candidates(swing, passing_ends, sign, designs[passing], slopes=False).values.min(axis=1)
            > 0.0
        )
    return passing


def transmission_angle_candidates(mechanism: Mechanism, swing: Swing, designs: Array) -> DrivenAngles:
    """Return the transmission angles for designs (n, 3 + k) that close, see `closes_over_swing`."""
    return _transmission_angle_candidates(
        swing, swing_ends(mechanism, swing, designs, slopes=True), _branch_sign(mechanism), designs
    )


def slider_travels(mechanism: Mechanism, swing: Swing, designs: Array) -> tuple[Array, Array]:
    """Return the slider travel (n,) between the ends, m, and its slopes (n, 3 + k)."""
    ends, sign = swing_ends(mechanism, swing, designs, slopes=True), _branch_sign(mechanism)

    def signed_travel(sizes: Any, first: Any, last: Any) -> Any:
        return _slider_position(last, sign, sizes) - _slider_position(first, sign, sizes)

    values, slopes = _value_and_slopes_by_complex_step(signed_travel, designs, ends, (ends.start, 0), (ends.end, 1))
    side = np.where(values < 0.0, -1.0, 1.0)
    return side * values, side[:, None] * slopes


def swept_crank_angles(mechanism: Mechanism, swing: Swing, designs: Array) -> tuple[Array, Array]:
    """Return the crank angle (n,) between the ends, rad, and its slopes (n, 3 + k)."""
    ends = swing_ends(mechanism, swing, designs, slopes=True)
    assert ends.slopes is not None
    slopes = np.zeros(designs.shape)
    for place, v in enumerate(ends.columns):
        slopes[:, v] = ends.direction * (ends.slopes[:, place, 1] - ends.slopes[:, place, 0])
    return ends.high - ends.low, slopes


def _branch_sign(mechanism: Mechanism) -> float:
    return mechanism.sign


def _closes_over_ends(designs: Array, ends: Ends) -> Mask:
    r, l = designs[:, 0], designs[:, 1]
    with np.errstate(invalid="ignore"):
        pin_distance, angle = ends.largest_pin_distance_from_line(designs), ends.high - ends.low
        closing = (r > 0.0) & (pin_distance < l) & np.isfinite(designs).all(axis=1) & (angle > 0.0) & (angle < _TURN)
    return np.asarray(closing)


def _has_dead_point(ends: Ends, sign: float, designs: Array) -> Mask:
    """Return which designs have a dead point in the swing; beyond two dead points the angle is positive again."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    dead = np.zeros(len(designs), np.bool_)
    for span, side in ((r + l, sign), (r - l, -sign)):
        with np.errstate(divide="ignore", invalid="ignore"):
            angle = np.arcsin(e / span)
        dead |= np.isfinite(ends.wrap_into_swing(angle if side > 0.0 else np.pi - angle))
    return dead


def _transmission_angle_candidates(
    swing: Swing, ends: Ends, sign: float, designs: Array, *, slopes: bool = True
) -> DrivenAngles:
    places: list[tuple[Array, int | None]] = [(ends.start, 0), (ends.end, 1)]
    if swing.driver == "crank":
        normal_angles = [
            angle for angle in (0.5 * np.pi, 1.5 * np.pi) if ends.columns or swing.equal_angles_within_swing(angle)
        ]
        places += [(ends.wrap_into_swing(angle), None) for angle in normal_angles]
        side = None
    else:
        places += [(angle, None) for angle in _angles_with_slider_at_pivot(ends, sign, designs)]
        middle = _transmission_sine(ends.middle, designs[:, 0], designs[:, 1], designs[:, 2], sign)
        side = np.where(middle < 0.0, -1.0, 1.0)

    def measure(sizes: Any, theta: Any) -> Any:
        """Return cos(mu) if the crank drives, else sin(mu)."""
        r, l, e = sizes[:, 0], sizes[:, 1], sizes[:, 2]
        if side is not None:
            with np.errstate(invalid="ignore"):
                return side * _transmission_sine(theta, r, l, e, sign) / l
        l_sin = e - r * np.sin(theta)
        return np.where(l_sin.real < 0.0, -l_sin, l_sin) / l

    measured: list[tuple[Array, Array]] = []
    for theta, end in places:
        is_present = np.isfinite(theta)
        size, slope = _value_and_slopes_by_complex_step(
            measure, designs, ends, (np.where(is_present, theta, ends.start), end), slopes=slopes
        )
        steep = np.sqrt(np.maximum(1.0 - size * size, _FLAT))[:, None]
        if swing.driver == "crank":
            value, slope = np.arccos(np.minimum(size, 1.0)), -slope / steep
        else:
            value, slope = np.arcsin(np.clip(size, -1.0, 1.0)), slope / steep
        measured.append((np.where(is_present, value, np.inf), np.where(is_present[:, None], slope, 0.0)))
    return DrivenAngles(*(np.stack(parts, axis=1) for parts in zip(*measured, strict=True)))


def _value_and_slopes_by_complex_step(
    function: Any, designs: Array, ends: Ends, *angles: tuple[Array, int | None], slopes: bool = True
) -> tuple[Array, Array]:
    """Return a function (n,) of dimensions and crank angles, and its derivatives (n, 3 + k) by complex steps.

    angles: each (n,), with the end of the swing (0 or 1) with which it moves; None if it does not move. slopes: whether
    derivatives are needed; otherwise they are zero.
    """
    sizes = designs[:, :3].astype(np.complex128)
    values = function(sizes, *(angle for angle, _ in angles)).real
    slopes_found = np.zeros(designs.shape)
    for v in sorted({0, 1, 2, *ends.columns}) if slopes else ():
        moved = sizes + 1j * STEP * np.eye(3)[v] if v < 3 else sizes
        at: list[Any] = [angle for angle, _ in angles]
        if v in ends.columns and ends.slopes is not None:
            slips = ends.slopes[:, ends.columns.index(v)]
            at = [angle if end is None else angle + 1j * STEP * slips[:, end] for angle, end in angles]
        slopes_found[:, v] = function(moved, *at).imag / STEP
    return values, slopes_found


def _transmission_sine(theta: Any, r: Any, l: Any, e: Any, sign: float) -> Any:
    sine, cosine = np.sin(theta), np.cos(theta)
    return pin_distance_from_crank_line(sine, cosine, motion(sine, cosine, r, l, e, sign))


def _angles_with_slider_at_pivot(ends: Ends, sign: float, designs: Array) -> list[Array]:
    """Return the crank angles (n,) at which the slider is at the pivot; NaN if the swing has none."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    size = np.abs(e)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.arccos((r * r + size * size - l * l) / (2.0 * r * size))
        angles = []
        for side in (-1.0, 1.0):
            theta = ends.wrap_into_swing(np.where(e < 0.0, -0.5, 0.5) * np.pi + side * half)
            off = np.abs(motion(np.sin(theta), np.cos(theta), r, l, e, sign).x)
            angles.append(np.where(off < 1e-6 * r, theta, np.nan))
    return angles


def _slider_position(angle: Any, sign: float, sizes: Any) -> Any:
    sine, cosine = np.sin(angle), np.cos(angle)
    return motion(sine, cosine, sizes[:, 0], sizes[:, 1], sizes[:, 2], sign).x
