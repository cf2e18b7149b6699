"""Curves of one design over a crank turn, with names, titles and units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ...model.cycle.crank_speed import acceleration_slope_by_angle, crank_speed_and_acceleration
from ...model.cycle.cycle import cycle
from ...model.cycle.multi_cylinder import multi_cylinder_curves
from ...model.errors import InputError
from ...model.kinematics.position import Motion, motion, third_slider_derivative
from ...model.linkage.linkage import Linkage
from ...model.linkage.linkage_values import direction_angle, real_or_complex_array
from ...model.machine.cylinders_and_turns import cycle_turns, cylinder_count
from ...model.machine.mechanism import Mechanism
from ...model.signals.motor_curves import MotorCurve, motor_curve
from ..kinds import (
    ACCELERATION,
    ANGLE,
    ANGULAR_SPEED,
    FORCE,
    JERK,
    LENGTH,
    PER_ANGLE,
    PER_CUBED_ANGLE,
    PER_SQUARED_ANGLE,
    POWER,
    SPEED,
    TORQUE,
    Kind,
)
from ..quantity import Array

if TYPE_CHECKING:
    import pandas as pd

LEAST, MOST = 4, 100_000
_RATES = SPEED, ACCELERATION, JERK
_RATES_PER_ANGLE = PER_ANGLE, PER_SQUARED_ANGLE, PER_CUBED_ANGLE
KINDS = (ANGLE, ANGULAR_SPEED, LENGTH, *_RATES, TORQUE, POWER, FORCE)
"""Kinds of curves for a machine with a crank speed."""
_FORCES = ("pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y", "slider_pin_x", "slider_pin_y")


@dataclass(frozen=True)
class Curve:
    """A curve over the crank angle.

    name: without its unit. values: (n,), SI; NaN where the curve is undefined.
    """

    name: str
    title: str
    values: Array
    kind: Kind

    @property
    def field(self) -> str:
        """Key of the curve in metric tables and JSON."""
        return self.name + self.kind.metric.suffix


def cycle_curves(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> list[Curve]:
    """Return the curves of one fully rotating linkage at crank angles (n,), rad; the angle comes first.

    Forces act from the frame on the crank (pivot), from the crank on the rod (crank pin), from the rod on the slider
    (slider pin), and from the guide on the slider along +y. Torque and power refer to the drive. With several
    cylinders, torque and power are over the shaft angle; all other curves belong to one cylinder, over its own crank
    angle. Without a crank speed, velocity, acceleration and jerk are for one radian per second, that is, derivatives
    with respect to the crank angle, and power is NaN. Position errors are NaN without tolerances. A drive adds the
    motor's torque, speed and power, positive in the direction of rotation. For values at load jumps and for errors
    raised, see `model.cycle.cycle`.
    """
    acting = cycle(mechanism, linkage, crank_angle)
    moving = acting if mechanism.speed else cycle(replace(mechanism, speed=1.0), linkage, crank_angle)
    nothing = np.full(len(acting.crank_angle), np.nan)
    if not mechanism.tolerances.are_stated:
        acting = replace(acting, position_error=nothing, position_error_rss=nothing)
    speed = mechanism.speed
    rates, note = (_RATES, "") if speed else (_RATES_PER_ANGLE, " per crank speed")
    theta = acting.crank_angle
    torque, all_cylinders = acting.torque, ""
    if cylinder_count(mechanism) > 1:
        torque, all_cylinders = multi_cylinder_curves(mechanism, linkage, theta).torque, " of all cylinders"
    sine, cosine = np.sin(theta), np.cos(theta)
    m = motion(sine, cosine, linkage.crank, linkage.rod, linkage.offset, linkage.sign)
    third = third_slider_derivative(sine, cosine, m, linkage.crank)
    jerk = _jerk(mechanism if speed else replace(mechanism, speed=1.0), m, third, theta)
    velocity, acceleration = moving.slider_velocity, moving.slider_acceleration
    return [
        Curve("crank_angle", "crank angle", theta, ANGLE),
        Curve("slider_position", "slider position", moving.slider_position, LENGTH),
        Curve("slider_velocity", f"slider velocity{note}", velocity, rates[0]),
        Curve("slider_acceleration", f"slider acceleration{note}", acceleration, rates[1]),
        Curve("slider_jerk", f"slider jerk{note}", jerk, rates[2]),
        Curve("rod_angle", "rod angle", direction_angle(m.l_sin, m.l_cos), ANGLE),
        Curve("transmission_angle", "transmission angle", moving.transmission_angle, ANGLE),
        Curve("torque", f"drive torque{all_cylinders}", torque, TORQUE),
        Curve(
            "power",
            f"drive power{all_cylinders}",
            crank_speed_and_acceleration(mechanism, theta)[0] * torque if speed else nothing,
            POWER,
        ),
        Curve("load", "load on the slider", acting.load, FORCE),
        *(
            Curve(name, f"{name[:-2].replace('_', ' ')} force along {name[-1]}", getattr(acting, name), FORCE)
            for name in _FORCES
        ),
        Curve("guide", "guide force", acting.guide, FORCE),
        Curve("position_error", "position error, worst case", acting.position_error, LENGTH),
        Curve("position_error_rss", "position error, root-sum-square", acting.position_error_rss, LENGTH),
        *(_motor_curves(mechanism, linkage, theta) if mechanism.drive else ()),
    ]


def _motor_curves(mechanism: Mechanism, linkage: Linkage, theta: Array) -> list[Curve]:
    """Return the curves upstream of the gear; speed and power need a crank speed."""
    assert mechanism.drive is not None
    design = np.array([[linkage.crank, linkage.rod, linkage.offset]])
    torque = Curve("motor_torque", "motor torque", motor_curve(mechanism, design, theta, MotorCurve.TORQUE), TORQUE)
    if not mechanism.speed:
        return [torque]
    speed = mechanism.drive.gear_ratio * np.abs(crank_speed_and_acceleration(mechanism, theta)[0])
    return [
        torque,
        Curve("motor_speed", "motor speed", speed, ANGULAR_SPEED),
        Curve("motor_power", "motor power", torque.values * speed, POWER),
    ]


def cycle_table(mechanism: Mechanism, linkage: Linkage, angles: int | ArrayLike = 360) -> pd.DataFrame:
    """Return the curves of one fully rotating linkage as a table in SI, with one row per crank angle.

    angles: number of crank angles, evenly spaced over the cycle from 0 (two turns if a load has a two-turn cycle); or
    crank angles (n,), rad. Columns: the names of `cycle_curves` with their unit, such as torque_Nm. Raises `InputError`
    for too few or too many angles, and for angles that are not finite.
    """
    if isinstance(angles, int | np.integer) and not isinstance(angles, bool):
        theta = cycle_turns(mechanism) * even_angles(int(angles))
    else:
        theta = real_or_complex_array(angles, "a crank angle")
    if theta.ndim != 1 or np.iscomplexobj(theta):
        raise InputError(
            f"crank angles must be a list of real numbers in rad, or a number of angles; got {angles!r:.60}; for "
            "example, write [1.0]"
        )
    import pandas as pd

    return pd.DataFrame(
        {
            curve.name + curve.kind.si_display_unit.suffix: curve.values
            for curve in cycle_curves(mechanism, linkage, theta)
        }
    )


def even_angles(count: int, limit: int = MOST) -> Array:
    """Return crank angles (n,), rad, evenly spaced over a turn from 0. Raises `InputError` for too few or too many."""
    if not LEAST <= count <= limit:
        raise InputError(f"curves must have {LEAST} to {limit} crank angles; got {count}; choose a number within these")
    angles: Array = np.arange(count, dtype=np.float64) * (2.0 * np.pi / count)
    return angles


def _jerk(mechanism: Mechanism, m: Motion, third: Array, theta: Array) -> Array:
    """Return the slider jerk, m/s^3: x''' w^3 + 3 x'' w a + x' w da/d(theta).

    a: acceleration of the crank. third: x''', m.
    """
    if mechanism.speed_profile is None:
        return np.asarray(third * mechanism.speed**3 + 3.0 * m.x_2 * mechanism.speed * mechanism.acceleration)
    speed, acceleration = crank_speed_and_acceleration(mechanism, theta)
    return np.asarray(
        (third * speed**2 + 3.0 * m.x_2 * acceleration + m.x_1 * acceleration_slope_by_angle(mechanism, theta)) * speed
    )
