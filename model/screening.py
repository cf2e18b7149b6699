"""Peak torque and greatest position error of very many designs at once, with gradients.

The same formulas as in `peaks`, with the innermost loop over designs, so that every operation is a vector instruction.
All designs share the crowded angles; the two highest local maxima of each are refined. The result equals that of
`peaks.find_peaks` to rounding where the curve is smooth. Where a load changes at the dead centres, a peak that sits on
the kink there is found only to the spacing of the angles: good for choosing designs, while what is delivered is
evaluated by `peaks`. Tables and partial strokes are not handled here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arithmetic import STEP, analytic, inlined, inverse, kernel, root
from .dynamics import smooth_load
from .loads import AngleTable, PositionTable
from .mechanism import Mechanism
from .parameters import DESIGN, derive, design_at, load_structure, raw_vector
from .peaks import ANGLES, in_chunks, watch_of
from .segments import crowding
from .signals import Signal, design_motion, signal

Array = NDArray[np.float64]

LANES = 128
"""Designs in a block: its working arrays stay in the first-level cache."""
_STEPS = 7
_CANDIDATES = 2
_FLAT = 1e-13
_TORQUE, _WORST, _RSS = int(Signal.TORQUE), int(Signal.POSITION_ERROR), int(Signal.POSITION_ERROR_RSS)


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
def _curve(kind: Any, sine_tau: Any, cosine_tau: Any, kappa: Any, d: Any, direction: Any) -> Any:
    """Value at the crowded angle tau: tan(theta - pi/2) = kappa tan(tau)."""
    y = kappa * sine_tau
    q = inverse(root(cosine_tau * cosine_tau + y * y))
    sine, cosine = cosine_tau * q, -y * q
    m = design_motion(sine, cosine, d)
    outward = d.branch.real * m.x_1.real * direction > 0.0
    load = smooth_load(m, d, d.outward_force if outward else d.inward_force)
    return signal(kind, sine, cosine, m, d, load)


@inlined
def _sample(kind: Any, sine: Any, cosine: Any, kappa: Any, block: Any, direction: Any, out: Any) -> Any:
    """Values of all lanes at one crowded angle. One loop a kind: within each the choice of formula is folded away."""
    if kind == _TORQUE:
        for j in range(LANES):
            out[j] = _curve(_TORQUE, sine, cosine, kappa[j], design_at(block, j), direction)
    elif kind == _WORST:
        for j in range(LANES):
            out[j] = _curve(_WORST, sine, cosine, kappa[j], design_at(block, j), direction)
    else:
        for j in range(LANES):
            out[j] = _curve(_RSS, sine, cosine, kappa[j], design_at(block, j), direction)


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


@inlined
def _partials(kind: Any, sine: Any, cosine: Any, kappa: Any, block: Any, direction: Any, slope: Any) -> Any:
    """Derivative along the imaginary step that `block` carries, at each lane's own angle."""
    if kind == _TORQUE:
        for j in range(LANES):
            z = _curve(_TORQUE, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
            slope[j] = z.imag * (1.0 / STEP)
    elif kind == _WORST:
        for j in range(LANES):
            z = _curve(_WORST, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
            slope[j] = z.imag * (1.0 / STEP)
    else:
        for j in range(LANES):
            z = _curve(_RSS, sine[j], cosine[j], kappa[j], design_at(block, j), direction)
            slope[j] = z.imag * (1.0 / STEP)


@inlined
def _refine(
    kind: Any,
    tau_sine: Any,
    tau_cosine: Any,
    h: Any,
    index: Any,
    delta: Any,
    bend: Any,
    kappa: Any,
    block: Any,
    direction: Any,
    best: Any,
    sines: Any,
    cosines: Any,
) -> Any:
    """Move every lane to its local maximum within one angle on either side; `delta` holds the parabola's vertex."""
    low, high = np.full(LANES, -h), np.full(LANES, h)
    old, old_slope = np.zeros(LANES), np.zeros(LANES)
    base_sine, base_cosine = np.empty(LANES), np.empty(LANES)
    sine, cosine, value, slope = np.empty(LANES), np.empty(LANES), np.empty(LANES), np.empty(LANES)
    for j in range(LANES):
        base_sine[j], base_cosine[j] = tau_sine[index[j]], tau_cosine[index[j]]
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
            t = delta[j]
            better = value[j] >= best[j] - _FLAT * abs(best[j])  # on the flat top the later angle is the better
            best[j] = value[j] if better else best[j]
            sines[j] = sine[j] if better else sines[j]
            cosines[j] = cosine[j] if better else cosines[j]
            rising = slope[j] > 0.0
            low[j] = t if rising else low[j]
            high[j] = high[j] if rising else t
            curvature = bend[j] if step == 0 else (slope[j] - old_slope[j]) / (t - old[j])
            trial = t - slope[j] / curvature
            inside = (trial > low[j]) & (trial < high[j])
            old[j] = t
            old_slope[j] = slope[j]
            delta[j] = trial if inside else 0.5 * (low[j] + high[j])


@kernel
def _screen(
    kind: Any,
    raw: Any,
    designs: Any,
    load_kind: Any,
    load_datum: Any,
    angles: Any,
    crowd: Any,
    values: Any,
    where: Any,
    gradients: Any,
) -> Any:
    n = designs.shape[0]
    rows = DESIGN + 2 * load_kind.shape[0]
    lanes = np.empty((raw.shape[0], LANES))
    stepped = np.empty((raw.shape[0], LANES), np.complex128)
    block = np.empty((rows, LANES))
    complex_block = np.empty((rows, LANES), np.complex128)
    for i in range(raw.shape[0]):
        lanes[i, :] = raw[i]
    tau_sine, tau_cosine = np.empty(angles), np.empty(angles)
    h = 2.0 * math.pi / angles
    for k in range(angles):
        tau_sine[k], tau_cosine[k] = math.sin(k * h), math.cos(k * h)
    direction = 1.0 if raw[4] >= 0.0 else -1.0
    kappa = np.ones(LANES)
    before, here, after = np.empty(LANES), np.empty(LANES), np.empty(LANES)
    estimate = np.empty((_CANDIDATES, LANES))
    index = np.empty((_CANDIDATES, LANES), np.int64)
    delta, bend = np.empty((_CANDIDATES, LANES)), np.empty((_CANDIDATES, LANES))
    value = np.empty((_CANDIDATES, LANES))
    sines, cosines = np.empty((_CANDIDATES, LANES)), np.empty((_CANDIDATES, LANES))
    for begin in range(0, n, LANES):
        for i in range(3):
            for j in range(LANES):
                lanes[i, j] = designs[min(begin + j, n - 1), i]
        derive(lanes, load_kind, load_datum, block)
        if crowd:
            for j in range(LANES):
                kappa[j] = crowding(lanes[0, j], lanes[1, j], lanes[2, j])
        for j in range(LANES):
            estimate[0, j] = estimate[1, j] = -1.0
            index[0, j] = index[1, j] = 0
            delta[0, j] = delta[1, j] = 0.0
            bend[0, j] = bend[1, j] = -1.0
        _sample(kind, tau_sine[angles - 1], tau_cosine[angles - 1], kappa, block, direction, before)
        _sample(kind, tau_sine[0], tau_cosine[0], kappa, block, direction, here)
        for k in range(1, angles + 1):
            w = k if k < angles else 0
            _sample(kind, tau_sine[w], tau_cosine[w], kappa, block, direction, after)
            for j in range(LANES):
                rise = 0.5 * (after[j] - before[j])
                second = after[j] - 2.0 * here[j] + before[j]
                top = (here[j] >= before[j]) & (here[j] > after[j])
                vertex = here[j] - 0.5 * rise * rise / second
                first = top & (vertex > estimate[0, j])
                other = top & (vertex > estimate[1, j])
                at, curve = -rise / second * h, second / (h * h)
                estimate[1, j] = estimate[0, j] if first else (vertex if other else estimate[1, j])
                index[1, j] = index[0, j] if first else (k - 1 if other else index[1, j])
                delta[1, j] = delta[0, j] if first else (at if other else delta[1, j])
                bend[1, j] = bend[0, j] if first else (curve if other else bend[1, j])
                estimate[0, j] = vertex if first else estimate[0, j]
                index[0, j] = k - 1 if first else index[0, j]
                delta[0, j] = at if first else delta[0, j]
                bend[0, j] = curve if first else bend[0, j]
                before[j], here[j] = here[j], after[j]
        for i in range(_CANDIDATES):
            _refine(
                kind,
                tau_sine,
                tau_cosine,
                h,
                index[i],
                delta[i],
                bend[i],
                kappa,
                block,
                direction,
                value[i],
                sines[i],
                cosines[i],
            )
        for j in range(LANES):
            second_wins = value[1, j] > value[0, j]
            value[0, j] = value[1, j] if second_wins else value[0, j]
            sines[0, j] = sines[1, j] if second_wins else sines[0, j]
            cosines[0, j] = cosines[1, j] if second_wins else cosines[0, j]
        last = min(LANES, n - begin)
        for j in range(last):
            values[begin + j] = value[0, j]
            angle = 0.5 * math.pi + math.atan2(kappa[j] * sines[0, j], cosines[0, j])
            where[begin + j] = angle if angle >= 0.0 else angle + 2.0 * math.pi
        if gradients.shape[0]:
            for i in range(raw.shape[0]):
                for j in range(LANES):
                    stepped[i, j] = lanes[i, j]
            for v in range(3):
                for j in range(LANES):
                    stepped[v, j] += complex(0.0, STEP)
                derive(stepped, load_kind, load_datum, complex_block)
                _partials(kind, sines[0], cosines[0], kappa, complex_block, direction, before)
                for j in range(LANES):
                    stepped[v, j] = lanes[v, j]
                for j in range(last):
                    gradients[begin + j, v] = before[j]


def screen(
    mechanism: Mechanism,
    kind: Signal,
    designs: Array,
    *,
    gradients: bool = False,
    angles: int = ANGLES,
    crowd: bool = True,
) -> Screened:
    """Return the greatest value of torque or position error for designs (n, 3): crank, rod, offset, m.

    angles: samples a turn, a multiple of 4. crowd: concentrate them where the linkage comes close to locking.
    """
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    n = len(designs)
    values, where = np.empty(n), np.empty(n)
    slopes = np.empty((n if gradients else 0, 3))
    raw, loads = raw_vector(mechanism), load_structure(mechanism)

    def work(begin: int, end: int) -> None:
        _screen(
            int(kind),
            raw,
            designs[begin:end],
            loads.kind,
            loads.datum,
            angles,
            crowd,
            values[begin:end],
            where[begin:end],
            slopes[begin:end] if gradients else slopes,
        )

    in_chunks(n, work, size=16 * LANES)
    return Screened(values, where, slopes if gradients else None)
