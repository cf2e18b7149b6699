"""Cylinders on a crankshaft as separate machines, and whether a machine is treated as a shaft.

A machine is treated as a shaft if several cylinders are added up, or if its speed follows a profile. For any other
machine, the formulas of a single crank at constant speed apply.

A cycle of two turns is treated as two machines with one turn each. The first machine has the loads of the first turn,
the second those of the second turn: a 720 deg table is cut at 0 and 360 deg, counted from its datum. A four-stroke
engine compresses and burns in the first turn, and exchanges its gas in the second. Everything else repeats with every
turn. So the maximum over the cycle is the larger of the maxima in the two halves, a mean is the mean of their means,
and both are exact. If a half does not close, it jumps at the cut; the other half has the opposite jump.
"""

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array, IntArray
from ..errors import InputError
from .arrangement import require_one_cylinder
from .loads.load import Load
from .mechanism import Mechanism
from .memoise import memoise_by_machine
from .varying_numbers import Varying


class Member(NamedTuple):
    """A cylinder as a separate machine.

    lead: lead of its crank angle over the shaft angle, rad. bank: rad. place: position along the shaft, m.
    """

    mechanism: Mechanism
    lead: float
    bank: float
    place: float


def has_cylinders_or_speed_profile(mechanism: Mechanism) -> bool:
    """Return whether a machine has individually stated cylinders or a speed profile."""
    return mechanism.arrangement is not None or mechanism.speed_profile is not None


def cylinder_count(mechanism: Mechanism) -> int:
    """Return the number of cylinders on a machine's crankshaft."""
    return 1 if mechanism.arrangement is None else len(mechanism.arrangement.phases)


@memoise_by_machine
def single_cylinder_machine(mechanism: Mechanism) -> Mechanism:
    """Return one cylinder of a machine by itself, at zero bank angle and constant mean speed."""
    return (
        replace(mechanism, arrangement=None, speed_profile=None)
        if has_cylinders_or_speed_profile(mechanism)
        else mechanism
    )


@memoise_by_machine
def machines_of_arrangement(mechanism: Mechanism) -> tuple[Member, ...]:
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


def machine_of_each_cylinder(mechanism: Mechanism) -> tuple[Member, ...]:
    """Return the cylinders of any machine: a machine without an arrangement has only one."""
    return (
        machines_of_arrangement(mechanism)
        if mechanism.arrangement is not None
        else (Member(single_cylinder_machine(mechanism), 0.0, 0.0, 0.0),)
    )


TURN = 2.0 * math.pi


def cycle_turns(mechanism: Mechanism) -> int:
    """Return the number of crank turns in a machine's cycle: 2 if a load has a two-turn cycle."""
    return turns_per_cycle(mechanism.loads)


def turns_per_cycle(loads: Iterable[Load]) -> int:
    """Return the number of crank turns in a cycle with these loads."""
    return max((load.cycle_turns for load in loads), default=1)


@memoise_by_machine
def machines_of_turns(mechanism: Mechanism) -> tuple[Mechanism, ...]:
    """Return the machine of each turn of the cycle: the machine itself if it has one turn.

    Raises `InputError` for loads of two turns with different datums.
    """
    if cycle_turns(mechanism) == 1:
        return (mechanism,)
    _cycle_datum(mechanism)
    return tuple(_machine_of_turn(mechanism, turn) for turn in (1, 2))


def _machine_of_turn(mechanism: Mechanism, turn: int) -> Mechanism:
    loads = mechanism.loads

    def numbers_of_turn(item: Varying) -> Varying:
        """Return the numbers of the loads by their names in that turn."""
        sets = []
        for path, factor in item.sets:
            match = re.fullmatch(r"loads\.(\d+)\.(\w+)", path)
            name = path if match is None else loads[int(match[1])].name_of_number_on_turn(match[2], turn)
            if name is not None:
                sets.append((path if match is None else f"loads.{match[1]}.{name}", factor))
        return replace(item, sets=tuple(sets), idle=not sets)

    varying = tuple(numbers_of_turn(item) for item in mechanism.varying)
    return replace(mechanism, loads=tuple(load.load_on_turn(turn) for load in loads), varying=varying)


def machine_of_first_turn(mechanism: Mechanism) -> Mechanism:
    """Return the machine for the first turn, for results independent of loads that differ between turns."""
    return machines_of_turns(mechanism)[0]


def half_of_cycle_at(mechanism: Mechanism, inner: Any, outer: Any, crank_angle: Array) -> IntArray:
    """Return the half, 0 or 1, that contains crank angles, rad, for dead centres inner and outer; broadcasts."""
    datum = _cycle_datum(mechanism)
    way = 1.0 if datum == "zero crank angle" else mechanism.direction
    start = np.mod({"zero crank angle": 0.0, "inner dead centre": inner, "outer dead centre": outer}[datum], TURN)
    start = np.where(start < TURN, start, 0.0)  # rounding of a tiny negative angle
    return np.asarray(np.mod(np.floor(way * (crank_angle - start) / TURN), 2.0), dtype=np.int64)


def shift_angles_into_half(mechanism: Mechanism, inner: Any, outer: Any, crank_angle: Array, half: Any) -> Array:
    """Return crank angles shifted by whole turns into [0, 4 pi), rad, and into a given half there."""
    angle = np.mod(crank_angle, TURN)
    return np.where(half_of_cycle_at(mechanism, inner, outer, angle) == half, angle, angle + TURN)


def _cycle_datum(mechanism: Mechanism) -> str:
    datums = {load.cycle_datum for load in mechanism.loads if load.cycle_turns > 1}
    if len(datums) != 1:
        raise InputError(
            "loads with a cycle of 720 deg must all be measured from one datum; got "
            f"{' and '.join(sorted(datums)) or 'none'}; convert the angles of one of them"
        )
    return datums.pop()


def require_one_turn(mechanism: Mechanism, subject: str) -> None:
    """Raise an error for a two-turn cycle if an analysis covers only one turn. subject: the analysis."""
    if cycle_turns(mechanism) > 1:
        raise InputError(
            f"{subject} needs a cycle of 360 deg; got a load with one of 720 deg; leave that load out, or state it "
            "for one turn"
        )
