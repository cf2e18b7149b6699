"""Deviation of the slider's motion from a target motion, given as points (crank angle, position).

With x the slider's distance from the crank pivot along its line and (theta_i, t_i) the points, the deviations are

    d_i = x(theta_i + phase) + shift - t_i,

judged by their maximum magnitude or their root mean square over the points. Phase and shift are zero or, where free,
chosen to minimise the deviation: a crank keyed to its shaft at another angle, a tool clamped elsewhere on the slider.
The best shift has a closed form (mid-range or mean). The best phase is searched over the whole turn. Branch and bound
minimises the maximum deviation; the smooth root mean square is minimised from the best intervals of a grid.
"""

import itertools
import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from ..arrays import Array
from ..checks import store_as_tuples
from ..errors import InputError
from ..kernel.arithmetic import analytic
from ..kernel.batches import require_full_rotation, run_in_chunks
from ..kernel.kernel import Row, Table, rarely_used_kernel
from .position import motion

Freedom = Literal["fixed", "free"]
Measure = Literal["greatest", "rms"]

_PHASES = 96  # number of phases in the grid
_HALVINGS = 14  # halvings of its cells: down to 4e-6 rad
_STRETCHES = 3  # best intervals of the grid that are searched further
_SECTIONS = 60  # golden sections from two grid spacings down to rounding
_NEWTON = 4
_GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
_TURN = 2.0 * math.pi


@dataclass(frozen=True, kw_only=True)
class TargetMotion:
    """Target motion for the slider.

    crank_angles: rad, increasing, within one turn. positions: slider positions, m, outward from the crank pivot. phase:
    whether the crank may be fixed to its shaft at any angle. shift: whether positions may be counted from any origin.
    """

    crank_angles: tuple[float, ...]
    positions: tuple[float, ...]
    phase: Freedom = "fixed"
    shift: Freedom = "fixed"

    def __post_init__(self) -> None:
        store_as_tuples(self, "crank_angles", "positions")
        for name in ("phase", "shift"):
            if getattr(self, name) not in ("fixed", "free"):
                raise InputError(f"{name} of a target motion must be 'fixed' or 'free'; got {getattr(self, name)!r}")
        angles, positions = self.crank_angles, self.positions
        if len(angles) != len(positions) or len(angles) < 3:
            raise InputError(
                f"a target motion needs as many positions as crank angles, at least three; got {len(angles)} crank "
                f"angles and {len(positions)} positions"
            )
        if not all(math.isfinite(value) for value in (*angles, *positions)):
            raise InputError("crank angles and positions of a target motion must be finite throughout")
        for before, after in itertools.pairwise(angles):
            if after <= before:
                raise InputError(
                    f"crank angles of a target motion must increase; got {after:g} after {before:g} rad; sort the "
                    "table and remove repeated points"
                )
        if angles[-1] - angles[0] >= _TURN:
            raise InputError(
                "crank angles of a target motion must span less than one turn, 360 deg; "
                f"got {math.degrees(angles[-1] - angles[0]):g} deg; leave out the repeated points"
            )


class Fit(NamedTuple):
    """Minimum deviation (n,), m, for n designs, with its phase, rad, in [-pi, pi) and shift, m."""

    values: Array
    phase: Array
    shift: Array


class _Case(NamedTuple):
    """One linkage and the points (n,) of the target motion. b: its branch, +1 or -1. shifts: whether a shift is free.

    sines, cosines: those of the points' crank angles. positions: positions of the points. d, slope, bend: work space
    for each point's deviation and its derivatives with respect to the phase.
    """

    r: float
    l: float
    e: float
    b: float
    sines: Row
    cosines: Row
    positions: Row
    shifts: bool
    d: Row
    slope: Row
    bend: Row


@analytic
def _deviation_and_best_shift(phase: Any, rms: Any, case: _Case) -> tuple[float, float]:
    """Return the deviation at a phase and the best shift, zero where fixed; fills each point's deviation."""
    r, l, e, b, sines, cosines, positions, shifts, d, _, _ = case
    n = positions.shape[0]
    # Angle-sum formulas avoid sines and cosines within the loop.
    p, q = r * math.sin(phase), r * math.cos(phase)
    high, low, total = -math.inf, math.inf, 0.0
    for i in range(n):
        l_sin = e - (sines[i] * q + cosines[i] * p)
        d[i] = b * (cosines[i] * q - sines[i] * p) + math.sqrt(l * l - l_sin * l_sin) - positions[i]
        high, low, total = max(high, d[i]), min(low, d[i]), total + d[i]
    if rms:
        mean = total / n if shifts else 0.0
        total = 0.0
        for i in range(n):
            total += (d[i] - mean) * (d[i] - mean)
        return math.sqrt(total / n), -mean
    if shifts:
        return 0.5 * (high - low), -0.5 * (high + low)
    return max(high, -low), 0.0


@analytic
def _newton_step(phase: Any, case: _Case) -> float:
    """Return the Newton step in the phase for the mean square deviation; zero where it is not convex."""
    r, l, e, b, sines, cosines, positions, shifts, d, slope, bend = case
    n = positions.shape[0]
    p, q = math.sin(phase), math.cos(phase)
    mean = mean_slope = 0.0
    for i in range(n):
        m = motion(sines[i] * q + cosines[i] * p, cosines[i] * q - sines[i] * p, r, l, e, b)
        slope[i], bend[i] = b * m.x_1, b * m.x_2
        mean, mean_slope = mean + d[i] / n, mean_slope + slope[i] / n
    if not shifts:
        mean = mean_slope = 0.0
    first = second = 0.0
    for i in range(n):
        first += (d[i] - mean) * slope[i]
        second += (slope[i] - mean_slope) * (slope[i] - mean_slope) + (d[i] - mean) * bend[i]
    return float(-first / second) if second > 0.0 else 0.0


@analytic
def _phase_by_golden_section(low: Any, high: Any, rms: Any, case: _Case) -> float:
    """Return the phase with the minimum deviation between two phases, by golden-section search."""
    p, q = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_p = at_q = 0.0
    left = True
    for step in range(_SECTIONS):
        value, _ = _deviation_and_best_shift(p if left else q, rms, case)
        if left:
            at_p = value
        else:
            at_q = value
        if step == 0:
            left = False
        elif at_p <= at_q:
            high, q, at_q = q, p, at_p
            p, left = high - _GOLDEN * (high - low), True
        else:
            low, p, at_p = p, q, at_q
            q, left = low + _GOLDEN * (high - low), False
    return float(0.5 * (low + high))


@analytic
def _bound_deviation(phase: Any, half: Any, bend: Any, case: _Case) -> Any:
    """Return the maximum deviation at a phase, and its lower bound within `half` of that phase.

    bend: bound on the deviations' curvature. If the shift is free, the common part of the deviations, and of their
    slopes, does not count.
    """
    r, l, e, b, sines, cosines, positions, shifts, d, slope, _ = case
    p, q = r * math.sin(phase), r * math.cos(phase)
    high = low = -math.inf
    common = rising = falling = 0.0
    for i in range(positions.shape[0]):
        up, out = sines[i] * q + cosines[i] * p, cosines[i] * q - sines[i] * p
        l_sin = e - up
        l_cos = math.sqrt(l * l - l_sin * l_sin)
        d[i], slope[i] = b * out + l_cos - positions[i], l_sin * out / l_cos - b * up
        if d[i] > high:
            high, rising = d[i], slope[i]
        if -d[i] > low:
            low, falling = -d[i], slope[i]
    if shifts:
        common = 0.5 * (rising + falling)
    high_least = low_least = -math.inf
    for i in range(positions.shape[0]):
        loss = half * abs(slope[i] - common)
        high_least, low_least = max(high_least, d[i] - loss), max(low_least, -d[i] - loss)
    rest = 0.5 * bend * half * half
    if shifts:
        return 0.5 * (high + low), 0.5 * (high_least + low_least) - rest
    return max(high, low), max(high_least, low_least) - rest


@analytic
def _phase_of_least_maximum(case: _Case, cells: Any) -> float:
    """Return the phase that minimises the maximum deviation.

    The curvature of a deviation is bounded by the slider's maximum acceleration over a turn. Cells of the phase whose
    bound exceeds the best value so far are therefore discarded. The others are halved until the function within one is
    practically convex.
    """
    bend, half = 0.0, math.pi / _PHASES
    for j in range(_PHASES):
        theta = 2.0 * half * j
        bend = max(bend, abs(motion(math.sin(theta), math.cos(theta), case.r, case.l, case.e, case.b).x_2))
        cells[0, j] = theta
    bend *= 1.1  # between the samples
    count, best, at_best = _PHASES, math.inf, 0.0
    for _ in range(_HALVINGS):
        for j in range(count):
            value, cells[1, j] = _bound_deviation(cells[0, j], half, bend, case)
            if value < best:
                best, at_best = value, cells[0, j]
        open_cells = 0
        for j in range(count):
            if cells[1, j] <= best and 2 * open_cells + 1 < cells.shape[1]:
                cells[2, open_cells] = cells[0, j]
                open_cells += 1
        half *= 0.5
        for j in range(open_cells):
            cells[0, 2 * j], cells[0, 2 * j + 1] = cells[2, j] - half, cells[2, j] + half
        count = 2 * open_cells
    return _phase_by_golden_section(at_best - 4.0 * half, at_best + 4.0 * half, False, case)


@analytic
def _phase_of_least_rms(case: _Case, grid: Any) -> float:
    """Return the phase with the minimum root mean square deviation, searched from the best intervals of the grid."""
    for j in range(_PHASES):
        grid[j], _ = _deviation_and_best_shift(_TURN * j / _PHASES, True, case)
    best_phase, least, last, j = 0.0, math.inf, -math.inf, -1
    for _ in range(_STRETCHES):
        best = -1
        for k in range(_PHASES):
            if grid[k] > grid[k - 1] or grid[k] > grid[(k + 1) % _PHASES]:
                continue
            later = grid[k] > last or (grid[k] == last and k > j)
            if later and (best < 0 or grid[k] < grid[best]):
                best = k
        if best < 0:
            break
        j, last = best, grid[best]
        low, high = _TURN * (j - 1) / _PHASES, _TURN * (j + 1) / _PHASES
        phase = _phase_by_golden_section(low, high, True, case)
        for turn in range(_NEWTON + 1):
            value, _ = _deviation_and_best_shift(phase, True, case)
            step = _newton_step(phase, case)
            if abs(step) > 1e-5 or turn == _NEWTON:  # if the square is convex, golden-section search errs by less
                break
            phase += step
        if value < least:
            best_phase, least = phase, value
    return best_phase


@rarely_used_kernel
def _fill_fits(
    designs: Table, b: float, angles: Row, positions: Row, rms: bool, turns: bool, shifts: bool, out: Table
) -> None:
    d, slope, bend = np.empty(positions.shape[0]), np.empty(positions.shape[0]), np.empty(positions.shape[0])
    sines, cosines, cells, grid = np.sin(angles), np.cos(angles), np.empty((3, 4 * _PHASES)), np.empty(_PHASES)
    for row in range(designs.shape[0]):
        r, l, e = designs[row, 0], designs[row, 1], designs[row, 2]
        case = _Case(r, l, e, b, sines, cosines, positions, shifts, d, slope, bend)
        phase = 0.0
        if turns and rms:
            phase = _phase_of_least_rms(case, grid)
        elif turns:
            phase = _phase_of_least_maximum(case, cells)
        out[row, 0], out[row, 2] = _deviation_and_best_shift(phase, rms, case)
        out[row, 1] = phase


def fit_target_motion(target: TargetMotion, branch: float, measure: Measure, designs: Array) -> Fit:
    """Return the minimum deviation for designs (n, 3): crank, rod, offset, m, each rotating fully; branch +1 or -1."""
    designs = require_full_rotation(designs)
    angles, positions = np.array(target.crank_angles), np.array(target.positions)
    free = target.phase == "free", target.shift == "free"
    out = np.empty((len(designs), 3))
    run_in_chunks(
        len(designs),
        lambda begin, end: _fill_fits(
            designs[begin:end], branch, angles, positions, measure == "rms", free[0], free[1], out[begin:end]
        ),
    )
    return Fit(out[:, 0], np.mod(out[:, 1] + math.pi, _TURN) - math.pi, out[:, 2])
