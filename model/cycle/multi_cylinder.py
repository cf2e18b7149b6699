"""Several identical cylinders on one crankshaft: total torque, shaking force, moment and rocking couple.

Each cylinder is a single machine at its own crank angle, in axes that are rotated with its bank (`arrangement`).
Gravity is rotated into these axes, and the results are rotated back. Forces and moments on the shaft and the frame add
up. If z is the position of a cylinder along the shaft, its shaking force F contributes the rocking couple (-z F_y, z
F_x) about the plane z = 0.

Effects of the moving masses alone: shaking force, shaking moment, reflected inertia (`torque`).
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.torque import reflected_inertia, shaking_force_and_moment
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.arrangement import Arrangement
from ..machine.cylinders_and_turns import TURN, cycle_turns, machine_of_first_turn, machines_of_arrangement
from ..machine.design import DESIGN, LOAD_ROWS, derive_design, design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import raw_inputs_with_added_masses_only, raw_vector
from ..machine.speed_profile import time_per_angle
from ..signals.panel_polynomials import Extreme, Panels, larger_extreme, resolve_curves, wrap_into_cycle
from ..signals.signals import design_motion
from .crank_speed import crank_speed_and_acceleration, speed_knots
from .cycle import breakpoints, cycle


@dataclass(frozen=True)
class ShakingCurves:
    """Curves of one design, each (n,), SI and radians: actions on the frame, without gravity and loads.

    force_x, force_y: shaking force, N. moment: moment about the crank pivot, N m, counter-clockwise. reflected_inertia:
    kg m^2.
    """

    crank_angle: Array
    force_x: Array
    force_y: Array
    moment: Array
    reflected_inertia: Array


def shaking_curves(
    mechanism: Mechanism,
    linkage: Linkage,
    crank_angle: ArrayLike,
    *,
    speed: Array | None = None,
    acceleration: Array | None = None,
) -> ShakingCurves:
    """Return the curves of one fully rotating linkage at crank angles (n,), rad.

    speed, acceleration: crank speed and acceleration at each angle, rad/s and rad/s^2, (n,); by default those of the
    mechanism, along its profile if it has one.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    theta = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    _, structure = raw_inputs_with_added_masses_only(machine_of_first_turn(mechanism))
    raw = raw_vector(mechanism)[:, None]
    raw[:3, 0] = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    block = np.empty((DESIGN + LOAD_ROWS * len(structure.kind), 1))
    derive_design(raw, structure.kind, structure.datum, block)
    d = design_at(block, 0)
    if mechanism.speed_profile is not None:
        profile_motion = crank_speed_and_acceleration(mechanism, theta)
        speed = profile_motion[0] if speed is None else speed
        acceleration = profile_motion[1] if acceleration is None else acceleration
    d = d if speed is None else d._replace(speed=speed)
    d = d if acceleration is None else d._replace(acceleration=acceleration)
    sine, cosine = np.sin(theta), np.cos(theta)
    m = design_motion(sine, cosine, d)
    x, y, moment = (np.broadcast_to(part, theta.shape) for part in shaking_force_and_moment(sine, cosine, m, d))
    inertia = np.broadcast_to(reflected_inertia(sine, cosine, m, d), theta.shape)
    return ShakingCurves(theta, x, y, moment, inertia)


_PIECES = 12  # minimum number of panels in a turn
_SAMPLES = 256
_ROUNDING = 1e-14  # remainder of cancelling forces, relative to their magnitudes
_NOTHING = 1e-12
"""If the total is below this fraction of the cylinders' individual magnitudes, it counts as zero: they cancel up to
rounding."""
_TORQUE, _X, _Y, _FORCE, _MOMENT, _COUPLE, _TIME = range(7)


@dataclass(frozen=True)
class MultiCylinderCurves:
    """Combined curves of all cylinders at crank angles of the shaft, each (n,), SI, in the axes of zero bank.

    torque: drive torque, N m, counter-clockwise. force_x, force_y, moment: shaking force, N, and moment about the
    shaft, N m, on the frame. couple_x, couple_y: rocking couple, N m. torques: torque of each cylinder, (k, n).
    """

    crank_angle: Array
    torque: Array
    force_x: Array
    force_y: Array
    moment: Array
    couple_x: Array
    couple_y: Array
    torques: Array


@dataclass(frozen=True)
class MultiCylinderCycle:
    """Statistics over a turn for all cylinders together; SI.

    least, greatest: extremes of the torque. peak: torque with the maximum magnitude. mean: mean torque over the crank
    angle. rms: RMS torque over time. fluctuation: RMS deviation of the torque from its mean, over the crank angle.
    energy_change: range of the integral of torque minus mean, J, which a flywheel absorbs. shaking_force,
    shaking_moment, couple: maximum magnitudes. rms_shaking_force, rms_shaking_moment: over time.
    """

    least: Extreme
    greatest: Extreme
    peak: Extreme
    mean: float
    rms: float
    fluctuation: float
    energy_change: float
    shaking_force: Extreme
    rms_shaking_force: float
    shaking_moment: Extreme
    rms_shaking_moment: float
    couple: Extreme


def multi_cylinder_curves(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> MultiCylinderCurves:
    """Return the combined curves of all cylinders at shaft crank angles (n,), rad; raises as `cycle` does."""
    theta = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    speed, acceleration = crank_speed_and_acceleration(mechanism, theta)
    torques, sums, sizes = [], np.zeros((5, len(theta))), np.zeros((5, len(theta)))
    for member in machines_of_arrangement(mechanism):
        at = theta + member.lead
        torques.append(cycle(member.mechanism, linkage, at, speed=speed, acceleration=acceleration).torque)
        shaken = shaking_curves(member.mechanism, linkage, at, speed=speed, acceleration=acceleration)
        c, s = math.cos(member.bank), math.sin(member.bank)
        x, y = c * shaken.force_x - s * shaken.force_y, s * shaken.force_x + c * shaken.force_y
        sums += np.stack([x, y, shaken.moment, -member.place * y, member.place * x])
        force = np.hypot(x, y)
        couple = abs(member.place) * force
        sizes += np.stack([force, force, np.abs(shaken.moment), couple, couple])
    sums[np.abs(sums) <= _ROUNDING * sizes] = 0.0
    force_x, force_y, moment, couple_x, couple_y = sums
    torque = np.sum(torques, axis=0)
    return MultiCylinderCurves(theta, torque, force_x, force_y, moment, couple_x, couple_y, np.stack(torques))


def multi_cylinder_breakpoints(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the shaft crank angles, rad from 0, at which the torque may have a jump or a kink."""
    angles = [breakpoints(member.mechanism, linkage) - member.lead for member in machines_of_arrangement(mechanism)]
    angles += [speed_knots(mechanism) + turn * TURN for turn in range(cycle_turns(mechanism))]
    return np.unique(np.mod(np.concatenate(angles), cycle_turns(mechanism) * TURN))


def multi_cylinder_cycle(mechanism: Mechanism, linkage: Linkage) -> MultiCylinderCycle:
    """Return the statistics for all cylinders together; raises as `cycle` and `breakpoints` do."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    cuts = multi_cylinder_breakpoints(mechanism, linkage)
    period = cycle_turns(mechanism) * TURN
    pieces = np.linspace(cuts[0], cuts[0] + period, 1 + _PIECES * cycle_turns(mechanism))
    ends = np.unique(np.concatenate([cuts, pieces]))
    sizes = _curve_magnitudes_without_cancelling(mechanism, linkage)
    panels = resolve_curves(
        lambda theta: _rows_of_curves(mechanism, multi_cylinder_curves(mechanism, linkage, theta)), ends, sizes
    )
    least, greatest = (_zero_if_cancelled(extreme, sizes[_TORQUE], period) for extreme in panels.extremes(_TORQUE))
    moment = larger_extreme(panels.extremes(_MOMENT), period)
    mean, time = panels.mean(_TORQUE), None if mechanism.speed_profile is None else _TIME
    return MultiCylinderCycle(
        least=least,
        greatest=greatest,
        peak=larger_extreme((least, greatest), period),
        mean=0.0 if abs(mean) <= _NOTHING * sizes[_TORQUE] else mean,
        rms=math.sqrt(panels.mean_square(_TORQUE, time=time)),
        fluctuation=math.sqrt(panels.mean_square(_TORQUE, subtract=mean)),
        energy_change=panels.integral_range(_TORQUE),
        shaking_force=_extreme_from_squared_force(panels, _FORCE, sizes, period),
        rms_shaking_force=math.sqrt(max(0.0, panels.mean(_FORCE, time))),
        shaking_moment=_zero_if_cancelled(Extreme(abs(moment.value), moment.angle), sizes[_MOMENT], period),
        rms_shaking_moment=math.sqrt(panels.mean_square(_MOMENT, time=time)),
        couple=_extreme_from_squared_force(panels, _COUPLE, sizes, period),
    )


def _rows_of_curves(mechanism: Mechanism, curves: MultiCylinderCurves) -> Array:
    x, y = curves.force_x, curves.force_y
    couple = curves.couple_x**2 + curves.couple_y**2
    profile = mechanism.speed_profile
    time = np.ones(len(x)) if profile is None else time_per_angle(profile, curves.crank_angle)
    return np.stack([curves.torque, x, y, x * x + y * y, curves.moment, couple, time])


def _curve_magnitudes_without_cancelling(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the magnitudes that the curves would have if the cylinders did not cancel."""
    theta = np.linspace(0.0, cycle_turns(mechanism) * TURN, _SAMPLES, endpoint=False)
    profile, sizes = mechanism.speed_profile, np.zeros(7)
    sizes[_TIME] = 1.0 if profile is None else time_per_angle(profile, theta).max()
    for member in machines_of_arrangement(mechanism):
        single = replace(mechanism, arrangement=Arrangement(phases=(member.lead,)), gravity=member.mechanism.gravity)
        curves = multi_cylinder_curves(single, linkage, theta)
        force, torque = np.hypot(curves.force_x, curves.force_y).max(), np.abs(curves.torque).max()
        sizes += np.array([torque, force, force, force, np.abs(curves.moment).max(), force * abs(member.place), 0.0])
    sizes[[_FORCE, _COUPLE]] **= 2
    return sizes


def _zero_if_cancelled(extreme: Extreme, size: float, period: float) -> Extreme:
    """Return an extreme value, or zero if cylinders cancel up to rounding."""
    if not abs(extreme.value) > _NOTHING * size:
        return Extreme(0.0, math.nan)
    return Extreme(extreme.value, wrap_into_cycle(extreme.angle, period))


def _extreme_from_squared_force(panels: Panels, curve: int, sizes: Array, period: float) -> Extreme:
    """Return the maximum magnitude of a force from its square."""
    greatest = panels.extremes(curve)[1]
    return _zero_if_cancelled(
        Extreme(math.sqrt(max(0.0, greatest.value)), greatest.angle), math.sqrt(sizes[curve]), period
    )
