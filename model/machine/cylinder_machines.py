"""Cylinders on a crankshaft as separate machines, and whether a machine is treated as a shaft.

A machine is treated as a shaft if several cylinders are added up, or if its speed follows a profile. For any other
machine, the formulas of a single crank at constant speed apply.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

from ..errors import InputError
from .arrangement import require_one_cylinder
from .mechanism import Mechanism
from .memoise import memoise_by_machine


class Member(NamedTuple):
    """A cylinder as a separate machine.

    lead: lead of its crank angle over the shaft angle, rad. bank: rad. place: position along the shaft, m.
    """

    mechanism: Mechanism
    lead: float
    bank: float
    place: float


def is_treated_as_shaft(mechanism: Mechanism) -> bool:
    """Return whether a machine has individually stated cylinders or a speed profile."""
    return mechanism.arrangement is not None or mechanism.speed_profile is not None


def cylinder_count(mechanism: Mechanism) -> int:
    """Return the number of cylinders on a machine's crankshaft."""
    return 1 if mechanism.arrangement is None else len(mechanism.arrangement.phases)


@memoise_by_machine
def single_cylinder(mechanism: Mechanism) -> Mechanism:
    """Return one cylinder of a machine by itself, at zero bank angle and constant mean speed."""
    return replace(mechanism, arrangement=None, speed_profile=None) if is_treated_as_shaft(mechanism) else mechanism


@memoise_by_machine
def member_machines(mechanism: Mechanism) -> tuple[Member, ...]:
    """Return the cylinders of a machine, each as a separate machine. Raises `InputError` if it has no arrangement.

    Gravity is rotated into the axes of each bank; varying gravity keeps its values.
    """
    arrangement = mechanism.arrangement
    if arrangement is None:
        raise InputError(
            "this needs a machine with several cylinders; got none; for example, add [mechanism] cylinders = { "
            'phases = ["0 deg", "180 deg"] }'
        )
    cylinders = []
    x, y = mechanism.gravity
    for k in range(len(arrangement.phases)):
        bank = arrangement.bank_angle(k)
        c, s = math.cos(bank), math.sin(bank)
        turned = (x, y) if bank == 0.0 else (c * x + s * y, c * y - s * x)
        cylinder = replace(mechanism, arrangement=None, speed_profile=None, gravity=turned)
        cylinders.append(Member(cylinder, arrangement.lead_over_slider_line(k), bank, arrangement.shaft_position(k)))
    return tuple(cylinders)


def require_single_cylinder_at_constant_speed(mechanism: Mechanism, subject: str) -> None:
    """Raise an error for several cylinders or a speed profile if an analysis covers neither. subject: the analysis."""
    require_one_cylinder(mechanism.arrangement, subject)
    if mechanism.speed_profile is not None:
        raise InputError(
            f"{subject} needs a constant crank speed; got a speed profile, "
            f"{mechanism.speed_profile.description}; leave out speed_profile"
        )


def cylinder_machines(mechanism: Mechanism) -> tuple[Member, ...]:
    """Return the cylinders of any machine: a machine without an arrangement has only one."""
    return (
        member_machines(mechanism)
        if mechanism.arrangement is not None
        else (Member(single_cylinder(mechanism), 0.0, 0.0, 0.0),)
    )
