"""Peaks of a curve over the cycle, to machine precision, with exact gradients.

Each segment between breakpoints (`segments`) is sampled at crowded angles. Every local maximum (for a single peak:
those near the highest) is then bracketed. A safeguarded secant iteration refines it on the slope, which the complex
step gives exactly. A breakpoint is a peak too when the curve has a kink or a jump there. The derivative of a peak by a
design variable is the partial derivative at the peak angle (envelope theorem); a peak on a breakpoint moves with it,
which the complex step carries along.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..dynamics.contact import cut_contacts, rubs, shift_of, sides_of
from ..dynamics.rubbing import always_drives
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    angle_within,
    breakpoint_capacity,
    crowded,
    crowding,
    cut_cycle,
    enter,
    load_on_slider,
    uncrowded,
)
from ..kernel.arithmetic import STEP, analytic
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import ComplexCube, Cube, Table, kernel
from ..machine.derived import derived
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.members import is_shaft
from ..machine.numbers import numbers_of
from ..machine.raw import Loads
from ..machine.two_turns import cycle_turns, halves
from .shaft_statistics import equivalent_single_cranks, highest_peaks, shaft_signal_peaks
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal, design_motion, signal
from .two_turns import highest

ANGLES = 128
"""Sampled angles per turn. Alone they miss the higher of two close peaks on 3 of 750,000 random machines with all kinds
of loads (64 angles: on 19), with errors up to 2e-4; hence the finer row of samples around near-highest tops."""
_FINER, _NEAR = 16, 0.95  # samples of that row, and how near the highest a sample must be to get one
_HOPELESS = 0.8
"""Fraction of the highest sample below which no sample is followed if one peak is requested. Of a million random peaks
of all signals, on machines with all loads, long tables, cylinders and friction, none was lost."""
STORED_PEAKS = 6
"""Peaks stored per design, highest first."""
_ITERATIONS = 60
_TURN = 2.0 * math.pi
_CONTINUOUS = 1e-11  # relative difference below which the two sides of a breakpoint count as continuous
_FLAT = 1e-13
_SAME = 1e-7  # rad: a flat top is not located better
_SHORTEST = 1e-13  # rad: breakpoints closer than this are one


@dataclass(frozen=True)
class Peaks:
    """Local peaks of n designs, highest first.

    values: (n, k), SI, -inf beyond the last peak; where friction locks the design one peak of +inf, at no angle (NaN).
    angles: (n, k), crank angles in [0, 2 pi), rad; in [0, 4 pi) for a cycle of two turns.
    gradients: (n, k, v), by the design variables; None unless asked for.
    """

    values: Array
    angles: Array
    gradients: Array | None


@analytic
def _value(
    kind: Any, theta: Any, d: Any, block: Any, j: Any, outward: Any, loads: Any, piece: Any, shift: Any, sides: Any
) -> Any:
    sine, cosine = math.sin(theta), math.cos(theta)
    m = design_motion(sine, cosine, d)
    load = load_on_slider(m, d, block, j, theta, outward, loads, piece, shift)
    return signal(kind, sine, cosine, m, d, load, sides, (block, j, theta, loads, piece, shift))


@analytic
def _slope(
    kind: Any, theta: Any, d: Any, block: Any, j: Any, outward: Any, loads: Any, piece: Any, shift: Any, sides: Any
) -> Any:
    """Value and slope over crank angle."""
    sine, cosine = math.sin(theta), math.cos(theta)
    s, c = complex(sine, cosine * STEP), complex(cosine, -sine * STEP)
    m = design_motion(s, c, d)
    at = complex(theta, STEP)
    load = load_on_slider(m, d, block, j, at, outward, loads, piece, shift)
    z = signal(kind, s, c, m, d, load, sides, (block, j, at, loads, piece, shift))
    return z.real, z.imag / STEP


@analytic
def _refine(
    kind: Any,
    a: Any,
    b: Any,
    start: Any,
    d: Any,
    block: Any,
    j: Any,
    outward: Any,
    loads: Any,
    piece: Any,
    shift: Any,
    sides: Any,
) -> Any:
    """Highest point found in (a, b): a root of the slope by secants, bisecting whenever a secant leaves the bracket."""
    theta = at = old_theta = start
    best = old_slope = 0.0
    for i in range(_ITERATIONS):
        value, slope = _slope(kind, theta, d, block, j, outward, loads, piece, shift, sides)
        # On the flat top values differ by rounding only: there the later angle is the better one.
        if i == 0 or value >= best - _FLAT * best:
            best, at = value, theta
        if slope > 0.0:
            a = theta
        elif slope < 0.0:
            b = theta
        else:
            break
        trial = 0.5 * (a + b)
        if i > 0 and slope != old_slope:
            secant = theta - slope * (theta - old_theta) / (slope - old_slope)
            if a < secant < b:
                trial = secant
        old_theta, old_slope = theta, slope
        if abs(trial - theta) < 4e-16 * _TURN or b - a < 1e-15:
            break
        theta = trial
    return best, at


@analytic
def _divide(
    kind: Any,
    a: Any,
    b: Any,
    d: Any,
    block: Any,
    j: Any,
    outward: Any,
    loads: Any,
    piece: Any,
    shift: Any,
    sides: Any,
) -> Any:
    """Sample a finer row between a and b: value and angle of its highest sample, and the spacing."""
    step = (b - a) / _FINER
    best, at = -1.0, a
    for i in range(1, _FINER):
        value = _value(kind, a + i * step, d, block, j, outward, loads, piece, shift, sides)
        if value > best:
            best, at = value, a + i * step
    return best, at, step


@analytic
def _is_listed(angles: Any, count: Any, theta: Any) -> bool:
    """Whether a peak at that angle is in the list."""
    listed = False
    for i in range(count):
        listed = listed or abs(angles[i] - theta) < _SAME
    return listed


@analytic
def _keep(values: Any, angles: Any, segment: Any, pin: Any, count: Any, value: Any, theta: Any, s: Any, p: Any) -> Any:
    """Insert a peak into the lists, highest first; if they are full, drop the lowest."""
    capacity = values.shape[0]
    if count == capacity and value <= values[capacity - 1]:
        return count
    i = min(count, capacity - 1)
    while i > 0 and values[i - 1] < value:
        values[i], angles[i], segment[i], pin[i] = values[i - 1], angles[i - 1], segment[i - 1], pin[i - 1]
        i -= 1
    values[i], angles[i], segment[i], pin[i] = value, theta, s, p
    return min(count + 1, capacity)


@kernel
def _find(
    kind: int,
    blocks: Cube,
    steps: ComplexCube,
    loads: Loads,
    watch: CycleWindow,
    angles: int,
    values: Table,
    peak_angles: Table,
    gradients: Cube,
    rubbing: bool,
) -> None:
    capacity = breakpoint_capacity(loads)
    cuts = Cuts(
        np.empty(capacity),
        np.empty(capacity, np.int64),
        np.empty(capacity),
        np.empty(capacity, np.int64),
    )
    piece = np.zeros(loads.kind.shape[0], np.int64)
    shift = np.zeros(loads.kind.shape[0])
    nv = gradients.shape[2] if gradients.shape[0] else 0
    listed = values.shape[1]
    peak, at = np.empty(listed), np.empty(listed)
    segment, pin = np.empty(listed, np.int64), np.empty(listed, np.int64)
    edge = np.empty((capacity, 4))  # value and slope at the start and end of each segment
    counts, is_negligible = np.empty(capacity, np.bool_), np.empty(capacity, np.bool_)
    theta = np.empty(angles + 8 + 5 * capacity)  # samples of all segments, one after another
    f = np.empty(theta.shape[0])
    first = np.empty(capacity + 1, np.int64)  # index at which the samples of each segment begin
    for n in range(blocks.shape[0]):
        block = blocks[n]
        d = design_at(block, 0)
        kappa = crowding(d.r, d.l, d.e)
        if rubbing and not always_drives(d) > 0.0:
            values[n, :], values[n, 0], peak_angles[n, :] = -np.inf, np.inf, np.nan
            if nv:
                gradients[n] = 0.0
            continue
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if rubbing:
            count = cut_contacts(d, block, 0, loads, watch, cuts, count, piece, shift)
        cuts.angle[count] = cuts.angle[0] + _TURN
        # First sample all segments: for a single peak, low segments need nothing more.
        highest = -1.0
        first[0] = 0
        has_motion = False
        sine, cosine = 0.0, 1.0
        m = design_motion(sine, cosine, d)
        for s in range(count):
            a, b = cuts.angle[s], cuts.angle[s + 1]
            first[s + 1] = first[s]
            is_negligible[s] = b - a < _SHORTEST
            probe = angle_within(a, b)
            counts[s], outward = enter(d, block, 0, probe, loads, watch, piece, shift)
            if is_negligible[s] or not counts[s]:
                has_motion = False
                continue
            sides = sides_of(probe, d, block, 0, outward, loads, piece, shift, rubbing)
            # A segment shorter than the spacing, such as between knots of a long table, has no samples of its own: the
            # slopes at its ends show whether it has a peak.
            low = high = 0.0
            points = 2
            if angles * (b - a) > 0.99 * kappa * _TURN:  # the spacing is nowhere less than kappa times that of tau
                low, high = crowded(a, kappa), crowded(b, kappa)
                spacings = int(angles * (high - low) / _TURN)
                points = min(angles + 8, max(5, spacings + 2)) if spacings > 0 else 2
            start = first[s]
            first[s + 1] = start + points
            theta[start], theta[start + points - 1] = a, b
            for i in range(1, points - 1):
                theta[start + i] = uncrowded(low + (high - low) * i / (points - 1), kappa)
            for i in range(0 if listed == 1 else 1, points if listed == 1 else points - 1):
                at_angle = theta[start + i]
                if i > 0 or not has_motion:  # otherwise at the end of the previous segment
                    sine, cosine = math.sin(at_angle), math.cos(at_angle)
                    m = design_motion(sine, cosine, d)
                load = load_on_slider(m, d, block, 0, at_angle, outward, loads, piece, shift)
                place = (block, 0, at_angle, loads, piece, shift)
                value = signal(kind, sine, cosine, m, d, load, sides, place)
                f[start + i], highest = value, max(highest, value)
            has_motion = listed == 1
        floor = _HOPELESS * highest if listed == 1 else -1.0
        peak_count = 0
        best, best_at, best_segment = -1.0, 0.0, -1
        for s in range(count):
            if is_negligible[s] or not counts[s]:
                continue
            a, b, start, end = cuts.angle[s], cuts.angle[s + 1], first[s], first[s + 1] - 1
            hopeful = listed > 1
            for i in range(start, end + 1 if listed == 1 else start):
                hopeful = hopeful or not f[i] < floor
            if not hopeful:
                edge[s, :] = -1.0
                continue
            probe = angle_within(a, b)
            _, outward = enter(d, block, 0, probe, loads, watch, piece, shift)
            sides = sides_of(probe, d, block, 0, outward, loads, piece, shift, rubbing)
            for side in range(2):
                value, slope = _slope(kind, b if side else a, d, block, 0, outward, loads, piece, shift, sides)
                edge[s, 2 * side], edge[s, 2 * side + 1] = value, slope
            f[start], f[end] = edge[s, 0], edge[s, 2]
            for i in range(start, end + 1):
                if f[i] > best:
                    best, best_at, best_segment = f[i], theta[i], s
            for i in range(start, end + 1):
                if f[i] < floor:
                    continue
                if i == start:
                    top = edge[s, 1] > 0.0 and f[i] >= f[i + 1]
                elif i == end:
                    top = edge[s, 3] < 0.0 and f[i] >= f[i - 1]
                else:
                    top = f[i] >= f[i - 1] and f[i] > f[i + 1]
                if not top:
                    continue
                left, right, angle = theta[max(i - 1, start)], theta[min(i + 1, end)], theta[i]
                # One call serves both rows, as the compiler inlines each call separately.
                for finer in range(2):
                    value, angle = _refine(kind, left, right, angle, d, block, 0, outward, loads, piece, shift, sides)
                    # A finer row that rises to the very end of the segment has no top; the breakpoint may be one.
                    if (finer == 0 or a + _SAME < angle < b - _SAME) and not _is_listed(at, peak_count, angle):
                        peak_count = _keep(peak, at, segment, pin, peak_count, value, angle, s, -1)
                    if finer == 1 or not f[i] > _NEAR * best:
                        break
                    left, right = theta[max(i - 2, start)], theta[min(i + 2, end)]
                    finest, angle, step = _divide(kind, left, right, d, block, 0, outward, loads, piece, shift, sides)
                    if not finest > value + _FLAT * value:
                        break
                    left, right = max(left, angle - step), min(right, angle + step)
        for s in range(count):
            if is_negligible[s]:
                continue
            # The breakpoint between segment `before` and segment s; between the two, breakpoints may coincide.
            before = s - 1 if s > 0 else count - 1
            while is_negligible[before]:
                before = before - 1 if before > 0 else count - 1
            after = counts[s]
            left = edge[before, 2] if counts[before] else -1.0
            right = edge[s, 0] if after else -1.0
            tolerance = _CONTINUOUS * max(left, right)
            if counts[before] and left >= right - tolerance and edge[before, 3] >= 0.0:
                if left > right + tolerance or edge[s, 1] <= 0.0:
                    peak_count = _keep(peak, at, segment, pin, peak_count, left, cuts.angle[s], before, s)
            elif after and right > left + tolerance and edge[s, 1] <= 0.0:
                peak_count = _keep(peak, at, segment, pin, peak_count, right, cuts.angle[s], s, s)
        if peak_count == 0 and best_segment >= 0:  # a constant curve
            peak_count = _keep(peak, at, segment, pin, peak_count, best, best_at, best_segment, -1)
        for i in range(listed):
            if i >= peak_count:
                values[n, i], peak_angles[n, i] = -np.inf, np.nan
                for v in range(nv):
                    gradients[n, i, v] = 0.0
                continue
            values[n, i] = peak[i]
            turned = at[i] - _TURN * math.floor(at[i] / _TURN)
            peak_angles[n, i] = turned if turned < _TURN else 0.0  # rounding, for an angle just below zero
            s = segment[i]
            probe = angle_within(cuts.angle[s], cuts.angle[s + 1])
            _, outward = enter(d, block, 0, probe, loads, watch, piece, shift)
            sides = sides_of(probe, d, block, 0, outward, loads, piece, shift, rubbing)
            # A breakpoint at the end of the last segment lies a turn ahead of its list entry.
            angle = at[i] if pin[i] < 0 or pin[i] == s else cuts.angle[s + 1]
            sine, cosine = math.sin(angle), math.cos(angle)
            for v in range(nv):
                stepped = steps[n * nv + v]
                z = design_at(stepped, 0)
                slip = 0.0
                if pin[i] >= 0:
                    slip = shift_of(z, stepped, d, block, angle, cuts, pin[i], outward, loads, piece, shift, sides)
                zs, zc = complex(sine, cosine * slip), complex(cosine, -sine * slip)
                m = design_motion(zs, zc, z)
                moved = complex(angle, slip)
                load = load_on_slider(m, z, stepped, 0, moved, outward, loads, piece, shift)
                place = (stepped, 0, moved, loads, piece, shift)
                gradients[n, i, v] = signal(kind, zs, zc, m, z, load, sides, place).imag / STEP


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

    The k further columns are the values of the machine's varying numbers.

    during: stroke that restricts the torque search, "outward stroke" or "inward stroke"; the position error counts over
    the window of the mechanism's tolerances. limit: peaks returned per design. angles: samples per turn.
    `shaft_statistics` describes how several cylinders and a speed profile count.
    """
    designs = turning(designs)
    if is_shaft(mechanism) or kind is Signal.ROCKING_COUPLE:
        parts = [
            find_peaks(crank, kind, designs, during=during, gradients=gradients, limit=limit, angles=angles)
            for crank in equivalent_single_cranks(mechanism, kind)
        ]
        if parts:
            return Peaks(*highest_peaks([(part.values, part.angles, part.gradients) for part in parts]))
        return Peaks(*shaft_signal_peaks(mechanism, kind, designs, during=during, gradients=gradients, limit=limit))
    if kind.needs_forces and cycle_turns(mechanism) > 1:
        first, second = (
            find_peaks(half, kind, designs, during=during, gradients=gradients, limit=limit, angles=angles)
            for half in halves(mechanism)
        )
        return Peaks(*highest(mechanism, designs, first, second))
    n = len(designs)
    values, peak_angles = np.empty((n, limit)), np.empty((n, limit))
    raw, loads = signal_inputs(mechanism, kind)
    numbers = numbers_of(mechanism, designs, limit=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes = np.empty((n if gradients else 0, limit, len(columns)))
    watch = cycle_window(mechanism, kind, during=during)
    rubbing = kind.needs_forces and rubs(mechanism)

    def work(begin: int, end: int) -> None:
        blocks, steps = derived(raw, loads, columns, designs[begin:end], steps=gradients)
        _find(
            int(kind),
            blocks,
            steps,
            loads,
            watch,
            angles,
            values[begin:end],
            peak_angles[begin:end],
            slopes[begin:end] if gradients else slopes,
            rubbing,
        )

    in_chunks(n, work, knots=len(loads.at))
    return Peaks(values, peak_angles, numbers.chain(slopes) if gradients else None)
