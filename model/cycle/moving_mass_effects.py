"""Effects of the moving masses alone: shaking force, shaking moment, reflected inertia (`inertia`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.inertia import reflected_inertia, shaking_force_and_moment
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.design import DESIGN, LOAD_ROWS, derive_design, design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import raw_inputs_with_added_masses_only, raw_vector
from ..machine.two_turn_machine import machine_of_first_turn
from ..signals.signals import design_motion
from .crank_speed import crank_speed_and_acceleration


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
