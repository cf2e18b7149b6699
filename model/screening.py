"""Peak torque and greatest position error of very many designs at once, with gradients.

The same formulas as in `peaks`, with the innermost loop over designs, so that every operation is a vector instruction;
the motion at an angle is computed once for all signals. All designs share the crowded angles; the two highest local
maxima of each are refined. The result equals that of `peaks.find_peaks` to rounding where the curve is smooth. Where a
load changes at the dead centres, a peak that sits on the kink there is found only to the spacing of the angles: good
for choosing designs, while what is delivered is evaluated by `peaks`. Tables and partial strokes are not handled here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arithmetic import STEP, analytic, inlined, inverse, kernel, root
from .batches import in_chunks
from .dynamics import smooth_load
from .loads import AngleTable, PositionTable
from .mechanism import Mechanism
from .parameters import DESIGN, derive, design_at, load_structure, raw_vector
from .peaks import ANGLES, watch_of
from .segments import crowding
from .signals import Signal, design_motion, signal

Array = NDArray[np.float64]

LANES = 64
"""Designs in a block: its working arrays stay in the first-level cache."""
_STEPS = 7
_TORQUE, _WORST, _RSS = int(Signal.TORQUE), int(Signal.POSITION_ERROR), int(Signal.POSITION_ERROR_RSS)
_FLAT = 1e-13


@dataclass(frozen=True)
class Screened:
    """Greatest value over the cycle: values (n,), angles (n,) in rad, gradients (n, 3) or None."""

    values: Array
    angles: Array
    gradients: Array | None


def screens(mechanism: Mechanism, kind: Signal, *, during: str = "cycle") -> bool:
    """Whether `screen` handles this signal of this mechanism."""
    if kind not in (Signal.TORQUE, Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS):
        return False
    watch = watch_of(mechanism, kind, during=during)
    whole = watch.strokes == 0 and watch.start == 0.0 and watch.end == 1.0
    if kind == Signal.TORQUE:
        return whole and not any(isinstance(load, PositionTable | AngleTable) for load in mechanism.loads)
    return whole


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


@inlined
def _sample(
    kind: Any, sine_tau: Any, cosine_tau: Any, crowd: Any, kappa: Any, block: Any, direction: Any, one: Any, two: Any
) -> None:
    """Values of all lanes at tau and -tau, the angles theta and pi - theta, which share most of the motion."""
    for j in range(LANES):
        d = design_at(block, j)
        sine, cosine = _turned(sine_tau, cosine_tau, crowd, kappa[j])
        one[j] = _value(kind, sine, cosine, design_motion(sine, cosine, d), d, direction)
        two[j] = _value(kind, sine, -cosine, design_motion(sine, -cosine, d), d, direction)


@inlined
def _sample_both(
    sine_tau: Any, cosine_tau: Any, crowd: Any, kappa: Any, block: Any, direction: Any, one: Any, two: Any
) -> None:
    """Torque and worst-case position error of all lanes at tau and -tau; they share the motion."""
    for j in range(LANES):
        d = design_at(block, j)
        sine, cosine = _turned(sine_tau, cosine_tau, crowd, kappa[j])
        m, n = design_motion(sine, cosine, d), design_motion(sine, -cosine, d)
        one[0, j] = _value(_TORQUE, sine, cosine, m, d, direction)
        two[0, j] = _value(_TORQUE, sine, -cosine, n, d, direction)
        one[1, j] = _value(_WORST, sine, cosine, m, d, direction)
        two[1, j] = _value(_WORST, sine, -cosine, n, d, direction)


@inlined
def _sweep(kinds: Any, tau: Any, crowd: Any, kappa: Any, block: Any, direction: Any, samples: Any) -> None:
    """Fill the samples (angles, signals, lanes). One loop a kind: within each the choice of formula is folded away."""
    angles = tau.shape[1]
    begin = 0
    if kinds.shape[0] > 1 and kinds[0] == _TORQUE and kinds[1] == _WORST:
        begin = 2
        for k in range(angles // 2 + 1):
            w = (angles - k) % angles
            _sample_both(tau[0, k], tau[1, k], crowd, kappa, block, direction, samples[k], samples[w])
    for q in range(begin, kinds.shape[0]):
        for k in range(angles // 2 + 1):
            w = (angles - k) % angles
            one, two = samples[k, q], samples[w, q]
            if kinds[q] == _TORQUE:
                _sample(_TORQUE, tau[0, k], tau[1, k], crowd, kappa, block, direction, one, two)
            elif kinds[q] == _WORST:
                _sample(_WORST, tau[0, k], tau[1, k], crowd, kappa, block, direction, one, two)
            else:
                _sample(_RSS, tau[0, k], tau[1, k], crowd, kappa, block, direction, one, two)


@inlined
def _track(samples: Any, q: Any, top: Any) -> bool:
    """Find each lane's highest sample, and the highest other local maximum that could still exceed it between samples.

    A parabola through three samples rises above the middle one by a quarter of their half difference at most, so other
    maxima below that are out. `top` gets place, half difference and second difference of both, the place -1 if there is
    no second; returns whether any lane has one.
    """
    angles = samples.shape[0]
    best, place = top[6], top[0]
    for j in range(LANES):
        best[j], place[j], top[3, j], top[7, j] = -1.0, 0.0, -1.0, -1.0
    for k in range(angles):
        here = samples[k, q]
        at = float(k)
        for j in range(LANES):
            value, old, old_place = here[j], best[j], place[j]  # loads before choices: selections, not branches
            best[j] = max(value, old)
            place[j] = at if value > old else old_place
    for k in range(angles):
        before, here, after = samples[k - 1, q], samples[k, q], samples[k + 1 if k + 1 < angles else 0, q]
        at = float(k)
        rivals = 0.0
        for j in range(LANES):
            low, middle, high = before[j], here[j], after[j]
            bound = middle + 0.125 * abs(high - low)
            rival = (middle >= low) & (middle > high) & (bound > best[j]) & (place[j] != at)
            rivals += 1.0 if rival else 0.0
        if rivals > 0.0:
            for j in range(LANES):
                if here[j] >= before[j] and here[j] > after[j] and place[j] != at:
                    bound = here[j] + 0.125 * abs(after[j] - before[j])
                    if bound > best[j] and bound > top[7, j]:
                        top[7, j], top[3, j] = bound, at
    second = False
    for j in range(LANES):
        for i in (0, 3):
            k = int(top[i, j])
            second = second or (i == 3 and k >= 0)
            before_j, after_j = samples[max(k, 0) - 1, q, j], samples[k + 1 if k + 1 < angles else 0, q, j]
            top[i + 1, j] = 0.5 * (after_j - before_j)
            top[i + 2, j] = after_j - 2.0 * samples[max(k, 0), q, j] + before_j
    return second


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


@inlined
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


@inlined
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


@inlined
def _refine(
    kind: Any, tau: Any, h: Any, top: Any, kappa: Any, block: Any, direction: Any, best: Any, sines: Any, cosines: Any
) -> Any:
    """Move every lane to its local maximum within one angle on either side, from the vertex of the parabola."""
    low, high = np.full(LANES, -h), np.full(LANES, h)
    delta, old, old_slope = np.empty(LANES), np.zeros(LANES), np.zeros(LANES)
    base_sine, base_cosine = np.empty(LANES), np.empty(LANES)
    sine, cosine, value, slope = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty(LANES)
    for j in range(LANES):
        at = max(int(top[0, j]), 0)
        base_sine[j], base_cosine[j] = tau[0, at], tau[1, at]
        delta[j] = -top[1, j] / top[2, j] * h if top[2, j] < 0.0 else 0.0
        best[j] = -1.0
    for step in range(_STEPS):
        for j in range(LANES):
            t = delta[j]
            t2 = t * t
            # Taylor series: |t| is at most one angle.
            s = t * (1.0 - t2 / 6.0 * (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0 * (1.0 - t2 / 110.0)))))
            c = 1.0 - t2 / 2.0 * (
                1.0 - t2 / 12.0 * (1.0 - t2 / 30.0 * (1.0 - t2 / 56.0 * (1.0 - t2 / 90.0 * (1.0 - t2 / 132.0))))
            )
            sine[j] = base_sine[j] * c + base_cosine[j] * s
            cosine[j] = base_cosine[j] * c - base_sine[j] * s
        _slopes(kind, sine, cosine, kappa, block, direction, value, slope)
        for j in range(LANES):
            t, found, rise, peak = delta[j], value[j], slope[j], best[j]
            floor, ceiling, last, last_slope = low[j], high[j], old[j], old_slope[j]
            new_sine, new_cosine, old_sine, old_cosine = sine[j], cosine[j], sines[j], cosines[j]
            second = top[2, j]
            better = found >= peak - _FLAT * abs(peak)  # on the flat top the later angle is the better
            best[j] = found if better else peak
            sines[j] = new_sine if better else old_sine
            cosines[j] = new_cosine if better else old_cosine
            floor = t if rise > 0.0 else floor
            ceiling = ceiling if rise > 0.0 else t
            low[j], high[j] = floor, ceiling
            bend = second / (h * h) if step == 0 else (rise - last_slope) / (t - last)
            trial = t - rise / bend
            middle = 0.5 * (floor + ceiling)
            old[j], old_slope[j] = t, rise
            delta[j] = trial if (trial > floor) & (trial < ceiling) else middle


@kernel
def _screen(
    kinds: Any,
    raw: Any,
    designs: Any,
    load_kind: Any,
    load_datum: Any,
    angles: Any,
    crowd: Any,
    values: Any,
    where: Any,
    gradients: Any,
) -> None:
    n, signals = designs.shape[0], kinds.shape[0]
    rows = DESIGN + 2 * load_kind.shape[0]
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
    samples, top, slope = np.empty((angles, signals, LANES)), np.empty((8, LANES)), np.empty(LANES)
    value, found = np.empty((2, LANES)), np.empty((2, signals, LANES))
    sines, cosines = np.empty((2, LANES)), np.empty((2, LANES))
    for begin in range(0, n, LANES):
        for i in range(3):
            for j in range(LANES):
                lanes[i, j] = designs[min(begin + j, n - 1), i]
        derive(lanes, load_kind, load_datum, block)
        if crowd:
            for j in range(LANES):
                kappa[j] = crowding(lanes[0, j], lanes[1, j], lanes[2, j])
        _sweep(kinds, tau, crowd, kappa, block, direction, samples)
        last = min(LANES, n - begin)
        for i in range(raw.shape[0] if gradients.shape[0] else 0):
            for j in range(LANES):
                stepped[i, j] = lanes[i, j]
        for q in range(signals):
            rivals = _track(samples, q, top)
            for i in range(2 if rivals else 1):
                _refine(
                    kinds[q], tau, h, top[3 * i : 3 * i + 3], kappa, block, direction, value[i], sines[i], cosines[i]
                )
            for j in range(LANES):
                one, two = value[0, j], (value[1, j] if rivals and top[3, j] >= 0.0 else -1.0)
                x, x_2, y, y_2 = cosines[0, j], cosines[1, j], sines[0, j], sines[1, j]
                value[0, j] = max(one, two)
                x = x_2 if two > one else x
                y = kappa[j] * (y_2 if two > one else y)
                scale = 1.0 / math.sqrt(x * x + y * y)
                found[0, q, j], found[1, q, j] = x * scale, -y * scale
            for j in range(last):
                values[q, begin + j] = value[0, j]
                angle = math.atan2(found[0, q, j], found[1, q, j])
                where[q, begin + j] = angle if angle >= 0.0 else angle + 2.0 * math.pi
        if gradients.shape[0]:
            for v in range(3):
                for j in range(LANES):
                    stepped[v, j] += complex(0.0, STEP)
                derive(stepped, load_kind, load_datum, complex_block)
                for q in range(signals):
                    _partials(kinds[q], found[0, q], found[1, q], complex_block, direction, slope)
                    for j in range(last):
                        gradients[q, begin + j, v] = slope[j]
                for j in range(LANES):
                    stepped[v, j] = lanes[v, j]


def screen(
    mechanism: Mechanism,
    kinds: tuple[Signal, ...],
    designs: Array,
    *,
    gradients: bool = False,
    angles: int = ANGLES,
    crowd: bool = True,
) -> tuple[Screened, ...]:
    """Return the greatest values of torque or position errors for designs (n, 3): crank, rod, offset, m.

    kinds: signals that `screens` accepts; evaluated together they share the motion. angles: samples a turn, a multiple
    of 4. crowd: concentrate them where the linkage comes close to locking.
    """
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n, signals = len(designs), len(kinds)
    values, where = np.empty((signals, n)), np.empty((signals, n))
    slopes = np.empty((signals if gradients else 0, n, 3))
    raw, loads = raw_vector(mechanism), load_structure(mechanism)
    codes = np.array([int(kind) for kind in kinds])

    def work(begin: int, end: int) -> None:
        part = slice(begin, end)
        _screen(
            codes,
            raw,
            designs[part],
            loads.kind,
            loads.datum,
            angles,
            crowd,
            values[:, part],
            where[:, part],
            slopes[:, part],
        )

    in_chunks(n, work, size=16 * LANES)
    return tuple(Screened(values[q], where[q], slopes[q] if gradients else None) for q in range(signals))
