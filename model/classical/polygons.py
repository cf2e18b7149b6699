"""Vertices of the position, velocity and acceleration polygons, constructed as with ruler and compasses.

    position       O, A, B            B on the slider line and on the circle around A
    velocity       o, a, b            o-a normal to the crank; b on the line of the slider's velocity and on the normal
                                      to the rod through a
    acceleration   o1, a11, a1, b11, b1    a11: normal acceleration of A; a1: plus its tangential one; b11: plus the
                                      normal one of B relative to A; b1 on the slider's line and on the normal to the
                                      rod through b11

No equation from `kinematics` is used: slider and rod motion are read off the polygons. Source: W. P. Boyle and K. Liu,
"The Offset Slider Crank: Kinematic Pseudographic Analysis", IJEE 13(3), Fig. 2 and Fig. 6; names of vertices as there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..linkage.linkage import Linkage


@dataclass(frozen=True)
class Polygons:
    """Vertices (..., vertex, 2), x and y, and values read from them, (...). SI and radians.

    position: O, A, B, m. velocity: o, a, b, m/s. acceleration: o1, a11, a1, b11, b1, m/s^2.
    rod_velocity, rod_acceleration: rad/s and rad/s^2, from a-b and b11-b1.
    """

    position: Array
    velocity: Array
    acceleration: Array
    rod_velocity: Array
    rod_acceleration: Array

    POSITION: ClassVar = ("O", "A", "B")
    VELOCITY: ClassVar = ("o", "a", "b")
    ACCELERATION: ClassVar = ("o1", "a11", "a1", "b11", "b1")


def motion_polygons(
    linkage: Linkage, crank_angle: ArrayLike, *, speed: ArrayLike = 0.0, acceleration: ArrayLike = 0.0
) -> Polygons:
    """Return the polygons at crank angles (rad) for crank speed (rad/s) and acceleration (rad/s^2); all broadcast.

    Raises `AssemblyError` where the linkage cannot be assembled.
    """
    linkage.at(crank_angle, speed=speed, acceleration=acceleration)  # rejects linkages that cannot be assembled
    theta, w, alpha, r, l, e = np.broadcast_arrays(
        *(np.asarray(value, dtype=np.float64) for value in (crank_angle, speed, acceleration)),
        linkage.crank,
        linkage.rod,
        linkage.offset,
    )
    origin = np.zeros((*theta.shape, 2))
    crank = np.stack([r * np.cos(theta), r * np.sin(theta)], axis=-1)
    rise = e - crank[..., 1]
    slider = np.stack([crank[..., 0] + linkage.sign * np.sqrt((l - rise) * (l + rise)), e], axis=-1)
    rod = slider - crank

    pin_velocity = _quarter_turned(crank) * w[..., None]
    slider_velocity, rod_velocity = _rod_normal_on_slider_line(pin_velocity, rod)

    normal = -crank * (w * w)[..., None]
    pin_acceleration = normal + _quarter_turned(crank) * alpha[..., None]
    towards_pin = pin_acceleration - rod * (rod_velocity**2)[..., None]
    slider_acceleration, rod_acceleration = _rod_normal_on_slider_line(towards_pin, rod)
    return Polygons(
        np.stack([origin, crank, slider], axis=-2),
        np.stack([origin, pin_velocity, slider_velocity], axis=-2),
        np.stack([origin, normal, pin_acceleration, towards_pin, slider_acceleration], axis=-2),
        rod_velocity,
        rod_acceleration,
    )


def _quarter_turned(vector: Array) -> Array:
    """Return vectors (..., 2) rotated by a quarter turn counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def _rod_normal_on_slider_line(start: Array, rod: Array) -> tuple[Array, Array]:
    """Return where the normal to the rod through `start` meets y = 0, and its signed distance in rod lengths."""
    turns = -start[..., 1] / rod[..., 0]
    x = start[..., 0] - turns * rod[..., 1]
    return np.stack([x, np.zeros_like(x)], axis=-1), turns
