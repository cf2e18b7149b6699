"""Shaking force and moment as affine functions of the masses that balance them, with exact peaks and means.

At constant crank speed w (`model.dynamics.torque`, alpha = 0), C is the first moment of everything fixed to the crank,
in its axes, R(theta) the rotation into the frame, and for the rod m is its mass, S its first moment and I its inertia
about the crank pin:

    force  = w^2 R(theta) C + m r w^2 (cos theta, sin theta) - S_tt - m_slider a_B
    moment = -(A x S_tt + S x a_A + I phi_tt) + e m_slider a_B,    a_A = -w^2 A.

Both are linear in C, m, S and I, and so affine in the contributions of a counterweight (c = mass times vector to its
centre) and a mass added to the rod (m, b, I about the crank pin). The moment about the pivot depends neither on c,
whose force passes through the pivot, nor on m: only b and I change it. m acts like a counterweight of moment m r
towards the crank pin. Mass and inertia are not affine as functions of a moment (m = |c| / radius, I = |c| radius).
Those of the counterweight matter only if the crank accelerates, so its mass follows afterwards for any radius; those on
the rod are separate variables (`counterweight`).
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.cycle.multi_cylinder import shaking_curves
from ...model.dynamics.segments import crank_angle_from_crowded, crowding_parameter
from ...model.linkage.linkage import Linkage
from ...model.machine.design import link_properties
from ...model.machine.links_and_joints import Bar, Counterweight, Link, RigidLink
from ...model.machine.mechanism import Mechanism

NAMES = ("c along", "c across", "m", "b along", "b across", "I")
"""Columns: the counterweight's moment along and across the crank, kg m. For the mass added to the rod: mass, kg, first
moment along and across the rod, kg m, and inertia, kg m^2, about the crank pin."""
_NODES = 192  # nodes for the means, as in `model.signals.averages`


def shaking_rows(mechanism: Mechanism, linkage: Linkage, angles: Array) -> tuple[Array, Array]:
    """Return force (2, k, 7), N, and moment (k, 7), N m, at crank angles (k,), rad.

    The first column is the shaking without a counterweight; the others are per unit of `NAMES`.
    """

    def curves_with_masses(**masses: Any) -> Array:
        machine = Mechanism(speed=mechanism.speed, branch=mechanism.branch, **masses)
        shaking = shaking_curves(machine, linkage, angles)
        return np.stack([shaking.force_x, shaking.force_y, shaking.moment])

    bare = curves_with_masses(crank=mechanism.crank, rod=mechanism.rod, slider_mass=mechanism.slider_mass)
    axial, lateral = (
        curves_with_masses(counterweight=Counterweight(mass=1.0, radius=1.0, angle=at)) for at in (0.0, 0.5 * math.pi)
    )
    mass = curves_with_masses(rod=RigidLink(mass=1.0, centre=0.0, inertia=0.0))
    inertia = curves_with_masses(rod=RigidLink(mass=0.0, inertia=1.0))
    pin = mass + inertia  # a mass of 1 kg at 1 m has both, besides its first moment
    ahead = curves_with_masses(rod=RigidLink(mass=1.0, centre=1.0, inertia=0.0)) - pin
    aside = curves_with_masses(rod=RigidLink(mass=1.0, centre=0.0, centre_across=1.0, inertia=0.0)) - pin
    table = np.stack([bare, axial, lateral, mass, ahead, aside, inertia], axis=-1)
    return table[:2], table[2]


def rms_shaking_rows(mechanism: Mechanism, linkage: Linkage) -> tuple[Array, Array]:
    """Return force and moment rows (7, 7) each; |rows @ (1, x)| is the root mean square over the cycle."""
    kappa = crowding_parameter(float(linkage.crank), float(linkage.rod), float(linkage.offset))
    tau = np.arange(_NODES) * (2.0 * math.pi / _NODES)
    angles = np.array([crank_angle_from_crowded(float(t), kappa) for t in tau])
    weight = kappa / (np.cos(tau) ** 2 + (kappa * np.sin(tau)) ** 2) / _NODES
    force, moment = shaking_rows(mechanism, linkage, angles)
    share = np.sqrt(weight)[:, None]
    weights = np.concatenate([share * force[0], share * force[1]]), share * moment
    reduced: list[Array] = [np.asarray(np.linalg.qr(table, mode="r")) for table in weights]
    return reduced[0], reduced[1]


def with_balance_masses(mechanism: Mechanism, linkage: Linkage, x: Array, radius: float) -> Mechanism:
    """Return the mechanism with its counterweight replaced by one at a radius, m, and with a mass on the rod.

    x: (6,), as in `NAMES`; the rod then becomes a `RigidLink` of that length.
    """
    size = math.hypot(x[0], x[1])
    weight = Counterweight(mass=size / radius, radius=radius, angle=math.atan2(x[1], x[0]) if size else math.pi)
    rod = mechanism.rod
    if x[2] > 0.0:
        mass, along, across, inertia = np.add(_link_moments(rod, float(linkage.rod)), x[2:])
        central = inertia - (along * along + across * across) / mass
        rod = RigidLink(
            mass=float(mass),
            centre=float(along / mass),
            centre_across=float(across / mass),
            inertia=max(0.0, float(central)),
        )
    return replace(mechanism, counterweight=weight, rod=rod)


def _link_moments(link: Link, length: float) -> Array:
    """Return mass, first moments along and across, and inertia of a link about its origin."""
    if isinstance(link, Bar):
        numbers = (link.width, link.depth, link.density, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    else:
        centre = 0.5 * length if link.centre is None else link.centre
        inertia, share = (0.0, 1.0 / 12.0) if link.inertia is None else (link.inertia, 0.0)
        numbers = (0.0, 0.0, 0.0, link.mass, centre, 0.0, link.centre_across, inertia, share)
    return np.array(link_properties(length, *numbers))


def first_moment_of_moving_parts(mechanism: Mechanism, linkage: Linkage) -> float:
    """Return the first moment, kg m, of crank, rod and slider, with the last two at the crank pin."""
    crank = _link_moments(mechanism.crank, float(linkage.crank))
    mass = _link_moments(mechanism.rod, float(linkage.rod))[0] + mechanism.slider_mass
    return float(math.hypot(crank[1], crank[2]) + mass * float(linkage.crank))
