"""Static forces of the massless linkage under a load on the slider, without friction.

Equilibrium of the slider, the rod and the crank under a load P along the slider line, positive outward as for all
loads:

    rod force (compression)      F = -P / |cos(phi)|
    guide on the slider (+y)     N = P tan(phi) on the open branch, -P tan(phi) on the crossed one
    crank torque                 T = -P r (cos(theta) tan(phi) - sin(theta)) on the open branch, P on the crossed one

T is the required drive torque, counter-clockwise. Without offset, with phi' = -phi = asin(r sin(theta) / l) and a load
p = -P towards the crank, F = p / cos(phi'), N = p tan(phi') and T = -p r (sin(theta) + cos(theta) tan(phi')): Eqs. 12
and 13 of the report "In-line Slider Crank Mechanism" (Amrita School of Engineering, 2021).

Mechanical advantage: load on the slider divided by the tangential crank pin force that balances it, r / |x'|. It grows
without bound towards the dead centres, where no crank torque is needed and the advantage is infinite.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..errors import InputError
from ..linkage.linkage import Linkage


@dataclass(frozen=True)
class StaticForces:
    """Arrays of the broadcast shape; SI and radians.

    rod_force: force along the rod, N, positive in compression. guide_reaction: force from the guide on the slider along
    +y, N. crank_torque: required drive torque, N m, counter-clockwise. tangential_force: crank_torque / crank, N.
    mechanical_advantage: magnitude of the load divided by that of the tangential force; `inf` at a dead centre.
    slider_force_per_torque: magnitude of the load divided by that of the crank torque, 1/m; `inf` at a dead centre.
    """

    crank_angle: Array
    load: Array
    rod_force: Array
    guide_reaction: Array
    crank_torque: Array
    tangential_force: Array
    mechanical_advantage: Array
    slider_force_per_torque: Array


def static_forces(linkage: Linkage, crank_angle: ArrayLike, *, load: ArrayLike) -> StaticForces:
    """Return the forces at crank angles, rad, in equilibrium with a load on the slider, N outward; all broadcast.

    The advantage does not depend on the load and is also returned for a zero load. Raises `AssemblyError` where the
    linkage cannot be assembled, `InputError` for a load that is not finite.
    """
    p = np.asarray(load, dtype=np.float64)
    if not np.all(np.isfinite(p)):
        raise InputError("the load on the slider must be finite; give it in N, positive outward")
    at = linkage.at(crank_angle)
    theta, phi = at.crank_angle, at.rod_angle
    tangent = np.tan(phi)
    outward = linkage.sign * p
    arm = linkage.crank * (np.cos(theta) * tangent - np.sin(theta))  # x'
    torque = -outward * arm
    # An angle that differs from a dead centre only by rounding is treated as the dead centre.
    still = np.abs(arm) <= 4.0 * np.finfo(np.float64).eps * (1.0 + np.abs(theta)) * linkage.crank
    with np.errstate(divide="ignore"):
        per_torque = np.where(still, np.inf, 1.0 / np.abs(arm))
    fields = (
        theta,
        p,
        -p / np.abs(np.cos(phi)),
        outward * tangent,
        torque,
        torque / linkage.crank,
        linkage.crank * per_torque,
        per_torque,
    )
    shape = np.broadcast_shapes(*(np.shape(field) for field in fields))
    return StaticForces(*(np.broadcast_to(field, shape) for field in fields))
