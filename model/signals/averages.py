"""Means and root mean squares over the cycle, above all of the torque, with exact gradients.

Here the speed is constant, so the crank angle is proportional to time; along a profile see `shaft_averages`.

Smooth curves are integrated by the trapezoidal rule in the crowded angle, which converges geometrically for periodic
analytic functions; piecewise curves by Gauss-Legendre panels between breakpoints. The nearer a linkage is to locking,
the nearer are the curves' singularities, at the distance atanh(kappa) in the crowded angle (`segments.crowding`): nodes
grow in number with 1 / kappa. The rod's direction would lose digits likewise; `quadrature.square_along` keeps them.
Loads that jump at a dead centre do so while the slider stands still. Without friction, therefore, only steps of tables
make the torque jump. A breakpoint that moves adds the jump times its own motion to the derivatives.

With friction the curves contain sizes of joint forces, |A| and the like, which turn sharply where a force passes close
to zero: there panels are halved until the last Legendre coefficients of curve and derivatives have died out, or are
rounding error from a load that changes over a tiny distance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..dynamics.contact import cut_contacts, rubs, shift_of, sides_of
from ..dynamics.crank_loads import on_crank, sense_of, torque_without_crank_loads
from ..dynamics.rubbing import always_drives, joint_forces
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    angle_within,
    breakpoint_capacity,
    crowded,
    cut_cycle,
    enter,
    load_on_slider,
    uncrowded,
)
from ..kernel.arithmetic import STEP, analytic, root
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import ComplexCube, Cube, Row, Table, kernel
from ..kinematics.position import motion_of
from ..machine.derived import derived
from ..machine.design import design_at
from ..machine.dissipation import works_over_a_turn
from ..machine.mechanism import Mechanism
from ..machine.members import is_shaft
from ..machine.memoise import memoise_by_batch
from ..machine.numbers import numbers_of
from ..machine.raw import Loads
from ..machine.two_turns import cycle_turns, halves
from .quadrature import (
    ANGLE_ROUNDING,
    DEEPEST,
    EVEN,
    MOST_HALVINGS,
    NOISE,
    PANELS,
    RESOLVED,
    gaps_of,
    panel_rule,
    rough,
    square_along,
    steepness,
)
from .shaft_statistics import shaft_signal_averages
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal, signal
from .two_turns import averaged

_NODES = 192  # nodes for a smooth curve; `quadrature` explains the number
_TORQUE = int(Signal.TORQUE)
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Averages:
    """Averages (3, n) of n designs' curves and their gradients (3, n, 3 + k) or None, over the cycle.

    Rows: mean over the crank angle, which is work per angle; RMS value over the crank angle, relevant for a flywheel;
    RMS value over time, relevant for heating. At constant speed the last two are the same. Where friction locks a
    design the mean is NaN and the RMS values are infinite.
    """

    values: Array
    gradients: Array | None

    @property
    def mean(self) -> Array:
        """Mean over the crank angle (n,)."""
        return np.asarray(self.values[0])

    @property
    def rms_over_angle(self) -> Array:
        """RMS value over the crank angle (n,)."""
        return np.asarray(self.values[1])

    @property
    def rms(self) -> Array:
        """RMS value over time (n,)."""
        return np.asarray(self.values[2])

    @property
    def mean_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the mean over the crank angle."""
        return None if self.gradients is None else np.asarray(self.gradients[0])

    @property
    def rms_over_angle_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the RMS value over the crank angle."""
        return None if self.gradients is None else np.asarray(self.gradients[1])

    @property
    def rms_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the RMS value over time."""
        return None if self.gradients is None else np.asarray(self.gradients[2])


@analytic
def _curve(
    kind: Any, theta: Any, square: Any, d: Any, block: Any, outward: Any, loads: Any, piece: Any, shift: Any, sides: Any
) -> Any:
    """Return the drive torque with its sign, without loads on the crank, or the size of another signal.

    square: the real l^2 cos^2(phi).
    """
    sine, cosine = math.sin(theta), math.cos(theta)
    l_sin = d.e - d.r * sine
    plain = d.l * d.l - l_sin * l_sin
    m = motion_of(sine, cosine, d.r, l_sin, d.branch * root(plain + (square - plain.real)))
    load = load_on_slider(m, d, block, 0, theta, outward, loads, piece, shift)
    if kind == _TORQUE:
        return joint_forces(sine, cosine, m, d, load, sides).torque
    return signal(kind, sine, cosine, m, d, load, sides, (block, 0, theta, loads, piece, shift))


@kernel
def _average(
    kind: int,
    blocks: Cube,
    steps: ComplexCube,
    gaps: Row,
    loads: Loads,
    watch: CycleWindow,
    rule: tuple[Row, Row, Table],
    gradients: bool,
    mean: Row,
    rms: Row,
    mean_slope: Table,
    rms_slope: Table,
    rubbing: bool,
    jumps: bool,
) -> None:
    nodes, weights, tail = rule
    capacity = breakpoint_capacity(loads)
    cuts = Cuts(
        np.empty(capacity),
        np.empty(capacity, np.int64),
        np.empty(capacity),
        np.empty(capacity, np.int64),
    )
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    nv = mean_slope.shape[1] if gradients else 0
    value, slope, weight = np.empty(_NODES), np.empty((nv, _NODES)), np.empty(_NODES)
    greatest = np.zeros(nv + 1)
    stack = np.empty((DEEPEST + 2, 3))
    turned = kind == _TORQUE and on_crank(loads)
    for n in range(blocks.shape[0]):
        block, stepped = blocks[n], steps[n * nv : (n + 1) * nv]
        for v in range(nv):
            mean_slope[n, v] = rms_slope[n, v] = 0.0
        d = design_at(block, 0)
        if rubbing and not always_drives(d) > 0.0:
            mean[n], rms[n] = np.nan, np.inf
            continue
        # Same as `crowding`, but from the gap: no digits are lost, so no floor is needed.
        kappa = math.sqrt(math.sqrt(gaps[n] * (gaps[n] + 2.0 * d.r)) / (gaps[n] + d.r))
        denser = math.ceil(max(1.0, EVEN / kappa))
        resolved = max(1.0, NOISE / (kappa * kappa))
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if rubbing:
            count = cut_contacts(d, block, 0, loads, watch, cuts, count, piece, shift)
        cuts.angle[count] = cuts.angle[0] + _TURN
        first, second, left = 0.0, 0.0, MOST_HALVINGS
        for v in range(nv + 1):
            greatest[v] = 0.0
        for s in range(count):
            a, b = cuts.angle[s], cuts.angle[s + 1]
            probe = angle_within(a, b)
            _, outward = enter(d, block, 0, probe, loads, watch, piece, shift)
            sides = sides_of(probe, d, block, 0, outward, loads, piece, shift, rubbing)
            low, high = crowded(a, kappa), crowded(b, kappa)
            smooth = count == 1 and not rubbing
            panels = denser if smooth else denser * (int(PANELS * (high - low) / _TURN) + 1)
            points = _NODES if smooth else nodes.shape[0]
            for p in range(panels):
                width = (high - low) / panels
                stack[0, 0], stack[0, 1], stack[0, 2] = low + width * p, width, 0.0
                top = 1
                while top > 0:
                    top -= 1
                    begin, width, depth = stack[top, 0], stack[top, 1], stack[top, 2]
                    for i in range(points):
                        tau = begin + width * (i / points if smooth else nodes[i])
                        theta = uncrowded(tau, kappa)
                        c, y = math.cos(tau), math.sin(tau)
                        share = 1.0 / points if smooth else weights[i]
                        weight[i] = share * width / _TURN * kappa / (c * c + kappa * kappa * y * y)
                        square = square_along(theta, d, gaps[n])
                        value[i] = _curve(kind, theta, square, d, block, outward, loads, piece, shift, sides)
                        if turned:  # added last, so that machines without it keep their last digits
                            value[i] += torque_without_crank_loads(
                                0.0, d, block, 0, theta, sense_of(d), loads, piece, shift
                            )
                        for v in range(nv):
                            z = design_at(stepped[v], 0)
                            z = _curve(kind, theta, square, z, stepped[v], outward, loads, piece, shift, sides)
                            slope[v, i] = z.imag / STEP
                            if turned:
                                z_crank = design_at(stepped[v], 0)
                                added = torque_without_crank_loads(
                                    0j, z_crank, stepped[v], 0, theta, sense_of(z_crank), loads, piece, shift
                                )
                                slope[v, i] += added.imag / STEP
                    if rubbing:
                        for i in range(points):
                            greatest[nv] = max(greatest[nv], abs(value[i]))
                        allowed = max(
                            RESOLVED[0] * resolved * greatest[nv], ANGLE_ROUNDING * steepness(value[:points], width)
                        )
                        halve = rough(value, tail, allowed)
                        for v in range(nv):
                            for i in range(points):
                                greatest[v] = max(greatest[v], abs(slope[v, i]))
                            steep = ANGLE_ROUNDING * steepness(slope[v, :points], width)
                            halve = halve or rough(slope[v], tail, max(RESOLVED[1] * resolved * greatest[v], steep))
                        if halve and depth < DEEPEST and left > 0:
                            left -= 1
                            for half in range(2):  # the left one on top: panels are added up in order
                                stack[top, 0] = begin + 0.5 * width * (1 - half)
                                stack[top, 1], stack[top, 2] = 0.5 * width, depth + 1.0
                                top += 1
                            continue
                    for i in range(points):
                        first += weight[i] * value[i]
                        second += weight[i] * value[i] * value[i]
                        for v in range(nv):
                            mean_slope[n, v] += weight[i] * slope[v, i]
                            rms_slope[n, v] += weight[i] * value[i] * slope[v, i]
            if jumps:
                # The torque may jump at a cut, which then adds the jump times the cut's own motion.
                for end in range(2):
                    i, theta = (s + 1) % count if end else s, b if end else a
                    square = square_along(theta, d, gaps[n])
                    t = _curve(kind, theta, square, d, block, outward, loads, piece, shift, sides)
                    if turned:
                        t += torque_without_crank_loads(0.0, d, block, 0, theta, sense_of(d), loads, piece, shift)
                    sign = (1.0 if end else -1.0) / (STEP * _TURN)
                    for v in range(nv):
                        z = design_at(stepped[v], 0)
                        slip = shift_of(z, stepped[v], d, block, theta, cuts, i, outward, loads, piece, shift, sides)
                        mean_slope[n, v] += sign * t * slip
                        rms_slope[n, v] += 0.5 * sign * t * t * slip
        mean[n] = first
        rms[n] = math.sqrt(second)
        for v in range(nv):
            rms_slope[n, v] = rms_slope[n, v] / rms[n] if rms[n] > 0.0 else 0.0


def average_torque(mechanism: Mechanism, designs: Array, *, gradients: bool = False) -> Averages:
    """Return mean and RMS drive torque, N m, for designs (n, 3 + k), as `average` does."""
    return average(mechanism, Signal.TORQUE, designs, gradients=gradients)


def average(mechanism: Mechanism, kind: Signal, designs: Array, *, gradients: bool = False) -> Averages:
    """Return mean and RMS values of a signal for fully turning designs (n, 3 + k): crank, rod, offset, m.

    The k further columns are the values of the machine's varying numbers.
    The torque counts with its sign, any other signal by its size. The mean torque is exactly zero for a machine that
    takes no work over a turn. `shaft_statistics` describes how several cylinders and a speed profile count.
    """
    averages = _batch_averages(mechanism, designs, kind, gradients)
    return Averages(averages.values.copy(), None if averages.gradients is None else averages.gradients.copy())


@memoise_by_batch
def _batch_averages(mechanism: Mechanism, designs: Array, kind: Signal, gradients: bool) -> Averages:
    """Return memoised averages: one batch is evaluated for mean and RMS torque, power, energy and more."""
    designs = turning(designs)
    if is_shaft(mechanism):
        return Averages(*shaft_signal_averages(mechanism, kind, designs, gradients=gradients))
    if kind.needs_forces and cycle_turns(mechanism) > 1:
        first, second = (average(half, kind, designs, gradients=gradients) for half in halves(mechanism))
        return Averages(*averaged(first, second))
    n = len(designs)
    mean, rms = np.empty(n), np.empty(n)
    raw, loads = signal_inputs(mechanism, kind)
    numbers = numbers_of(mechanism, designs, limit=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes = np.empty((2, n if gradients else 0, len(columns)))
    watch = cycle_window(mechanism, kind)
    rubbing = kind.needs_forces and rubs(mechanism)
    jumps = rubbing or (kind.needs_forces and any(load.steps for load in mechanism.fullest.loads))
    rule, gaps = panel_rule(), gaps_of(*designs.T[:3])

    def work(begin: int, end: int) -> None:
        part = slice(begin, end) if gradients else slice(0, 0)
        blocks, steps = derived(raw, loads, columns, designs[begin:end], steps=gradients)
        _average(
            int(kind),
            blocks,
            steps,
            gaps[begin:end],
            loads,
            watch,
            rule,
            gradients,
            mean[begin:end],
            rms[begin:end],
            slopes[0, part],
            slopes[1, part],
            rubbing,
            jumps,
        )

    in_chunks(n, work, knots=len(loads.at))
    if kind is Signal.TORQUE and not works_over_a_turn(mechanism):  # exact: no rounding of cancelling terms
        mean[:], slopes[0] = 0.0, 0.0
    values = np.stack([mean, rms, rms])
    if not gradients:
        return Averages(values, None)
    by_mean, by_rms = (numbers.chain(part_slopes) for part_slopes in slopes)
    return Averages(values, np.stack([by_mean, by_rms, by_rms]))
