"""Crank angles at which the swings of many designs start and end.

A swing is stated by two crank angles, or by two slider positions. For slider positions, the linkage gives the crank
angles, with its crank pin on a given side of the line from crank pivot to slider pin: theta = atan2(e, x) +- acos((r^2
+ d^2 - l^2) / (2 r d)), d^2 = x^2 + e^2. If the start varies, it is among the numbers of the designs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..kernel.arithmetic import STEP
from ..machine.mechanism import Mechanism
from ..machine.raw_numbers_of_designs import RawNumbers
from .angles_from_position import crank_angles_at
from .swing import STARTS, Swing

Complexes = NDArray[np.complex128]
_NO_SLOT = -1
_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Ends:
    """Crank angles of n designs at both ends of their swings, rad.

    start, end: (n,), NaN if the slider does not reach its position. slopes: (n, v, 2), their derivatives with respect
    to the design numbers that `columns` names; None unless requested.
    """

    start: Array
    end: Array
    columns: tuple[int, ...] = ()
    slopes: Array | None = None

    def select(self, rows: Any) -> Ends:
        """Return the ends for a selection of designs."""
        return Ends(self.start[rows], self.end[rows], self.columns, None if self.slopes is None else self.slopes[rows])

    @property
    def low(self) -> Array:
        """The smaller angle of each swing, rad."""
        return np.minimum(self.start, self.end)

    @property
    def high(self) -> Array:
        """The larger angle of each swing, rad."""
        return np.maximum(self.start, self.end)

    @property
    def middle(self) -> Array:
        """The angle halfway, rad."""
        return 0.5 * (self.start + self.end)

    @property
    def direction(self) -> Array:
        """+1 if the crank turns counter-clockwise on the forward stroke, -1 otherwise."""
        return np.where(self.end > self.start, 1.0, -1.0)

    def wrap_into_swing(self, angle: Any) -> Array:
        """Return crank angles (n,), or one, shifted by whole turns into the swings; NaN where impossible."""
        with np.errstate(invalid="ignore"):
            turned = angle + _TURN * np.ceil((self.low - angle) / _TURN)
            return np.where(turned <= self.high, turned, np.nan)

    def extreme_angles(self) -> list[Array]:
        """Return the ends, and the crank angles normal to the slider line; NaN where a swing has none."""
        return [self.start, self.end, self.wrap_into_swing(0.5 * np.pi), self.wrap_into_swing(1.5 * np.pi)]

    def largest_pin_distance_from_line(self, designs: Array) -> Array:
        """Return the maximum distance (n,) between the crank pin and the slider line over the swings, m."""
        return greatest_pin_distance(designs, self.extreme_angles())

    def with_imaginary_steps(self, columns: int, column: int | None) -> Complexes:
        """Return both ends (n c, 2), the start last, with an imaginary step in each of c numbers."""
        moved = np.repeat(np.stack([self.start, self.end], axis=1)[:, None] + 0j, columns, axis=1)
        assert self.slopes is not None
        for place, v in enumerate(self.columns):
            moved[:, columns - 1 if v == column else v] += 1j * STEP * self.slopes[:, place]
        return moved.reshape(-1, 2)


def append_swing_start(
    numbers: RawNumbers, plain: Complexes, steps: Complexes, designs: Array, column: int
) -> tuple[RawNumbers, Complexes]:
    """Return numbers and stepped blocks followed by the start of the swing, a number that no kernel uses.

    plain: blocks (n, rows, 1). steps: (n c, rows, 1); none if no derivatives are requested.
    """
    n, rows = plain.shape[:2]
    if len(steps):
        by_design = steps.reshape(n, len(numbers.columns), rows, 1)
        steps = np.concatenate([by_design, plain[:, None]], axis=1).reshape(-1, rows, 1)
    slopes = None
    if numbers.slopes is not None:
        slope = np.zeros((len(numbers.slopes), 1, designs.shape[1]))
        slope[:, 0, column] = 1.0
        slopes = np.concatenate([numbers.slopes, slope], axis=1)
    values = np.concatenate([numbers.values, designs[:, column : column + 1]], axis=1)
    return RawNumbers(np.append(numbers.columns, _NO_SLOT), values, slopes), steps


def greatest_pin_distance(designs: Array, angles: Iterable[Array]) -> Array:
    """Return the maximum |e - r sin(theta)| (n,) over crank angles (n,), ignoring NaN, m."""
    r, e = designs[:, 0], designs[:, 2]
    distances = [np.abs(e - r * np.sin(angle)) for angle in angles]
    return np.asarray(np.fmax.reduce(distances))


def swing_start_column(mechanism: Mechanism) -> int | None:
    """Return the column in which designs have the start of their swing; None if all have the same start."""
    for place, item in enumerate(mechanism.varying):
        if item.paths[0] in STARTS.values():
            return 3 + place
    return None


def swing_ends(mechanism: Mechanism, swing: Swing, designs: Array, *, slopes: bool = False) -> Ends:
    """Return both ends of the swings for designs (n, 3 + k). slopes: whether derivatives are needed."""
    sign = mechanism.sign
    column = swing_start_column(mechanism)
    plain = _end_angles(swing, sign, designs, column)
    if not slopes:
        return Ends(*plain)
    columns = ((0, 1, 2) if swing.stated_for == "slider" else ()) + (() if column is None else (column,))
    stepped = np.zeros((len(designs), len(columns), 2))
    for place, v in enumerate(columns):
        moved = designs.astype(np.complex128)
        moved[:, v] += 1j * STEP
        stepped[:, place] = np.stack([end.imag for end in _end_angles(swing, sign, moved, column)], axis=1) / STEP
    return Ends(*plain, columns, stepped)


def _end_angles(swing: Swing, sign: float, designs: Any, column: int | None) -> tuple[Any, Any]:
    if column is None:
        first, last = (np.full(len(designs), angle) for angle in (swing.start, swing.end))
    else:
        first = designs[:, column]
        last = first + (swing.end - swing.start) if swing.follows else np.full(len(designs), swing.end)
    if swing.stated_for == "crank":
        return first, last
    side = 1.0 if swing.side == "left" else -1.0
    return crank_angles_at(first, sign, side, designs), crank_angles_at(last, sign, side, designs)
