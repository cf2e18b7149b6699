"""Greatest stresses of crank and rod, and greatest swings of stress, exact over crank angle and place, with gradients.

Of every point of a bar, share xi of its length from the crank pin and face +-, the stress is a smooth curve over each
segment of the cycle (`segments`). Sought is the greatest value of

    p sigma(xi, theta) - q sigma(xi, phi),    p, q >= 0,

over place, face and two crank angles: with (p, q) = (1, 0) and (0, 1) the greatest tension and compression, and with

    2 p = 1 / S_e + 1 / S_m,   2 q = 1 / S_e - 1 / S_m      and      2 p = 2 q = 1 / S_e

the greatest amplitude / S_e + mean / S_m of one point over the cycle, a mean that is compression left out (Goodman's
line with its horizontal part, Shigley, "Mechanical Engineering Design", 9th ed., eq. 6-46): the pair of angles that is
greatest is that of the point's own greatest and least stress, since p, q >= 0.

Samples over crank angle and stations along the bar tell the highest maxima. Each is refined: the place by secants on
the slope along the bar, at each place both angles by secants on their slopes, which the complex step gives. All three
are stationary, or at an end that moves with the design, so the gradient is the partial derivative there (envelope
theorem).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..dynamics.contact import cut_contacts, rubs, shift_of, sides_of
from ..dynamics.rubbing import always_drives
from ..dynamics.segments import (
    Cuts,
    Watch,
    crowded,
    crowding,
    cut_cycle,
    enter,
    load_on_slider,
    room_for,
    uncrowded,
    within,
)
from ..kernel.arithmetic import STEP, analytic
from ..kernel.batches import in_chunks, turning
from ..kernel.kernel import ComplexCube, Cube, Row, Table, seldom_kernel
from ..machine.derived import derived
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.numbers import numbers_of
from ..machine.raw import Loads, Raw
from ..signals.signals import Signal, design_motion
from ..signals.watch import inputs_of, watch_of
from .section_forces import CRANK, ROD, Stress, at_share, slope_at_share, stress_along

Array = NDArray[np.float64]

KEPT = 8
"""Maxima kept of a design, highest first."""
_ANGLES, _STATIONS = 128, 9
_NEAR, _WIDE = 0.05, 0.2  # how far below the highest sample a maximum is refined: for the value, for pieces
_LISTED = 6  # local maxima of a place's stress over the cycle
_ITERATIONS = 60
_TURN = 2.0 * math.pi
_THIN = 1e-13  # rad: breakpoints closer than this are one
_EDGE = 1e-11  # rad, from a breakpoint: on it
_SETTLED = 1e-11  # share of the length
_SAME = 1e-7
_OTHER = 7.0  # weight of the second angle in a label, more than a turn
APART, CLASSES = 60.0, 12
"""Distance of the labels of maxima that are no neighbours, more than a turn; how many classes there are of these."""


@dataclass(frozen=True)
class StressPeaks:
    """Local maxima of n designs, highest first.

    values: (n, k), -inf beyond the last one; inf where friction locks the design. labels: (n, k), what tells those of
    neighbouring designs apart. places: (n, k, 4), share of the length from the crank pin, face, both angles, rad.
    gradients: (n, k, 3 + v); None unless asked for.
    """

    values: Array
    labels: Array
    places: Array
    gradients: Array | None


@analytic
def _bar_at(
    part: Any,
    sine: Any,
    cosine: Any,
    theta: Any,
    d: Any,
    block: Any,
    outward: Any,
    loads: Any,
    piece: Any,
    shift: Any,
    sides: Any,
    w: Any,
    t: Any,
    rho: Any,
) -> Any:
    m = design_motion(sine, cosine, d)
    load = load_on_slider(m, d, block, 0, theta, outward, loads, piece, shift)
    return stress_along(part, sine, cosine, m, d, load, sides, w, t, rho)


@analytic
def _listed(row: Any, first: Any, count: Any, sign: Any, found: Any) -> int:
    """List the highest local maxima of sign times a row of samples, ends of segments included; return how many."""
    n = 0
    for k in range(count):
        value = sign * row[k]
        left = -math.inf if first[k] else sign * row[k - 1]
        right = -math.inf if k + 1 == count or first[k + 1] else sign * row[k + 1]
        if value < left or value <= right or (n == _LISTED and value <= sign * row[found[n - 1]]):
            continue
        i = min(n, _LISTED - 1)
        while i > 0 and sign * row[found[i - 1]] < value:
            found[i] = found[i - 1]
            i -= 1
        found[i] = k
        n = min(n + 1, _LISTED)
    return n


@seldom_kernel
def _find(
    part: int,
    blocks: Cube,
    steps: ComplexCube,
    sizes: Table,
    turned: Table,
    faces: Row,
    criteria: Table,
    loads: Loads,
    watch: Watch,
    wide: float,
    values: Table,
    labels: Table,
    places: Cube,
    gradients: Cube,
    rubbing: bool,
) -> None:
    room = room_for(loads)
    cuts = Cuts(np.empty(room), np.empty(room, np.int64), np.empty(room), np.empty(room, np.int64))
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    nv, kept = gradients.shape[2] if gradients.shape[0] else 0, values.shape[1]
    samples = _ANGLES + 4 * room
    theta, first, owner = np.empty(samples), np.empty(samples, np.bool_), np.empty(samples, np.int64)
    series = np.empty((samples, 7))
    stress, best = np.empty((_STATIONS, samples)), np.empty((faces.shape[0], criteria.shape[0], _STATIONS))
    ups, downs = np.empty(_LISTED, np.int64), np.empty(_LISTED, np.int64)
    at, segment, pin = np.empty(2), np.empty(2, np.int64), np.empty(2, np.int64)
    peak, places_of = np.empty(kept), np.empty((kept, 4))
    label, whose = np.empty(kept), np.empty((kept, 6), np.int64)
    c = Stress(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for n in range(blocks.shape[0]):
        block = blocks[n]
        d = design_at(block, 0)
        w, t, rho = sizes[n, 0], sizes[n, 1], sizes[n, 2]
        kappa = crowding(d.r, d.l, d.e)
        values[n, :], labels[n, :], places[n, :, :] = -np.inf, 0.0, np.nan
        if nv:
            gradients[n] = 0.0
        if rubbing and not always_drives(d) > 0.0:
            values[n, 0] = np.inf
            continue
        count = cut_cycle(d, block, 0, loads, watch, cuts)
        if rubbing:
            count = cut_contacts(d, block, 0, loads, watch, cuts, count, piece, shift)
        cuts.angle[count] = cuts.angle[0] + _TURN
        total = 0
        for s in range(count):
            a, b = cuts.angle[s], cuts.angle[s + 1]
            if b - a < _THIN:
                continue
            inside = within(a, b)
            _, outward = enter(d, block, 0, inside, loads, watch, piece, shift)
            sides = sides_of(inside, d, block, 0, outward, loads, piece, shift, rubbing)
            low, high = crowded(a, kappa), crowded(b, kappa)
            points = max(3, int(_ANGLES * (high - low) / _TURN) + 2)
            for i in range(points):
                angle = uncrowded(low + (high - low) * i / (points - 1), kappa)
                angle = a if i == 0 else b if i == points - 1 else angle
                theta[total], first[total], owner[total] = angle, i == 0, s
                sine, cosine = math.sin(angle), math.cos(angle)
                c = _bar_at(part, sine, cosine, angle, d, block, outward, loads, piece, shift, sides, w, t, rho)
                series[total, 0], series[total, 1], series[total, 2] = c.n0, c.n1, c.n2
                series[total, 3], series[total, 4], series[total, 5], series[total, 6] = c.b0, c.b1, c.b2, c.b3
                total += 1
        whole = -math.inf
        for f in range(faces.shape[0]):
            for j in range(_STATIONS):
                xi = j / (_STATIONS - 1.0)
                top, bottom = -math.inf, math.inf
                for k in range(total):
                    value = series[k, 0] + xi * (series[k, 1] + xi * series[k, 2])
                    moment = series[k, 4] + xi * (series[k, 5] + xi * series[k, 6])
                    value += faces[f] * (series[k, 3] + xi * moment)
                    top, bottom = max(top, value), min(bottom, value)
                for g in range(criteria.shape[0]):
                    best[f, g, j] = criteria[g, 0] * top - criteria[g, 1] * bottom
                    whole = max(whole, best[f, g, j])
        found, floor = 0, whole - wide * abs(whole)
        for f in range(faces.shape[0]):
            for g in range(criteria.shape[0]):
                p, q, face = criteria[g, 0], criteria[g, 1], faces[f]
                for j in range(_STATIONS):
                    height = best[f, g, j]
                    left = -math.inf if j == 0 else best[f, g, j - 1]
                    right = -math.inf if j == _STATIONS - 1 else best[f, g, j + 1]
                    if height < left or height <= right or height < floor:
                        continue
                    start = j / (_STATIONS - 1.0)
                    for k in range(total):
                        value = series[k, 0] + start * (series[k, 1] + start * series[k, 2])
                        moment = series[k, 4] + start * (series[k, 5] + start * series[k, 6])
                        stress[j, k] = value + face * (series[k, 3] + start * moment)
                    high_count = _listed(stress[j], first, total, 1.0, ups) if p > 0.0 else 1
                    low_count = _listed(stress[j], first, total, -1.0, downs) if q > 0.0 else 1
                    for pair in range(high_count * low_count):
                        up = ups[pair // low_count] if p > 0.0 else 0
                        down = downs[pair % low_count] if q > 0.0 else 0
                        height = (p * stress[j, up] if p > 0.0 else 0.0) - (q * stress[j, down] if q > 0.0 else 0.0)
                        if height < floor:
                            continue
                        xi, lower, upper, ended = start, 0.0, 1.0, False
                        at[0], segment[0], pin[0] = theta[up], owner[up], -1
                        at[1], segment[1], pin[1] = theta[down], owner[down], -1
                        old_xi = old_slope = value = 0.0
                        for outer in range(_ITERATIONS):
                            slope = value = 0.0
                            for which in range(2):
                                weight = p if which == 0 else -q
                                if weight == 0.0:
                                    continue
                                s = segment[which]
                                a, b = cuts.angle[s], cuts.angle[s + 1]
                                inside = within(a, b)
                                _, outward = enter(d, block, 0, inside, loads, watch, piece, shift)
                                sides = sides_of(inside, d, block, 0, outward, loads, piece, shift, rubbing)
                                # Two spacings to either side; where samples are crowded that is less of an angle.
                                spacing = 2.5 * _TURN / _ANGLES * max(kappa, 0.02)
                                angle = at[which]
                                tau = crowded(angle, kappa)
                                step = 1.5 * _TURN / _ANGLES
                                begin = max(a, angle - max(spacing, angle - uncrowded(tau - step, kappa)))
                                end = min(b, angle + max(spacing, uncrowded(tau + step, kappa) - angle))
                                old_angle = old_rate = 0.0
                                for inner in range(_ITERATIONS):
                                    sine, cosine = math.sin(angle), math.cos(angle)
                                    zs, zc = complex(sine, cosine * STEP), complex(cosine, -sine * STEP)
                                    ztheta = complex(angle, STEP)
                                    z = _bar_at(
                                        part, zs, zc, ztheta, d, block, outward, loads, piece, shift, sides, w, t, rho
                                    )
                                    z_value = at_share(z, face, xi)
                                    rate = weight * z_value.imag / STEP
                                    if rate > 0.0:
                                        begin = angle
                                    elif rate < 0.0:
                                        end = angle
                                    else:
                                        break
                                    trial = 0.5 * (begin + end)
                                    if inner == 0:
                                        near = angle + math.copysign(1e-4, rate)
                                        trial = near if begin < near < end else trial
                                    elif rate != old_rate:
                                        secant = angle - rate * (angle - old_angle) / (rate - old_rate)
                                        trial = secant if begin < secant < end else trial
                                    old_angle, old_rate = angle, rate
                                    if abs(trial - angle) < 4e-16 * _TURN or end - begin < 1e-15:
                                        break
                                    angle = trial
                                pin[which] = -1
                                if angle - a < _EDGE:
                                    angle, pin[which] = a, s
                                elif b - angle < _EDGE:
                                    angle, pin[which] = b, (s + 1) % count
                                at[which] = angle
                                value += weight * z_value.real
                                slope += weight * slope_at_share(z, face, xi).real
                            if slope > 0.0:
                                lower = xi
                            elif slope < 0.0:
                                upper = xi
                            else:
                                break
                            if (xi == 0.0 and slope < 0.0) or (xi == 1.0 and slope > 0.0):
                                break
                            if outer == 0:
                                trial = xi + math.copysign(1e-3, slope)
                            elif slope != old_slope:
                                trial = xi - slope * (xi - old_xi) / (slope - old_slope)
                            else:
                                trial = 0.5 * (lower + upper)
                            if not lower < trial < upper:
                                if trial >= upper and upper == 1.0 and not ended:
                                    trial, ended = 1.0, True
                                elif trial <= lower and lower == 0.0 and not ended:
                                    trial, ended = 0.0, True
                                else:
                                    trial = 0.5 * (lower + upper)
                            old_xi, old_slope = xi, slope
                            if abs(trial - xi) < _SETTLED or upper - lower < _SETTLED:
                                break
                            xi = trial
                        number = (f * criteria.shape[0] + g) * 3 + (1 if xi == 0.0 else 2 if xi == 1.0 else 0)
                        own = APART * number
                        own += at[0] - _TURN * math.floor(at[0] / _TURN) if p > 0.0 else 0.0
                        own += _OTHER * (at[1] - _TURN * math.floor(at[1] / _TURN)) if q > 0.0 else 0.0
                        known = False
                        for i in range(found):
                            known = known or (
                                whose[i, 0] == f
                                and whose[i, 1] == g
                                and abs(places_of[i, 0] - xi) < 1e-5
                                and (p == 0.0 or math.cos(places_of[i, 2] - at[0]) > 1.0 - 1e-9)
                                and (q == 0.0 or math.cos(places_of[i, 3] - at[1]) > 1.0 - 1e-9)
                            )
                        if known or (found == kept and value <= peak[kept - 1]):
                            continue
                        i = min(found, kept - 1)
                        while i > 0 and peak[i - 1] < value:
                            peak[i], label[i] = peak[i - 1], label[i - 1]
                            places_of[i], whose[i] = places_of[i - 1], whose[i - 1]
                            i -= 1
                        peak[i], label[i] = value, own
                        places_of[i, 0], places_of[i, 1], places_of[i, 2], places_of[i, 3] = xi, face, at[0], at[1]
                        whose[i, 0], whose[i, 1] = f, g
                        whose[i, 2], whose[i, 3], whose[i, 4], whose[i, 5] = segment[0], segment[1], pin[0], pin[1]
                        found = min(found + 1, kept)
        for i in range(found):
            values[n, i], labels[n, i] = peak[i], label[i]
            places[n, i] = places_of[i]
            xi, face = places_of[i, 0], places_of[i, 1]
            for which in range(2 if nv else 0):
                weight = criteria[whose[i, 1], 0] if which == 0 else -criteria[whose[i, 1], 1]
                if weight == 0.0:
                    continue
                s, own_pin, angle = whose[i, 2 + which], whose[i, 4 + which], places_of[i, 2 + which]
                inside = within(cuts.angle[s], cuts.angle[s + 1])
                _, outward = enter(d, block, 0, inside, loads, watch, piece, shift)
                sides = sides_of(inside, d, block, 0, outward, loads, piece, shift, rubbing)
                sine, cosine = math.sin(angle), math.cos(angle)
                for v in range(nv):
                    stepped = steps[n * nv + v]
                    z_design = design_at(stepped, 0)
                    slip = 0.0
                    if own_pin >= 0:
                        slip = shift_of(
                            z_design, stepped, d, block, angle, cuts, own_pin, outward, loads, piece, shift, sides
                        )
                    zs, zc = complex(sine, cosine * slip), complex(cosine, -sine * slip)
                    zw, zt = complex(w, turned[v, 0] * STEP), complex(t, turned[v, 1] * STEP)
                    z = _bar_at(
                        part,
                        zs,
                        zc,
                        complex(angle, slip),
                        z_design,
                        stepped,
                        outward,
                        loads,
                        piece,
                        shift,
                        sides,
                        zw,
                        zt,
                        complex(rho, turned[v, 2] * STEP),
                    )
                    gradients[n, i, v] += weight * at_share(z, face, xi).imag / STEP


def stress_peaks(
    mechanism: Mechanism,
    part: int,
    designs: Array,
    criteria: Array,
    *,
    bending: bool = True,
    gradients: bool = False,
    kept: int = KEPT,
) -> StressPeaks:
    """Return the greatest p sigma - q sigma of rod or crank of designs (n, 3 + k).

    criteria: (m, 2), p and q of each, none negative. bending: whether moments count, else the axial stress alone.
    kept: maxima returned a design; with one only the highest ones are followed. The link must be a `Bar`.
    """
    assert part in (ROD, CRANK)
    designs = turning(designs)
    n = len(designs)
    raw, loads = inputs_of(mechanism, Signal.CRANK_PIN_FORCE)
    numbers = numbers_of(mechanism, designs, room=len(raw), gradients=gradients)
    columns, designs = numbers.columns, numbers.values
    values, labels, places = np.empty((n, kept)), np.empty((n, kept)), np.empty((n, kept, 4))
    slopes = np.empty((n if gradients else 0, kept, len(columns)))
    slots = np.arange(3) + (Raw.ROD_WIDTH if part == ROD else Raw.CRANK_WIDTH)
    sizes = np.empty((n, 3))
    for place, slot in enumerate(slots.tolist()):
        own = np.flatnonzero(columns == slot)
        sizes[:, place] = designs[:, own[0]] if len(own) else raw[slot]
    turned = np.ascontiguousarray((columns[:, None] == slots) * 1.0)
    faces = np.array([1.0, -1.0] if bending else [0.0])
    watch = watch_of(mechanism, Signal.CRANK_PIN_FORCE)
    criteria = np.ascontiguousarray(criteria, dtype=np.float64)

    def work(begin: int, end: int) -> None:
        blocks, steps = derived(raw, loads, columns, designs[begin:end], steps=gradients)
        _find(
            part,
            blocks,
            steps,
            sizes[begin:end],
            turned,
            faces,
            criteria,
            loads,
            watch,
            _NEAR if kept == 1 else _WIDE,
            values[begin:end],
            labels[begin:end],
            places[begin:end],
            slopes[begin:end] if gradients else slopes,
            rubs(mechanism),
        )

    in_chunks(n, work)
    return StressPeaks(values, labels, places, numbers.chain(slopes) if gradients else None)
