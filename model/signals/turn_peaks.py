"""Peaks of a curve over the cycle, to machine precision, with exact gradients.

Each segment between breakpoints (`segments`) is sampled at crowded angles. Every local maximum (for a single peak: each
one near the highest) is then bracketed. A safeguarded secant iteration refines it using the slope, which the complex
step gives exactly. A breakpoint is also a peak if the curve has a kink or a jump there. The derivative of a peak
with respect to a design variable is the partial derivative at the peak angle (envelope theorem); a peak at a breakpoint
moves with it, and the complex step includes this.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    Segment,
    angle_identifying_segment,
    breakpoint_capacity,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
    cut_cycle,
    find_segment_pieces,
)
from ..dynamics.torque_with_friction import (
    Sides,
    add_guide_force_change_cuts,
    cut_imaginary_shift,
    friction_signs_in_segment,
    least_determinacy_margin,
)
from ..kernel.arithmetic import STEP, analytic
from ..kernel.kernel import ComplexCube, Cube, Flags, Integers, Row, Table, kernel
from ..machine.design import Design, design_at
from ..machine.raw_machine_vector import Loads
from .signals import design_motion, signal_in_segment

_FINER, _NEAR = 16, 0.95  # samples in that row, and how close to the highest a sample must be to get one
_HOPELESS = 0.8
"""Fraction of the highest sample below which no sample is followed if a single peak is requested. No peak was lost
among a million random peaks of all signals, on machines with all loads, long tables, cylinders and friction."""
_ITERATIONS = 60
_TURN = 2.0 * math.pi
_CONTINUOUS = 1e-11  # relative difference below which the curve is continuous at a breakpoint
_FLAT = 1e-13
_SAME = 1e-7  # rad: a flat top cannot be located more accurately
_SHORTEST = 1e-13  # rad: breakpoints closer than this count as one


class _Curve(NamedTuple):
    """A signal of one design within a segment. sides: signs of the sliding there."""

    kind: int
    d: Design
    segment: Segment
    sides: Sides


class TurnTask(NamedTuple):
    """A signal of a machine, with the number of sampled angles per turn. rubbing: whether friction is included."""

    kind: int
    loads: Loads
    watch: CycleWindow
    angles: int
    rubbing: bool


class _Tops(NamedTuple):
    """Lists of peaks, highest first. pin: the breakpoint at which a peak lies, -1 if there is none."""

    value: Row
    angle: Row
    segment: Integers
    pin: Integers


class _Workspace(NamedTuple):
    """Work space for one design.

    piece, shift: those of the tables. counts, negligible: whether a segment counts, or is empty. edge: value and slope
    at start and end of each segment. starts: where the samples of each segment begin. theta, value: samples in all
    segments.
    """

    cuts: Cuts
    piece: Integers
    shift: Row
    counts: Flags
    negligible: Flags
    edge: Table
    starts: Integers
    theta: Row
    value: Row
    tops: _Tops


@analytic
def _value_and_slope(theta: Any, curve: _Curve) -> Any:
    """Value and slope over the crank angle."""
    sine, cosine = math.sin(theta), math.cos(theta)
    s, c = complex(sine, cosine * STEP), complex(cosine, -sine * STEP)
    m = design_motion(s, c, curve.d)
    z = signal_in_segment(curve.kind, complex(theta, STEP), s, c, m, curve.d, curve.segment, curve.sides)
    return z.real, z.imag / STEP


@analytic
def _refine_peak(a: Any, b: Any, start: Any, curve: _Curve) -> Any:
    """Highest point found in (a, b): a root of the slope by secants, bisecting whenever a secant leaves the bracket."""
    theta = at = old_theta = start
    best = old_slope = 0.0
    for i in range(_ITERATIONS):
        value, slope = _value_and_slope(theta, curve)
        # On a flat top values differ only by rounding errors; the later angle is then the better one.
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
def _highest_point_between(a: Any, b: Any, curve: _Curve) -> Any:
    """Sample a finer row between a and b; return value and angle of its highest sample, and the spacing."""
    step = (b - a) / _FINER
    best, at = -1.0, a
    for i in range(1, _FINER):
        theta = a + i * step
        sine, cosine = math.sin(theta), math.cos(theta)
        m = design_motion(sine, cosine, curve.d)
        value = signal_in_segment(curve.kind, theta, sine, cosine, m, curve.d, curve.segment, curve.sides)
        if value > best:
            best, at = value, theta
    return best, at, step


@analytic
def _is_listed(angles: Any, count: Any, theta: Any) -> bool:
    """Whether a peak at that angle is in the list."""
    listed = False
    for i in range(count):
        listed = listed or abs(angles[i] - theta) < _SAME
    return listed


@analytic
def _insert_peak(tops: _Tops, count: int, value: float, theta: float, s: int, p: int) -> int:
    """Insert a peak into the lists, highest first; if they are full, drop the lowest. Return their new length."""
    capacity: int = tops.value.shape[0]
    if count == capacity and value <= tops.value[capacity - 1]:
        return count
    i = min(count, capacity - 1)
    while i > 0 and tops.value[i - 1] < value:
        tops.value[i], tops.angle[i] = tops.value[i - 1], tops.angle[i - 1]
        tops.segment[i], tops.pin[i] = tops.segment[i - 1], tops.pin[i - 1]
        i -= 1
    tops.value[i], tops.angle[i], tops.segment[i], tops.pin[i] = value, theta, s, p
    return min(count + 1, capacity)


@analytic
def _sample_segments(task: TurnTask, d: Design, block: Any, count: int, workspace: _Workspace) -> float:
    """Sample all segments of a design for a single peak, else prepare the samples; return the highest value."""
    cuts, theta, kappa = workspace.cuts, workspace.theta, crowding_parameter(d.r, d.l, d.e)
    single = workspace.tops.value.shape[0] == 1
    highest, has_motion = -1.0, False
    sine, cosine = 0.0, 1.0
    m = design_motion(sine, cosine, d)
    workspace.starts[0] = 0
    for s in range(count):
        a, b = cuts.angle[s], cuts.angle[s + 1]
        start = workspace.starts[s]
        workspace.starts[s + 1] = start
        workspace.negligible[s] = b - a < _SHORTEST
        probe = angle_identifying_segment(a, b)
        workspace.counts[s], outward = find_segment_pieces(
            d, block, 0, probe, task.loads, task.watch, workspace.piece, workspace.shift
        )
        if workspace.negligible[s] or not workspace.counts[s]:
            has_motion = False
            continue
        segment = Segment(block, task.loads, outward, workspace.piece, workspace.shift)
        sides = friction_signs_in_segment(probe, d, segment, task.rubbing)
        # A segment shorter than the spacing, such as between knots of a long table, has no samples of its own; the
        # slopes at its ends show whether it contains a peak.
        low = high = 0.0
        points = 2
        if task.angles * (b - a) > 0.99 * kappa * _TURN:  # the spacing is nowhere less than kappa times that of tau
            low, high = crowded_from_crank_angle(a, kappa), crowded_from_crank_angle(b, kappa)
            spacings = int(task.angles * (high - low) / _TURN)
            points = min(task.angles + 8, max(5, spacings + 2)) if spacings > 0 else 2
        workspace.starts[s + 1] = start + points
        theta[start], theta[start + points - 1] = a, b
        for i in range(1, points - 1):
            theta[start + i] = crank_angle_from_crowded(low + (high - low) * i / (points - 1), kappa)
        for i in range(0 if single else 1, points if single else points - 1):
            angle = theta[start + i]
            if i > 0 or not has_motion:  # otherwise at the end of the previous segment
                sine, cosine = math.sin(angle), math.cos(angle)
                m = design_motion(sine, cosine, d)
            value = signal_in_segment(task.kind, angle, sine, cosine, m, d, segment, sides)
            workspace.value[start + i], highest = value, max(highest, value)
        has_motion = single
    return highest


@analytic
def _peaks_near_samples(curve: _Curve, s: int, floor: float, best: float, workspace: _Workspace, peaks: int) -> int:
    """List the peaks next to those samples in segment s that reach `floor`; return the new number of peaks.

    best: highest sample so far.
    """
    a, b, start, end = (
        workspace.cuts.angle[s],
        workspace.cuts.angle[s + 1],
        workspace.starts[s],
        workspace.starts[s + 1] - 1,
    )
    f, theta, tops = workspace.value, workspace.theta, workspace.tops
    for i in range(start, end + 1):
        if f[i] < floor:
            continue
        if i == start:
            is_top = workspace.edge[s, 1] > 0.0 and f[i] >= f[i + 1]
        elif i == end:
            is_top = workspace.edge[s, 3] < 0.0 and f[i] >= f[i - 1]
        else:
            is_top = f[i] >= f[i - 1] and f[i] > f[i + 1]
        if not is_top:
            continue
        left, right, angle = theta[max(i - 1, start)], theta[min(i + 1, end)], theta[i]
        # A single call serves both rows, as the compiler inlines each call separately.
        for finer in range(2):
            value, angle = _refine_peak(left, right, angle, curve)
            # A finer row that rises up to the end of the segment has no maximum inside; the breakpoint may be one.
            if (finer == 0 or a + _SAME < angle < b - _SAME) and not _is_listed(tops.angle, peaks, angle):
                peaks = _insert_peak(tops, peaks, value, angle, s, -1)
            if finer == 1 or not f[i] > _NEAR * best:
                break
            left, right = theta[max(i - 2, start)], theta[min(i + 2, end)]
            finest, angle, step = _highest_point_between(left, right, curve)
            if not finest > value + _FLAT * value:
                break
            left, right = max(left, angle - step), min(right, angle + step)
    return peaks


@analytic
def _inner_peaks(
    task: TurnTask, d: Design, block: Any, count: int, floor: float, workspace: _Workspace
) -> tuple[int, float, float, int]:
    """List the peaks between breakpoints; return their number, and value, angle and segment of the highest sample.

    Fills values and slopes at the ends of segments.
    """
    single, peaks = workspace.tops.value.shape[0] == 1, 0
    best, best_at, best_segment = -1.0, 0.0, -1
    for s in range(count):
        if workspace.negligible[s] or not workspace.counts[s]:
            continue
        a, b, start, end = (
            workspace.cuts.angle[s],
            workspace.cuts.angle[s + 1],
            workspace.starts[s],
            workspace.starts[s + 1] - 1,
        )
        hopeful = not single
        for i in range(start, end + 1 if single else start):
            hopeful = hopeful or not workspace.value[i] < floor
        if not hopeful:
            workspace.edge[s, :] = -1.0
            continue
        probe = angle_identifying_segment(a, b)
        _, outward = find_segment_pieces(d, block, 0, probe, task.loads, task.watch, workspace.piece, workspace.shift)
        segment = Segment(block, task.loads, outward, workspace.piece, workspace.shift)
        curve = _Curve(task.kind, d, segment, friction_signs_in_segment(probe, d, segment, task.rubbing))
        for side in range(2):
            value, slope = _value_and_slope(b if side else a, curve)
            workspace.edge[s, 2 * side], workspace.edge[s, 2 * side + 1] = value, slope
        workspace.value[start], workspace.value[end] = workspace.edge[s, 0], workspace.edge[s, 2]
        for i in range(start, end + 1):
            if workspace.value[i] > best:
                best, best_at, best_segment = workspace.value[i], workspace.theta[i], s
        peaks = _peaks_near_samples(curve, s, floor, best, workspace, peaks)
    return peaks, best, best_at, best_segment


@analytic
def _breakpoint_peaks(count: int, workspace: _Workspace, peaks: int) -> int:
    """List the breakpoints that are peaks, at a kink or a jump; return the new number of peaks."""
    cuts, counts, edge = workspace.cuts, workspace.counts, workspace.edge
    for s in range(count):
        if workspace.negligible[s]:
            continue
        # The breakpoint between segment `before` and segment s; breakpoints in between may coincide.
        before = s - 1 if s > 0 else count - 1
        while workspace.negligible[before]:
            before = before - 1 if before > 0 else count - 1
        left = edge[before, 2] if counts[before] else -1.0
        right = edge[s, 0] if counts[s] else -1.0
        tolerance = _CONTINUOUS * max(left, right)
        if counts[before] and left >= right - tolerance and edge[before, 3] >= 0.0:
            if left > right + tolerance or edge[s, 1] <= 0.0:
                peaks = _insert_peak(workspace.tops, peaks, left, cuts.angle[s], before, s)
        elif counts[s] and right > left + tolerance and edge[s, 1] <= 0.0:
            peaks = _insert_peak(workspace.tops, peaks, right, cuts.angle[s], s, s)
    return peaks


@analytic
def _fill_gradient(task: TurnTask, d: Design, block: Any, steps: Any, workspace: _Workspace, i: int, out: Any) -> None:
    """Fill `out` (v,) with the derivatives of peak i. steps: derived numbers (v, rows, 1) with imaginary steps."""
    cuts, tops = workspace.cuts, workspace.tops
    s, pin = tops.segment[i], tops.pin[i]
    probe = angle_identifying_segment(cuts.angle[s], cuts.angle[s + 1])
    _, outward = find_segment_pieces(d, block, 0, probe, task.loads, task.watch, workspace.piece, workspace.shift)
    segment = Segment(block, task.loads, outward, workspace.piece, workspace.shift)
    sides = friction_signs_in_segment(probe, d, segment, task.rubbing)
    # A breakpoint at the end of the last segment lies a turn ahead of its list entry.
    angle = tops.angle[i] if pin < 0 or pin == s else cuts.angle[s + 1]
    sine, cosine = math.sin(angle), math.cos(angle)
    for v in range(out.shape[0]):
        stepped = Segment(steps[v], task.loads, outward, workspace.piece, workspace.shift)
        z = design_at(stepped.block, 0)
        slip = 0.0
        if pin >= 0:
            slip = cut_imaginary_shift(z, stepped, d, segment, angle, cuts, pin, sides)
        zs, zc = complex(sine, cosine * slip), complex(cosine, -sine * slip)
        m = design_motion(zs, zc, z)
        out[v] = signal_in_segment(task.kind, complex(angle, slip), zs, zc, m, z, stepped, sides).imag / STEP


@kernel
def find_turn_peaks(
    task: TurnTask, blocks: Cube, steps: ComplexCube, values: Table, peak_angles: Table, gradients: Cube
) -> None:
    """Fill the peaks for n designs (n, k), highest first, and their derivatives (n, k, v), if these have rows.

    blocks: derived numbers (n, rows, 1). steps: (n v, rows, 1), with an imaginary step in each number in turn.
    """
    loads, listed = task.loads, values.shape[1]
    nv = gradients.shape[2] if gradients.shape[0] else 0
    capacity = breakpoint_capacity(loads)
    cuts = Cuts(np.empty(capacity), np.empty(capacity, np.int64), np.empty(capacity), np.empty(capacity, np.int64))
    tops = _Tops(np.empty(listed), np.empty(listed), np.empty(listed, np.int64), np.empty(listed, np.int64))
    samples = task.angles + 8 + 5 * capacity
    workspace = _Workspace(
        cuts,
        np.zeros(loads.kind.shape[0], np.int64),
        np.zeros(loads.kind.shape[0]),
        np.empty(capacity, np.bool_),
        np.empty(capacity, np.bool_),
        np.empty((capacity, 4)),
        np.empty(capacity + 1, np.int64),
        np.empty(samples),
        np.empty(samples),
        tops,
    )
    for n in range(blocks.shape[0]):
        block = blocks[n]
        d = design_at(block, 0)
        if task.rubbing and not least_determinacy_margin(d) > 0.0:
            values[n, :], values[n, 0], peak_angles[n, :] = -np.inf, np.inf, np.nan
            if nv:
                gradients[n] = 0.0
            continue
        count = cut_cycle(d, block, 0, loads, task.watch, cuts)
        if task.rubbing:
            count = add_guide_force_change_cuts(
                d, block, loads, task.watch, cuts, count, workspace.piece, workspace.shift
            )
        cuts.angle[count] = cuts.angle[0] + _TURN
        highest = _sample_segments(
            task, d, block, count, workspace
        )  # for a single peak, low segments need nothing further
        floor = _HOPELESS * highest if listed == 1 else -1.0
        peaks, best, best_at, best_segment = _inner_peaks(task, d, block, count, floor, workspace)
        peaks = _breakpoint_peaks(count, workspace, peaks)
        if peaks == 0 and best_segment >= 0:  # a constant curve
            peaks = _insert_peak(tops, peaks, best, best_at, best_segment, -1)
        for i in range(listed):
            if i >= peaks:
                values[n, i], peak_angles[n, i] = -np.inf, np.nan
                for v in range(nv):
                    gradients[n, i, v] = 0.0
                continue
            values[n, i] = tops.value[i]
            turned = tops.angle[i] - _TURN * math.floor(tops.angle[i] / _TURN)
            peak_angles[n, i] = turned if turned < _TURN else 0.0  # rounding error of an angle just below zero
            if nv:
                _fill_gradient(task, d, block, steps[n * nv : (n + 1) * nv], workspace, i, gradients[n, i])
