"""A crankshaft under way: breakpoints of all its cylinders, and its curves between them."""

from __future__ import annotations

from copy import copy
from functools import cached_property

import numpy as np

from ..arrays import Array, Mask, Whole
from ..dynamics.breakpoints import breakpoints_of
from ..dynamics.contact import rubs
from ..dynamics.rubbing import always_drives
from ..dynamics.segments import crowding
from ..dynamics.speed_ratio import speed_ratio_of
from ..kinematics import geometry
from ..machine.derived import derived
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.members import cylinders_of, single_cylinder
from ..machine.numbers import numbers_of
from ..machine.raw import Loads
from ..machine.two_turns import TURN, cycle_turns, half_at, halves
from .cycle_segments import Segments
from .shaft_curves import TOUCH, VECTORS, WORK, Axes, Blocks, Found, Items, cut_rates, follow_kernel
from .shaft_segments import CONTACT, FIXED, Breaks, joined, segments_of
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal

_NEAR = 1e-9  # rad: so near to where a turn of two begins a breakpoint may be of either
_CONTACTS = 24  # panels of a turn in which the guide's force may change sides, of 16 samples each
_HALVINGS = 60
_BESIDE = 1e-12  # rad


class Shaft:
    """Designs (n, 3 + k) of a machine with cylinders or a profile, followed by one curve.

    kind: a signal, or a curve of `shaft_curves`. members: which cylinders, added up. during: a stroke of the first one.
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
        single = single_cylinder(mechanism)
        self._single, self._designs = single, designs
        whole = signal.needs_forces and cycle_turns(single) > 1
        self._parts = halves(single) if whole else (single,)
        self.period = len(self._parts) * TURN
        self.vector = kind in [int(each) for each in VECTORS]
        self.rubbing = signal.needs_forces and rubs(single)
        cylinders = cylinders_of(mechanism)
        lead, bank = np.array([own.lead for own in cylinders]), np.array([own.bank for own in cylinders])
        place = np.array([own.place for own in cylinders])
        self._axes = Axes(lead, np.cos(bank), np.sin(bank), place)
        self._pace, self.profile = speed_ratio_of(mechanism), mechanism.speed_profile
        self._loads: list[Loads] = []
        plain, stepped = [], []
        for part in self._parts:
            raw, loads = signal_inputs(part, signal)
            numbers = numbers_of(part, designs, room=len(raw), gradients=gradients)
            blocks, steps = derived(raw, loads, numbers.columns, numbers.values, steps=gradients)
            self._loads.append(loads)
            plain.append(blocks)
            own = blocks[:, None, :, 0].astype(np.complex128)
            if gradients:
                rates = steps.imag.reshape(len(designs), len(numbers.columns), -1)
                if numbers.slopes is not None:
                    rates = np.einsum("ncr,ncu->nur", rates, numbers.slopes)
                own = np.concatenate([own, own + 1j * rates], axis=1)
            stepped.append(own)
        self._watch = cycle_window(self._parts[0], signal, during=during)
        if kind >= WORK:
            self._watch = self._watch._replace(split=True, swing=True)
        self.numbers = designs.shape[1] if gradients else 0
        self._plain = plain
        self._stepped = [np.ascontiguousarray(own.reshape(-1, own.shape[2], 1)) for own in stepped]
        both = np.stack(plain, axis=1).reshape(-1, plain[0].shape[1], 1)
        all_steps = np.stack(stepped, axis=1).reshape(-1, plain[0].shape[1], 1)
        self._blocks = Blocks(np.ascontiguousarray(both), np.ascontiguousarray(all_steps))

    def of(self, kind: int) -> Shaft:
        """Return the same followed by another curve, with the same breakpoints."""
        other = copy(self)
        other.kind, other.vector = kind, kind in [int(each) for each in VECTORS]
        return other

    @cached_property
    def drives(self) -> Mask:
        """Designs (n,) that no friction locks."""
        if not self.rubbing:
            return np.ones(len(self._designs), dtype=bool)
        return np.asarray(always_drives(design_at(self._plain[0][:, :, 0].T, slice(None))) > 0.0)

    @cached_property
    def fineness(self) -> Array:
        """Panels of a turn (n,) to begin with: more for designs near locking and for rough profiles."""
        r, l, e = self._designs[:, :3].T
        crowd = np.array([crowding(*each) for each in zip(r, l, e, strict=True)])
        return np.asarray(np.ceil(np.maximum(12.0 / np.maximum(crowd, 0.05), 1.0 * len(self._pace.cosines))))

    def half(self, angle: Array, row: Whole) -> Whole:
        """Return the half (p, m) that every cylinder is in at angles (p,) of the shaft."""
        if len(self._parts) < 2:
            return np.zeros((len(angle), len(self._axes.lead)), dtype=np.int64)
        inner, outer = self._dead_centres
        at = angle[:, None] + self._axes.lead
        return np.asarray(half_at(self._single, inner[row, None], outer[row, None], at))

    @cached_property
    def _dead_centres(self) -> tuple[Array, ...]:
        dimensions = self._designs[:, :3].T
        inner, outer = geometry.inner_crank_angle(*dimensions), geometry.outer_crank_angle(*dimensions)
        crossed = self._single.branch == "crossed"
        return tuple(np.asarray(np.pi - at if crossed else at) for at in (inner, outer))

    def at(
        self, row: Whole, inside: Array, angle: Array, *, rate: Array | None = None, wanted: bool = False
    ) -> tuple[Array, Array]:
        """Return the curve (p, k, 2 + v) and its sizes (p, k) at angles (p, k) of segments.

        Value, slope over the crank angle, derivatives where wanted. rate: (p, v), of the angles by the design.
        """
        return self._follow(self.kind, self.members, row, inside, angle, rate, wanted)[:2]

    def outward(self, segments: Segments) -> Mask:
        """Return whether the slider of the first cylinder moves outward in the segments."""
        inside = segments.inside
        found = self._follow(self.kind, self.members, segments.row, inside, inside[:, None], None, False)
        return np.asarray(found[2][:, 0] == 1)

    def _follow(
        self, kind: int, members: Whole, row: Whole, inside: Array, angle: Array, rate: Array | None, wanted: bool
    ) -> tuple[Array, Array, Whole]:
        """Return curve, sizes and strokes; for an angle where every force vanishes at once those beside it."""
        found = self._asked(kind, members, row, inside, angle, rate, wanted)
        lost = np.asarray(~np.isfinite(found[0]).all(axis=(1, 2)))
        if lost.any():
            beside = angle[lost] + np.copysign(_BESIDE, inside[lost, None] - angle[lost])
            own = None if rate is None else rate[lost]
            again = self._asked(kind, members, row[lost], inside[lost], beside, own, wanted)
            there = np.asarray(np.isfinite(found[0][lost]).all(axis=2))
            found[0][lost] = np.where(there[:, :, None], found[0][lost], again[0])
            found[1][lost] = np.where(there, found[1][lost], again[1])
        return found

    def _asked(
        self, kind: int, members: Whole, row: Whole, inside: Array, angle: Array, rate: Array | None, wanted: bool
    ) -> tuple[Array, Array, Whole]:
        rate = np.zeros((len(row), self.numbers)) if rate is None else rate
        items = Items(
            np.ascontiguousarray(row),
            np.ascontiguousarray(inside),
            np.ascontiguousarray(angle),
            np.ascontiguousarray(rate),
            np.ascontiguousarray(self.half(inside, row)),
        )
        width = 2 + (self.numbers if wanted else 0)
        out = Found(
            np.empty((*angle.shape, width)), np.empty(angle.shape), np.empty((len(row), len(members)), np.int64)
        )
        follow_kernel(
            kind,
            members,
            items,
            self._axes,
            self._pace,
            self._blocks,
            self._loads[0],
            self._loads[-1],
            len(self._parts),
            self.vector and kind == self.kind,
            self.rubbing,
            wanted,
            out,
        )
        return out.curve, out.size, out.outward

    @cached_property
    def breaks(self) -> Breaks:
        """All breakpoints of the designs that no friction locks."""
        parts = [self._of_half(half) for half in range(len(self._parts))]
        rows = np.flatnonzero(self.drives)
        fixed = np.concatenate([self._pace.knots[:-1] + turn * TURN for turn in range(len(self._parts))])
        fixed = np.append(np.mod(fixed, self.period), 0.0)
        row, angle = np.repeat(rows, len(fixed)), np.tile(fixed, len(rows))
        none = np.zeros(len(row), dtype=np.int64)
        parts.append(Breaks(row, angle, none, none, none + FIXED, np.zeros(len(row)), none))
        found = joined(parts)
        return joined([found, self._contacts(found)]) if self.rubbing else found

    def _of_half(self, half: int) -> Breaks:
        """Return the breakpoints of every cylinder in a turn of two."""
        cuts = breakpoints_of(self._plain[half], self._loads[half], self._watch, rubbing=False)
        places = np.arange(cuts.angle.shape[1])
        row, place = np.nonzero((places < cuts.many[:, None]) & self.drives[:, None])
        parts = []
        for member in self.members:
            for turn in range(len(self._parts)):
                local = cuts.angle[row, place] + turn * TURN
                angle = np.mod(local - self._axes.lead[member], self.period)
                there = np.ones(len(row), dtype=bool)
                if len(self._parts) > 1:
                    inner, outer = (ends[row] for ends in self._dead_centres)
                    near = [half_at(self._single, inner, outer, local + away) == half for away in (-_NEAR, _NEAR)]
                    there = near[0] | near[1]
                parts.append(
                    Breaks(
                        row[there],
                        angle[there],
                        np.full(there.sum(), member),
                        np.full(there.sum(), half),
                        cuts.code[row, place][there],
                        cuts.number[row, place][there],
                        cuts.load[row, place][there],
                    )
                )
        return joined(parts)

    def _contacts(self, breaks: Breaks) -> Breaks:
        """Return where the force of a guide changes sides, between neighbouring samples."""
        segments = segments_of(breaks, self.period)
        row, inside, low, width, _ = segments.panels(np.full(len(self.drives), _CONTACTS))
        angle = low[:, None] + width[:, None] * np.linspace(0.0, 1.0, 17)
        parts = []
        for member in self.members:
            one = np.array([member])
            value = self._follow(TOUCH, one, row, inside, angle, None, False)[0][:, :, 0]
            panel, place = np.nonzero(value[:, :-1] * value[:, 1:] < 0.0)
            left, right, before = angle[panel, place], angle[panel, place + 1], value[panel, place]
            for _ in range(_HALVINGS):
                middle = 0.5 * (left + right)
                now = self._follow(TOUCH, one, row[panel], inside[panel], middle[:, None], None, False)[0][:, 0, 0]
                same = now * before > 0.0
                left, right = np.where(same, middle, left), np.where(same, right, middle)
            none = np.zeros(len(panel), dtype=np.int64)
            at = np.mod(0.5 * (left + right), self.period)
            own = np.full(len(panel), member)
            parts.append(Breaks(row[panel], at, own, none, none + CONTACT, np.zeros(len(panel)), none))
        return joined(parts)

    def rates(self, cuts: Whole, inside: Array) -> Array:
        """Return the derivatives (c, v) of the angles of breakpoints by the design; inside: of the segments behind."""
        breaks = self.breaks
        code, row = breaks.code[cuts], breaks.row[cuts]
        out = np.zeros((len(cuts), self.numbers))
        local = breaks.angle[cuts] + self._axes.lead[breaks.member[cuts]]
        for half in range(len(self._parts)):
            own = np.flatnonzero((code >= 0) & (breaks.half[cuts] == half))
            found = np.zeros((len(own), self.numbers))
            chosen = np.ascontiguousarray(cuts[own])
            cut_rates(
                np.ascontiguousarray(row[own]),
                np.ascontiguousarray(local[own]),
                np.ascontiguousarray(breaks.code[chosen]),
                np.ascontiguousarray(breaks.number[chosen]),
                np.ascontiguousarray(breaks.load[chosen]),
                self._stepped[half],
                found,
            )
            out[own] = found
        for member in self.members:
            own = np.flatnonzero((code == CONTACT) & (breaks.member[cuts] == member))
            at = breaks.angle[cuts[own], None]
            found = self._follow(TOUCH, np.array([member]), row[own], inside[own], at, None, True)[0][:, 0]
            out[own] = -found[:, 2:] / found[:, 1:2]
        return out
