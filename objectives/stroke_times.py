"""Times of the outward and the inward stroke and their ratios, at constant speed or with a speed profile."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..model.cycle.stroke_times import ScaledStrokeTimes, scaled_stroke_times
from ..model.kernel.arithmetic import STEP
from ..model.machine.cylinders_and_turns import cylinder_count
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers, require_design_columns
from .kinds import RATIO, TIME
from .machine_needs import ONE_TIMING, REPEATS, SPEED
from .quantity import Array, Formula, Group, Pieces, Quantity, Values, undefined_values

_SECTION = "2. Closed forms"
_NEEDS = (SPEED, REPEATS, ONE_TIMING)


def evaluate_stroke_times(
    mechanism: Mechanism,
    designs: Array,
    formula: Callable[[ScaledStrokeTimes], Any],
    gradients: bool,
    *,
    cylinder: int = 0,
) -> tuple[Array, Array | None]:
    """Return a smooth function (n,) of the stroke times, and its derivatives by complex steps.

    designs: (n, 3 + k)."""
    designs = np.asarray(designs, dtype=np.float64)
    require_design_columns(mechanism, designs)
    lengths = designs[:, :3].T
    with np.errstate(invalid="ignore"):  # NaN for a linkage that does not rotate fully
        values = np.asarray(formula(scaled_stroke_times(mechanism, *lengths, cylinder=cylinder)))
        if not gradients:
            return values, None
        slopes = np.zeros(designs.shape)
        for place in range(3):
            stepped = [length + 1j * STEP if place == n else length for n, length in enumerate(lengths)]
            slopes[:, place] = np.imag(formula(scaled_stroke_times(mechanism, *stepped, cylinder=cylinder))) / STEP
    return values, slopes


@dataclass(frozen=True, kw_only=True)
class StrokeTime(Quantity):
    """Time of one stroke. outward: whether it is the outward stroke."""

    outward: bool

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the formula at constant speed; see `Quantity`."""
        return _constant_speed_formulas(mechanism, self._stroke_crank_angle, _inverse_speed_formula(mechanism))

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        dimensions = np.asarray(dimensions, dtype=np.float64)
        if self.undefined_because([mechanism]):
            return undefined_values(dimensions, gradients)
        angles = Values(*evaluate_stroke_times(mechanism, dimensions, self._stroke_crank_angle, gradients))
        per_speed = evaluate_formula_of_raw_numbers(
            mechanism, dimensions, _inverse_speed_formula(mechanism), gradients=gradients
        )
        return angles.multiplied_by(Values(*per_speed))

    def _stroke_crank_angle(self, times: ScaledStrokeTimes) -> Any:
        return times.outward if self.outward else times.inward


def _inverse_speed_formula(mechanism: Mechanism) -> Formula:
    return lambda number: 1.0 / (mechanism.direction * number(Raw.SPEED))


def _constant_speed_formulas(
    mechanism: Mechanism, function: Callable[[ScaledStrokeTimes], Any], factor: Formula = lambda number: 1.0
) -> Sequence[Formula]:
    """Return a factor times a function of the stroke times, as a formula in a machine's numbers.

    None with a profile.
    """
    if mechanism.speed_profile is not None:
        return ()
    slots = (Raw.CRANK, Raw.ROD, Raw.OFFSET)
    return [lambda number: function(scaled_stroke_times(mechanism, *map(number, slots))) * factor(number)]


@dataclass(frozen=True, kw_only=True)
class StrokeTimeRatio(Quantity):
    """Time of one stroke divided by the other; with a profile, a slow stroke sets a lower bound on it.

    For several cylinders with a profile, it is the minimum over the cylinders. outward: whether the outward stroke is
    the numerator.
    """

    outward: bool

    @property
    def depends_only_on_dimensions(self) -> bool:
        """True."""
        return True

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the formula at constant speed; see `Quantity`."""
        return _constant_speed_formulas(mechanism, self._ratio_of_times)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = self._cylinder_ratios(mechanism, dimensions, gradients)
        rows, least = np.arange(values.shape[1]), values.argmin(axis=0)
        return Values(values[least, rows], None if slopes is None else slopes[least, rows])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the minimum of the ratios of its cylinders; see `Quantity`."""
        values, slopes = self._cylinder_ratios(mechanism, dimensions, True)
        assert slopes is not None
        labels = np.broadcast_to(np.arange(float(len(values))), values.T.shape)
        return Pieces(values.T, slopes.transpose(1, 0, 2), labels, least=True)

    def _cylinder_ratios(self, mechanism: Mechanism, designs: Array, gradients: bool) -> tuple[Array, Array | None]:
        """Return the ratios (c, n) for cylinders that differ, and their derivatives (c, n, 3 + k)."""
        count = 1 if mechanism.speed_profile is None else cylinder_count(mechanism)
        parts = [
            evaluate_stroke_times(mechanism, designs, self._ratio_of_times, gradients, cylinder=k) for k in range(count)
        ]
        slopes = [ratio_slopes for _, ratio_slopes in parts if ratio_slopes is not None]
        return np.stack([values for values, _ in parts]), np.stack(slopes) if slopes else None

    def _ratio_of_times(self, times: ScaledStrokeTimes) -> Any:
        return times.outward / times.inward if self.outward else times.inward / times.outward


OUTWARD_STROKE_TIME = StrokeTime(
    name="outward_stroke_time",
    kind=TIME,
    outward=True,
    place=102,
    group=Group.MOTION,
    sentence="The time that the slider takes to move from the inner to the outer dead centre.",
    advice="The two strokes together take the time of one turn.",
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
    sentence="The time that the slider takes to move from the outer to the inner dead centre.",
    advice="The two strokes together take the time of one turn.",
    formula="integral of d(theta) / |omega| from the outer to the inner dead centre",
    section=_SECTION,
    picture="time ratio",
    example="0.05 s",
    needs=_NEEDS,
    plain=True,
)
OUTWARD_TO_INWARD_TIME_RATIO = StrokeTimeRatio(
    name="outward_to_inward_time_ratio",
    title="outward-to-inward time ratio",
    kind=RATIO,
    outward=True,
    place=104,
    group=Group.MOTION,
    sentence=(
        "The time of the outward stroke divided by that of the inward stroke: above 1 if the outward stroke is slower."
    ),
    advice="The time ratio is the greater of this and its inverse. If cylinders differ, this is their least value.",
    formula="t_out / t_in; at constant speed (180 deg - s b) / (180 deg + s b); s: sign of branch times rotation",
    section=_SECTION,
    picture="time ratio",
    example=1.2,
    in_line=1.0,
    plain=True,
)
INWARD_TO_OUTWARD_TIME_RATIO = StrokeTimeRatio(
    name="inward_to_outward_time_ratio",
    title="inward-to-outward time ratio",
    kind=RATIO,
    outward=False,
    place=105,
    group=Group.MOTION,
    sentence=(
        "The time of the inward stroke divided by that of the outward stroke: above 1 if the inward stroke is slower."
    ),
    advice="The time ratio is the greater of this and its inverse. If cylinders differ, this is their least value.",
    formula="t_in / t_out; at constant speed (180 deg + s b) / (180 deg - s b); s: sign of branch times rotation",
    section=_SECTION,
    picture="time ratio",
    example=1.2,
    in_line=1.0,
    plain=True,
)
STROKE_TIME_RATIOS: dict[str, StrokeTimeRatio] = {
    "outward": OUTWARD_TO_INWARD_TIME_RATIO,
    "inward": INWARD_TO_OUTWARD_TIME_RATIO,
}
"""For each stroke, the ratio of its time to that of the other stroke."""
