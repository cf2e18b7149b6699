"""Times of outward and inward stroke, at constant speed or along a speed profile.

A stroke takes the integral of d(theta) / |omega| between its dead centres. At constant speed that is its crank angle
over the speed; with omega = speed p(theta) it is the integral of 1 / p instead, over |speed|. Cylinders are alike in
this at constant speed alone: along a profile each has times of its own.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..kinematics import geometry
from ..linkage.linkage import Linkage
from ..machine.mechanism import Mechanism
from ..machine.members import cylinders_of
from ..machine.speed_profile import Profile

_EQUAL = 1e-12  # of their sum: strokes whose times differ by less differ by rounding
DIFFERS = "differs"
"""Slow stroke of cylinders that have not the same one."""


class Strokes(NamedTuple):
    """Times of the strokes times the size of the mean speed, rad: at constant speed their crank angles."""

    outward: Any
    inward: Any

    @property
    def ratio(self) -> Any:
        """Time of the outward stroke over that of the inward one."""
        return self.outward / self.inward


def strokes(mechanism: Mechanism, crank: Any, rod: Any, offset: Any, *, cylinder: int = 0) -> Strokes:
    """Return the strokes of linkages that turn fully, m; complex lengths carry a derivative.

    With e on the open branch the crank turns through pi + b from the outer dead centre counter-clockwise to the inner
    one, b the excess angle, on the crossed branch through pi - b. That way is the inward stroke of a crank that turns
    counter-clockwise, the outward one of a crank that turns clockwise.
    """
    profile = mechanism.speed_profile
    if profile is None:
        between: Any = math.pi + mechanism.sign * geometry.excess_angle(crank, rod, offset)
        turn = 2.0 * math.pi
    else:
        outer, inner = geometry.outer_crank_angle(crank, rod, offset), geometry.inner_crank_angle(crank, rod, offset)
        if mechanism.branch == "crossed":
            outer, inner = math.pi - outer, 3.0 * math.pi - inner
        lead = cylinders_of(mechanism)[cylinder].lead
        between, turn = _elapsed(profile, inner - lead) - _elapsed(profile, outer - lead), profile.elapsed.turn
    return Strokes(turn - between, between) if mechanism.direction > 0.0 else Strokes(between, turn - between)


def with_times_alone(mechanism: Mechanism) -> Mechanism:
    """Return a machine that weighs nothing and whose strokes take the same times."""
    given = mechanism.nominal
    if given.speed_profile is None:
        return Mechanism(speed=given.speed, branch=given.branch)
    own = given.arrangement
    return Mechanism(speed=given.speed, branch=given.branch, speed_profile=given.speed_profile, arrangement=own)


def _elapsed(profile: Profile, crank_angle: Any) -> Any:
    angle = np.asarray(np.real(crank_angle), dtype=np.float64)
    found = profile.elapsed.at(angle)
    if np.iscomplexobj(crank_angle):
        return found + 1j * np.imag(crank_angle) / profile.ratio(angle)
    return found


def time_ratio(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the time of the slower stroke over that of the faster one, of the first cylinder; 1 or more."""
    if mechanism.speed_profile is None:
        return linkage.time_ratio
    linkage.require_full_rotation()
    found = strokes(mechanism, linkage.crank, linkage.rod, linkage.offset).ratio
    return np.asarray(np.maximum(found, 1.0 / found))[()]


def slow_stroke(mechanism: Mechanism, linkage: Linkage) -> NDArray[np.str_]:
    """Return which stroke takes longer: "outward", "inward", "equal", or "differs" where cylinders do so."""
    if mechanism.speed_profile is None:
        return linkage.slow_stroke(direction=mechanism.direction)
    linkage.require_full_rotation()
    found = []
    for cylinder in range(len(cylinders_of(mechanism))):
        own = strokes(mechanism, linkage.crank, linkage.rod, linkage.offset, cylinder=cylinder)
        more = np.asarray((own.outward - own.inward) / (own.outward + own.inward))
        found.append(np.where(more > _EQUAL, "outward", np.where(more < -_EQUAL, "inward", "equal")))
    same = np.all([one == found[0] for one in found], axis=0)
    return np.asarray(np.where(same, found[0], DIFFERS))[()]
