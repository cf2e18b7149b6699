"""Times of the outward and the inward stroke, at constant speed or with a speed profile.

The time of a stroke is the integral of d(theta) / |omega| between its dead centres. At constant speed that is its crank
angle divided by the speed; with omega = speed p(theta), it is the integral of 1 / p divided by |speed|. At constant
speed all cylinders have the same stroke times; with a profile, each cylinder has its own.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..kinematics import geometry
from ..linkage.linkage import Linkage
from ..machine.cylinders_and_turns import machine_of_each_cylinder
from ..machine.mechanism import Mechanism
from ..machine.speed_profile import Profile

_EQUAL = 1e-12  # fraction of their sum: a smaller difference between stroke times is a rounding error
DIFFERS = "differs"
"""Reported instead of a slow stroke if cylinders differ."""


class ScaledStrokeTimes(NamedTuple):
    """Stroke times multiplied by the magnitude of the mean speed, rad; at constant speed, their crank angles."""

    outward: Any
    inward: Any

    @property
    def outward_to_inward_ratio(self) -> Any:
        """Duration of the outward stroke divided by that of the inward stroke."""
        return self.outward / self.inward


def scaled_stroke_times(
    mechanism: Mechanism, crank: Any, rod: Any, offset: Any, *, cylinder: int = 0
) -> ScaledStrokeTimes:
    """Return the scaled stroke times of fully rotating linkages, lengths in m; complex lengths carry a derivative.

    On the open branch the crank turns counter-clockwise through pi + b from the outer to the inner dead centre, where b
    is the excess angle; on the crossed branch, through pi - b. That is the inward stroke if the crank rotates
    counter-clockwise, and the outward stroke if it rotates clockwise.
    """
    profile = mechanism.speed_profile
    if profile is None:
        inward_span: Any = math.pi + mechanism.sign * geometry.excess_stroke_angle(crank, rod, offset)
        turn = 2.0 * math.pi
    else:
        outer, inner = geometry.outer_crank_angle(crank, rod, offset), geometry.inner_crank_angle(crank, rod, offset)
        if mechanism.branch == "crossed":
            outer, inner = math.pi - outer, 3.0 * math.pi - inner
        lead = machine_of_each_cylinder(mechanism)[cylinder].lead
        inward_span = _elapsed_time(profile, inner - lead) - _elapsed_time(profile, outer - lead)
        turn = profile.elapsed_time.elapsed_over_full_turn
    outward, inward = (
        (turn - inward_span, inward_span) if mechanism.direction > 0.0 else (inward_span, turn - inward_span)
    )
    return ScaledStrokeTimes(outward, inward)


def massless_machine(mechanism: Mechanism) -> Mechanism:
    """Return a machine without masses and loads but with the same stroke times."""
    nominal = mechanism.nominal
    if nominal.speed_profile is None:
        return Mechanism(speed=nominal.speed, branch=nominal.branch)
    arrangement = nominal.arrangement
    return Mechanism(
        speed=nominal.speed, branch=nominal.branch, speed_profile=nominal.speed_profile, arrangement=arrangement
    )


def _elapsed_time(profile: Profile, crank_angle: Any) -> Any:
    angle = np.asarray(np.real(crank_angle), dtype=np.float64)
    elapsed = profile.elapsed_time.elapsed_up_to(angle)
    if np.iscomplexobj(crank_angle):
        return elapsed + 1j * np.imag(crank_angle) / profile.speed_ratio(angle)
    return elapsed


def time_ratio(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the duration of the slower stroke divided by that of the faster one, 1 or more.

    With several cylinders, the ratio is that of the first cylinder.
    """
    if mechanism.speed_profile is None:
        return linkage.time_ratio
    linkage.require_full_rotation()
    ratio = scaled_stroke_times(mechanism, linkage.crank, linkage.rod, linkage.offset).outward_to_inward_ratio
    return np.asarray(np.maximum(ratio, 1.0 / ratio))[()]


def slow_stroke(mechanism: Mechanism, linkage: Linkage) -> NDArray[np.str_]:
    """Return which stroke is slower: "outward", "inward", "equal", or "differs" if cylinders differ."""
    if mechanism.speed_profile is None:
        return linkage.slow_stroke(direction=mechanism.direction)
    linkage.require_full_rotation()
    slower = []
    for cylinder in range(len(machine_of_each_cylinder(mechanism))):
        times = scaled_stroke_times(mechanism, linkage.crank, linkage.rod, linkage.offset, cylinder=cylinder)
        difference = np.asarray((times.outward - times.inward) / (times.outward + times.inward))
        slower.append(np.where(difference > _EQUAL, "outward", np.where(difference < -_EQUAL, "inward", "equal")))
    same = np.all([stroke == slower[0] for stroke in slower], axis=0)
    return np.asarray(np.where(same, slower[0], DIFFERS))[()]
