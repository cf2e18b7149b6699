"""Curves of many levers at many places of their motion: one kernel for swings and one for full turns.

Complex throughout, for derivatives by complex steps.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..kernel.arithmetic import analytic, inverse, magnitude
from ..kernel.kernel import ComplexTable, Integers, Row, Table, rarely_used_kernel
from .crank_turn_state import TurnState, turn_state
from .lever_state import LeverNumbers, LeverState, state_in_swing, vector_length

Complexes = NDArray[np.complex128]

CURVES_OF_SWING = (
    *("push", "pull", "buckling_share", "push_power", "pull_power", "speed"),
    *("pin", "pivot", "cylinder_pivot", "angle_error"),
)
"""Curves of a swing by their codes, with the friction of the seal: both ways together."""
CURVES_OF_TURN = (
    *("torque_up", "torque_down", "arm_speed_ratio", "arm_speed", "arm_rise_ratio", "arm_fall_ratio", "arm_rise"),
    *("arm_fall", "sliding_speed", "ram_speed", "pin", "pivot", "cylinder_pivot", "torque_over_place"),
)
"""Curves of a full turn by their codes; the last one is the square of the torque times d(crank angle) / d(place)."""


@analytic
def curve_of_swing(code: int, c: LeverNumbers, s: LeverState) -> Any:
    """Return the value of a curve of a swing."""
    if code == 0:
        return c.rub + s.push
    if code == 1:
        return c.rub - s.push
    if code == 2:
        return (c.rub + s.push) * s.length * s.length * inverse(c.buckling)
    if code == 3:
        return (c.rub + s.push) * magnitude(s.speed)
    if code == 4:
        return (c.rub - s.push) * magnitude(s.speed)
    if code == 5:
        return magnitude(s.speed)
    if code == 6:
        return vector_length(s.pin)
    if code == 7:
        return vector_length(s.pivot)
    if code == 8:
        return vector_length(s.cylinder_pivot)
    return 1.0 * s.angle_error


@analytic
def curve_of_turn(code: int, c: LeverNumbers, s: TurnState) -> Any:
    """Return the value of a curve of a full turn."""
    if code == 0:
        return 1.0 * s.torque
    if code == 1:
        return -s.torque
    if code == 2:
        return magnitude(s.turn_1)
    if code == 3:
        return magnitude(s.turn_1 * c.speed)
    if code == 4:
        return 1.0 * s.turn_2
    if code == 5:
        return -s.turn_2
    if code == 6:
        return s.turn_2 * c.speed * c.speed
    if code == 7:
        return -s.turn_2 * c.speed * c.speed
    if code == 8:
        return magnitude(s.length_1 * c.speed)
    if code == 9:
        return magnitude(s.ram_1 * c.speed)
    if code == 10:
        return vector_length(s.pin)
    if code == 11:
        return vector_length(s.pivot)
    if code == 12:
        return vector_length(s.cylinder_pivot)
    return s.torque * s.torque * s.stretch


# Written out when the module is loaded, because numba does not accept an array row as a tuple.
_FIELDS = ", ".join(f"table[row, {place}]" for place in range(len(LeverNumbers._fields)))
numbers_at: Any = analytic(eval(f"lambda table, row: LeverNumbers({_FIELDS})"))
"""Row of a table as `LeverNumbers`."""


@rarely_used_kernel
def fill_curves_of_swing(
    numbers: ComplexTable,
    law: int,
    table: Table,
    lever: Integers,
    curve: Integers,
    place: ComplexTable,
    probe: Row,
    out: ComplexTable,
) -> None:
    """Fill the curves (p, k) of levers (p,) at time fractions (p, k); probe (p,): between the same corners."""
    for p in range(place.shape[0]):
        c = numbers_at(numbers, lever[p])
        for k in range(place.shape[1]):
            state = state_in_swing(c, law, table, place[p, k], probe[p])
            out[p, k] = curve_of_swing(curve[p], c, state)


@rarely_used_kernel
def fill_curves_of_turn(
    numbers: ComplexTable, lever: Integers, curve: Integers, place: ComplexTable, probe: Row, out: ComplexTable
) -> None:
    """Fill the curves (p, k) of levers (p,) at places (p, k) in their turns; probe (p,): same piece."""
    for p in range(place.shape[0]):
        c = numbers_at(numbers, lever[p])
        for k in range(place.shape[1]):
            out[p, k] = curve_of_turn(curve[p], c, turn_state(c, place[p, k], probe[p]))
