"""Times of outward and inward stroke, and the one over the other: along a speed profile those of the profile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model.cycle.strokes import Strokes, strokes
from ..model.kernel.arithmetic import STEP
from ..model.machine.mechanism import Mechanism
from ..model.machine.members import cylinder_count
from ..model.machine.numbers import of_numbers, require_width
from ..model.machine.raw import Raw
from .kinds import RATIO, TIME
from .needs import ONE_TIMING, REPEATS, TURNING
from .quantity import Array, Group, Pieces, Quantity, Values, undefined

_SECTION = "2. Closed forms"
_NEEDS = (TURNING, REPEATS, ONE_TIMING)


def of_strokes(
    mechanism: Mechanism, designs: Array, formula: Callable[[Strokes], Any], gradients: bool, *, cylinder: int = 0
) -> tuple[Array, Array | None]:
    """Return a smooth formula of the strokes of designs (n, 3 + k), (n,), and its derivatives by complex steps."""
    designs = np.asarray(designs, dtype=np.float64)
    require_width(mechanism, designs)
    lengths = designs[:, :3].T
    with np.errstate(invalid="ignore"):  # of a linkage that does not turn fully: no number
        values = np.asarray(formula(strokes(mechanism, *lengths, cylinder=cylinder)))
        if not gradients:
            return values, None
        slopes = np.zeros(designs.shape)
        for place in range(3):
            stepped = [length + 1j * STEP if place == n else length for n, length in enumerate(lengths)]
            slopes[:, place] = np.imag(formula(strokes(mechanism, *stepped, cylinder=cylinder))) / STEP
    return values, slopes


@dataclass(frozen=True, kw_only=True)
class StrokeTime(Quantity):
    """The time of one stroke. outward: of which."""

    outward: bool

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        dimensions = np.asarray(dimensions, dtype=np.float64)
        if self.undefined_because([mechanism]):
            return undefined(dimensions, gradients)

        def angle(found: Strokes) -> Any:
            return found.outward if self.outward else found.inward

        def per_speed(number: Callable[[int], Any]) -> Any:
            return 1.0 / (mechanism.direction * number(Raw.SPEED))

        angles, by_lengths = of_strokes(mechanism, dimensions, angle, gradients)
        rates, by_speed = of_numbers(mechanism, dimensions, per_speed, gradients=gradients)
        if by_lengths is None or by_speed is None:
            return Values(angles * rates, None)
        return Values(angles * rates, by_lengths * rates[:, None] + angles[:, None] * by_speed)


@dataclass(frozen=True, kw_only=True)
class StrokeQuotient(Quantity):
    """Time of one stroke over that of the other: what a slow stroke is a least value of along a profile.

    Of several cylinders along a profile it is that of the cylinder in which it is least. outward: whether the outward
    stroke is the one above.
    """

    outward: bool

    @property
    def of_dimensions(self) -> bool:
        """True."""
        return True

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = self._of_cylinders(mechanism, dimensions, gradients)
        rows, least = np.arange(values.shape[1]), values.argmin(axis=0)
        return Values(values[least, rows], None if slopes is None else slopes[least, rows])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the least of those of its cylinders; see `Quantity`."""
        values, slopes = self._of_cylinders(mechanism, dimensions, True)
        assert slopes is not None
        labels = np.broadcast_to(np.arange(float(len(values))), values.T.shape)
        return Pieces(values.T, slopes.transpose(1, 0, 2), labels, least=True)

    def _of_cylinders(self, mechanism: Mechanism, designs: Array, gradients: bool) -> tuple[Array, Array | None]:
        """Return the quotients (c, n) of cylinders that differ, and their derivatives (c, n, 3 + k)."""

        def quotient(found: Strokes) -> Any:
            return found.outward / found.inward if self.outward else found.inward / found.outward

        count = 1 if mechanism.speed_profile is None else cylinder_count(mechanism)
        parts = [of_strokes(mechanism, designs, quotient, gradients, cylinder=k) for k in range(count)]
        slopes = [by for _, by in parts if by is not None]
        return np.stack([values for values, _ in parts]), np.stack(slopes) if slopes else None


OUTWARD_STROKE_TIME = StrokeTime(
    name="outward_stroke_time",
    kind=TIME,
    outward=True,
    place=102,
    group=Group.MOTION,
    sentence="The time that the slider takes from the inner to the outer dead centre.",
    advice="Both strokes together take the time of a turn.",
    formula="integral of d(theta) / |omega| from the inner to the outer dead centre",
    section=_SECTION,
    picture="time ratio",
    example="0.05 s",
    needs=_NEEDS,
    plain=True,
)
INWARD_STROKE_TIME = StrokeTime(
    name="inward_stroke_time",
    kind=TIME,
    outward=False,
    place=103,
    group=Group.MOTION,
    sentence="The time that the slider takes from the outer to the inner dead centre.",
    advice="Both strokes together take the time of a turn.",
    formula="integral of d(theta) / |omega| from the outer to the inner dead centre",
    section=_SECTION,
    picture="time ratio",
    example="0.05 s",
    needs=_NEEDS,
    plain=True,
)
OUTWARD_TO_INWARD_TIME = StrokeQuotient(
    name="outward_to_inward_time",
    kind=RATIO,
    outward=True,
    place=104,
    group=Group.MOTION,
    sentence="The time of the outward stroke divided by that of the inward one: above 1 where the outward one is slow.",
    advice="The time ratio is the greater of this and its inverse. Of cylinders that differ it is the least one.",
    formula="t_out / t_in; at constant speed (180 deg - s b) / (180 deg + s b), s the sign of branch and rotation",
    section=_SECTION,
    picture="time ratio",
    example=1.2,
    in_line=1.0,
    plain=True,
)
INWARD_TO_OUTWARD_TIME = StrokeQuotient(
    name="inward_to_outward_time",
    kind=RATIO,
    outward=False,
    place=105,
    group=Group.MOTION,
    sentence="The time of the inward stroke divided by that of the outward one: above 1 where the inward one is slow.",
    advice="The time ratio is the greater of this and its inverse. Of cylinders that differ it is the least one.",
    formula="t_in / t_out; at constant speed (180 deg + s b) / (180 deg - s b), s the sign of branch and rotation",
    section=_SECTION,
    picture="time ratio",
    example=1.2,
    in_line=1.0,
    plain=True,
)
STROKE_QUOTIENTS: dict[str, StrokeQuotient] = {"outward": OUTWARD_TO_INWARD_TIME, "inward": INWARD_TO_OUTWARD_TIME}
"""Of each stroke its time over that of the other one."""
