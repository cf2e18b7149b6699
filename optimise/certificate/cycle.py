"""A curve over the cycle, enclosed over boxes of designs at chosen crank angles.

The greatest value of a curve over the cycle is at least its value at any one crank angle, so an enclosure at one angle
bounds a peak from below, for every design of a box. At the angle where the peak of the box's middle design is, the
bound is right to second order in the size of the box: there the curve is flat over crank angle. Where the curve counts
only over a part of the stroke, and the peak sits on the end of that part, the angle follows the design: it is the one
at which the slider has covered a fixed share of its stroke. From above a peak is not bounded here.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from ...model.arrays import Array, Mask
from ...model.dynamics.torque import forces, smooth_load
from ...model.kinematics.position import motion
from ...model.machine.design import AREA, DESIGN, LOAD_ROWS, Design, derive, design_at
from ...model.machine.loads.cylinder import Cylinder
from ...model.machine.loads.load import Enters
from ...model.machine.loads.registry import force_of
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw import Loads
from ...model.signals.peaks import find_peaks
from ...model.signals.screening import screen, screens
from ...model.signals.signal_inputs import cycle_window, signal_inputs
from ...model.signals.signals import Signal, design_motion, signal, size_of_force
from ...objectives.cycle_peak import CyclePeak
from .enclosure import UNIT, Enclosure, interval, select, side_by_side
from .gas import gas_force

_TURN = 2.0 * np.pi
_ON_END = 1e-7  # share of the stroke: nearer to a dead centre than this is on it
_SIDE_STEP, _FARTHEST = 1e-9, 0.5  # rad from a step
_AT_REST = 1e-6  # of the crank: |x'| below it is a dead centre
_derive = cast(Any, derive)


def best_angles(peak: CyclePeak, mechanism: Mechanism, designs: Array) -> Array:
    """Return the crank angle, rad, of each design's peak (n,)."""
    if screens(mechanism, peak.signal, during=peak.during):
        return screen(mechanism, (peak.signal,), designs, places=True)[0].angles
    angles = find_peaks(mechanism, peak.signal, designs, during=peak.during, limit=1).angles[:, 0]
    return np.where(np.isfinite(angles), angles, 0.0)


class Curve:
    """One signal of a machine over boxes of designs. Without friction: its forces are no plain formula."""

    def __init__(self, mechanism: Mechanism, peak: CyclePeak) -> None:
        self.kind, self.peak = peak.signal, peak
        self.mechanism = mechanism
        self.raw, self.loads = signal_inputs(mechanism, peak.signal)
        self.watch = cycle_window(mechanism, peak.signal, during=peak.during)
        self.direction = 1.0 if mechanism.speed >= 0.0 else -1.0
        self.partial = self.watch.strokes != 0 or self.watch.start > 0.0 or self.watch.end < 1.0
        self.jumps = self.watch.split and peak.signal not in (Signal.TORQUE, Signal.POWER)
        self.steps = peak.signal.needs_forces and any(load.steps for load in mechanism.fullest.loads)
        self.shares = self.partial and peak.signal in (Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS)

    def enclose(self, dimensions: list[Enclosure], angles: Array, middle: Array) -> Enclosure:
        """Return the signal (n, p) at crank angles (n,) for dimensions (n, 1) and middle designs (n, 3).

        It has two parts where it may jump at the angle, and three where a table steps. The rest is not a number where
        the angle does not count in all of the box.
        """
        enclosure = self._enclose_at(dimensions, angles, middle)
        if self.steps:
            # A peak on a step moves with the design: beside it all designs of the box are on one side of the step.
            r, l, e = middle.T
            pace = np.abs(motion(np.sin(angles), np.cos(angles), r, l, e, self.mechanism.sign).x_1)
            ends = [dimension.ends() for dimension in dimensions]
            width = np.sum([high[:, 0] - low[:, 0] for low, high in ends], axis=0)
            away = np.minimum(width / np.maximum(pace, 1e-3 * r) + width / r + _SIDE_STEP, _FARTHEST)
            for side in (-away, away):
                enclosure = side_by_side(enclosure, self._enclose_at(dimensions, angles + side, middle))
        return enclosure

    def _enclose_at(self, dimensions: list[Enclosure], angles: Array, middle: Array) -> Enclosure:
        """Return the signal as `enclose` does, at these angles alone."""
        raw = self.raw.astype(object)[:, None]
        raw[:3, 0] = dimensions
        block = np.empty((DESIGN + LOAD_ROWS * len(self.loads.kind), 1), dtype=object)
        _derive(raw, self.loads.kind, self.loads.datum, block)
        d = design_at(block, 0)
        theta = angles[:, None]
        sine: Any = np.sin(theta)
        cosine: Any = np.cos(theta)
        if self.shares:
            sine, cosine = _at_share(d, sine, cosine, middle, self.watch.start, self.watch.end)
        jump = None
        if self.jumps:
            jump, sine, cosine = _at_dead_centre(d, sine, cosine, middle)
        m = design_motion(sine, cosine, d)
        outward = m.x_1 * (d.branch * self.direction)
        if jump is not None and jump.any():
            # The peak is the greater of what the curve tends to from either side, which are the two strokes.
            sides = [
                select(jump, interval(side, side, len(outward.slopes)), outward) for side in (jump + 0.0, -1.0 * jump)
            ]
            return side_by_side(*(self._signal(sine, cosine, m, d, block, theta, side) for side in sides))
        value = self._signal(sine, cosine, m, d, block, theta, outward)
        if self.partial and not self.shares:
            low, high = outward.ends()
            counts = low > 0.0 if self.watch.strokes == 1 else high < 0.0
            value = Enclosure(value.centre, value.slopes, np.where(counts, value.rest, np.nan), value.empty)
        return value

    def _signal(
        self, sine: Any, cosine: Any, m: Any, d: Design, block: Any, theta: Array, outward: Enclosure
    ) -> Enclosure:
        if self.kind.needs_forces:
            load = smooth_load(m, d, _by_stroke(outward, d.outward_force, d.inward_force))
            way = _by_stroke(outward, 1.0, -1.0)
            for k, code in enumerate(self.loads.kind.tolist()):
                if code >= Enters.FORMULA:
                    first, second = block[DESIGN + LOAD_ROWS * k : DESIGN + LOAD_ROWS * k + 2, 0]
                    velocity = m.x_1 * d.branch * d.speed
                    load = load + force_of(code, m.x * d.branch, velocity, way, first, second)
                elif code in (Enters.CYLINDER, Enters.BURNING_CYLINDER):
                    stroke = d.outer - d.inner
                    z = (m.x * d.branch - block[DESIGN + LOAD_ROWS * k + 1, 0]) * block[DESIGN + LOAD_ROWS * k, 0]
                    cylinder = cast(Cylinder, self.mechanism.loads[k])
                    load = load + gas_force(cylinder, z / stroke, stroke, outward)
                if self.loads.start[k] < self.loads.start[k + 1] and not self.loads.factor[k, 2]:
                    load = load + self._table(k, m, d, block, theta, outward)
            f = forces(sine, cosine, m, d, load)
            total = f._replace(torque=f.torque - self._on_crank(m, d, block, theta, outward))
            return cast(Enclosure, size_of_force(int(self.kind), total, m, d))
        return cast(Enclosure, signal(int(self.kind), sine, cosine, m, d, None))

    def _on_crank(self, m: Any, d: Design, block: Any, theta: Array, outward: Enclosure) -> Any:
        """Return the torque of the loads on the crank, N m: as `torque_without_crank_loads` has it."""
        torque: Any = 0.0
        for k, load in enumerate(self.mechanism.loads):
            if load.on_crank and self.loads.kind[k] == Enters.CRANK_TORQUE:
                q = DESIGN + LOAD_ROWS * k + AREA
                torque = torque + (block[q, 0] - self.direction * block[q + 1, 0])
            elif load.on_crank:
                torque = torque + self._table(k, m, d, block, theta, outward)
        return torque

    def _table(self, k: int, m: Any, d: Design, block: Any, theta: Array, outward: Enclosure) -> Enclosure:
        loads: Loads = self.loads
        part = slice(loads.start[k], loads.start[k + 1])
        at, force = loads.at[part], loads.force[part]
        factor = loads.factor[k, 2] or _by_stroke(outward, *loads.factor[k, :2].tolist())
        if loads.kind[k] == Enters.ANGLE_TABLE:
            if loads.datum[k] == 0:
                turned = theta - _TURN * np.floor((theta - at[0]) / _TURN)
                return cast(Enclosure, factor * np.interp(turned, at, force))
            counted = theta - block[DESIGN + LOAD_ROWS * k + 1, 0]
            turns = counted - _TURN * np.floor((counted.centre - at[0]) / _TURN)
            # A turn before and one after: a box may reach beyond the ends of the table.
            # Where the table steps at its seam, the end of one turn and the start of the next are both sides of that.
            at = np.concatenate([at - _TURN, at, at + _TURN])
            return factor * interpolated(turns, at, np.tile(force, 3))
        at_x = (m.x * d.branch - block[DESIGN + LOAD_ROWS * k + 1, 0]) * block[DESIGN + LOAD_ROWS * k, 0]
        return factor * interpolated(at_x, at, force)


def interpolated(x: Enclosure, at: Array, force: Array) -> Enclosure:
    """Return the table's force over an enclosed position: the chord, and how far the knots lie off it."""
    low, high = x.ends()
    first, last = np.interp(low, at, force), np.interp(high, at, force)
    wide = high > low
    slope = np.where(wide, (last - first) / np.where(wide, high - low, 1.0), 0.0)
    highest, lowest = np.zeros_like(low), np.zeros_like(low)
    for knot, value in zip(at, force, strict=True):
        off = np.where((low < knot) & (knot < high), value - (first + slope * (knot - low)), 0.0)
        highest, lowest = np.maximum(highest, off), np.minimum(lowest, off)
    chord = (x - low) * slope + (first + 0.5 * (highest + lowest))
    rounding = UNIT * (np.abs(force).max() + np.abs(slope) * x.size)
    return Enclosure(chord.centre, chord.slopes, chord.rest + 0.5 * (highest - lowest) + 4.0 * rounding, chord.empty)


def _by_stroke(outward: Enclosure, out: Any, back: Any) -> Enclosure:
    """Return one number in the outward stroke and another in the inward one, both where the stroke is not certain."""
    low, high = outward.ends()
    k = len(outward.slopes)
    least = np.where(low > 0.0, out, np.where(high < 0.0, back, min(out, back)))
    greatest = np.where(low > 0.0, out, np.where(high < 0.0, back, max(out, back)))
    return interval(least, greatest, k)


def _at_share(
    d: Design, sine: Array, cosine: Array, middle: Array, start: float, end: float
) -> tuple[Enclosure, Enclosure]:
    """Return sine and cosine of the crank angle at the share of the stroke that the middle design has covered.

    With B the slider pin and q = (r^2 + B^2 - l^2) / (2 B^2), the crank pin is q B +- h B' where B' is B turned by 90
    degrees and h^2 = r^2 / B^2 - q^2. On a dead centre it lies on the line of the rod: -r/(l - r) or r/(l + r) times B.
    """
    r, l, e = (column[:, None] for column in middle.T)
    at = motion(sine, cosine, r, l, e, d.branch)
    inner, outer = np.sqrt((l - r) ** 2 - e * e), np.sqrt((l + r) ** 2 - e * e)
    share = np.clip((at.x * d.branch - inner) / (outer - inner), start, end)
    side = np.where(at.x * r * sine >= e * r * cosine, 1.0, -1.0)
    x = (d.inner + (d.outer - d.inner) * np.clip(share, _ON_END, 1.0 - _ON_END)) * d.branch
    square = x * x + d.e * d.e
    q = (d.r * d.r + square - d.l * d.l) / (square * 2.0)
    h = np.sqrt(d.r * d.r / square - q * q) * side
    on_inner, on_outer = share < _ON_END, share > 1.0 - _ON_END
    q = select(on_inner, -d.r / (d.l - d.r), select(on_outer, d.r / (d.l + d.r), q))
    h = select(on_inner | on_outer, 0.0 * d.r, h)
    x = select(on_inner, d.inner * d.branch, select(on_outer, d.outer * d.branch, x))
    return (q * d.e + h * x) / d.r, (q * x - h * d.e) / d.r


def _at_dead_centre(d: Design, sine: Array, cosine: Array, middle: Array) -> tuple[Mask, Enclosure, Enclosure]:
    """Return where the middle design is on a dead centre, and sine and cosine of an angle that stays there."""
    r, l, e = (column[:, None] for column in middle.T)
    at = motion(sine, cosine, r, l, e, d.branch)
    on_dead_centre = np.abs(at.x_1) < _AT_REST * r
    far = at.x * d.branch > np.sqrt(l * l - e * e)  # between the two dead centres
    q = select(far, d.r / (d.l + d.r), -d.r / (d.l - d.r))
    x = select(far, d.outer * d.branch, d.inner * d.branch)
    k = len(q.slopes)
    return (
        on_dead_centre,
        select(on_dead_centre, q * d.e / d.r, interval(sine, sine, k)),
        select(on_dead_centre, q * x / d.r, interval(cosine, cosine, k)),
    )
