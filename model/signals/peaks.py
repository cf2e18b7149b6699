"""Peaks of a curve over the cycle for many designs, with exact gradients: one turn, two turns, a crankshaft."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..dynamics.torque_with_friction import needs_friction_kernel
from ..kernel.batches import require_full_rotation, run_in_chunks
from ..machine.cylinders_and_turns import cycle_turns, has_cylinders_or_speed_profile, machines_of_turns
from ..machine.derived_designs import derived_blocks
from ..machine.mechanism import Mechanism
from ..machine.raw_numbers_of_designs import raw_machine_numbers
from .shaft_statistics import equivalent_single_cranks, merge_highest_peaks, shaft_signal_peaks
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal
from .turn_peaks import TurnTask, find_turn_peaks
from .two_turn_peaks import highest_peaks_of_both_turns

ANGLES = 128
"""Sampled angles per turn. Alone, they miss the higher of two close peaks on 3 of 750,000 random machines with all
kinds of loads (64 angles: on 19), with errors up to 2e-4; hence the finer row of samples around near-highest peaks."""
STORED_PEAKS = 6
"""Peaks stored per design, highest first."""


@dataclass(frozen=True)
class Peaks:
    """Local peaks for n designs, highest first.

    values: (n, k), SI, -inf beyond the last peak; if friction locks the design, one peak of +inf without an angle
    (NaN). angles: (n, k), crank angles in [0, 2 pi), rad; in [0, 4 pi) for a two-turn cycle. gradients: (n, k, v), by
    the design variables; None unless requested.
    """

    values: Array
    angles: Array
    gradients: Array | None


def find_peaks(
    mechanism: Mechanism,
    kind: Signal,
    designs: Array,
    *,
    during: str = "cycle",
    gradients: bool = False,
    limit: int = STORED_PEAKS,
    angles: int = ANGLES,
) -> Peaks:
    """Return the local peaks of a signal for designs (n, 3 + k): crank, rod, offset, m, each rotating fully.

    The k additional columns are the values of the machine's variables.

    during: stroke to which the torque search is limited, "outward stroke" or "inward stroke"; the position error counts
    over the window in the mechanism's tolerances. limit: peaks returned per design. angles: samples per turn.
    `shaft_statistics` describes how several cylinders and a speed profile are included.
    """
    designs = require_full_rotation(designs)
    if has_cylinders_or_speed_profile(mechanism) or kind is Signal.ROCKING_COUPLE:
        parts = [
            find_peaks(crank, kind, designs, during=during, gradients=gradients, limit=limit, angles=angles)
            for crank in equivalent_single_cranks(mechanism, kind)
        ]
        if parts:
            return Peaks(*merge_highest_peaks([(part.values, part.angles, part.gradients) for part in parts]))
        return Peaks(*shaft_signal_peaks(mechanism, kind, designs, during=during, gradients=gradients, limit=limit))
    if kind.needs_forces and cycle_turns(mechanism) > 1:
        first, second = (
            find_peaks(half, kind, designs, during=during, gradients=gradients, limit=limit, angles=angles)
            for half in machines_of_turns(mechanism)
        )
        return Peaks(*highest_peaks_of_both_turns(mechanism, designs, first, second))
    n = len(designs)
    values, peak_angles = np.empty((n, limit)), np.empty((n, limit))
    raw, loads = signal_inputs(mechanism, kind)
    numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes = np.empty((n if gradients else 0, limit, len(columns)))
    rubbing = kind.needs_forces and needs_friction_kernel(mechanism)
    task = TurnTask(int(kind), loads, cycle_window(mechanism, kind, during=during), angles, rubbing)

    def work(begin: int, end: int) -> None:
        blocks, steps = derived_blocks(raw, loads, columns, designs[begin:end], steps=gradients)
        part = slice(begin, end)
        find_turn_peaks(task, blocks, steps, values[part], peak_angles[part], slopes[part] if gradients else slopes)

    run_in_chunks(n, work, knots=len(loads.knots))
    return Peaks(values, peak_angles, numbers.gradients_by_design_numbers(slopes) if gradients else None)
