"""Breakpoints for many designs: crank angles that cut each cycle into segments on which every curve is smooth."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..kernel.kernel import Cube, Integers, IntegerTable, Table, kernel
from ..machine.design import design_at
from ..machine.raw_machine_vector import Loads
from .segments import Cuts, CycleWindow, breakpoint_capacity, cut_cycle
from .torque_with_friction import add_guide_force_change_cuts, least_determinacy_margin


class Breakpoints(NamedTuple):
    """Breakpoints (n, k) for n designs in ascending crank angle, of which the first `many` (n,) are valid.

    See `segments.Cuts`.

    A design that friction locks has no breakpoints.
    """

    angle: Table
    code: IntegerTable
    number: Table
    load: IntegerTable
    many: Integers


@kernel
def _fill_breakpoints(blocks: Cube, loads: Loads, watch: CycleWindow, breakpoints: Breakpoints, rubbing: bool) -> None:
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    for n in range(blocks.shape[0]):
        block = blocks[n]
        d = design_at(block, 0)
        breakpoints.many[n] = 0
        if rubbing and not least_determinacy_margin(d) > 0.0:
            continue
        cuts = Cuts(breakpoints.angle[n], breakpoints.code[n], breakpoints.number[n], breakpoints.load[n])
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if rubbing:
            count = add_guide_force_change_cuts(d, block, loads, watch, cuts, count, piece, shift)
        breakpoints.many[n] = count


def breakpoints_of(blocks: Array, loads: Loads, watch: CycleWindow, *, rubbing: bool) -> Breakpoints:
    """Return the breakpoints for designs given by their blocks (n, rows, 1), each rotating fully."""
    shape = len(blocks), breakpoint_capacity(loads)
    breakpoints = Breakpoints(
        np.empty(shape),
        np.empty(shape, np.int64),
        np.empty(shape),
        np.empty(shape, np.int64),
        np.empty(len(blocks), np.int64),
    )
    _fill_breakpoints(blocks, loads, watch, breakpoints, rubbing)
    return breakpoints
