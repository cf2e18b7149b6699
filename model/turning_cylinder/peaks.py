"""Greatest values of a lever's curves over its motion, for many levers, to rounding and with exact derivatives.

`peak_search` searches a full turn, or one way of a swing, as the way back has the same forces at the same places. A law
that starts with a jump of speed or acceleration has other forces at its ends than the cylinder that holds the lever
there, so both count.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, IntArray
from ..kernel.arithmetic import STEP, magnitude
from ..signals.cycle_segments import Segments
from ..signals.peak_search import find_maxima
from ..swing.law import corners
from ..swing.swing_types import LeverLaw
from .states import LeverNumbers, lever_state, size
from .turn import PIECES, turn_state

Curve = Callable[[LeverNumbers, Any], Any]
"""A curve from the numbers of levers and their `LeverState` or, for a full turn, `TurnState`."""
CURVES: dict[str, Curve] = {
    "push": lambda c, s: c.rub + s.push,
    "pull": lambda c, s: c.rub - s.push,
    "push_pressure": lambda c, s: (c.rub + s.push) / c.full_area,
    "pull_pressure": lambda c, s: (c.rub - s.push) / c.annular_area,
    "push_share": lambda c, s: (c.rub + s.push) / (c.full_area * c.supply),
    "pull_share": lambda c, s: (c.rub - s.push) / (c.annular_area * c.supply),
    "buckling_share": lambda c, s: (c.rub + s.push) * s.length * s.length / c.buckling,
    "push_power": lambda c, s: (c.rub + s.push) * magnitude(s.speed),
    "pull_power": lambda c, s: (c.rub - s.push) * magnitude(s.speed),
    "speed": lambda c, s: magnitude(s.speed),
    "pin": lambda c, s: size(s.pin),
    "pivot": lambda c, s: size(s.pivot),
    "cylinder_pivot": lambda c, s: size(s.cylinder_pivot),
    "angle_error": lambda c, s: s.angle_error,
    "arm_speed_ratio": lambda c, s: magnitude(s.turn_1),
    "arm_speed": lambda c, s: magnitude(s.turn_1 * c.speed),
    "arm_rise_ratio": lambda c, s: s.turn_2,
    "arm_fall_ratio": lambda c, s: -s.turn_2,
    "arm_rise": lambda c, s: s.turn_2 * c.speed * c.speed,
    "arm_fall": lambda c, s: -s.turn_2 * c.speed * c.speed,
    "sliding_speed": lambda c, s: magnitude(s.length_1 * c.speed),
    "ram_speed": lambda c, s: magnitude(s.ram_1 * c.speed),
    "torque_up": lambda c, s: s.torque,
    "torque_down": lambda c, s: -s.torque,
}
"""Curves whose greatest value counts, with the friction of the seal: of a swing, both ways together; of a full turn,
those of the forces in the three pins and from `arm_speed_ratio` on."""
_PANELS = 1.0
_PEAKS = 4


@dataclass(frozen=True)
class LeverBatch:
    """Levers that can make their motion. plain: numbers (n,). stepped: with an imaginary step of each variable.

    law: that of a swing.
    """

    plain: LeverNumbers
    law: LeverLaw
    stepped: tuple[LeverNumbers, ...] = ()
    of_full_turn: bool = False

    @property
    def count(self) -> int:
        """Number of levers."""
        return len(self.plain.crank)

    def part(self, begin: int, end: int) -> LeverBatch:
        """Return some of the levers."""
        plain, *stepped = (
            LeverNumbers(*(number[begin:end] for number in numbers)) for numbers in (self.plain, *self.stepped)
        )
        return LeverBatch(plain, self.law, tuple(stepped), self.of_full_turn)

    @property
    def cuts(self) -> Array:
        """Breakpoints of the curves, which do not move: fractions of the time, or places of `turn_state`."""
        return np.arange(PIECES + 1.0) if self.of_full_turn else np.array([0.0, *corners(self.law), 1.0])


@dataclass(frozen=True)
class LeverPeaks:
    """Local peaks of n levers, in any order.

    values: (n, k), -inf where absent. places: (n, k), fraction of the time of the way out, plus 2 for a cylinder that
    holds the lever at an end, or place of `turn_state`; NaN where absent. gradients: (n, k, v), by the variables.
    """

    values: Array
    places: Array
    gradients: Array


@dataclass(frozen=True)
class _Rows:
    """Curves of levers as rows of a search: curve c of lever i is row c n + i."""

    batch: LeverBatch
    curves: tuple[Curve, ...]
    numbers: int

    def values(self, numbers: LeverNumbers, law: LeverLaw, row: IntArray, share: Any, probe: Array) -> Any:
        """Return the curves (p, k) of rows at places (p, k). numbers: of the batch."""
        curve, lever = np.divmod(row, self.batch.count)
        c = LeverNumbers(*(number[lever, None] for number in numbers))
        state: Any = turn_state(c, share, probe) if self.batch.of_full_turn else lever_state(c, law, share, probe)
        found = self.curves[0](c, state)
        for place, other in enumerate(self.curves[1:], 1):
            found = np.where((curve == place)[:, None], other(c, state), found)
        return found

    def evaluate(
        self, row: IntArray, probe: Array, place: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return value, slope and derivatives; see `peak_search.Curve`. Breakpoints do not move."""
        batch, within = self.batch, probe[:, None]
        found = self.values(batch.plain, batch.law, row, place + 1j * STEP, within)
        chosen = batch.stepped[: self.numbers] if gradients else ()
        slopes = [self.values(stepped, batch.law, row, place, within).imag / STEP for stepped in chosen]
        curve = np.stack([found.real, found.imag / STEP, *slopes], axis=-1)
        return curve, np.abs(found.real)

    def rates(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives of breakpoints, which are zero."""
        return np.zeros((len(cuts), self.numbers))

    def at_rest(self) -> LeverPeaks:
        """Return the values (r, 2) with the cylinder at rest at both ends."""
        row, ends = np.arange(len(self.curves) * self.batch.count), np.array([[0.0, 1.0]])
        still = [c._replace(rate=0.0 * c.rate) for c in (self.batch.plain, *self.batch.stepped[: self.numbers])]
        plain, *stepped = (self.values(c, "slow", row, ends, ends) for c in still)
        slopes = [part.imag / STEP for part in stepped]
        gradients = np.stack(slopes, axis=-1) if slopes else np.zeros((*plain.shape, 0))
        return LeverPeaks(plain.real, np.broadcast_to(2.0 + ends, plain.shape), gradients)


def lever_peaks(
    batch: LeverBatch, curves: Sequence[str], *, gradients: bool = False, limit: int = _PEAKS
) -> LeverPeaks:
    """Return the peaks of curves by name.

    Those of curve c are columns c k to (c + 1) k. limit: local peaks of each curve, highest first; for a law other than
    slow, two values at rest at the ends follow.
    """
    rows = _Rows(batch, tuple(CURVES[name] for name in curves), len(batch.stepped) if gradients else 0)
    count = batch.count * len(curves)
    cuts = batch.cuts
    pieces = len(cuts) - 1
    row, piece = np.repeat(np.arange(count), pieces), np.tile(np.arange(pieces), count)
    first = np.arange(len(row)) + 1 - pieces if batch.of_full_turn else -1
    following = np.where(piece + 1 < pieces, np.arange(len(row)) + 1, first)
    segments = Segments(row, cuts[piece], cuts[piece + 1], np.arange(len(row)), following)
    found = find_maxima(rows, segments, np.full(count, _PANELS), limit=limit, signed=True)
    parts = [LeverPeaks(found.values, found.places, found.slopes)]
    if batch.law != "slow":
        parts.append(rows.at_rest())
    columns = zip(*((part.values, part.places, part.gradients) for part in parts), strict=True)
    return LeverPeaks(*(_by_lever(column, len(curves), batch.count) for column in columns))


def _by_lever(parts: tuple[Array, ...], curves: int, count: int) -> Array:
    """Return peaks in motion and at rest (c n, k, ...) as (n, c k, ...)."""
    joined = np.concatenate(parts, axis=1)
    by_curve = joined.reshape(curves, count, *joined.shape[1:])
    return np.concatenate(list(by_curve), axis=1)
