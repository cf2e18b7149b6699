"""A cycle of two turns, treated as two machines with one turn each.

The first machine has the loads of the first turn, the second those of the second turn: a 720 deg table is cut at 0 and
360 deg, counted from its datum. A four-stroke engine compresses and burns in the first turn, and exchanges its gas in
the second. Everything else repeats with every turn. So the maximum over the cycle is the larger of the maxima in the
two halves, a mean is the mean of their means, and both are exact. If a half does not close, it jumps at the cut; the
other half has the opposite jump.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array, IntArray
from ..errors import InputError
from .loads.load import Load
from .mechanism import Mechanism
from .memoise import memoise_by_machine
from .varying_numbers import Varying

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
