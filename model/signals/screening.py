"""Peak torque and greatest position error of very many designs together, with gradients.

The innermost loop is over designs, so that every operation is a vector instruction. All designs share the crowded
angles, at which `coarse_peaks` samples the curves and finds the cells of the two highest local maxima; these are
refined by the formulas of `peaks`. The result equals that of `peaks.find_peaks` to rounding where the curve is smooth.
Where a load changes at the dead centres, a peak that sits on the kink there is found only to the spacing of the angles.
This suffices for choosing designs; `peaks` evaluates the results. Tables, loads with their own formula and partial
strokes are not handled here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..dynamics.segments import crowding
from ..dynamics.torque import forces, smooth_load
from ..kernel.arithmetic import STEP, analytic, inverse, root
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import Cube, Integers, Row, Table, kernel
from ..machine.design import DESIGN, LOAD_ROWS, derive, design_at
from ..machine.loads.load import Enters
from ..machine.mechanism import Clearances, Mechanism
from ..machine.members import is_shaft
from ..machine.memoise import memoise_by_machine
from ..machine.numbers import numbers_of
from ..machine.raw import fullest_inputs
from ..machine.two_turns import one_turn
from .coarse_peaks import LANES as LANES
from .coarse_peaks import ROWS, prepare, row_of, sweep, two_highest
from .signal_inputs import cycle_window
from .signals import Signal, design_motion, signal

ANGLES = 64
"""Sampled angles per turn if thousands of designs are only sorted."""

_STEPS = 7
_CONVERGED = 3e-7  # a step of the refinement, rad, whose cube does not show in the value
_TORQUE, _WORST, _RSS = int(Signal.TORQUE), int(Signal.POSITION_ERROR), int(Signal.POSITION_ERROR_RSS)
_FLAT = 1e-13


@dataclass(frozen=True)
class Screened:
    """Greatest value over the cycle: values (n,), gradients (n, 3 + k) or None.

    angles: crank angles of the greatest value (n,), rad, or (0,). still: greater size of the drive torque at the dead
    centres (n,), N m, or (0,). Where a load changes there, a peak that does not exceed `still` may be a kink.
    """

    values: Array
    angles: Array
    still: Array
    gradients: Array | None


@memoise_by_machine
def screens(mechanism: Mechanism, kind: Signal, *, during: str = "cycle") -> bool:
    """Whether `screen` handles this signal of this mechanism."""
    if kind not in (Signal.TORQUE, Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS):
        return False
    watch, shaft = cycle_window(mechanism, kind, during=during), is_shaft(mechanism)
    mechanism = mechanism.fullest
    full_cycle = watch.strokes == 0 and watch.start == 0.0 and watch.end == 1.0
    if kind == Signal.POSITION_ERROR_RSS and mechanism.tolerances.clearances != Clearances():
        return False  # `coarse_peaks` samples the squares with the tolerances alone
    if kind == Signal.TORQUE:
        return (
            full_cycle
            and not shaft
            and not mechanism.friction.acts
            and all(load.enters <= Enters.ADDED_MASS for load in mechanism.loads)
        )
    return full_cycle


@analytic
def _value(kind: Any, sine: Any, cosine: Any, m: Any, d: Any, direction: Any) -> Any:
    """Value of a signal, its load taken from the stroke that the slider is in."""
    outward = d.branch.real * m.x_1.real * direction > 0.0
    load = smooth_load(m, d, d.outward_force if outward else d.inward_force)
    return signal(kind, sine, cosine, m, d, load)


@analytic
def _turned(sine_tau: Any, cosine_tau: Any, crowd: Any, kappa: Any) -> Any:
    """Sine and cosine of the crank angle at tau: tan(theta - pi/2) = kappa tan(tau)."""
    if crowd:
        y = kappa * sine_tau
        q = inverse(root(cosine_tau * cosine_tau + y * y))
        return cosine_tau * q, -y * q
    return cosine_tau, -sine_tau


@analytic
def _curve(kind: Any, sine_tau: Any, cosine_tau: Any, kappa: Any, d: Any, direction: Any) -> Any:
    """Value at one tau, real or complex."""
    sine, cosine = _turned(sine_tau, cosine_tau, True, kappa)
    return _value(kind, sine, cosine, design_motion(sine, cosine, d), d, direction)


@analytic
def _step(kind: Any, sine: Any, cosine: Any, kappa: Any, d: Any, direction: Any) -> Any:
    """Value, and slope over the crowded angle."""
    z = _curve(kind, complex(sine, cosine * STEP), complex(cosine, -sine * STEP), kappa, d, direction)
    return z.real, z.imag * (1.0 / STEP)


@analytic
def _slopes(kind: Any, sine: Any, cosine: Any, kappa: Any, block: Any, direction: Any, value: Any, slope: Any) -> Any:
    """Value and slope of every lane at its own angle."""
    if kind == _TORQUE:
        for j in range(LANES):
            value[j], slope[j] = _step(_TORQUE, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
    elif kind == _WORST:
        for j in range(LANES):
            value[j], slope[j] = _step(_WORST, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
    else:
        for j in range(LANES):
            value[j], slope[j] = _step(_RSS, sine[j], cosine[j], kappa[j], design_at(block, j), direction)


@analytic
def _partial(kind: Any, sine: Any, cosine: Any, d: Any, direction: Any) -> Any:
    """Derivative along the imaginary step that the design carries, at a fixed crank angle."""
    return _value(kind, sine, cosine, design_motion(sine, cosine, d), d, direction).imag * (1.0 / STEP)


@analytic
def _partials(kind: Any, sine: Any, cosine: Any, block: Any, direction: Any, slope: Any) -> Any:
    """Derivatives of all lanes, each at its own crank angle."""
    if kind == _TORQUE:
        for j in range(LANES):
            slope[j] = _partial(_TORQUE, sine[j], cosine[j], design_at(block, j), direction)
    elif kind == _WORST:
        for j in range(LANES):
            slope[j] = _partial(_WORST, sine[j], cosine[j], design_at(block, j), direction)
    else:
        for j in range(LANES):
            slope[j] = _partial(_RSS, sine[j], cosine[j], design_at(block, j), direction)


@analytic
def _refine(
    kind: Any,
    tau: Any,
    h: Any,
    top: Any,
    kappa: Any,
    block: Any,
    direction: Any,
    work: Any,
    best: Any,
    sines: Any,
    cosines: Any,
) -> Any:
    """Move every lane to its local maximum within one angle on either side, from the vertex of the parabola.

    top: place, vertex and curvature of `coarse_peaks.two_highest`. work: room (12, lanes). A lane that has settled
    stays where it is while others take more steps, so its result does not depend on them.
    """
    share = 0.5 if kind == _RSS else 1.0  # `coarse_peaks` samples its square, which curves twice as much
    for j in range(LANES):
        at = max(int(top[0, j]), 0)
        work[4, j], work[5, j], work[6, j] = tau[0, at], tau[1, at], top[1, j] * h
        work[7, j], work[8, j], work[9, j], work[10, j], work[11, j] = -h, h, 0.0, 0.0, 1.0 if top[0, j] >= 0.0 else 0.0
        best[j] = -1.0
    for step in range(_STEPS):
        for j in range(LANES):
            t = work[6, j]
            t2 = t * t
            # Taylor series: |t| is at most one angle.
            s = t * (1.0 - t2 / 6.0 * (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0 * (1.0 - t2 / 110.0)))))
            c = 1.0 - t2 / 2.0 * (
                1.0 - t2 / 12.0 * (1.0 - t2 / 30.0 * (1.0 - t2 / 56.0 * (1.0 - t2 / 90.0 * (1.0 - t2 / 132.0))))
            )
            work[0, j] = work[4, j] * c + work[5, j] * s
            work[1, j] = work[5, j] * c - work[4, j] * s
        _slopes(kind, work[0], work[1], kappa, block, direction, work[2], work[3])
        moving = 0.0
        for j in range(LANES):
            t, value_here, rise, peak = work[6, j], work[2, j], work[3, j], best[j]
            floor, ceiling, last, last_slope, moves = work[7, j], work[8, j], work[9, j], work[10, j], work[11, j]
            new_sine, new_cosine, old_sine, old_cosine = work[0, j], work[1, j], sines[j], cosines[j]
            curvature = share * top[2, j]
            floor = t if rise > 0.0 else floor
            ceiling = ceiling if rise > 0.0 else t
            bend = curvature * value_here / (h * h) if step == 0 else (rise - last_slope) / (t - last)
            trial = t - rise / bend
            middle = 0.5 * (floor + ceiling)
            trial = trial if (trial > floor) & (trial < ceiling) else middle
            # Such a short step is taken without checking again: its square still counts in the value, its cube does
            # not.
            goes_on = moves if (abs(trial - t) > _CONVERGED) | (step == 0) else 0.0
            ahead = 0.0 if goes_on > 0.0 else trial - t
            value_here += 0.5 * rise * ahead
            # On the flat top the later angle is the better.
            better = (moves > 0.0) & (value_here >= peak - _FLAT * abs(peak))
            best[j] = value_here if better else peak
            sines[j] = new_sine + new_cosine * ahead if better else old_sine
            cosines[j] = new_cosine - new_sine * ahead if better else old_cosine
            moving += goes_on
            work[6, j] = trial if goes_on > 0.0 else t
            work[7, j], work[8, j], work[9, j], work[10, j], work[11, j] = floor, ceiling, t, rise, goes_on
        if moving == 0.0:
            break


@analytic
def _still(d: Any) -> Any:
    """Greater size of the torque at the two dead centres, where loads along the stroke need no torque."""
    outer, inner = d.e * inverse(d.l + d.r), -d.e * inverse(d.l - d.r)
    sine, cosine = outer, d.branch * root(1.0 - outer * outer)
    at_outer = forces(sine, cosine, design_motion(sine, cosine, d), d, 0.0).torque
    sine, cosine = inner, -d.branch * root(1.0 - inner * inner)
    at_inner = forces(sine, cosine, design_motion(sine, cosine, d), d, 0.0).torque
    return max(abs(at_outer), abs(at_inner))


@kernel
def _screen(
    kinds: Integers,
    raw: Row,
    columns: Integers,
    designs: Table,
    load_kind: Integers,
    load_datum: Integers,
    angles: int,
    crowd: bool,
    first: int,
    values: Table,
    peak_angles: Table,
    still: Row,
    gradients: Cube,
) -> None:
    n, signals = designs.shape[0], kinds.shape[0]
    rows = DESIGN + LOAD_ROWS * load_kind.shape[0]
    lanes, stepped = np.empty((raw.shape[0], LANES)), np.empty((raw.shape[0], LANES), np.complex128)
    block, complex_block = np.empty((rows, LANES)), np.empty((rows, LANES), np.complex128)
    for i in range(raw.shape[0]):
        lanes[i, :] = raw[i]
    h = 2.0 * math.pi / angles
    tau = np.empty((2, angles))
    for k in range(angles):
        tau[0, k], tau[1, k] = math.sin(k * h), math.cos(k * h)
    direction = 1.0 if raw[4] >= 0.0 else -1.0
    kappa = np.ones(LANES)
    coarse = tau.astype(np.float32)
    scaled, mark = np.empty((ROWS, LANES), np.float32), np.empty((7, LANES), np.float32)
    samples, top, slope = np.empty((3, angles + 2, LANES), np.float32), np.empty((6, LANES)), np.empty(LANES)
    value, peak_sines = np.empty((2, LANES)), np.empty((2, signals, LANES))
    sines, cosines = np.empty((2, LANES)), np.empty((2, LANES))
    work = np.empty((12, LANES))  # in one array, so that the compiler sees that the rows do not overlap
    for begin in range(0, n, LANES):
        for i in range(columns.shape[0]):
            for j in range(LANES):
                lanes[columns[i], j] = designs[min(begin + j, n - 1), i]
        derive(lanes, load_kind, load_datum, block)
        if crowd:
            for j in range(LANES):
                kappa[j] = crowding(lanes[0, j], lanes[1, j], lanes[2, j])
        prepare(block, kappa, direction, scaled)
        sweep(kinds, coarse, crowd, scaled, samples)
        last = min(LANES, n - begin)
        if still.shape[0]:
            for j in range(LANES):
                slope[j] = _still(design_at(block, j))
            for j in range(last):
                still[first + begin + j] = slope[j]
        for i in range(raw.shape[0] if gradients.shape[0] else 0):
            for j in range(LANES):
                stepped[i, j] = lanes[i, j]
        for q in range(signals):
            rivals = two_highest(samples[row_of(kinds[q])], scaled, mark, top)
            for i in range(2 if rivals else 1):
                part = top[3 * i : 3 * i + 3]
                _refine(kinds[q], tau, h, part, kappa, block, direction, work, value[i], sines[i], cosines[i])
            for j in range(LANES):
                first_value, second_value = value[0, j], (value[1, j] if rivals else -1.0)
                x, x_2, y, y_2 = cosines[0, j], cosines[1, j], sines[0, j], sines[1, j]
                value[0, j] = max(first_value, second_value)
                x = x_2 if second_value > first_value else x
                y = kappa[j] * (y_2 if second_value > first_value else y)
                scale = 1.0 / math.sqrt(x * x + y * y)
                peak_sines[0, q, j], peak_sines[1, q, j] = x * scale, -y * scale
            for j in range(last):
                values[q, first + begin + j] = value[0, j]
            for j in range(last if peak_angles.shape[1] else 0):
                angle = math.atan2(peak_sines[0, q, j], peak_sines[1, q, j])
                peak_angles[q, first + begin + j] = angle if angle >= 0.0 else angle + 2.0 * math.pi
        if gradients.shape[0]:
            for v in range(columns.shape[0]):
                for j in range(LANES):
                    stepped[columns[v], j] += complex(0.0, STEP)
                for i in range(rows):
                    for j in range(LANES):
                        complex_block[i, j] = block[i, j]
                derive(stepped, load_kind, load_datum, complex_block, columns[v])
                for q in range(signals):
                    _partials(kinds[q], peak_sines[0, q], peak_sines[1, q], complex_block, direction, slope)
                    for j in range(last):
                        gradients[q, first + begin + j, v] = slope[j]
                for j in range(LANES):
                    stepped[columns[v], j] = lanes[columns[v], j]


def screen(
    mechanism: Mechanism,
    kinds: tuple[Signal, ...],
    designs: Array,
    *,
    gradients: bool = False,
    places: bool = False,
    still: bool = False,
    angles: int = ANGLES,
    crowd: bool = True,
) -> tuple[Screened, ...]:
    """Return the greatest values of torque or position errors for designs (n, 3 + k): crank, rod, offset, m.

    The k further columns are the values of the machine's varying numbers.

    kinds: signals that `screens` accepts; evaluated together, they share the motion. places, still: whether to return
    these, see `Screened`. angles: samples per turn, a multiple of 4. crowd: whether to concentrate samples where the
    linkage comes close to locking.
    """
    designs = turning(designs)
    n, signals = len(designs), len(kinds)
    values, peak_angles = np.empty((signals, n)), np.empty((signals, n if places else 0))
    standing = np.empty(n if still else 0)
    raw, loads = fullest_inputs(one_turn(mechanism))
    numbers = numbers_of(mechanism, designs, limit=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes = np.empty((signals if gradients else 0, n, len(columns)))
    codes = np.array([int(kind) for kind in kinds])

    def work(begin: int, end: int) -> None:
        # Pass whole tables: slices have another array type, for which the kernel would be compiled again.
        _screen(
            codes,
            raw,
            columns,
            designs[begin:end],
            loads.kind,
            loads.datum,
            angles,
            crowd,
            begin,
            values,
            peak_angles,
            standing,
            slopes,
        )

    in_chunks(n, work, size=16 * LANES)
    return tuple(
        Screened(values[q], peak_angles[q], standing, numbers.chain(slopes[q]) if gradients else None)
        for q in range(signals)
    )
