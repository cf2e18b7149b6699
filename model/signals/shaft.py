"""A rotating crankshaft: breakpoints of all its cylinders, and its curves between these."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from functools import cached_property

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..dynamics.breakpoints import breakpoints_of
from ..dynamics.segments import crowding_parameter
from ..dynamics.speed_ratio import speed_ratio_of
from ..dynamics.torque_with_friction import least_determinacy_margin, needs_friction_kernel
from ..kinematics import geometry
from ..machine.cylinders_and_turns import (
    TURN,
    half_of_cycle_at,
    machine_of_each_cylinder,
    machines_of_turns,
    single_cylinder_machine,
)
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads
from ..machine.raw_numbers_of_designs import raw_machine_numbers
from .peak_search import Segments
from .roots import find_roots
from .shaft_curves import (
    TOUCH,
    VECTORS,
    WORK,
    Axes,
    Blocks,
    Crankshaft,
    CurveArrays,
    Evaluations,
    ShaftCurve,
    fill_breakpoint_gradients,
    fill_curves,
)
from .shaft_segments import CONTACT, FIXED, Breaks, join_breaks, segments_between_breakpoints
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal

_NEAR = 1e-9  # rad: a breakpoint this close to the start of one of two turns may belong to either
_CROSSED = 24  # panels per turn in which a curve may change sign, with 16 samples each
_SIDE_STEP = 1e-12  # rad


class Shaft:
    """Designs (n, 3 + k) of a machine with cylinders or a profile, and one curve along their cycles.

    kind: signal, or curve of `shaft_curves`. members: cylinders to be summed. during: stroke of the first cylinder.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        kind: int,
        designs: Array,
        *,
        members: tuple[int, ...],
        during: str = "cycle",
        gradients: bool = False,
    ) -> None:
        self.kind, self.members, self.gradients = kind, np.array(members, dtype=np.int64), gradients
        signal = Signal(kind) if kind < TOUCH else Signal.CRANK_PIN_FORCE
        single = single_cylinder_machine(mechanism)
        self._single, self._designs = single, designs
        self._parts = machines_of_turns(single) if signal.needs_forces else (single,)
        self.period = len(self._parts) * TURN
        self.vector = kind in [int(vector) for vector in VECTORS]
        self.rubbing = signal.needs_forces and needs_friction_kernel(single)
        cylinders = machine_of_each_cylinder(mechanism)
        lead, bank = (
            np.array([cylinder.lead for cylinder in cylinders]),
            np.array([cylinder.bank for cylinder in cylinders]),
        )
        place = np.array([cylinder.place for cylinder in cylinders])
        self._axes = Axes(lead, np.cos(bank), np.sin(bank), place)
        self._pace, self.profile = speed_ratio_of(mechanism), mechanism.speed_profile
        self._loads: list[Loads] = []
        plain, stepped = [], []
        for part in self._parts:
            raw, loads = signal_inputs(part, signal)
            numbers = raw_machine_numbers(part, designs, slot_count=len(raw), gradients=gradients)
            numbers_block, steps = derived_blocks(raw, loads, numbers.columns, numbers.values, steps=gradients)
            self._loads.append(loads)
            plain.append(numbers_block)
            cylinder = numbers_block[:, None, :, 0].astype(np.complex128)
            if gradients:
                rates = steps.imag.reshape(len(designs), len(numbers.columns), -1)
                if numbers.slopes is not None:
                    rates = np.einsum("ncr,ncu->nur", rates, numbers.slopes)
                cylinder = np.concatenate([cylinder, cylinder + 1j * rates], axis=1)
            stepped.append(cylinder)
        self._watch = cycle_window(self._parts[0], signal, during=during)
        if kind >= WORK:
            self._watch = self._watch._replace(split=True, swing=True)
        self.numbers = designs.shape[1] if gradients else 0
        self._plain = plain
        self._stepped = [np.ascontiguousarray(cylinder.reshape(-1, cylinder.shape[2], 1)) for cylinder in stepped]
        both_halves = np.stack(plain, axis=1).reshape(-1, plain[0].shape[1], 1)
        all_steps = np.stack(stepped, axis=1).reshape(-1, plain[0].shape[1], 1)
        blocks = Blocks(np.ascontiguousarray(both_halves), np.ascontiguousarray(all_steps))
        self._crankshaft = Crankshaft(self._axes, self._pace, blocks, self._loads[0], self._loads[-1], len(self._parts))

    def with_curve(self, kind: int) -> Shaft:
        """Return the same shaft for another curve, with the same breakpoints."""
        copied = copy(self)
        copied.kind, copied.vector = kind, kind in [int(vector) for vector in VECTORS]
        return copied

    @cached_property
    def unlocked_designs(self) -> Mask:
        """Designs (n,) that friction does not lock."""
        if not self.rubbing:
            return np.ones(len(self._designs), dtype=bool)
        return np.asarray(least_determinacy_margin(design_at(self._plain[0][:, :, 0].T, slice(None))) > 0.0)

    @cached_property
    def panels_per_turn(self) -> Array:
        """Initial panels per turn (n,): more for designs near locking and for rough profiles."""
        r, l, e = self._designs[:, :3].T
        crowd = np.array([crowding_parameter(*lengths) for lengths in zip(r, l, e, strict=True)])
        return np.asarray(np.ceil(np.maximum(12.0 / np.maximum(crowd, 0.05), 1.0 * len(self._pace.cosines))))

    def cycle_half_of_each_cylinder(self, angle: Array, row: IntArray) -> IntArray:
        """Return the half (p, m) of its cycle in which every cylinder is at shaft angles (p,)."""
        if len(self._parts) < 2:
            return np.zeros((len(angle), len(self._axes.lead)), dtype=np.int64)
        inner, outer = self._dead_centres
        at = angle[:, None] + self._axes.lead
        return np.asarray(half_of_cycle_at(self._single, inner[row, None], outer[row, None], at))

    @cached_property
    def _dead_centres(self) -> tuple[Array, ...]:
        dimensions = self._designs[:, :3].T
        inner, outer = geometry.inner_crank_angle(*dimensions), geometry.outer_crank_angle(*dimensions)
        crossed = self._single.branch == "crossed"
        return tuple(np.asarray(np.pi - at if crossed else at) for at in (inner, outer))

    def evaluate(
        self, row: IntArray, probe: Array, angle: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return the curve (p, k, 2 + v) and its magnitudes (p, k) at angles (p, k) in segments.

        Value, slope over the crank angle and, if requested, derivatives. rate: (p, v), derivatives of the angles with
        respect to the design.
        """
        evaluated = self._evaluate(self._signal_curve, self._points_to_evaluate(row, probe, angle, rate), gradients)
        return evaluated.curve, evaluated.size

    def moves_outward(self, segments: Segments) -> Mask:
        """Return whether the slider of the first cylinder moves outward in the segments."""
        items = self._points_to_evaluate(segments.row, segments.probe, segments.probe[:, None])
        return np.asarray(self._evaluate(self._signal_curve, items).outward[:, 0] == 1)

    @property
    def _signal_curve(self) -> ShaftCurve:
        return ShaftCurve(self.kind, self.members, self.vector, self.rubbing)

    def _guide_side_curve(self, member: int) -> ShaftCurve:
        """Return the curve that has the sign of the force on a cylinder's guide."""
        return ShaftCurve(TOUCH, np.array([member]), False, self.rubbing)

    def _points_to_evaluate(self, row: IntArray, probe: Array, angle: Array, rate: Array | None = None) -> Evaluations:
        rate = np.zeros((len(row), self.numbers)) if rate is None else rate
        contiguous = np.ascontiguousarray
        half = self.cycle_half_of_each_cylinder(probe, row)
        return Evaluations(contiguous(row), contiguous(probe), contiguous(angle), contiguous(rate), contiguous(half))

    def _evaluate(self, curve: ShaftCurve, items: Evaluations, gradients: bool = False) -> CurveArrays:
        """Return a curve; where all forces vanish together, its value beside that angle."""
        evaluated = self._run_kernel(curve, items, gradients)
        lost = np.asarray(~np.isfinite(evaluated.curve).all(axis=(1, 2)))
        if lost.any():
            of_lost = Evaluations._make(column[lost] for column in items)
            nearby = of_lost.angle + np.copysign(_SIDE_STEP, of_lost.probe[:, None] - of_lost.angle)
            substitute = self._run_kernel(curve, of_lost._replace(angle=nearby), gradients)
            is_finite = np.asarray(np.isfinite(evaluated.curve[lost]).all(axis=2))
            evaluated.curve[lost] = np.where(is_finite[:, :, None], evaluated.curve[lost], substitute.curve)
            evaluated.size[lost] = np.where(is_finite, evaluated.size[lost], substitute.size)
        return evaluated

    def _run_kernel(self, curve: ShaftCurve, items: Evaluations, gradients: bool) -> CurveArrays:
        shape = items.angle.shape
        values = np.empty((*shape, 2 + (self.numbers if gradients else 0)))
        out = CurveArrays(values, np.empty(shape), np.empty((len(items.row), len(curve.members)), np.int64))
        fill_curves(curve, self._crankshaft, items, out)
        return out

    @cached_property
    def all_breakpoints(self) -> Breaks:
        """All breakpoints of the designs that friction does not lock."""
        parts = [self._breakpoints_of_turn(half) for half in range(len(self._parts))]
        rows = np.flatnonzero(self.unlocked_designs)
        fixed = np.concatenate([self._pace.knots[:-1] + turn * TURN for turn in range(len(self._parts))])
        fixed = np.append(np.mod(fixed, self.period), 0.0)
        row, angle = np.repeat(rows, len(fixed)), np.tile(fixed, len(rows))
        zeros = np.zeros(len(row), dtype=np.int64)
        parts.append(Breaks(row, angle, zeros, zeros, zeros + FIXED, np.zeros(len(row)), zeros))
        return self._cut_at_kinks(join_breaks(parts))

    def _cut_at_kinks(self, breaks: Breaks) -> Breaks:
        """Return breakpoints together with those at which friction changes sides, between which the curve is smooth."""
        parts = [breaks]
        for member in self.members if self.rubbing else ():
            touch = self._guide_side_curve(member)

            def contact(row: IntArray, probe: Array, angle: Array, touch: ShaftCurve = touch) -> Array:
                return self._evaluate(touch, self._points_to_evaluate(row, probe, angle)).curve[:, :, 0]

            parts.append(self.sign_change_breakpoints(breaks, contact, CONTACT, int(member)))
        return join_breaks(parts)

    def _breakpoints_of_turn(self, half: int) -> Breaks:
        """Return the breakpoints of every cylinder in one of two turns."""
        cuts = breakpoints_of(self._plain[half], self._loads[half], self._watch, rubbing=False)
        places = np.arange(cuts.angle.shape[1])
        row, place = np.nonzero((places < cuts.many[:, None]) & self.unlocked_designs[:, None])
        parts = []
        for member in self.members:
            for turn in range(len(self._parts)):
                local = cuts.angle[row, place] + turn * TURN
                angle = np.mod(local - self._axes.lead[member], self.period)
                belongs = np.ones(len(row), dtype=bool)
                if len(self._parts) > 1:
                    inner, outer = (ends[row] for ends in self._dead_centres)
                    near = [
                        half_of_cycle_at(self._single, inner, outer, local + away) == half for away in (-_NEAR, _NEAR)
                    ]
                    belongs = near[0] | near[1]
                parts.append(
                    Breaks(
                        row[belongs],
                        angle[belongs],
                        np.full(belongs.sum(), member),
                        np.full(belongs.sum(), half),
                        cuts.code[row, place][belongs],
                        cuts.number[row, place][belongs],
                        cuts.load[row, place][belongs],
                    )
                )
        return join_breaks(parts)

    def sign_change_breakpoints(
        self, breaks: Breaks, curve: Callable[[IntArray, Array, Array], Array], code: int, member: int = 0
    ) -> Breaks:
        """Return the angles between neighbouring samples at which a curve changes sign.

        curve: function of designs (p,), angles in their segments (p,) and angles (p, k), rad, that returns (p, k).
        """
        segments = segments_between_breakpoints(breaks, self.period)
        row, probe, low, width, _ = segments.split_into_panels(np.full(len(self.unlocked_designs), _CROSSED))
        angle = low[:, None] + width[:, None] * np.linspace(0.0, 1.0, 17)
        value = curve(row, probe, angle)
        panel, place = np.nonzero((value[:, :-1] < 0.0) != (value[:, 1:] < 0.0))
        sign = np.where(value[panel, place] < 0.0, -1.0, 1.0)
        begin, end = ((angle[panel, at], sign * value[panel, at]) for at in (place, place + 1))

        def fall(brackets: IntArray, trial: Array) -> Array:
            rows = panel[brackets]
            return np.asarray(sign[brackets] * curve(row[rows], probe[rows], trial[:, None])[:, 0])

        at = np.mod(find_roots(fall, begin, end), self.period)
        zeros = np.zeros(len(panel), dtype=np.int64)
        return Breaks(row[panel], at, zeros + member, zeros, zeros + code, np.zeros(len(panel)), zeros)

    def breakpoint_gradients(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives (c, v) of breakpoint angles by the design.

        Probe: angles in segments that begin there.
        """
        breaks = self.all_breakpoints
        code, row = breaks.code[cuts], breaks.row[cuts]
        out = np.zeros((len(cuts), self.numbers))
        local = breaks.angle[cuts] + self._axes.lead[breaks.member[cuts]]
        for half in range(len(self._parts)):
            rows = np.flatnonzero((code >= 0) & (breaks.half[cuts] == half))
            member_rates = np.zeros((len(rows), self.numbers))
            chosen = np.ascontiguousarray(cuts[rows])
            fill_breakpoint_gradients(
                np.ascontiguousarray(row[rows]),
                np.ascontiguousarray(local[rows]),
                np.ascontiguousarray(breaks.code[chosen]),
                np.ascontiguousarray(breaks.number[chosen]),
                np.ascontiguousarray(breaks.load[chosen]),
                self._stepped[half],
                member_rates,
            )
            out[rows] = member_rates
        for member in self.members:
            rows = np.flatnonzero((code == CONTACT) & (breaks.member[cuts] == member))
            items = self._points_to_evaluate(row[rows], probe[rows], breaks.angle[cuts[rows], None])
            member_rates = self._evaluate(self._guide_side_curve(member), items, gradients=True).curve[:, 0]
            out[rows] = -member_rates[:, 2:] / member_rates[:, 1:2]
        return out
