"""Torque, forces and shaking of a machine whose crank speed follows a profile over the crank angle.

With w(theta) and alpha = w dw/d(theta) at every angle, the inverse dynamics of the cycle applies unchanged:

    T = w^2 J' / 2 + J alpha + V' - F x'.

Over a turn the kinetic energy J w^2 / 2 returns to its initial value, so the torque's work equals that of loads and
friction.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..cycle.crank_speed import crank_speed_and_acceleration, speed_knots
from ..cycle.cycle import Cycle, breakpoints, cycle
from ..cycle.multi_cylinder import shaking_curves
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.cylinders_and_turns import TURN, cycle_turns
from ..machine.mechanism import Mechanism
from ..signals.panel_polynomials import Extreme, larger_extreme, resolve_curves, wrap_into_cycle

_PIECES = 12  # minimum number of panels in a turn
_SAMPLES = 360
_TIME = 2  # row with the time per crank angle
_SQUARES = ("pivot_force", "crank_pin_force", "slider_pin_force", "shaking_force")
_SIZES = ("torque", "power", "guide_force", "slider_speed", "slider_acceleration", "shaking_moment")


@dataclass(frozen=True)
class SpeedProfileCurves:
    """Crank speed, rad/s, and acceleration, rad/s^2, over the crank angle (n,), and the curves of the cycle there.

    named_curves: curves (n,) by name, SI: magnitudes of the joint forces, shaking force and moment, power.
    """

    speed: Array
    acceleration: Array
    curves: Cycle
    named_curves: Mapping[str, Array]


@dataclass(frozen=True)
class SpeedProfileCycle:
    """Numbers over a turn, SI.

    period: time of a turn, s. mean_speed: mean over time, rad/s. fluctuation: range of the speed divided by its mean.
    peaks: maximum magnitudes by name. mean_torque: mean over the crank angle, N m. rms_torque: RMS value over time, N
    m. work: work of the torque, J.
    """

    least_speed: Extreme
    greatest_speed: Extreme
    acceleration: Extreme
    period: float
    mean_speed: float
    fluctuation: float
    peaks: Mapping[str, Extreme]
    mean_torque: float
    rms_torque: float
    work: float

    @property
    def mean_power(self) -> float:
        """Mean power of the drive over time, W."""
        return self.work / self.period


class CrankMotion(NamedTuple):
    """A crank speed over the crank angle that replaces the machine's own.

    speed_at: function of crank angles (n,), rad, that returns crank speed, rad/s, and acceleration, rad/s^2.
    knots: crank angles (k,), rad, at which they are not analytic.
    """

    speed_at: Callable[[Array], tuple[Array, Array]]
    knots: Array


def speed_profile_curves(
    mechanism: Mechanism, linkage: Linkage, crank_angle: Array, motion: CrankMotion | None = None
) -> SpeedProfileCurves:
    """Return the curves of one fully rotating linkage at crank angles (n,), rad. motion: replaces the machine's."""
    speed, acceleration = (
        crank_speed_and_acceleration(mechanism, crank_angle) if motion is None else motion.speed_at(crank_angle)
    )
    curves = cycle(mechanism, linkage, crank_angle, speed=speed, acceleration=acceleration)
    shaken = shaking_curves(mechanism, linkage, crank_angle, speed=speed, acceleration=acceleration)
    named = {
        "pivot_force": np.hypot(curves.pivot_x, curves.pivot_y),
        "crank_pin_force": np.hypot(curves.crank_pin_x, curves.crank_pin_y),
        "slider_pin_force": np.hypot(curves.slider_pin_x, curves.slider_pin_y),
        "shaking_force": np.hypot(shaken.force_x, shaken.force_y),
        "torque": curves.torque,
        "power": curves.torque * speed,
        "guide_force": curves.guide,
        "slider_speed": curves.slider_velocity,
        "slider_acceleration": curves.slider_acceleration,
        "shaking_moment": shaken.moment,
    }
    return SpeedProfileCurves(speed, acceleration, curves, named)


def speed_profile_cycle(mechanism: Mechanism, linkage: Linkage, motion: CrankMotion | None = None) -> SpeedProfileCycle:
    """Return the statistics of one fully rotating linkage over a turn; for a two-turn cycle, per turn.

    motion: crank motion that replaces the machine's own, in its direction. Raises `InputError` for a machine at rest or
    under a constant acceleration, and if friction locks the linkage.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    if not mechanism.speed or (mechanism.acceleration and mechanism.speed_profile is None):
        raise InputError(
            f"a repeating turn must have a speed and no constant acceleration; got {mechanism.speed:g} rad/s and "
            f"{mechanism.acceleration:g} rad/s^2"
        )

    def curve_rows(theta: Array) -> Array:
        curves = speed_profile_curves(mechanism, linkage, theta, motion)
        rows = [
            curves.speed,
            curves.acceleration,
            1.0 / np.abs(curves.speed),
            *(curves.named_curves[name] for name in _SIZES),
        ]
        return np.stack([*rows, *(curves.named_curves[name] ** 2 for name in _SQUARES)])

    turns = cycle_turns(mechanism)
    cuts, knots = breakpoints(mechanism, linkage), speed_knots(mechanism) if motion is None else motion.knots
    start, end = cuts[0], cuts[0] + turns * TURN
    profile_knots = [start + np.mod(knots - start, TURN) + turn * TURN for turn in range(turns)]
    ends = np.unique(np.concatenate([cuts, *profile_knots, np.linspace(start, end, 1 + turns * _PIECES)]))
    sizes = np.abs(curve_rows(np.linspace(start, end, _SAMPLES))).max(axis=1)
    panels = resolve_curves(curve_rows, ends, np.where(sizes > 0.0, sizes, 1.0))
    least, greatest = panels.extremes(0)
    period = TURN * panels.mean(_TIME)
    peaks = {name: _larger_extreme(panels.extremes(3 + row), turns) for row, name in enumerate(_SIZES)}
    for row, name in enumerate(_SQUARES, start=3 + len(_SIZES)):
        top = panels.extremes(row)[1]
        peaks[name] = Extreme(math.sqrt(max(0.0, top.value)), wrap_into_cycle(top.angle, turns * TURN))
    way, torque = mechanism.direction, 3 + _SIZES.index("torque")
    mean = panels.mean(torque)
    return SpeedProfileCycle(
        least_speed=Extreme(least.value, wrap_into_cycle(least.angle, TURN)),
        greatest_speed=Extreme(greatest.value, wrap_into_cycle(greatest.angle, TURN)),
        acceleration=_larger_extreme(panels.extremes(1), 1),
        period=period,
        mean_speed=way * TURN / period,
        fluctuation=(greatest.value - least.value) * period / TURN,
        peaks=peaks,
        mean_torque=mean,
        rms_torque=math.sqrt(panels.mean_square(torque, time=_TIME)),
        work=way * TURN * mean,
    )


def _larger_extreme(extremes: tuple[Extreme, Extreme], turns: int) -> Extreme:
    """Return the larger magnitude of both extremes."""
    top = larger_extreme(extremes, turns * TURN)
    return Extreme(abs(top.value), wrap_into_cycle(top.angle, turns * TURN))
