"""Means and mean squares of signals and of work over one turn, with exact gradients.

Smooth curves are integrated with the trapezoidal rule in the crowded angle, which converges geometrically for periodic
analytic functions. Piecewise curves are integrated on Gauss-Legendre panels between breakpoints. The closer a linkage
is to locking, the closer are the curves' singularities, at the distance atanh(kappa) in the crowded angle
(`segments.crowding_parameter`). The number of nodes therefore grows with 1 / kappa. The rod's direction would lose
digits in the same way; `_squared_rod_component_along_line` keeps them. Loads that jump at a dead centre do so while the
slider stands still. Without friction, therefore, only steps in tables make the torque jump. A moving breakpoint adds
the jump times its own motion to the derivatives.

Magnitudes of joint forces, such as |A|, have sharp bends where a force is close to zero. Friction transfers these bends
to the torque. There, panels are halved until the last Legendre coefficients of curve and derivatives have died out, or
are rounding errors from a load that changes over a tiny distance.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    Segment,
    angle_identifying_segment,
    breakpoint_capacity,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    cut_cycle,
    find_segment_pieces,
    load_on_slider,
)
from ..dynamics.torque_with_friction import (
    Sides,
    add_guide_force_change_cuts,
    cut_imaginary_shift,
    friction_signs_in_segment,
    joint_forces_with_optional_friction,
    least_determinacy_margin,
    rotation_sense,
    torque_without_crank_loads,
)
from ..kernel.arithmetic import STEP, analytic, magnitude, root
from ..kernel.batches import run_in_chunks
from ..kernel.kernel import ComplexCube, Cube, Row, Table, kernel
from ..kinematics.position import motion_from_rod_vector
from ..machine.derived_designs import derived_blocks
from ..machine.design import Design, design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads
from ..machine.raw_numbers_of_designs import raw_machine_numbers
from ..quadrature import ANGLE_ROUNDING, DEEPEST, MOST_HALVINGS, NODES, TAIL, WEIGHTS
from .signals import Signal, signal_of_forces, signal_of_motion

WORK = -1
"""In place of a signal: the five curves of `turn_work`."""
CURVES = 5
"""Their number."""
_TORQUE, _LINE = int(Signal.TORQUE), int(Signal.LINE_FORCE)
_RULE = NODES, WEIGHTS, TAIL
_TURN = 2.0 * math.pi
_SMOOTH = 192  # nodes for a smooth curve
# Measured on rods 0.1 % longer than crank + offset (kappa 0.21), over random machines: 128 nodes and 12 panels of 16
# nodes leave an RMS torque off by 4e-9 and gradients by 7e-7; these 2e-14 and 2e-11. Below _EVEN there are more.
_PANELS, _EVEN = 24, 0.21
_RESOLVED = 1e-12, 1e-10  # magnitude of the last coefficients, relative to the maximum of the curve and its derivatives
_NOISE = 0.004  # rounding error of a curve due to the crank angle itself, in units of _RESOLVED, times kappa^2
_SHARE = 0.1
"""Allowed tail in a panel's mean of the work, as a fraction of that in a curve: narrow panels count less.

Otherwise rounding errors, which halving does not reduce, would halve every panel for a linkage that nearly locks.
"""


class MeansTask(NamedTuple):
    """Curves of a machine. kind: a `Signal` or `WORK`. jumps: whether the curves may jump at cuts.

    rubbing: whether friction is included.
    """

    kind: int
    loads: Loads
    watch: CycleWindow
    rubbing: bool
    jumps: bool


class CurveMeans(NamedTuple):
    """Results for n designs.

    mean: (n, c) for c curves, infinite where friction locks the design. square: mean squares (n, c or 0).

    mean_slope, square_slope: (n, c, v), derivatives of the means and half those of the mean squares, or without rows.
    """

    mean: Table
    square: Table
    mean_slope: Cube
    square_slope: Cube


class _Curve(NamedTuple):
    """The curves of one design within a segment. gap: l - r - |e|, m. stepped: (v, rows, 1), with imaginary steps."""

    kind: int
    d: Design
    gap: float
    kappa: float
    segment: Segment
    sides: Sides
    stepped: Any


class _Workspace(NamedTuple):
    """Work space and rule.

    rates: (c, 1 + v, nodes), curves and derivatives at a panel's nodes. greatest: their maximum magnitudes.

    real, stepped: curves at one node. stack: start, width and depth of the panels that remain. nodes, weights, tail:
    see `quadrature`.
    """

    rates: Cube
    real: Row
    stepped: Any
    weight: Row
    greatest: Table
    stack: Table
    nodes: Row
    weights: Row
    tail: Table


@analytic
def _squared_rod_component_along_line(theta: Any, d: Any, gap: Any) -> Any:
    """Return l^2 cos^2(phi), m^2, exact to rounding however close to locking; gap: l - r - |e|, m, equally exact.

    l^2 - across^2 = (l - |across|) (l + |across|) loses digits where the rod is nearly normal to the slider line. With
    psi the crank angle from there, -pi/2 for e >= 0, the factors are gap + 2 r sin^2(psi / 2) and gap + 2 |e| + 2 r
    cos^2(psi / 2).
    """
    half = 0.5 * (theta - (0.5 if d.e < 0.0 else 1.5) * math.pi)
    s, c = math.sin(half), math.cos(half)
    return (gap + 2.0 * d.r * s * s) * (gap + 2.0 * abs(d.e) + 2.0 * d.r * c * c)


@analytic
def _fill_signal_or_work(kind: Any, theta: Any, square: Any, d: Any, segment: Segment, sides: Sides, out: Any) -> None:
    """Fill `out` with a signal, the torque with its sign, or the curves of the work; square: real l^2 cos^2(phi)."""
    sine, cosine = math.sin(theta), math.cos(theta)
    l_sin = d.e - d.r * sine
    plain = d.l * d.l - l_sin * l_sin
    m = motion_from_rod_vector(sine, cosine, d.r, l_sin, d.branch * root(plain + (square - plain.real)))
    if kind > _LINE:
        out[0] = signal_of_motion(kind, sine, cosine, m, d)
        return
    load = load_on_slider(m, d, theta, segment)
    if kind == _TORQUE:  # separate, so that the compiler leaves out everything that the torque alone does not need
        torque = joint_forces_with_optional_friction(sine, cosine, m, d, load, sides).torque
        out[0] = torque_without_crank_loads(torque, theta, rotation_sense(d), segment)
        return
    f = joint_forces_with_optional_friction(sine, cosine, m, d, load, sides)
    if kind != WORK:
        out[0] = signal_of_forces(kind, f, m, d, theta, segment)
        return
    out[0] = -rotation_sense(d) * d.branch * load * m.x_1
    out[1] = magnitude(f.guide * m.x_1)
    out[2] = root(f.pivot_x * f.pivot_x + f.pivot_y * f.pivot_y)
    out[3] = root(f.crank_pin_x * f.crank_pin_x + f.crank_pin_y * f.crank_pin_y) * (1.0 - m.rod_1)
    out[4] = root(f.slider_pin_x * f.slider_pin_x + f.slider_pin_y * f.slider_pin_y) * magnitude(m.rod_1)


@analytic
def _fill_panel(curve: _Curve, begin: float, width: float, points: int, workspace: _Workspace) -> None:
    """Fill curves, derivatives and weights at the nodes of a panel in the crowded angle, Gauss or equidistant."""
    own, kappa = curve.segment, curve.kappa
    is_even = points == _SMOOTH
    for i in range(points):
        tau = begin + width * (i / points if is_even else workspace.nodes[i])
        theta = crank_angle_from_crowded(tau, kappa)
        c, y = math.cos(tau), math.sin(tau)
        share = 1.0 / points if is_even else workspace.weights[i]
        workspace.weight[i] = share * width / _TURN * kappa / (c * c + kappa * kappa * y * y)
        square = _squared_rod_component_along_line(theta, curve.d, curve.gap)
        _fill_signal_or_work(curve.kind, theta, square, curve.d, own, curve.sides, workspace.real)
        for k in range(workspace.rates.shape[0]):
            workspace.rates[k, 0, i] = workspace.real[k]
        for v in range(curve.stepped.shape[0]):
            stepped = Segment(curve.stepped[v], own.loads, own.outward, own.piece, own.shift)
            z = design_at(stepped.block, 0)
            _fill_signal_or_work(curve.kind, theta, square, z, stepped, curve.sides, workspace.stepped)
            for k in range(workspace.rates.shape[0]):
                workspace.rates[k, v + 1, i] = workspace.stepped[k].imag / STEP


@analytic
def _is_rough(curve: _Curve, width: float, workspace: _Workspace) -> bool:
    """Return whether the last Legendre coefficients on a panel exceed the tolerance; raises the maximum magnitudes."""
    halve, points = False, workspace.nodes.shape[0]
    resolved = max(1.0, _NOISE / (curve.kappa * curve.kappa))
    for k in range(workspace.rates.shape[0]):
        for row in range(workspace.rates.shape[1]):
            least = greatest = workspace.rates[k, row, 0]
            for i in range(points):
                least, greatest = min(least, workspace.rates[k, row, i]), max(greatest, workspace.rates[k, row, i])
            workspace.greatest[k, row] = max(workspace.greatest[k, row], greatest, -least)
            allowed = (_RESOLVED[0] if row == 0 else _RESOLVED[1]) * resolved * workspace.greatest[k, row]
            if curve.kind == WORK:
                allowed = allowed * (_SHARE * _TURN / width)
            else:
                allowed = max(allowed, ANGLE_ROUNDING * ((greatest - least) / width))
            for order in range(0 if halve else workspace.tail.shape[0]):
                coefficient = 0.0
                for i in range(points):
                    coefficient += workspace.tail[order, i] * workspace.rates[k, row, i]
                halve = halve or abs(coefficient) > allowed
    return halve


@analytic
def _add_panel(points: int, n: int, workspace: _Workspace, means: CurveMeans) -> None:
    """Add the panel in `workspace` to the means of design n."""
    has_squares = means.square.shape[1] > 0
    for k in range(workspace.rates.shape[0]):
        value = workspace.rates[k, 0]
        for row in range(workspace.rates.shape[1]):
            rate = workspace.rates[k, row]
            first = second = 0.0
            for i in range(points):
                first += workspace.weight[i] * rate[i]
                second += workspace.weight[i] * value[i] * rate[i]
            if row == 0:
                means.mean[n, k] += first
                if has_squares:
                    means.square[n, k] += second
            else:
                means.mean_slope[n, k, row - 1] += first
                if has_squares:
                    means.square_slope[n, k, row - 1] += second


@analytic
def _add_segment(
    curve: _Curve, a: float, b: float, points: int, left: int, n: int, workspace: _Workspace, means: CurveMeans
) -> int:
    """Add a segment between crank angles to the means of design n.

    points: nodes of a panel. left: halvings that remain, -1 if there are none at all; return how many are left.
    """
    low, high = crowded_from_crank_angle(a, curve.kappa), crowded_from_crank_angle(b, curve.kappa)
    panels = math.ceil(max(1.0, _EVEN / curve.kappa))
    if points < _SMOOTH:
        panels = panels * (int(_PANELS * (high - low) / _TURN) + 1)
    for p in range(panels):
        width = (high - low) / panels
        workspace.stack[0, 0], workspace.stack[0, 1], workspace.stack[0, 2] = low + width * p, width, 0.0
        top = 1
        while top > 0:
            top -= 1
            begin, width, depth = workspace.stack[top, 0], workspace.stack[top, 1], workspace.stack[top, 2]
            _fill_panel(curve, begin, width, points, workspace)
            if left >= 0 and _is_rough(curve, width, workspace) and depth < DEEPEST and left > 0:
                left -= 1
                for half in range(2):  # the left one on top, because panels are added up in order
                    workspace.stack[top, 0] = begin + 0.5 * width * (1 - half)
                    workspace.stack[top, 1], workspace.stack[top, 2] = 0.5 * width, depth + 1.0
                    top += 1
                continue
            _add_panel(points, n, workspace, means)
    return left


@analytic
def _add_moving_segment_ends(
    curve: _Curve, cuts: Cuts, s: int, count: int, n: int, workspace: _Workspace, means: CurveMeans
) -> None:
    """Add to derivatives of design n what the moving ends of segment s contribute: the curve there times the motion."""
    own = curve.segment
    for end in range(2):
        i, theta = (s + 1) % count if end else s, cuts.angle[s + 1] if end else cuts.angle[s]
        square = _squared_rod_component_along_line(theta, curve.d, curve.gap)
        _fill_signal_or_work(curve.kind, theta, square, curve.d, own, curve.sides, workspace.real)
        sign = (1.0 if end else -1.0) / (STEP * _TURN)
        for v in range(curve.stepped.shape[0]):
            stepped = Segment(curve.stepped[v], own.loads, own.outward, own.piece, own.shift)
            slip = cut_imaginary_shift(design_at(stepped.block, 0), stepped, curve.d, own, theta, cuts, i, curve.sides)
            for k in range(means.mean.shape[1]):
                means.mean_slope[n, k, v] += sign * workspace.real[k] * slip
                if means.square.shape[1] > 0:
                    means.square_slope[n, k, v] += 0.5 * sign * workspace.real[k] * workspace.real[k] * slip


@kernel
def fill_means(
    task: MeansTask, blocks: Cube, steps: ComplexCube, gaps: Row, rule: tuple[Row, Row, Table], means: CurveMeans
) -> None:
    """Fill the means for n designs, whose fields are zero.

    blocks: derived numbers (n, rows, 1). steps: (n v, rows, 1), with an imaginary step in each number in turn. gaps:
    (n,), see `_distance_to_locking`.
    """
    loads, watch, nv = task.loads, task.watch, means.mean_slope.shape[2] if means.mean_slope.shape[0] else 0
    capacity, curves = breakpoint_capacity(loads), means.mean.shape[1]
    cuts = Cuts(np.empty(capacity), np.empty(capacity, np.int64), np.empty(capacity), np.empty(capacity, np.int64))
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    workspace = _Workspace(
        np.empty((curves, nv + 1, _SMOOTH)),
        np.empty(CURVES),
        np.empty(CURVES, np.complex128),
        np.empty(_SMOOTH),
        np.empty((curves, nv + 1)),
        np.empty((DEEPEST + 2, 3)),
        rule[0],
        rule[1],
        rule[2],
    )
    for n in range(blocks.shape[0]):
        block, gap = blocks[n], gaps[n]
        d = design_at(block, 0)
        if task.rubbing and not least_determinacy_margin(d) > 0.0:
            means.mean[n, :] = np.inf
            continue
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if task.rubbing:
            count = add_guide_force_change_cuts(d, block, loads, watch, cuts, count, piece, shift)
        cuts.angle[count] = cuts.angle[0] + _TURN
        # Same as `crowding_parameter`, but from the gap: no digits are lost, so no floor is needed.
        kappa = math.sqrt(math.sqrt(gap * (gap + 2.0 * d.r)) / (gap + d.r))
        halved = task.rubbing or task.kind == WORK
        points = _SMOOTH if count == 1 and not halved else rule[0].shape[0]
        left = MOST_HALVINGS if halved else -1
        workspace.greatest[:] = 0.0
        for s in range(count):
            a, b = cuts.angle[s], cuts.angle[s + 1]
            probe = angle_identifying_segment(a, b)
            _, outward = find_segment_pieces(d, block, 0, probe, loads, watch, piece, shift)
            segment = Segment(block, loads, outward, piece, shift)
            sides = friction_signs_in_segment(probe, d, segment, task.rubbing)
            curve = _Curve(task.kind, d, gap, kappa, segment, sides, steps[n * nv : (n + 1) * nv])
            left = _add_segment(curve, a, b, points, left, n, workspace, means)
            if task.jumps:
                _add_moving_segment_ends(curve, cuts, s, count, n, workspace, means)


def turn_means(
    task: MeansTask, raw: Array, mechanism: Mechanism, designs: Array, *, squares: bool, gradients: bool
) -> CurveMeans:
    """Return the means for fully rotating designs (n, 3 + k), with their gradients.

    raw: the machine's raw numbers. squares: whether mean squares are needed.
    """
    numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=gradients)
    count, gaps, curves = len(designs), _distance_to_locking(*numbers.values.T[:3]), CURVES if task.kind == WORK else 1
    squared, rows, columns = curves if squares else 0, count if gradients else 0, len(numbers.columns)
    means = CurveMeans(
        np.zeros((count, curves)),
        np.zeros((count, squared)),
        np.zeros((rows, curves, columns)),
        np.zeros((rows, squared, columns)),
    )

    def work(begin: int, end: int) -> None:
        blocks, steps = derived_blocks(raw, task.loads, numbers.columns, numbers.values[begin:end], steps=gradients)
        part = CurveMeans(*(column[begin:end] if len(column) else column for column in means))
        fill_means(task, blocks, steps, gaps[begin:end], _RULE, part)

    run_in_chunks(count, work, knots=len(task.loads.knots))
    if gradients:
        return CurveMeans(
            means.mean,
            means.square,
            numbers.gradients_by_design_numbers(means.mean_slope),
            numbers.gradients_by_design_numbers(means.square_slope),
        )
    return means


def _distance_to_locking(crank: Array, rod: Array, offset: Array) -> Array:
    """Return l - r - |e|, exact to its own rounding: the first difference's error is added (Knuth's two-sum)."""
    first = rod - crank
    back = first - rod
    return np.asarray((first - np.abs(offset)) + ((rod - (first - back)) - (crank + back)))
