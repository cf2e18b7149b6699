"""A curve over the cycle, enclosed over boxes of designs at selected crank angles.

A curve's greatest value over the cycle is at least its value at any one crank angle. So an enclosure at one angle
bounds the peak from below for every design in a box. At the peak of the box's middle design, the bound is accurate to
second order in the box size, because the curve is flat there. If the curve counts only during part of the stroke and
peaks at the end of that part, the angle follows the design. There, the slider has covered a fixed fraction of its
stroke. This module does not bound peaks from above.

The cylinders of a crankshaft add up at the same shaft angle. With a speed profile, that angle determines the speed.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import reduce
from typing import Any

import numpy as np

from ...model.arrays import Array, Mask
from ...model.dynamics.speed_ratio import speed_ratio_at, speed_ratio_of
from ...model.dynamics.torque import Forces, forces_without_friction
from ...model.kernel.arithmetic import magnitude
from ...model.kinematics.position import Motion, motion
from ...model.machine.arrangement import Arrangement
from ...model.machine.cylinders_and_turns import (
    TURN,
    Member,
    has_cylinders_or_speed_profile,
    machine_of_each_cylinder,
    machines_of_turns,
    single_cylinder_machine,
)
from ...model.machine.design import Design
from ...model.machine.mechanism import Mechanism
from ...model.signals.fast_torque_and_error import screened_maxima, supports_screening
from ...model.signals.peaks import find_peaks
from ...model.signals.shaft_curves import VECTORS, components_of_force_signal, components_of_motion_signal
from ...model.signals.shaft_statistics import SUMS, equivalent_single_cranks
from ...model.signals.signal_inputs import cycle_window, signal_inputs
from ...model.signals.signals import Signal, design_motion, signal_of_motion
from .enclosed_machine import BoxMachine, Numbers, crank_at_stroke_fraction, dead_centre_angle, track_dead_centre
from .enclosure import Enclosure, enclosure_of_ends, join_parts, select_by_mask

_SIDE_STEP, _FARTHEST = 1e-9, 0.5  # rad, distances from a step
_ERRORS = (Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS)


def machines_with_separate_peaks(mechanism: Mechanism, kind: Signal) -> tuple[Mechanism, ...]:
    """Return machines whose highest peak of a signal equals the whole machine's peak.

    If the cycle of a single crank has two turns, each turn is a separate machine. So is each cylinder, if the signal
    does not add up over the cylinders.
    """
    if not has_cylinders_or_speed_profile(mechanism):
        return machines_of_turns(mechanism) if kind.needs_forces else (mechanism,)
    alike = equivalent_single_cranks(mechanism, kind)
    every = mechanism.arrangement
    if alike:
        return tuple(part for single in alike for part in machines_with_separate_peaks(single, kind))
    if kind in SUMS or every is None or len(every.phases) == 1:
        return (mechanism,)
    apart = (
        Arrangement(phases=(phase,), banks=(every.bank_angle(k),), places=(every.shaft_position(k),))
        for k, phase in enumerate(every.phases)
    )
    return tuple(
        part for one in apart for part in machines_with_separate_peaks(replace(mechanism, arrangement=one), kind)
    )


Read = Callable[[Forces, Any, Any, Motion, Design], tuple[Any, Any]]
"""Two components of a signal from the joint forces, sine and cosine of the crank angle, the motion and the design."""


class CycleCurve:
    """One signal of a machine over boxes of designs. Friction is excluded: its forces have no plain formula."""

    least = False
    default_position: tuple[float, ...] = (0.5 * math.pi,)
    """Position for boxes whose middle design does not rotate fully."""

    def __init__(self, mechanism: Mechanism, kind: Signal, *, during: str = "cycle") -> None:
        self.kind, self.during, self.mechanism = kind, during, mechanism
        single = single_cylinder_machine(mechanism)
        of_turns = machines_of_turns(single) if self.kind.needs_forces else (single,)
        self.machines = [BoxMachine(machine, *signal_inputs(machine, self.kind)) for machine in of_turns]
        self.members = (
            machine_of_each_cylinder(mechanism)
            if has_cylinders_or_speed_profile(mechanism)
            else (Member(single, 0.0, 0.0, 0.0),)
        )
        self.watch = cycle_window(self.machines[0].mechanism, self.kind, during=during)
        self.pace = speed_ratio_of(mechanism)
        self.partial = self.watch.strokes != 0 or self.watch.start > 0.0 or self.watch.end < 1.0
        self.jumps = self.watch.split and self.kind not in (Signal.TORQUE, Signal.POWER)
        self.steps = self.kind.needs_forces and any(load.has_steps for load in mechanism.with_largest_variables.loads)
        self.shares = self.partial and self.kind in _ERRORS

    def peak_positions(self, designs: Array) -> Array:
        """Return each design's crank angle at the peak, rad, (n, 1); for a crankshaft, the shaft's angle."""
        if supports_screening(self.mechanism, self.kind, during=self.during):
            return screened_maxima(self.mechanism, (self.kind,), designs, places=True)[0].angles[:, None]
        angles = find_peaks(self.mechanism, self.kind, designs, during=self.during, limit=1).angles
        return np.where(np.isfinite(angles), angles, 0.0)

    def enclose(self, numbers: Numbers, positions: Array, middle: Array) -> Enclosure:
        """Return the signal (n, p) at crank angles (n, 1). numbers: (n, 1). middle: middle designs (n, 3 + k).

        The result has two parts where the signal may jump at the angle, and three where a table steps. The rest is NaN
        where the angle does not count throughout the box.
        """
        sums = [
            pair
            for angles in self.angles_around_load_steps(numbers, positions, middle)
            for pair in self.sum_over_cylinders(numbers, angles, middle)
        ]
        sizes: list[Enclosure] = [np.sqrt(x * x + y * y) if self.kind in VECTORS else magnitude(x) for x, y in sums]
        return reduce(join_parts, sizes)

    def angles_around_load_steps(self, numbers: Numbers, angles: Array, middle: Array) -> list[Array]:
        """Return angles (n, 1) and, if loads have steps, angles on both sides of each step.

        A peak at a step moves with the design: beside it, all designs in the box are on one side of the step.
        """
        if not self.steps:
            return [angles]
        r, l, e = middle[:, :3].T[:, :, None]
        pace = np.abs(motion(np.sin(angles), np.cos(angles), r, l, e, self.mechanism.sign).x_1)
        width = np.sum([np.subtract(*numbers[slot].least_and_greatest()[::-1]) for slot in range(3)], axis=0)
        away = np.minimum(width / np.maximum(pace, 1e-3 * r) + width / r + _SIDE_STEP, _FARTHEST)
        return [angles, angles - away, angles + away]

    def sum_over_cylinders(
        self, numbers: Numbers, angles: Array, middle: Array, read: Read | None = None
    ) -> list[tuple[Any, Any]]:
        """Return the signal's two components, or what `read` takes from the joint forces, summed over all cylinders.

        Two pairs if it jumps at the angle, as only a single cylinder does at its dead centre.
        """
        designs = [machine.derived_design(numbers) for machine in self.machines]
        read = read or self._components_of_signal
        parts = [self._cylinder_components(member, designs, angles, middle, read) for member in self.members]
        sums: list[tuple[Any, Any]] = []
        for pairs in zip(*parts, strict=True):
            xs, ys = zip(*pairs, strict=True)
            sums.append((sum(xs[1:], xs[0]), sum(ys[1:], ys[0])))
        return sums

    def _components_of_signal(self, f: Forces, sine: Any, cosine: Any, m: Motion, d: Design) -> tuple[Any, Any]:
        x, y = components_of_force_signal(int(self.kind), f, m, d)
        return x, y

    def _cylinder_components(
        self, member: Member, designs: list[tuple[Design, Any]], angles: Array, middle: Array, read: Read
    ) -> list[tuple[Enclosure, Enclosure]]:
        """Return a cylinder's components at shaft angles; for both strokes if they jump at the angle."""
        d = self._design_in_motion(designs[0][0], member, angles)
        local: Any = angles + member.lead
        sine: Any = np.sin(local)
        cosine: Any = np.cos(local)
        if self.shares:
            sine, cosine = crank_at_stroke_fraction(d, sine, cosine, middle, self.watch.start, self.watch.end)
        jump = None
        if self.jumps:
            jump, sine, cosine, local = track_dead_centre(d, sine, cosine, local, middle)
            if jump.any() and self.mechanism.speed_profile is not None:
                d = self._design_in_motion(designs[0][0], member, local - member.lead)
        m = design_motion(sine, cosine, d)
        outward = m.x_1 * (d.branch * self.mechanism.direction)
        place = (sine, cosine, local, m)
        if jump is not None and jump.any():
            # The peak is the greater one-sided limit of the curve, one for each stroke.
            sides = [
                select_by_mask(jump, enclosure_of_ends(side, side, len(outward.slopes)), outward)
                for side in (jump + 0.0, -1.0 * jump)
            ]
            return [self._member_components_on_stroke(member, designs, d, place, side, read) for side in sides]
        x, y = self._member_components_on_stroke(member, designs, d, place, outward, read)
        if self.partial and not self.shares:
            low, high = outward.least_and_greatest()
            counts = low > 0.0 if self.watch.strokes == 1 else high < 0.0
            x = Enclosure(x.centre, x.slopes, np.where(counts, x.rest, np.nan), x.empty)
        return [(x, y)]

    def _design_in_motion(self, d: Design, member: Member, angles: Array | Enclosure) -> Design:
        """Return a design with the speed and acceleration at shaft angles, and gravity in the axes of its bank."""
        if member.bank:
            c, s = math.cos(member.bank), math.sin(member.bank)
            x, y = d.gravity_x, d.gravity_y
            d = d._replace(gravity_x=c * x + s * y, gravity_y=c * y - s * x)
        if self.mechanism.speed_profile is None:
            return d
        ratio, slope, _ = _speed_ratio_and_derivatives(self.pace, angles)
        square = d.speed * d.speed
        return d._replace(speed=d.speed * ratio, acceleration=d.acceleration + square * (ratio * slope))

    def _member_components_on_stroke(
        self, member: Member, designs: list[tuple[Design, Any]], d: Design, place: Any, outward: Enclosure, read: Read
    ) -> tuple[Enclosure, Enclosure]:
        """Return the components of one cylinder; a shaking signal is in the axes of the shaft."""
        sine, cosine, local, m = place
        kind, nothing = self.kind, 0.0 * outward
        if kind in _ERRORS:
            return signal_of_motion(int(kind), sine, cosine, m, d), nothing
        if kind.needs_forces:
            vectors = [
                self._force_components(machine, d, block, place, outward, read)
                for machine, (_, block) in zip(self.machines, designs, strict=True)
            ]
            if len(vectors) == 1:
                return vectors[0]
            first, known = self._turn_masks(d, local)
            x, y = (select_by_mask(first, *pair) for pair in zip(*vectors, strict=True))
            return Enclosure(x.centre, x.slopes, np.where(known, x.rest, np.nan), x.empty), y
        rate = 0.0
        if kind is Signal.SLIDER_JERK and self.mechanism.speed_profile is not None:
            ratio, slope, bend = _speed_ratio_and_derivatives(self.pace, local - member.lead)
            plain = designs[0][0].speed
            rate = plain * plain * (slope * slope + ratio * bend)
        x, y = (nothing + part for part in components_of_motion_signal(int(kind), sine, cosine, m, d, rate))
        if kind in (Signal.SHAKING_FORCE, Signal.ROCKING_COUPLE) and member.bank:
            c, s = math.cos(member.bank), math.sin(member.bank)
            x, y = c * x - s * y, s * x + c * y
        return (-member.place * y, member.place * x) if kind is Signal.ROCKING_COUPLE else (x, y)

    def _force_components(
        self, machine: BoxMachine, d: Design, block: Any, place: Any, outward: Enclosure, read: Read
    ) -> tuple[Enclosure, Enclosure]:
        sine, cosine, local, m = place
        load = machine.slider_load(m, d, block, local, outward)
        f = forces_without_friction(sine, cosine, m, d, load)
        if self.kind not in (Signal.TORQUE, Signal.POWER):
            x, y = read(f, sine, cosine, m, d)
            return x, 0.0 * outward + y
        torque = f.torque - machine.crank_torque_of_loads(m, d, block, local, outward, self.mechanism.direction)
        return (torque * d.speed if self.kind is Signal.POWER else torque), 0.0 * outward

    def _turn_masks(self, d: Design, local: Any) -> tuple[Mask, Mask]:
        """Return two masks: angles in the first of two turns, and boxes that lie within one turn."""
        (datum,) = {load.cycle_datum for load in self.mechanism.loads if load.cycle_turns > 1}
        way = 1.0 if datum == "zero crank angle" else self.mechanism.direction
        counted: Any = local
        if datum != "zero crank angle":
            start = dead_centre_angle(d, np.asarray(datum == "outer dead centre"))
            low, high = start.least_and_greatest()
            counted = local - (start - TURN * np.floor(low / TURN))
            counted = Enclosure(
                counted.centre,
                counted.slopes,
                np.where(np.floor(low / TURN) == np.floor(high / TURN), counted.rest, np.nan),
                counted.empty,
            )
        turned = (
            counted * (way / TURN)
            if isinstance(counted, Enclosure)
            else enclosure_of_ends(counted * (way / TURN), counted * (way / TURN), 0)
        )
        low, high = turned.least_and_greatest()
        with np.errstate(invalid="ignore"):
            return np.mod(np.floor(low), 2.0) == 0.0, np.floor(low) == np.floor(high)


def _speed_ratio_and_derivatives(pace: Any, angles: Any) -> tuple[Any, Any, Any]:
    """Return p of a speed profile and its first two derivatives at shaft angles (n, p).

    Over an enclosed angle: the tangent at its centre, and bounds on the second and third derivatives for the rest.
    """
    if not isinstance(angles, Enclosure):
        found = [speed_ratio_at(float(angle), pace)[:3] for angle in angles.ravel()]
        p, slope, bend = np.array(found).T.reshape(3, *angles.shape)
        return p, slope, bend
    p, slope, bend = _speed_ratio_and_derivatives(pace, angles.centre)
    k = np.arange(1.0, len(pace.cosines) + 1.0)
    size = np.abs(pace.cosines) + np.abs(pace.sines)
    second, third = float((k**2 * size).sum()), float((k**3 * size).sum())
    if pace.pieces.shape[1]:
        x = np.diff(pace.knots)
        second = float(np.abs([2.0 * pace.pieces[1], 6.0 * pace.pieces[0] * x + 2.0 * pace.pieces[1]]).max())
        third = float(np.abs(6.0 * pace.pieces[0]).max())
    away, zero = angles - angles.centre, np.zeros_like(p)
    square = 0.5 * angles.radius**2 * (1.0 + 1e-9)
    curved = [Enclosure(zero, 0.0 * angles.slopes, bound * square) for bound in (second, third)]
    return p + away * slope + curved[0], slope + away * bend + curved[1], bend
