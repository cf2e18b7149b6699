"""Maximum combinations of stress among samples over the cycle, by polynomials between neighbours.

Between two samples, each coefficient of `section_forces.Stress` is the cubic that matches values and slopes at both.
The maximum of p sigma(xi, theta) - q sigma(xi, phi) is found in closed form for both crank angles, and by secants along
the bar. Its error falls with the fourth power of the distance between samples.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..kernel.arithmetic import analytic
from ..kernel.kernel import Cube, Flags, Integers, IntegerTable, Row, Table, rarely_used_kernel

STATIONS = 9
"""Locations along the bar at which samples are taken."""
LISTED = 6
"""Local maxima of the stress at one location over the cycle."""
_ITERATIONS = 60
_CONVERGED = 1e-11  # fraction of the length
_SLOPE = 7  # first column of the slopes over the crank angle
_PLACE, _ANGLE = 1e-5, 1e-9  # fraction of the length, and 1 - cosine of crank angles: maxima this close are one


class Candidates(NamedTuple):
    """Starting points of c maxima; all (c,), `samples` (c, 2).

    bar: index of the bar. side: index of its side. pull: index of the criterion. samples: those next to both crank
    angles. share: location along the bar.
    """

    bar: Integers
    side: Integers
    pull: Integers
    samples: IntegerTable
    share: Row


def uninitialised_candidates(count: int) -> Candidates:
    """Return empty arrays for candidates."""
    columns = [np.empty(count, np.int64) for _ in range(3)]
    return Candidates(columns[0], columns[1], columns[2], np.empty((count, 2), np.int64), np.empty(count))


def first_rows_of_candidates(candidates: Candidates, count: int) -> Candidates:
    """Return the first candidates."""
    return Candidates(
        candidates.bar[:count],
        candidates.side[:count],
        candidates.pull[:count],
        candidates.samples[:count],
        candidates.share[:count],
    )


@analytic
def _stress_of_sample(row: Any, k: Any, base: Any, side: Any, xi: Any) -> Any:
    """Stress of a sample at a location; with base + 7, its slope over the crank angle."""
    axial = row[k, base] + xi * (row[k, base + 1] + xi * row[k, base + 2])
    bent = row[k, base + 4] + xi * (row[k, base + 5] + xi * row[k, base + 6])
    return axial + side * (row[k, base + 3] + xi * bent)


@analytic
def _stress_slope_of_sample(row: Any, k: Any, base: Any, side: Any, xi: Any) -> Any:
    """Slope of `_stress_of_sample` over the location."""
    axial = row[k, base + 1] + 2.0 * xi * row[k, base + 2]
    return axial + side * (row[k, base + 4] + xi * (2.0 * row[k, base + 5] + 3.0 * xi * row[k, base + 6]))


@analytic
def _list_maxima(row: Any, first: Any, begin: Any, count: Any, sign: Any, listed: Any) -> int:
    """List the highest local maxima of sign times a row of samples, segment ends included; return their number."""
    n = 0
    for k in range(count):
        value = sign * row[k]
        left = -math.inf if first[begin + k] else sign * row[k - 1]
        right = -math.inf if k + 1 == count or first[begin + k + 1] else sign * row[k + 1]
        if value < left or value <= right or (n == LISTED and value <= sign * row[listed[n - 1]]):
            continue
        i = min(n, LISTED - 1)
        while i > 0 and sign * row[listed[i - 1]] < value:
            listed[i] = listed[i - 1]
            i -= 1
        listed[i] = k
        n = min(n + 1, LISTED)
    return n


class SampledStress(NamedTuple):
    """Samples (s,) of a link's stress over the cycles of designs, one design after the other.

    theta: crank angles, rad. begins: whether a segment begins. stress: (s, 2 WIDE), coefficients and their slopes over
    the crank angle. sides: (f,), 1 or -1.
    """

    theta: Row
    begins: Flags
    stress: Table
    sides: Row


@analytic
def _fill_greatest_combinations(samples: SampledStress, begin: int, count: int, criteria: Any, best: Any) -> float:
    """Fill `best` (sides, m, STATIONS) with each criterion's maximum over samples; return the overall maximum."""
    greatest = -math.inf
    for f in range(samples.sides.shape[0]):
        for j in range(STATIONS):
            xi = j / (STATIONS - 1.0)
            top, bottom = -math.inf, math.inf
            for k in range(count):
                value = _stress_of_sample(samples.stress, begin + k, 0, samples.sides[f], xi)
                top, bottom = max(top, value), min(bottom, value)
            for g in range(criteria.shape[0]):
                best[f, g, j] = criteria[g, 0] * top - criteria[g, 1] * bottom
                greatest = max(greatest, best[f, g, j])
    return float(greatest)


@rarely_used_kernel
def list_maximum_candidates(
    start: Integers,
    samples: SampledStress,
    criteria: Table,
    margin: float,
    space: Table,
    listed: IntegerTable,
    best: Cube,
    candidates: Candidates,
) -> int:
    """List the samples next to maxima within the fraction `margin` of the overall maximum; return their number.

    start: (n + 1,), where the samples of each design begin. criteria: (m, 2), p and q. space: (STATIONS, samples of a
    design), listed: (2, LISTED), best: (sides, m, STATIONS), work space. candidates: with room for all possible ones.
    """
    stress, sides = samples.stress, samples.sides
    total = 0
    ups, downs = listed[0], listed[1]
    for n in range(start.shape[0] - 1):
        begin, count = start[n], start[n + 1] - start[n]
        if count == 0:
            continue
        greatest = _fill_greatest_combinations(samples, begin, count, criteria, best)
        floor = greatest - margin * abs(greatest)
        for f in range(sides.shape[0]):
            for g in range(criteria.shape[0]):
                p, q = criteria[g, 0], criteria[g, 1]
                for j in range(STATIONS):
                    height = best[f, g, j]
                    left = -math.inf if j == 0 else best[f, g, j - 1]
                    right = -math.inf if j == STATIONS - 1 else best[f, g, j + 1]
                    if height < left or height <= right or height < floor:
                        continue
                    row, xi = space[j], j / (STATIONS - 1.0)
                    for k in range(count):
                        row[k] = _stress_of_sample(stress, begin + k, 0, sides[f], xi)
                    high_count = low_count = 1
                    ups[0] = downs[0] = 0
                    for end in range(2):  # a single call, as the compiler inlines each call separately
                        if end == 0 and p > 0.0:
                            high_count = _list_maxima(row, samples.begins, begin, count, 1.0, ups)
                        elif end == 1 and q > 0.0:
                            low_count = _list_maxima(row, samples.begins, begin, count, -1.0, downs)
                    for pair in range(high_count * low_count):
                        up, down = ups[pair // low_count], downs[pair % low_count]
                        height = (p * row[up] if p > 0.0 else 0.0) - (q * row[down] if q > 0.0 else 0.0)
                        if height < floor:
                            continue
                        candidates.bar[total], candidates.side[total], candidates.pull[total] = n, f, g
                        candidates.samples[total, 0], candidates.samples[total, 1] = begin + up, begin + down
                        candidates.share[total] = xi
                        total += 1
    return total


@analytic
def _angle_of_nearby_maximum(samples: SampledStress, side: Any, sign: Any, xi: Any, k: int) -> Any:
    """Return the sample before the maximum of sign times the stress, near sample k, and its values.

    The values are the crank angle of the maximum, the stress, and its slope over the location. Stays within the
    segment.
    """
    stress, first, last = samples.stress, samples.begins, samples.theta.shape[0] - 1
    t = 0.0
    for _ in range(_ITERATIONS):
        rate = sign * _stress_of_sample(stress, k, _SLOPE, side, xi)
        if rate > 0.0 and k < last and not first[k + 1]:
            if sign * _stress_of_sample(stress, k + 1, _SLOPE, side, xi) < 0.0:
                t = 1.0
                break
            k += 1
        elif rate < 0.0 and not first[k]:
            k -= 1
            if sign * _stress_of_sample(stress, k, _SLOPE, side, xi) > 0.0:
                t = 1.0
                break
        else:
            break
    f0, g0 = _stress_of_sample(stress, k, 0, side, xi), _stress_slope_of_sample(stress, k, 0, side, xi)
    if t == 0.0:
        return k, samples.theta[k], f0, g0
    h = samples.theta[k + 1] - samples.theta[k]
    f1, g1 = _stress_of_sample(stress, k + 1, 0, side, xi), _stress_slope_of_sample(stress, k + 1, 0, side, xi)
    s0 = h * _stress_of_sample(stress, k, _SLOPE, side, xi)
    s1 = h * _stress_of_sample(stress, k + 1, _SLOPE, side, xi)
    # The slope of the cubic is s0 + b t + a t^2; s0 and s1 = s0 + b + a have opposite signs.
    a, b = 3.0 * (s0 + s1) - 6.0 * (f1 - f0), 6.0 * (f1 - f0) - 4.0 * s0 - 2.0 * s1
    width = sign * math.sqrt(max(b * b - 4.0 * a * s0, 0.0))
    t = min(1.0, max(0.0, 2.0 * s0 / (width - b)))
    u = 1.0 - t
    h0, h1, d0, d1 = u * u * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), t * u * u, -t * t * u
    r0 = h * _stress_slope_of_sample(stress, k, _SLOPE, side, xi)
    r1 = h * _stress_slope_of_sample(stress, k + 1, _SLOPE, side, xi)
    value, slope = h0 * f0 + h1 * f1 + d0 * s0 + d1 * s1, h0 * g0 + h1 * g1 + d0 * r0 + d1 * r1
    return k, samples.theta[k] + h * t, value, slope


@rarely_used_kernel
def climb_to_maxima(
    samples: SampledStress, criteria: Table, candidates: Candidates, values: Row, angles: Table
) -> None:
    """Move candidates to the maxima next to them; fill values (c,), locations and angles (c, 2) of these maxima.

    `candidates` is updated in place. The search stays within the segment.
    """
    for c in range(candidates.bar.shape[0]):
        side, criterion = samples.sides[candidates.side[c]], candidates.pull[c]
        xi, lower, upper, ended = candidates.share[c], 0.0, 1.0, False
        old_xi = old_slope = value = 0.0
        for outer in range(_ITERATIONS):
            slope = value = 0.0
            for end in range(2):
                weight = criteria[criterion, 0] if end == 0 else -criteria[criterion, 1]
                if weight == 0.0:
                    continue
                sign = 1.0 if weight > 0.0 else -1.0
                k, angles[c, end], height, rise = _angle_of_nearby_maximum(
                    samples, side, sign, xi, candidates.samples[c, end]
                )
                candidates.samples[c, end] = k
                value += weight * height
                slope += weight * rise
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
            if abs(trial - xi) < _CONVERGED or upper - lower < _CONVERGED:
                break
            xi = trial
        values[c], candidates.share[c] = value, xi


@rarely_used_kernel
def choose_highest_candidates(
    candidates: Candidates, criteria: Table, values: Row, angles: Table, turns: IntegerTable, chosen: IntegerTable
) -> None:
    """Number the highest candidates of each design: kept (n, k), -1 beyond the last one.

    angles, turns: (c, 2), crank angles within a turn and the turns of the cycle that contain them. Among coinciding
    candidates, the highest counts: next to a breakpoint there may be two, one of them at the breakpoint.
    """
    count = -1
    for n in range(chosen.shape[0]):
        for i in range(chosen.shape[1]):
            chosen[n, i] = -1
    chosen_count, last = 0, -1
    for c in range(candidates.bar.shape[0]):
        n = candidates.bar[c]
        if n != last:
            last, chosen_count = n, 0
        p, q = criteria[candidates.pull[c], 0], criteria[candidates.pull[c], 1]
        count = chosen.shape[1]
        place = min(chosen_count, count - 1)
        full = chosen_count == count
        for i in range(chosen_count):
            o = chosen[n, i]
            if (
                candidates.side[o] == candidates.side[c]
                and candidates.pull[o] == candidates.pull[c]
                and abs(candidates.share[o] - candidates.share[c]) < _PLACE
                and (p == 0.0 or (math.cos(angles[o, 0] - angles[c, 0]) > 1.0 - _ANGLE and turns[o, 0] == turns[c, 0]))
                and (q == 0.0 or (math.cos(angles[o, 1] - angles[c, 1]) > 1.0 - _ANGLE and turns[o, 1] == turns[c, 1]))
            ):
                place, full = i, True
        if full and values[c] <= values[chosen[n, place]]:
            continue
        chosen_count += 0 if full else 1
        i = place
        while i > 0 and values[chosen[n, i - 1]] < values[c]:
            chosen[n, i] = chosen[n, i - 1]
            i -= 1
        chosen[n, i] = c
