"""Peak torque and maximum position error for very many designs together, with gradients.

The innermost loop is over designs, so that every operation is a vector instruction. All designs share the crowded
angles, at which `coarse_peaks` samples the curves and finds the cells of the two highest local maxima. These are
refined with the formulas from `peaks`. The result equals that of `peaks.find_peaks` to rounding if the curve is smooth.
If a load changes at the dead centres, a peak at the kink there is found only to the spacing of the angles. This
suffices for choosing designs; `peaks` evaluates the results. Tables, loads with their own formula and partial strokes
are not supported here.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..dynamics.segments import crowding_parameter
from ..dynamics.torque import forces_without_friction, load_without_pieces
from ..kernel.arithmetic import STEP, analytic, inverse, root
from ..kernel.batches import require_full_rotation, run_in_chunks
from ..kernel.kernel import Cube, Integers, Row, Table, kernel
from ..machine.cylinders_and_turns import has_cylinders_or_speed_profile, machine_of_first_turn
from ..machine.design import DESIGN, LOAD_ROWS, derive_design, design_at
from ..machine.loads.load import Enters
from ..machine.mechanism import Clearances, Mechanism
from ..machine.memoise import memoise_by_machine
from ..machine.raw_machine_vector import raw_inputs_with_all_features
from ..machine.raw_numbers_of_designs import raw_machine_numbers
from .coarse_peaks import LANES as LANES
from .coarse_peaks import ROWS, fill_curve_numbers, find_two_highest, row_number_of_signal, sample_curves
from .signal_inputs import cycle_window
from .signals import Signal, design_motion, signal_without_friction

ANGLES = 64
"""Sampled angles per turn if thousands of designs are only ranked."""

_STEPS = 7
_CONVERGED = 3e-7  # a refinement step, rad, whose cube does not show in the value
_TORQUE, _WORST, _RSS = int(Signal.TORQUE), int(Signal.POSITION_ERROR), int(Signal.POSITION_ERROR_RSS)
_FLAT = 1e-13


@dataclass(frozen=True)
class Screened:
    """Maximum over the cycle: values (n,), gradients (n, 3 + k) or None.

    angles: crank angles of the maximum (n,), rad, or (0,). still: larger magnitude of the drive torque at the two dead
    centres (n,), N m, or (0,). If a load changes there, a peak that does not exceed `still` may be at a kink.
    """

    values: Array
    angles: Array
    still: Array
    gradients: Array | None


class Screening(NamedTuple):
    """Input of a screening: signals, angles per turn, whether these are crowded, and the machine's numbers.

    columns: slots of the raw numbers that designs set.
    """

    kinds: Integers
    angles: int
    crowd: bool
    raw: Row
    columns: Integers
    load_kind: Integers
    load_datum: Integers


class ScreenedArrays(NamedTuple):
    """Fields of `Screened` for all signals (first axis); without rows if not requested."""

    values: Table
    angles: Table
    still: Row
    gradients: Cube


class _Lanes(NamedTuple):
    """Derived designs in a block, one per lane, with kappa of the crowded angle and the sense of rotation."""

    block: Any
    kappa: Any
    direction: Any


class _Tops(NamedTuple):
    """Values of maxima and their location: the crowded angle or the crank angle."""

    value: Any
    sine: Any
    cosine: Any


@memoise_by_machine
def supports_screening(mechanism: Mechanism, kind: Signal, *, during: str = "cycle") -> bool:
    """Whether `screened_maxima` supports this signal for this mechanism."""
    if kind not in (Signal.TORQUE, Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS):
        return False
    watch, shaft = cycle_window(mechanism, kind, during=during), has_cylinders_or_speed_profile(mechanism)
    mechanism = mechanism.with_largest_variables
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
def _signal_value(kind: Any, sine: Any, cosine: Any, m: Any, d: Any, direction: Any) -> Any:
    """Value of a signal, with the load for the stroke that the slider is in."""
    outward = d.branch.real * m.x_1.real * direction > 0.0
    load = load_without_pieces(m, d, d.outward_force if outward else d.inward_force)
    return signal_without_friction(kind, sine, cosine, m, d, load)


@analytic
def _crank_sine_and_cosine(sine_tau: Any, cosine_tau: Any, crowd: Any, kappa: Any) -> Any:
    """Sine and cosine of the crank angle at tau: tan(theta - pi/2) = kappa tan(tau)."""
    if crowd:
        y = kappa * sine_tau
        q = inverse(root(cosine_tau * cosine_tau + y * y))
        return cosine_tau * q, -y * q
    return cosine_tau, -sine_tau


@analytic
def _signal_at_crowded_angle(kind: Any, sine_tau: Any, cosine_tau: Any, kappa: Any, d: Any, direction: Any) -> Any:
    """Value at one tau, real or complex."""
    sine, cosine = _crank_sine_and_cosine(sine_tau, cosine_tau, True, kappa)
    return _signal_value(kind, sine, cosine, design_motion(sine, cosine, d), d, direction)


@analytic
def _value_and_slope(kind: Any, sine: Any, cosine: Any, kappa: Any, d: Any, direction: Any) -> Any:
    """Value and slope over the crowded angle."""
    z = _signal_at_crowded_angle(kind, complex(sine, cosine * STEP), complex(cosine, -sine * STEP), kappa, d, direction)
    return z.real, z.imag * (1.0 / STEP)


@analytic
def _fill_values_and_slopes(kind: Any, sine: Any, cosine: Any, lanes: _Lanes, value: Any, slope: Any) -> Any:
    """Value and slope for every lane at its own angle."""
    block, kappa, direction = lanes
    if kind == _TORQUE:
        for j in range(LANES):
            value[j], slope[j] = _value_and_slope(_TORQUE, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
    elif kind == _WORST:
        for j in range(LANES):
            value[j], slope[j] = _value_and_slope(_WORST, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
    else:
        for j in range(LANES):
            value[j], slope[j] = _value_and_slope(_RSS, sine[j], cosine[j], kappa[j], design_at(block, j), direction)


@analytic
def _design_derivative(kind: Any, sine: Any, cosine: Any, d: Any, direction: Any) -> Any:
    """Derivative along the imaginary step that the design carries, at a fixed crank angle."""
    return _signal_value(kind, sine, cosine, design_motion(sine, cosine, d), d, direction).imag * (1.0 / STEP)


@analytic
def _fill_design_derivatives(kind: Any, tops: _Tops, block: Any, direction: Any, slope: Any) -> Any:
    """Derivatives for all lanes, each at the crank angle of its maximum."""
    sine, cosine = tops.sine, tops.cosine
    if kind == _TORQUE:
        for j in range(LANES):
            slope[j] = _design_derivative(_TORQUE, sine[j], cosine[j], design_at(block, j), direction)
    elif kind == _WORST:
        for j in range(LANES):
            slope[j] = _design_derivative(_WORST, sine[j], cosine[j], design_at(block, j), direction)
    else:
        for j in range(LANES):
            slope[j] = _design_derivative(_RSS, sine[j], cosine[j], design_at(block, j), direction)


@analytic
def _refine_maxima(kind: Any, tau: Any, top: Any, lanes: _Lanes, work: Any, tops: _Tops) -> Any:
    """Move every lane to its local maximum within one angle on either side, starting at the vertex of the parabola.

    top: place, vertex and curvature of `coarse_peaks.find_two_highest`. work: workspace (12, lanes). A lane that has
    settled stays there while others take more steps, so its result does not depend on them.
    """
    best, sines, cosines = tops
    h = 2.0 * math.pi / tau.shape[1]
    share = 0.5 if kind == _RSS else 1.0  # `coarse_peaks` samples its square, whose curvature is twice as large
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
        _fill_values_and_slopes(kind, work[0], work[1], lanes, work[2], work[3])
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
            # Such a short step is taken without another check: its square still affects the value, its cube does not.
            goes_on = moves if (abs(trial - t) > _CONVERGED) | (step == 0) else 0.0
            ahead = 0.0 if goes_on > 0.0 else trial - t
            value_here += 0.5 * rise * ahead
            # On a flat top, the later angle is better.
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
def _torque_at_dead_centres(d: Any) -> Any:
    """Larger magnitude of the torque at the two dead centres, where loads along the stroke need no torque."""
    outer, inner = d.e * inverse(d.l + d.r), -d.e * inverse(d.l - d.r)
    sine, cosine = outer, d.branch * root(1.0 - outer * outer)
    at_outer = forces_without_friction(sine, cosine, design_motion(sine, cosine, d), d, 0.0).torque
    sine, cosine = inner, -d.branch * root(1.0 - inner * inner)
    at_inner = forces_without_friction(sine, cosine, design_motion(sine, cosine, d), d, 0.0).torque
    return max(abs(at_outer), abs(at_inner))


@analytic
def _fill_higher_maximum(
    kind: Any, tau: Any, tops: Any, rivals: Any, lanes: _Lanes, work: Any, found: Any, peak: _Tops
) -> None:
    """Fill in the higher of each lane's two refined maxima.

    tops: `top` from `coarse_peaks.find_two_highest`; rivals: whether any lane has a second maximum. found: workspace
    (2, 3, lanes).
    """
    kappa = lanes.kappa
    for i in range(2 if rivals else 1):
        _refine_maxima(kind, tau, tops[3 * i : 3 * i + 3], lanes, work, _Tops(found[i, 0], found[i, 1], found[i, 2]))
    for j in range(LANES):
        first, second = found[0, 0, j], (found[1, 0, j] if rivals else -1.0)
        x, x_2, y, y_2 = found[0, 2, j], found[1, 2, j], found[0, 1, j], found[1, 1, j]
        peak.value[j] = max(first, second)
        x = x_2 if second > first else x
        y = kappa[j] * (y_2 if second > first else y)
        scale = 1.0 / math.sqrt(x * x + y * y)
        peak.sine[j], peak.cosine[j] = x * scale, -y * scale


@analytic
def _fill_gradients(task: Screening, lanes: _Lanes, raw: Any, peaks: Any, workspace: Any, out: Any) -> None:
    """Fill the derivatives (signals, designs, columns) of peaks (signals, 3, lanes).

    raw: numbers for all lanes. workspace: complex raw numbers and derived designs, and derivatives for the lanes.
    """
    stepped, block, slope = workspace
    for i in range(raw.shape[0]):
        for j in range(LANES):
            stepped[i, j] = raw[i, j]
    for v in range(task.columns.shape[0]):
        column = task.columns[v]
        for j in range(LANES):
            stepped[column, j] += complex(0.0, STEP)
        for i in range(block.shape[0]):
            for j in range(LANES):
                block[i, j] = lanes.block[i, j]
        derive_design(stepped, task.load_kind, task.load_datum, block, column)
        for q in range(task.kinds.shape[0]):
            _fill_design_derivatives(
                task.kinds[q], _Tops(peaks[q, 0], peaks[q, 1], peaks[q, 2]), block, lanes.direction, slope
            )
            for j in range(out.shape[1]):
                out[q, j, v] = slope[j]
        for j in range(LANES):
            stepped[column, j] = raw[column, j]


@kernel
def _screen_designs(task: Screening, designs: Table, first: int, out: ScreenedArrays) -> None:
    n, signals, angles = designs.shape[0], task.kinds.shape[0], task.angles
    rows = DESIGN + LOAD_ROWS * task.load_kind.shape[0]
    raw = np.empty((task.raw.shape[0], LANES))
    for i in range(raw.shape[0]):
        raw[i, :] = task.raw[i]
    tau = np.empty((2, angles))
    for k in range(angles):
        tau[0, k], tau[1, k] = math.sin(k * (2.0 * math.pi / angles)), math.cos(k * (2.0 * math.pi / angles))
    lanes = _Lanes(np.empty((rows, LANES)), np.ones(LANES), 1.0 if task.raw[4] >= 0.0 else -1.0)
    coarse = tau.astype(np.float32)
    scaled, mark = np.empty((ROWS, LANES), np.float32), np.empty((7, LANES), np.float32)
    samples, tops, slope = np.empty((3, angles + 2, LANES), np.float32), np.empty((6, LANES)), np.empty(LANES)
    found, peaks = np.empty((2, 3, LANES)), np.empty((signals, 3, LANES))
    work = np.empty((12, LANES))  # in one array, so that the compiler sees that the rows do not overlap
    workspace = np.empty(raw.shape, np.complex128), np.empty((rows, LANES), np.complex128), slope
    for begin in range(0, n, LANES):
        for i in range(task.columns.shape[0]):
            for j in range(LANES):
                raw[task.columns[i], j] = designs[min(begin + j, n - 1), i]
        derive_design(raw, task.load_kind, task.load_datum, lanes.block)
        for j in range(LANES if task.crowd else 0):
            lanes.kappa[j] = crowding_parameter(raw[0, j], raw[1, j], raw[2, j])
        fill_curve_numbers(lanes.block, lanes.kappa, lanes.direction, scaled)
        sample_curves(task.kinds, coarse, task.crowd, scaled, samples)
        last, here = min(LANES, n - begin), first + begin
        for j in range(LANES if out.still.shape[0] else 0):
            slope[j] = _torque_at_dead_centres(design_at(lanes.block, j))
        for j in range(last if out.still.shape[0] else 0):
            out.still[here + j] = slope[j]
        for q in range(signals):
            rivals = find_two_highest(samples[row_number_of_signal(task.kinds[q])], scaled, mark, tops)
            peak = _Tops(peaks[q, 0], peaks[q, 1], peaks[q, 2])
            _fill_higher_maximum(task.kinds[q], tau, tops, rivals, lanes, work, found, peak)
            for j in range(last):
                out.values[q, here + j] = peak.value[j]
            for j in range(last if out.angles.shape[1] else 0):
                angle = math.atan2(peak.sine[j], peak.cosine[j])
                out.angles[q, here + j] = angle if angle >= 0.0 else angle + 2.0 * math.pi
        if out.gradients.shape[0]:
            _fill_gradients(task, lanes, raw, peaks, workspace, out.gradients[:, here : here + last])


def screened_maxima(
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
    """Return the maxima of torque or position errors for designs (n, 3 + k): crank, rod, offset, m.

    The k additional columns are the values of the machine's variables.

    kinds: signals that `supports_screening` accepts; they are evaluated together and share the motion. places, still:
    whether to return these, see `Screened`. angles: samples per turn, a multiple of 4. crowd: whether to concentrate
    samples where the linkage is close to locking.
    """
    designs = require_full_rotation(designs)
    n, signals = len(designs), len(kinds)
    values, peak_angles = np.empty((signals, n)), np.empty((signals, n if places else 0))
    standing = np.empty(n if still else 0)
    raw, loads = raw_inputs_with_all_features(machine_of_first_turn(mechanism))
    numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    slopes = np.empty((signals if gradients else 0, n, len(columns)))
    codes = np.array([int(kind) for kind in kinds])
    task = Screening(codes, angles, crowd, raw, columns, loads.kind, loads.datum)
    out = ScreenedArrays(values, peak_angles, standing, slopes)

    def work(begin: int, end: int) -> None:
        _screen_designs(task, designs[begin:end], begin, out)

    run_in_chunks(n, work, size=16 * LANES)
    return tuple(
        Screened(
            values[q], peak_angles[q], standing, numbers.gradients_by_design_numbers(slopes[q]) if gradients else None
        )
        for q in range(signals)
    )
