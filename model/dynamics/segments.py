"""The cycle cut into segments on which every curve is smooth.

Loads that change at a dead centre, tables with knots, valves that open, and a position error that counts only over part
of the stroke make the curves piecewise. They are smooth between *breakpoints*, at which they have a kink or a jump.
Within a segment the stroke and the piece of every table and cylinder are fixed, so the curve there is an analytic
function of crank angle and design.
"""

import math
from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic
from ..kernel.kernel import Integers, Row
from ..kinematics.geometry import inner_crank_angle, outer_crank_angle
from ..kinematics.position import motion
from ..machine.design import AREA, DESIGN, LOAD_ROWS, Design
from ..machine.loads.load import Enters
from ..machine.loads.registry import force_of
from ..machine.raw_machine_vector import Loads
from .gas import burning_force, gas_force, pressure_piece_at, valve_event_positions
from .torque import load_without_pieces

_ANGLE_TABLE, _FORMULA = int(Enters.ANGLE_TABLE), int(Enters.FORMULA)
_CYLINDER, _BURNING_CYLINDER = int(Enters.CYLINDER), int(Enters.BURNING_CYLINDER)
_OUTER, _INNER, _FIXED, _KNOT, _FRACTION = range(5)
_EXPANDED, _COMPRESSED, _TURNED, _BURNT = 6, 7, 8, 9  # 5: `contact.CONTACT`
_TURN = 2.0 * math.pi
_STILL = 1e-13
"""|x'| over crank below which the slider is at a dead centre, to the accuracy of a crank angle."""
BASE_CAPACITY = 40
"""Room for breakpoints, besides two per knot and four per cylinder: at most 8, plus those due to friction."""


class CycleWindow(NamedTuple):
    """Part of the cycle that counts, and the kinds of breakpoints in it.

    strokes: 0 the cycle, 1 the outward stroke, 2 the inward stroke. start, end: fractions of the stroke from the inner
    dead centre. split: whether a load or friction changes at the dead centres. swing: whether friction changes where
    the rod reverses, with the crank normal to the slider line.
    """

    strokes: int
    start: float
    end: float
    split: bool
    swing: bool = False


class Cuts(NamedTuple):
    """Work space for one design's breakpoints: angle, kind, number (of the knot or fraction) and load."""

    angle: Row
    code: Integers
    number: Row
    load: Integers


class Segment(NamedTuple):
    """State that determines the loads within one segment of a design's cycle.

    block: derived numbers (rows, 1), real or with an imaginary step. outward: the slider's stroke. piece, shift: the
    piece of every table and cylinder, and the turns by which an angle table is shifted, filled by
    `find_segment_pieces`.
    """

    block: Any
    loads: Loads
    outward: bool
    piece: Any
    shift: Any


@analytic
def crank_angle_at(x: float, r: float, l: float, e: float, second: bool) -> float:
    """Return one of the two crank angles for slider position x.

    atan2(e, x) -+ acos((r^2 + d^2 - l^2) / (2 r d)) with d^2 = x^2 + e^2: law of cosines.
    """
    d = math.sqrt(x * x + e * e)
    ratio = (r * r + x * x + e * e - l * l) / (2.0 * r * d)
    half = math.acos(min(1.0, max(-1.0, ratio)))
    return math.atan2(e, x) + (half if second else -half)


@analytic
def breakpoint_capacity(loads: Loads) -> int:
    """Return the maximum number of breakpoints that a design can have."""
    return int(BASE_CAPACITY + 2 * loads.knots.shape[0] + 4 * loads.kind.shape[0])


@analytic
def add_cut(cuts: Cuts, n: int, angle: float, code: int, number: float, load: int) -> int:
    """Insert a breakpoint into the first `n`, in ascending order; return the new count."""
    wrapped = angle - _TURN * math.floor(angle / _TURN)
    i = n
    while i > 0 and cuts.angle[i - 1] > wrapped:
        cuts.angle[i] = cuts.angle[i - 1]
        cuts.code[i] = cuts.code[i - 1]
        cuts.number[i] = cuts.number[i - 1]
        cuts.load[i] = cuts.load[i - 1]
        i -= 1
    cuts.angle[i], cuts.code[i], cuts.number[i], cuts.load[i] = wrapped, code, number, load
    return n + 1


@analytic
def _cut_valves(d: Design, block: Any, j: int, k: int, kind: int, margin: float, cuts: Cuts, n: int) -> int:
    """Add the valve events of a cylinder, or the end of burning, to the first `n` cuts.

    Each is added in its own stroke or, if the crank is at rest, in both.
    """
    sign, origin = block[DESIGN + LOAD_ROWS * k, j], block[DESIGN + LOAD_ROWS * k + 1, j]
    expanded, compressed = valve_event_positions(d, block, j, k, kind)
    first = _BURNT if kind == _BURNING_CYLINDER else _EXPANDED
    for event in range(2):
        x = origin + sign * (compressed if event else expanded)
        if d.inner + margin < x < d.outer - margin:
            for second in (False, True):
                outward = second == (d.speed < 0.0)
                if d.speed == 0.0 or outward == ((event == 0) == (sign > 0.0)):
                    angle = crank_angle_at(d.branch * x, d.r, d.l, d.e, second)
                    n = add_cut(cuts, n, angle, _COMPRESSED if event else first, 0.0, k)
    return n


@analytic
def cut_cycle(d: Design, block: Any, j: int, loads: Loads, watch: CycleWindow, cuts: Cuts) -> int:
    """Fill `cuts` with the breakpoints of a design in ascending crank angle; return their number (at least one)."""
    n = 0
    if watch.split or watch.strokes != 0:
        a, b = outer_crank_angle(d.r, d.l, d.e), inner_crank_angle(d.r, d.l, d.e)
        # The crossed branch is the mirror image about the y axis: theta -> pi - theta.
        n = add_cut(cuts, n, a if d.branch > 0.0 else math.pi - a, _OUTER, 0.0, -1)
        n = add_cut(cuts, n, b if d.branch > 0.0 else math.pi - b, _INNER, 0.0, -1)
    if watch.swing:
        n = add_cut(cuts, n, 0.5 * math.pi, _FIXED, 0.0, -1)
        n = add_cut(cuts, n, 1.5 * math.pi, _FIXED, 0.0, -1)
    for fraction in (watch.start, watch.end):
        if 0.0 < fraction < 1.0:
            x = d.branch * (d.inner + fraction * (d.outer - d.inner))
            for second in (False, True):
                n = add_cut(cuts, n, crank_angle_at(x, d.r, d.l, d.e, second), _FRACTION, fraction, -1)
    # A knot on a dead centre is not a breakpoint. The slider stands still there, so a force that is continuous over
    # position has no kink over crank angle, whereas the crank angle of the knot has no derivative.
    margin = 1e-12 * (d.outer - d.inner)
    for k in range(loads.kind.shape[0]):
        first, last = loads.start[k], loads.start[k + 1]
        if loads.kind[k] == _CYLINDER or loads.kind[k] == _BURNING_CYLINDER:
            n = _cut_valves(d, block, j, k, loads.kind[k], margin, cuts, n)
            continue
        if loads.kind[k] == _ANGLE_TABLE:
            for i in range(first, last - 1):
                at = loads.knots[i] + block[DESIGN + LOAD_ROWS * k + 1, j]
                n = add_cut(cuts, n, at, _FIXED if loads.datum[k] == 0 else _TURNED, at, k)
            continue
        scale, datum = block[DESIGN + LOAD_ROWS * k, j], block[DESIGN + LOAD_ROWS * k + 1, j]
        for second in (True, False):
            # Knots by ascending crank angle, so that most are added behind all others.
            rising = (d.branch * scale > 0.0) != second
            for i in range(first, last):
                at = loads.knots[i if rising else first + last - 1 - i]
                x = datum + scale * at
                if d.inner + margin < x < d.outer - margin:
                    n = add_cut(cuts, n, crank_angle_at(d.branch * x, d.r, d.l, d.e, second), _KNOT, at, k)
    if n == 0:
        n = add_cut(cuts, n, 0.0, _FIXED, 0.0, -1)
    return n


@analytic
def frictionless_cut_imaginary_shift(d: Any, block: Any, j: int, theta: float, cuts: Cuts, i: int) -> float:
    """Return the imaginary part of the angle of breakpoint i when the design carries an imaginary step."""
    code = cuts.code[i]
    if code == _FIXED:
        return 0.0
    if code == _TURNED:
        return float(block[DESIGN + LOAD_ROWS * cuts.load[i] + 1, j].imag)
    sign = d.branch.real
    if code == _OUTER:
        return float(sign * outer_crank_angle(d.r, d.l, d.e).imag)
    if code == _INNER:
        return float(sign * inner_crank_angle(d.r, d.l, d.e).imag)
    if code == _FRACTION:
        target = (d.inner + cuts.number[i] * (d.outer - d.inner)).imag
    elif code == _BURNT:
        row = DESIGN + LOAD_ROWS * cuts.load[i]
        target = (block[row + 1, j] + block[row, j] * block[row + AREA + 7, j]).imag
    elif code in (_EXPANDED, _COMPRESSED):
        row = DESIGN + LOAD_ROWS * cuts.load[i]
        expanded, compressed = valve_event_positions(d, block, j, cuts.load[i], _CYLINDER)
        target = (block[row + 1, j] + block[row, j] * (compressed if code == _COMPRESSED else expanded)).imag
    else:
        row = DESIGN + LOAD_ROWS * cuts.load[i]
        target = (block[row + 1, j] + block[row, j] * cuts.number[i]).imag
    # Implicit function theorem applied to x(theta, design) = target.
    m = motion(math.sin(theta), math.cos(theta), d.r, d.l, d.e, d.branch)
    return float((sign * target - m.x.imag) / m.x_1.real)


@analytic
def angle_identifying_segment(a: float, b: float) -> float:
    """Return a crank angle in (a, b) that identifies the segment's stroke and table pieces.

    The midpoint is unsuitable: without offset it is a dead centre. Rounding then decides on which side of the stroke's
    end, or of a knot, the slider is.
    """
    return a + 0.382 * (b - a)


@analytic
def find_load_pieces(
    d: Design, block: Any, j: int, theta: float, x: float, loads: Loads, piece: Any, shift: Any
) -> None:
    """Fix the piece of every table and cylinder at a crank angle and a slider distance x from the pivot."""
    for k in range(loads.kind.shape[0]):
        first, last = loads.start[k], loads.start[k + 1]
        if loads.kind[k] == _CYLINDER or loads.kind[k] == _BURNING_CYLINDER:
            piece[k] = pressure_piece_at(d, block, j, k, loads.kind[k], x)
        if first == last:
            continue
        if loads.kind[k] == _ANGLE_TABLE:
            at = theta - block[DESIGN + LOAD_ROWS * k + 1, j]
            shift[k] = -_TURN * math.floor((at - loads.knots[first]) / _TURN)
            at = at + shift[k]
        else:
            at = block[DESIGN + LOAD_ROWS * k, j] * (x - block[DESIGN + LOAD_ROWS * k + 1, j])
        low, high, near = first, last, piece[k]
        if first <= near < last:  # usually the piece of the previous segment, or its neighbour
            if loads.knots[near] < at:
                low = near + 1
                if low < last and loads.knots[low] >= at:
                    high = low
            else:
                high = near - 1 if near > first and loads.knots[near - 1] >= at else near
                if high > first and loads.knots[high - 1] < at:
                    low = high
        while low < high:
            middle = (low + high) // 2
            if loads.knots[middle] < at:
                low = middle + 1
            else:
                high = middle
        piece[k] = low


@analytic
def find_segment_pieces(
    d: Design, block: Any, j: int, probe: float, loads: Loads, watch: CycleWindow, piece: Any, shift: Any
) -> tuple[bool, bool]:
    """Fix the table pieces for the segment that contains the crank angle `probe`; return (counts, outward).

    Within rounding of a dead centre, where the sign of x' is arbitrary, the inward stroke is used.
    """
    m = motion(math.sin(probe), math.cos(probe), d.r, d.l, d.e, d.branch)
    x = d.branch * m.x
    outward = d.branch * m.x_1 * (1.0 if d.speed >= 0.0 else -1.0) > _STILL * d.r
    fraction = (x - d.inner) / (d.outer - d.inner)
    counts = watch.strokes == 0 or (watch.strokes == 1) == outward
    # Only at ends that are cuts: elsewhere a dead centre in mid-segment may leave the range 0 to 1 by a rounding error.
    if (watch.start > 0.0 and fraction < watch.start) or (watch.end < 1.0 and fraction > watch.end):
        counts = False
    find_load_pieces(d, block, j, probe, x, loads, piece, shift)
    return counts, outward


@analytic
def add_formula_loads(force: Any, m: Any, d: Any, block: Any, j: int, outward: bool, loads: Loads) -> Any:
    """Return a force plus all loads with their own formula, N outward."""
    way = 1.0 if outward else -1.0
    for k in range(loads.kind.shape[0]):
        if loads.kind[k] >= _FORMULA:
            # Selected rather than multiplied by the branch: the compiler regroups a product shared with
            # `load_without_pieces`, which would change the last digits of machines without such a load.
            position, pace = (m.x, m.x_1) if d.branch.real > 0.0 else (-m.x, -m.x_1)
            first, second = block[DESIGN + LOAD_ROWS * k, j], block[DESIGN + LOAD_ROWS * k + 1, j]
            force = force + force_of(loads.kind[k], position, pace * d.speed, way, first, second)
    return force


@analytic
def load_on_slider(m: Any, d: Any, theta: Any, segment: Segment) -> Any:
    """Return the load on the slider at a crank angle within a segment, N outward."""
    block, loads, outward, piece, shift = segment
    force = load_without_pieces(m, d, d.outward_force if outward else d.inward_force)
    force = add_formula_loads(force, m, d, block, 0, outward, loads)
    for k in range(loads.kind.shape[0]):
        first, last = loads.start[k], loads.start[k + 1]
        if loads.kind[k] == _CYLINDER:
            force = force + gas_force(m, d, block, 0, k, outward, piece[k])
        elif loads.kind[k] == _BURNING_CYLINDER:
            force = force + burning_force(m, d, block, 0, k, outward, piece[k])
        if first == last:
            continue
        factor = loads.factor[k, 0] if outward else loads.factor[k, 1]
        i = piece[k]
        if i == first:
            force = force + factor * loads.force[first]
        elif i == last:
            force = force + factor * loads.force[last - 1]
        else:
            slope = (loads.force[i] - loads.force[i - 1]) / (loads.knots[i] - loads.knots[i - 1])
            if loads.kind[k] == _ANGLE_TABLE:
                # Summed separately, as the compiler may regroup a sum: summing tables from zero preserves their last
                # digits.
                if loads.datum[k] == 0:
                    force = force + factor * (loads.force[i - 1] + slope * (theta + shift[k] - loads.knots[i - 1]))
                else:
                    at = theta - block[DESIGN + LOAD_ROWS * k + 1, 0]
                    force = force + factor * (loads.force[i - 1] + slope * (at + shift[k] - loads.knots[i - 1]))
            else:
                at = block[DESIGN + LOAD_ROWS * k, 0] * (d.branch * m.x - block[DESIGN + LOAD_ROWS * k + 1, 0])
                force = force + factor * (loads.force[i - 1] + slope * (at - loads.knots[i - 1]))
    return force


@analytic
def crowding_parameter(r: float, l: float, e: float) -> float:
    """Return kappa for the crowded angle tau with tan(theta - pi/2) = kappa tan(tau).

    The curves are singular at theta = +-pi/2 + i w with cosh(w) = (l - |e|) / r: the closer the linkage is to locking,
    the closer to the real axis. The map widens the strip of analyticity around both to the half-width atanh(kappa) on
    either side when kappa^2 = tanh(w) = sqrt(1 - (r / (l - |e|))^2), the best balance between near and far
    singularities. Equidistant tau then resolves every linkage with the same number of angles.
    """
    q = r / (l - abs(e))
    return math.sqrt(math.sqrt(max(1.0 - q * q, 1e-12)))


@analytic
def crowded_from_crank_angle(theta: float, kappa: float) -> float:
    """Return tau for a crank angle, in the same half-turn as theta - pi/2."""
    psi = theta - 0.5 * math.pi
    turn = math.atan2(math.sin(psi), kappa * math.cos(psi)) - psi
    return psi + turn - _TURN * math.floor(turn / _TURN + 0.5)


@analytic
def crank_angle_from_crowded(tau: float, kappa: float) -> float:
    """Return the crank angle for tau; inverse of `crowded_from_crank_angle`."""
    turn = math.atan2(kappa * math.sin(tau), math.cos(tau)) - tau
    return 0.5 * math.pi + tau + turn - _TURN * math.floor(turn / _TURN + 0.5)
