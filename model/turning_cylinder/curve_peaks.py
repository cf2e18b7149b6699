"""Greatest values of a lever's curves over its motion, for many levers, to rounding and with exact derivatives.

`peak_search` searches a full turn, or one way of a swing, as the way back has the same forces at the same places. A law
that starts with a jump in speed or acceleration causes other forces at its ends than those that hold the lever at rest
there, so both are included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import Array, IntArray
from ..kernel.arithmetic import STEP
from ..signals.peak_search import Segments, find_maxima
from ..swing.law import NO_TABLE, corner_times, law_code
from ..swing.swing_types import LeverLaw
from .crank_turn_state import PIECES
from .curves import CURVES_OF_SWING, CURVES_OF_TURN, Complexes, fill_curves_of_swing, fill_curves_of_turn
from .lever_state import LeverNumbers

_PANELS = 1.0
_PEAKS = 4


@dataclass(frozen=True)
class LeverBatch:
    """Levers that can make their motion.

    table: rows of `LeverNumbers` (n, ...). steps: tables with an imaginary step of each variable. law: that of a swing.
    """

    table: Array
    law: LeverLaw
    steps: tuple[Complexes, ...] = ()
    of_full_turn: bool = False

    @property
    def lever_count(self) -> int:
        """Number of levers."""
        return len(self.table)

    @property
    def plain(self) -> LeverNumbers:
        """Numbers (n,) of the levers."""
        return LeverNumbers(*self.table.T)

    @property
    def stepped(self) -> tuple[LeverNumbers, ...]:
        """Numbers (n,) with each step."""
        return tuple(LeverNumbers(*table.T) for table in self.steps)

    def levers_between(self, begin: int, end: int) -> LeverBatch:
        """Return some of the levers."""
        steps = tuple(table[begin:end] for table in self.steps)
        return LeverBatch(self.table[begin:end], self.law, steps, self.of_full_turn)

    @property
    def curve_breakpoints(self) -> Array:
        """Breakpoints of the curves, which do not move: fractions of the time, or places of `turn_state`."""
        return np.arange(PIECES + 1.0) if self.of_full_turn else np.array([0.0, *corner_times(self.law), 1.0])

    @cached_property
    def number_tables(self) -> tuple[Complexes, ...]:
        """Numbers (n, ...) of the levers, then with each step."""
        return self.table.astype(np.complex128), *self.steps

    def curve_codes(self, curves: Sequence[str]) -> IntArray:
        """Return the codes of curves by name."""
        names = CURVES_OF_TURN if self.of_full_turn else CURVES_OF_SWING
        return np.array([names.index(name) for name in curves])

    def curve_values(
        self,
        table: Complexes,
        lever: IntArray,
        curve: IntArray,
        place: Array | Complexes,
        probe: Array,
        *,
        slow: bool = False,
    ) -> Complexes:
        """Return curves (p, k) of levers (p,), by code (p,), at places (p, k); probe (p,): in the same piece.

        table: one of `tables`. slow: whether to ignore the law.
        """
        places, found = np.ascontiguousarray(place, dtype=np.complex128), np.empty(place.shape, np.complex128)
        if self.of_full_turn:
            fill_curves_of_turn(table, lever, curve, places, np.ascontiguousarray(probe), found)
        else:
            law = law_code("slow" if slow else self.law)
            fill_curves_of_swing(table, law, NO_TABLE, lever, curve, places, np.ascontiguousarray(probe), found)
        return found


def table_of_numbers(numbers: LeverNumbers, count: int, kind: Any = np.float64) -> Any:
    """Return numbers of levers (count,), or one for all, as a table with a row for each lever."""
    table = np.empty((count, len(numbers)), kind)
    for place, number in enumerate(numbers):
        table[:, place] = number
    return table


@dataclass(frozen=True)
class LeverPeaks:
    """Local peaks of n levers, in any order.

    values: (n, k), -inf where absent. places: (n, k), fraction of the duration from start to end, plus 2 for a cylinder
    that holds the lever at an end, or place of `turn_state`; NaN where absent. gradients: (n, k, v), with respect to
    the variables.
    """

    values: Array
    places: Array
    gradients: Array


@dataclass(frozen=True)
class _Rows:
    """Curves of levers as rows of a search: curve c of lever i is row c n + i. curves: codes."""

    batch: LeverBatch
    curves: IntArray
    numbers: int

    def curve_values(
        self, table: Complexes, row: IntArray, place: Array | Complexes, probe: Array, *, slow: bool = False
    ) -> Complexes:
        """Return the curves (p, k) of rows at places (p, k); see `LeverBatch.curve_values`."""
        curve, lever = np.divmod(row, self.batch.lever_count)
        return self.batch.curve_values(table, lever, self.curves[curve], place, probe, slow=slow)

    def evaluate(
        self, row: IntArray, probe: Array, place: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return value, slope and derivatives; see `peak_search.Curve`. Breakpoints do not move."""
        plain, *stepped = self.batch.number_tables[: 1 + self.numbers] if gradients else self.batch.number_tables[:1]
        found = self.curve_values(plain, row, np.asarray(place + 1j * STEP, dtype=np.complex128), probe)
        slopes = [self.curve_values(table, row, place, probe).imag / STEP for table in stepped]
        curve = np.stack([found.real, found.imag / STEP, *slopes], axis=-1)
        return curve, np.abs(found.real)

    def breakpoint_gradients(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives of breakpoints, which are zero."""
        return np.zeros((len(cuts), self.numbers))

    def peaks_at_rest(self) -> LeverPeaks:
        """Return the values (r, 2) with the cylinder at rest at both ends."""
        row, ends = np.arange(len(self.curves) * self.batch.lever_count), np.array([0.0, 1.0])
        place, rate = np.tile(ends, (len(row), 1)), LeverNumbers._fields.index("rate")
        still = [table.copy() for table in self.batch.number_tables[: 1 + self.numbers]]
        for table in still:
            table[:, rate] = 0.0
        plain, *stepped = (self.curve_values(table, row, place, np.full(len(row), 0.5), slow=True) for table in still)
        slopes = [part.imag / STEP for part in stepped]
        gradients = np.stack(slopes, axis=-1) if slopes else np.zeros((*plain.shape, 0))
        return LeverPeaks(plain.real, 2.0 + place, gradients)


def lever_peaks(
    batch: LeverBatch, curves: Sequence[str], *, gradients: bool = False, limit: int = _PEAKS
) -> LeverPeaks:
    """Return the peaks of curves by name.

    Those of curve c are columns c k to (c + 1) k. limit: local peaks of each curve, highest first; for a law other than
    slow, two values at rest at the ends follow.
    """
    rows = _Rows(batch, batch.curve_codes(curves), len(batch.steps) if gradients else 0)
    count = batch.lever_count * len(curves)
    cuts = batch.curve_breakpoints
    pieces = len(cuts) - 1
    row, piece = np.repeat(np.arange(count), pieces), np.tile(np.arange(pieces), count)
    first = np.arange(len(row)) + 1 - pieces if batch.of_full_turn else -1
    following = np.where(piece + 1 < pieces, np.arange(len(row)) + 1, first)
    segments = Segments(row, cuts[piece], cuts[piece + 1], np.arange(len(row)), following)
    found = find_maxima(rows, segments, np.full(count, _PANELS), limit=limit, signed=True)
    parts = [LeverPeaks(found.values, found.places, found.slopes)]
    if batch.law != "slow":
        parts.append(rows.peaks_at_rest())
    columns = zip(*((part.values, part.places, part.gradients) for part in parts), strict=True)
    return LeverPeaks(*(_reshape_by_lever(column, len(curves), batch.lever_count) for column in columns))


def _reshape_by_lever(parts: tuple[Array, ...], curves: int, count: int) -> Array:
    """Return peaks in motion and at rest (c n, k, ...) as (n, c k, ...)."""
    joined = np.concatenate(parts, axis=1)
    by_curve = joined.reshape(curves, count, *joined.shape[1:])
    return np.concatenate(list(by_curve), axis=1)
