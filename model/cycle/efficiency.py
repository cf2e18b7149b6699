"""Work balance over a cycle: loads, friction in each joint, kinetic energy.

Per cycle, one turn or two, with dt = dtheta / w at constant speed:

- input: integral of T over the cycle, in the direction of rotation;
- useful: work done against the loads, which is minus the integral of F dx (F, x positive outward) and, for torques M on
  the crank, of M dtheta;
- friction heat: mu |N| |dx| in the guide, rho |F| times the relative rotation in the pins: |phi'| in the slider pin, 1
  - phi' in the crank pin, 1 in the crank pivot;
- stored: kinetic energy from the crank's acceleration, if any. Springs and gravity return the energy that they store
  within a turn.

Loads that do net work on the machine drive it; the crank then delivers that work less friction.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..arrays import Array
from ..dynamics.segments import crank_angle_from_crowded, crowded_from_crank_angle, crowding_parameter
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.mechanism import Mechanism
from ..machine.two_turn_machine import TURN, cycle_turns
from ..signals.averages import signal_averages
from ..signals.panel_polynomials import resolve_curves
from ..signals.signals import Signal
from .cycle import breakpoints, cycle

_PIECES = 8  # minimum number of panels between two breakpoints
_SAMPLES = 720
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Energies:
    """Energies over one cycle of one or two turns, J. useful: work done against the load, negative if the load drives.

    throughput: integral of |F dx|, used to judge whether the useful work exceeds rounding errors.
    """

    input: float
    useful: float
    stored: float
    guide_heat: float
    crank_pivot_heat: float
    crank_pin_heat: float
    slider_pin_heat: float
    throughput: float

    @property
    def heat(self) -> float:
        """Friction heat in all joints, J."""
        return self.guide_heat + self.crank_pivot_heat + self.crank_pin_heat + self.slider_pin_heat

    @property
    def efficiency(self) -> float | None:
        """Work output divided by work input; None if the load neither absorbs nor supplies net work.

        If the crank drives, the input is useful work plus friction heat. If the load drives, the input is the work of
        the load and the output is the work that the crank delivers after friction, at least 0.
        """
        if abs(self.useful) <= _ROUNDING * self.throughput:
            return None
        net = self.useful + self.heat
        return self.useful / net if self.useful > 0.0 else max(0.0, net / self.useful)


def cycle_energies(mechanism: Mechanism, linkage: Linkage) -> Energies:
    """Return the energies over one cycle for one linkage.

    Raises `InputError` where friction locks the linkage, `AssemblyError` where it does not rotate fully.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    cuts = breakpoints(mechanism, linkage)
    dimensions = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    kappa = crowding_parameter(*map(float, dimensions[0]))
    turn = 1.0 if mechanism.speed >= 0.0 else -1.0
    friction = mechanism.friction

    def energy_rates(tau: Array) -> Array:
        """Return all integrands (k, n) over the crowded angle."""
        theta = np.array([crank_angle_from_crowded(angle, kappa) for angle in tau])
        weight = kappa / (np.cos(tau) ** 2 + (kappa * np.sin(tau)) ** 2)
        curves = cycle(mechanism, linkage, theta)
        motion = linkage.at(theta, speed=1.0)
        work = -linkage.sign * curves.load * motion.slider_velocity - curves.crank_load
        swing = motion.rod_velocity
        integrands: Array = weight * np.stack(
            [
                turn * curves.torque,
                turn * work,
                friction.guide * np.abs(curves.guide * motion.slider_velocity),
                friction.crank_pivot.friction_circle_radius * np.hypot(curves.pivot_x, curves.pivot_y),
                friction.crank_pin.friction_circle_radius
                * np.hypot(curves.crank_pin_x, curves.crank_pin_y)
                * (1.0 - swing),
                friction.slider_pin.friction_circle_radius
                * np.hypot(curves.slider_pin_x, curves.slider_pin_y)
                * np.abs(swing),
                np.abs(work),
            ]
        )
        return integrands

    turns = cycle_turns(mechanism)
    edges = [crowded_from_crank_angle(float(angle), kappa) for angle in (*cuts, cuts[0] + turns * TURN)]
    ends = np.concatenate([edges[:1], *(np.linspace(a, b, 1 + _PIECES)[1:] for a, b in pairwise(edges))])
    sizes = np.abs(energy_rates(np.linspace(edges[0], edges[-1], _SAMPLES))).max(axis=1)
    panels = resolve_curves(energy_rates, ends, np.where(sizes > 0.0, sizes, 1.0))
    drive_work, useful, guide, pivot, crank_pin, slider_pin, throughput = map(panels.integral, range(len(sizes)))
    inertia = signal_averages(mechanism, Signal.REFLECTED_INERTIA, dimensions).mean[0]
    stored = turn * turns * TURN * mechanism.acceleration * float(inertia)
    return Energies(drive_work, useful, stored, guide, pivot, crank_pin, slider_pin, throughput)
