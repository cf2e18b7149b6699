"""Real or complex values of linkages: motion, angles, and dimensions in messages."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, Mask
from ..errors import LONGEST, AssemblyError, InputError, number_in_si_and_usual_unit
from ..kinematics.geometry import is_in_line
from .dimensions import DIMENSIONS


@dataclass(frozen=True)
class Kinematics:
    """Motion at given crank angles; arrays of the broadcast shape, SI and radians.

    rod_angle: angle of the rod from +x, counter-clockwise; near 180 deg on the crossed branch. transmission_angle:
    angle between rod and the normal of the slider line: 90 deg minus |phi|, with phi measured from the slider line.
    """

    crank_angle: Array
    slider_position: Array
    slider_velocity: Array
    slider_acceleration: Array
    rod_angle: Array
    rod_velocity: Array
    rod_acceleration: Array
    transmission_angle: Array


@dataclass(frozen=True)
class PointMotion:
    """Position, velocity and acceleration of a point on a link, each (..., 2): x and y. SI."""

    position: Array
    velocity: Array
    acceleration: Array


def real_or_complex_array(value: ArrayLike, argument: str = "a crank angle, speed or acceleration") -> Array:
    """Return real or complex numbers, typed as real, which all are except complex steps. Raises `InputError`."""
    kind = np.complex128 if np.iscomplexobj(value) else np.float64
    try:
        array: Array = np.asarray(value, dtype=kind)
    except (TypeError, ValueError):
        raise InputError(f"{argument} must be a number or an array of numbers in SI units; got {value!r}") from None
    return array


def dimension_arrays(crank: ArrayLike, rod: ArrayLike, offset: ArrayLike) -> tuple[Array, Array, Array]:
    """Return crank, rod and offset, m, as arrays that broadcast; an offset below rounding becomes zero.

    Raises `InputError` for other values, `AssemblyError` if no crank angle is possible.
    """
    values = []
    for name, length in zip(DIMENSIONS, (crank, rod, offset), strict=True):
        value = real_or_complex_array(length, name)
        if not np.all(np.isfinite(value)):
            raise InputError(f"{name} must be finite; got {length!r}")
        values.append(value)
    try:
        real = np.broadcast_arrays(*(value.real for value in values))
    except ValueError:
        shapes = ", ".join(str(value.shape) for value in values)
        raise InputError(f"crank, rod and offset must broadcast to one shape; got {shapes}") from None
    for name, size in zip(("crank", "rod"), real, strict=False):
        if np.any(size <= 0.0):
            raise InputError(f"{name} must be above zero; got {first_marked_value(size, size <= 0.0):g} m")
    cannot_close = np.abs(real[2]) >= real[0] + real[1]
    if np.any(cannot_close):
        raise AssemblyError(
            "|offset| must be less than crank + rod, or the linkage cannot close; got "
            f"{dimensions_text(real[0], real[1], real[2], cannot_close)}; shorten the offset or lengthen a link"
        )
    rounding = is_in_line(real[1], real[2]) & (real[2] != 0.0)
    if np.any(rounding):
        values[2] = np.where(rounding, values[2] - real[2], values[2])
    return values[0], values[1], values[2]


def implausible_length_text(lengths: Iterable[Array], longest: Iterable[float] = (LONGEST,) * 3) -> str | None:
    """Return the first implausibly long dimension in words, as read in m and as probably meant in mm.

    None if there is no such length. longest: plausible limits for crank, rod and offset, m.
    """
    for name, size, limit in zip(DIMENSIONS, lengths, longest, strict=True):
        is_too_long = np.isfinite(size) & (np.abs(size) > limit)
        if np.any(is_too_long):
            return number_in_si_and_usual_unit(name, first_marked_value(size, is_too_long), "m", "mm", 1e3)
    return None


def direction_angle(y: Array, x: Array) -> Array:
    """Return the angle of (x, y), rad, with its derivative if these are complex."""
    angle: Array = np.arctan2(y.real, x.real)
    if np.iscomplexobj(x) or np.iscomplexobj(y):
        turned = (x.real * y.imag - y.real * x.imag) / (x.real * x.real + y.real * y.real)
        return np.asarray(angle + 1j * turned)
    return angle


def wrap_into_turn(angle: Array) -> Array:
    """Return an angle in [0, 2 pi), rad."""
    in_turn = np.mod(angle.real, 2.0 * np.pi)
    # Rounding takes a tiny negative angle to 2 pi itself.
    in_turn = np.where(in_turn < 2.0 * np.pi, in_turn, 0.0)
    wrapped: Array = (in_turn + 1j * angle.imag if np.iscomplexobj(angle) else in_turn)[()]
    return wrapped


def first_marked_value(values: Array, marked: Mask) -> float:
    """Return the first marked value."""
    return float(np.asarray(values)[marked].flat[0])


def dimensions_text(crank: Array, rod: Array, offset: Array, marked: Mask) -> str:
    """Return the first marked linkage in words, mm."""
    crank, rod, offset = (np.broadcast_to(value, marked.shape) for value in (crank, rod, offset))
    return (
        f"rod {1e3 * first_marked_value(rod, marked):g} mm, crank {1e3 * first_marked_value(crank, marked):g} mm, "
        f"offset {1e3 * first_marked_value(offset, marked):g} mm"
    )
