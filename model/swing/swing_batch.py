"""Many designs over one swing: their pieces between kinks, and states at points in these.

A swing is cut where its law has a corner, where a table has a knot, and where friction, a load or the guide force
changes sides. Between two cuts every curve is smooth. A cut moves with the design. Where a state g is zero at it, the
fraction t of the time changes by -dg/dp / (dg/dt) (implicit function theorem).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, IntArray, Mask
from ..dynamics.torque_with_friction import determinacy_margin
from ..kernel.arithmetic import STEP
from ..kernel.batches import run_in_chunks
from ..kinematics.position import motion
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.loads.load import Enters
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import raw_inputs_with_all_features
from ..machine.raw_numbers_of_designs import raw_machine_numbers
from .closure import swings_without_dead_point, transmission_angle_candidates
from .end_angles import Ends, append_swing_start, greatest_pin_distance, swing_ends, swing_start_column
from .forces import angle_above_which_pins_cannot_lock
from .law import corner_times, reversed_law_pieces, time_fractions_at_travel
from .swing import Swing, slow_swing
from .swing_states import ANGLE, GUIDE, PACE, PLACE, Complexes, KernelSwing, Points, kernel_swing, swing_states

_SHORTEST = 1e-12
_SCAN = 33
_CONTACTS = 6
_ROOTS = 60


@dataclass(frozen=True)
class Pieces:
    """Pieces of one stroke of the swing.

    cuts: fractions of the time (n, c), ascending from 0 to 1. state: index (n, c) of the state that has a fixed value
    at a cut; -1 if the cut does not move.
    """

    back: bool
    cuts: Array
    state: IntArray

    @property
    def have_length(self) -> Mask:
        """Pieces (n, c - 1) of nonzero length."""
        return np.asarray(np.diff(self.cuts, axis=1) > _SHORTEST)

    @property
    def probe(self) -> Array:
        """A fraction of the time within each piece (n, c - 1)."""
        return np.asarray(self.cuts[:, :-1] + 0.382 * np.diff(self.cuts, axis=1))


class SwingBatch:
    """Designs that can make the swing. numbers: raw numbers that they set. slopes: whether derivatives are needed."""

    def __init__(
        self,
        mechanism: Mechanism,
        swing: Swing,
        designs: Array,
        *,
        slopes: bool,
        slow: bool = False,
        free: bool = False,
        forces: bool = True,
    ) -> None:
        """Take designs (n, 3 + k). slow: without inertia. free: without friction. forces: whether states need them."""
        raw, self.loads = raw_inputs_with_all_features(mechanism)
        self.mechanism, self.swing = mechanism, slow_swing(swing) if slow else swing
        self.rubs = mechanism.with_largest_variables.friction.acts and not free
        self.path: KernelSwing = kernel_swing(self.swing, rubbing=self.rubs, forces=forces)
        self.designs, self.count = designs, len(designs)
        self.sign = mechanism.sign
        self.ends: Ends = swing_ends(mechanism, self.swing, designs, slopes=slopes)
        numbers = raw_machine_numbers(mechanism, designs, slot_count=len(raw), gradients=slopes)
        self.blocks, self.steps = derived_blocks(raw, self.loads, numbers.columns, numbers.values, steps=slopes)
        self.complex_blocks: Complexes = self.blocks.astype(np.complex128)
        column = swing_start_column(mechanism)
        if column is not None:
            numbers, self.steps = append_swing_start(numbers, self.complex_blocks, self.steps, designs, column)
        self.numbers, self.columns = numbers, len(numbers.columns)
        self.plain_ends = np.stack([self.ends.start, self.ends.end], axis=1).astype(np.complex128)
        self.stepped_ends = self.ends.with_imaginary_steps(self.columns, column) if slopes else self.plain_ends
        self.table = self.swing.law_pieces
        # Quantities that depend only on position are equal in both strokes: all laws except tables are symmetric in
        # time.
        alike = all(load.is_conservative for load in mechanism.loads)
        self.ways_differ = self.rubs or self.swing.law == "table" or not alike

    def states(self, designs: Any, share: Any, probe: Any, back: Any, slip: Any = 0.0, step: int | None = None) -> Any:
        """Return states (..., 8) at fractions of the time. designs: indices. step: raw number for the slope."""
        shape = np.broadcast_shapes(*(np.shape(argument) for argument in (designs, share, probe, back, slip)))
        share, slip, probe, back = (
            np.ascontiguousarray(np.broadcast_to(argument, shape), dtype=np.float64).ravel()
            for argument in (share, slip, probe, back)
        )
        rows = np.ascontiguousarray(np.broadcast_to(designs, shape), dtype=np.int64).ravel()
        stepped = rows if step is None else rows * self.columns + step
        blocks, ends = (self.complex_blocks, self.plain_ends) if step is None else (self.steps, self.stepped_ends)
        flat = swing_states(
            self.blocks, blocks, self.loads, self.path, Points(rows, stepped, share, slip, probe, back), ends
        )
        return flat.reshape(*shape, flat.shape[1])

    def may_lock(self) -> Mask:
        """Return which designs friction may lock somewhere in the swing."""
        if not self.rubs:
            return np.zeros(self.count, np.bool_)
        d = design_at(self.blocks.transpose(1, 2, 0).reshape(self.blocks.shape[1], -1), slice(None))
        if self.swing.driver == "slider":
            least = transmission_angle_candidates(self.mechanism, self.swing, self.designs).values.min(axis=1)
            pins = d.crank_pin_circle + d.slider_pin_circle + d.crank_pivot_circle > 0.0
            return np.asarray(pins & (least <= angle_above_which_pins_cannot_lock(d)))
        pin_distance = greatest_pin_distance(self.designs, self.ends.extreme_angles())
        return np.asarray(determinacy_margin(np.sqrt(d.l * d.l - pin_distance * pin_distance), pin_distance, d) <= 0.0)

    def distinct_strokes(self) -> tuple[bool, ...]:
        """Return the strokes that differ: the forward stroke, and the return stroke unless it is alike."""
        return (False, True) if self.ways_differ else (False,)

    def pieces_of_stroke(self, *, back: bool, forces: bool = True, contacts: bool = True) -> Pieces:
        """Return the pieces of one stroke.

        forces: whether to include cuts that only forces have. contacts: whether these include sign changes of the guide
        force.
        """
        self.table = reversed_law_pieces(self.swing.points) if back else self.swing.law_pieces
        kinks = list(self._cuts_where_forces_change()) if forces else []
        kink_shares, codes = self._time_fractions_at_travel([way for way, _ in kinks]), [code for _, code in kinks]
        inner_cuts = [*self._cuts_at_law_corners(), *zip(kink_shares, codes, strict=True)]
        shares = [np.zeros(self.count), np.ones(self.count), *(share for share, _ in inner_cuts)]
        state = np.tile(np.array([-1, -1, *(code for _, code in inner_cuts)], dtype=np.int64), (self.count, 1))
        cuts = np.stack(shares, axis=1)
        cuts = np.where((cuts > _SHORTEST) & (cuts < 1.0 - _SHORTEST), cuts, np.where(cuts < 0.5, 0.0, 1.0))
        cuts = np.where(np.isnan(np.stack(shares, axis=1)), 1.0, cuts)
        uncut = _sort_cuts(Pieces(back, 1.0 - cuts if back else cuts, state))
        touching = forces and contacts and self.rubs and self.mechanism.with_largest_variables.friction.guide > 0.0
        return self._cut_at_guide_side_changes(uncut) if touching else uncut

    def _cuts_at_law_corners(self) -> Any:
        for share in corner_times(self.swing.law, self.table):
            yield np.full(self.count, share), -1

    def _cuts_where_forces_change(self) -> Any:
        """Yield every cut in the forces: fraction (n,) of the forward stroke, and the state with a fixed value."""
        friction, slider = self.mechanism.with_largest_variables.friction, self.swing.driver == "slider"
        if self.rubs:
            for angle in (0.5 * np.pi, 1.5 * np.pi):
                yield from self._cuts_at_angle(np.full(self.count, angle), ANGLE)
            if (
                friction.crank_pin.friction_circle_radius
            ):  # the rod turns as fast as the crank where the slider is at the pivot
                yield from self._cuts_at_position(0.0)
        if self.ways_differ and not slider:
            r, l, e = self.designs[:, :3].T
            for span, ahead in ((r + l, True), (r - l, False)):
                with np.errstate(divide="ignore", invalid="ignore"):
                    angle = np.arcsin(e / span)
                yield from self._cuts_at_angle(angle if ahead == (self.sign > 0.0) else np.pi - angle, PACE)
        for k, kind in enumerate(self.loads.kind.tolist()):
            for knot in self.loads.knots[self.loads.start[k] : self.loads.start[k + 1]].tolist():
                if kind == int(Enters.ANGLE_TABLE):
                    yield from self._cuts_at_angle(np.full(self.count, knot), ANGLE)
                else:
                    yield from self._cuts_at_position(self.sign * knot)

    def _cuts_at_position(self, x: float) -> Any:
        """Yield the cuts at which the slider passes a position."""
        if self.swing.driver == "slider":
            yield self._travel_time_fraction_at_position(np.full(self.count, x)), PLACE
            return
        r, l, e = self.designs[:, :3].T
        size = np.hypot(x, e)
        with np.errstate(divide="ignore", invalid="ignore"):
            half = np.arccos((r * r + size * size - l * l) / (2.0 * r * size))
        for way in (-1.0, 1.0):
            yield from self._cuts_at_angle(np.arctan2(e, x) + way * half, PLACE)

    def _cuts_at_angle(self, angle: Array, state: int) -> Any:
        theta = self.ends.wrap_into_swing(angle)
        if np.isnan(theta).all():
            return
        first, last = self.ends.start, self.ends.end
        if self.swing.driver == "crank":
            yield np.clip((theta - first) / (last - first), 0.0, 1.0), state
        else:
            yield self._travel_time_fraction_at_position(self._slider_position(theta)), state

    def _slider_position(self, theta: Any) -> Array:
        r, l, e = self.designs[:, :3].T
        with np.errstate(invalid="ignore"):
            return np.asarray(motion(np.sin(theta), np.cos(theta), r, l, e, self.sign).x)

    def driver_position_at(self, theta: Array) -> Array:
        """Return the driver position at crank angles (n,): these angles, or slider positions, m."""
        return theta if self.swing.driver == "crank" else self._slider_position(theta)

    def _travel_time_fraction_at_position(self, x: Array) -> Array:
        first, last = self._slider_position(self.ends.start), self._slider_position(self.ends.end)
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (x - first) / (last - first)
        return np.where((s >= 0.0) & (s <= 1.0), s, np.nan)

    def _time_fractions_at_travel(self, ways: list[Array]) -> list[Array]:
        """Return the fractions of the time (n,) at fractions of the travel; NaN stays NaN. A single call is fastest."""
        if not ways:
            return []
        s = np.stack(ways)
        off = np.isnan(s)
        return list(np.where(off, np.nan, time_fractions_at_travel(self.swing.law, np.where(off, 0.0, s), self.table)))

    def _cut_at_guide_side_changes(self, pieces: Pieces) -> Pieces:
        """Return pieces with further cuts where the guide force changes sides between neighbouring samples."""
        u = np.linspace(0.0, 1.0, _SCAN)
        a, span = pieces.cuts[:, :-1, None], np.diff(pieces.cuts, axis=1)[:, :, None]
        share = a + span * u
        probe = np.broadcast_to(pieces.probe[:, :, None], share.shape)
        designs = np.broadcast_to(np.arange(self.count)[:, None, None], share.shape)
        guide = self.states(designs, share, probe, float(pieces.back))[..., GUIDE].real
        change = (guide[..., :-1] * guide[..., 1:] < 0.0) & pieces.have_length[:, :, None]
        design, piece, left = np.nonzero(change)
        if not len(design):
            return pieces
        low, high = share[design, piece, left], share[design, piece, left + 1]
        roots = self._time_fractions_of_guide_side_changes(
            design, low, high, probe[design, piece, left], float(pieces.back)
        )
        rank = np.zeros(len(design), np.int64)
        for i in range(1, len(design)):
            rank[i] = rank[i - 1] + 1 if design[i] == design[i - 1] else 0
        counted = rank < _CONTACTS
        contact_cuts = np.ones((self.count, int(rank[counted].max()) + 1))
        contact_cuts[design[counted], rank[counted]] = roots[counted]
        state = np.where(contact_cuts < 1.0, GUIDE, -1)
        cuts, states_of = (
            np.concatenate([pieces.cuts, contact_cuts], axis=1),
            np.concatenate([pieces.state, state], axis=1),
        )
        return _sort_cuts(Pieces(pieces.back, cuts, states_of))

    def _time_fractions_of_guide_side_changes(
        self, design: IntArray, low: Array, high: Array, probe: Array, back: float
    ) -> Array:
        """Return the fractions between two at which the guide force is zero, by bisection and Newton's method."""
        rising = self.states(design, high, probe, back)[:, GUIDE].real > 0.0
        roots, rows = 0.5 * (low + high), np.arange(len(low))
        for _ in range(_ROOTS):
            shares = roots[rows]
            guide = self.states(design[rows], shares, probe[rows], back, STEP)[:, GUIDE]
            is_above = (guide.real > 0.0) == rising[rows]
            low[rows[~is_above]], high[rows[is_above]] = shares[~is_above], shares[is_above]
            with np.errstate(divide="ignore", invalid="ignore"):
                trial = shares - guide.real / (guide.imag / STEP)
            good = (trial > low[rows]) & (trial < high[rows])
            roots[rows] = np.where(good, trial, 0.5 * (low[rows] + high[rows]))
            rows = rows[np.abs(roots[rows] - shares) > 2e-16]
            if not len(rows):
                break
        return roots

    def cut_slopes(self, pieces: Pieces, design: IntArray, cut: IntArray, probe: Array) -> Array:
        """Return the derivatives (p, c) of the cuts (p,), as fractions of the time, by each raw number."""
        state = pieces.state[design, cut]
        slips = np.zeros((len(design), self.columns))
        rows = np.flatnonzero(state >= 0)
        if not len(rows):
            return slips
        at, side, way = pieces.cuts[design[rows], cut[rows]], probe[rows], float(pieces.back)
        place = np.arange(len(rows))
        rise = self.states(design[rows], at, side, way, STEP)[place, state[rows]].imag / STEP
        for v in range(self.columns):
            change = self.states(design[rows], at, side, way, 0.0, v)[place, state[rows]].imag / STEP
            slips[rows, v] = -change / rise
        return slips


def _sort_cuts(pieces: Pieces) -> Pieces:
    order = np.argsort(pieces.cuts, axis=1, kind="stable")
    cuts = np.take_along_axis(pieces.cuts, order, axis=1)
    state = np.take_along_axis(pieces.state, order, axis=1)
    ends = (cuts <= 0.0) | (cuts >= 1.0)  # a position outside the swing counts as its end
    return Pieces(pieces.back, cuts, np.where(ends, -1, state))


def can_swing_despite_friction(mechanism: Mechanism, swing: Swing, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) can make the swing without being locked by friction."""
    passing = swings_without_dead_point(mechanism, swing, designs)
    if mechanism.with_largest_variables.friction.acts:
        rows = np.flatnonzero(passing)

        def work(begin: int, end: int) -> None:
            rows_here = rows[begin:end]
            passing[rows_here] = ~SwingBatch(mechanism, swing, designs[rows_here], slopes=False).may_lock()

        run_in_chunks(len(rows), work)
    return passing
