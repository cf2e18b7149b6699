"""Times of outward and inward stroke, and the one over the other: along a speed profile those of the profile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model.cycle.strokes import Strokes, strokes
from ..model.kernel.arithmetic import STEP
from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import of_numbers, require_width
from ..model.machine.raw import Raw
from .kinds import RATIO, TIME
from .needs import ONE_TIMING, REPEATS, TURNING
from .quantity import Array, Group, Quantity, Values, undefined

_SECTION = "2. Closed forms"
_NEEDS = (TURNING, REPEATS, ONE_TIMING)


def of_strokes(
    mechanism: Mechanism, designs: Array, formula: Callable[[Strokes], Any], gradients: bool
) -> tuple[Array, Array | None]:
    """Return a smooth formula of the strokes of designs (n, 3 + k), (n,), and its derivatives by complex steps."""
    designs = np.asarray(designs, dtype=np.float64)
    require_width(mechanism, designs)
    lengths = designs[:, :3].T
    with np.errstate(invalid="ignore"):  # of a linkage that does not turn fully: no number
        values = np.asarray(formula(strokes(mechanism, *lengths)))
        if not gradients:
            return values, None
        slopes = np.zeros(designs.shape)
        for place in range(3):
            stepped = [length + 1j * STEP if place == n else length for n, length in enumerate(lengths)]
            slopes[:, place] = np.imag(formula(strokes(mechanism, *stepped))) / STEP
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


class OutwardToInwardTime(Quantity):
    """Time of the outward stroke over that of the inward one: what a slow stroke is a bound on along a profile."""

    @property
    def of_dimensions(self) -> bool:
        """True."""
        return True

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        return Values(*of_strokes(mechanism, dimensions, lambda found: found.ratio, gradients))


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
OUTWARD_TO_INWARD_TIME = OutwardToInwardTime(
    name="outward_to_inward_time",
    kind=RATIO,
    place=104,
    group=Group.MOTION,
    sentence="The time of the outward stroke divided by that of the inward one: above 1 where the outward one is slow.",
    advice="The time ratio is this number or one over it, whichever is greater.",
    formula="t_out / t_in; at constant speed (180 deg - s b) / (180 deg + s b), s the sign of branch and rotation",
    section=_SECTION,
    picture="time ratio",
    example=1.2,
    in_line=1.0,
    needs=(ONE_TIMING,),
    plain=True,
)
