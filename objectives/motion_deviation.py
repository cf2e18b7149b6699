"""Position error from tolerances, and deviation of the slider's motion from a target motion given as points.

The position error is the slider's displacement, maximum over the cycle or over part of the stroke. Deviations exist
only for a target motion; a `Problem` lists them among its own quantities.
"""

from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from ..model.kinematics.target_motion import Fit, Measure, TargetMotion, fit_target_motion
from ..model.kinematics.target_pieces import least_deviation_pieces
from ..model.machine.loads.load import require_word
from ..model.machine.mechanism import Mechanism
from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import ANGLE, LENGTH
from .machine_needs import TOLERANCES
from .quantity import Array, Group, Pieces, Quantity, Values

_SOURCE = "R. Chetana and T. V. Vineeth Kumar, Analysis of Position Error in Offset Slider Crank Mechanism, Eq. (3)"

_error = partial(
    CyclePeak,
    kind=LENGTH,
    group=Group.ACCURACY,
    section="12. Position error",
    source=_SOURCE,
    picture="position error",
    needs=(TOLERANCES,),
    about_tolerances=True,
)
POSITION_ERROR = _error(
    name="position_error",
    title="position error, worst case",
    short="position error",
    signal=Signal.POSITION_ERROR,
    place=40,
    sentence=(
        "The greatest error of the slider position over the cycle, with crank, rod, offset and crank angle at their "
        "tolerances in the worst combination."
    ),
    advice="It depends on lengths and tolerances, not on masses, loads or speed; without tolerances it is undefined.",
    formula="max over theta of the sum of |dx/di| T_i, for i = crank, rod, offset, crank angle",
    example="0.3 mm",
    offered=("objective",),
    on_datasheet=True,
)
POSITION_ERROR_RSS = _error(
    name="position_error_rss",
    title="position error, root sum square",
    signal=Signal.POSITION_ERROR_RSS,
    place=90,
    sentence=("The position error to expect if the deviations are independent: the root of the sum of their squares."),
    advice="With the four tolerances alone it is at least half of the worst case, and never exceeds it.",
    formula="max over theta of sqrt(sum of (dx/di T_i)^2)",
    example="0.2 mm",
)


@dataclass(frozen=True, kw_only=True)
class MotionDeviation(Quantity):
    """Maximum or root mean square deviation from a target motion; a free phase and a free shift are fitted.

    target: the target motion; None before a job gives one, when the quantity has facts but no values.
    """

    target: TargetMotion | None = None
    measure: Measure
    table: ClassVar[str] = "target_motion"

    def __post_init__(self) -> None:
        super().__post_init__()
        require_word("measure", self.measure, Measure)

    @property
    def _required_target(self) -> TargetMotion:
        assert self.target is not None
        return self.target

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3) or more columns; see `Quantity`."""
        if not gradients:
            return Values(
                fit_target_motion(self._required_target, mechanism.sign, self.measure, dimensions[:, :3]).values, None
            )
        pieces = self.pieces(mechanism, dimensions)
        return Values(pieces.values[:, 0], pieces.gradients[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of smooth pieces; see `Quantity`."""
        fitted = least_deviation_pieces(self._required_target, mechanism.sign, self.measure, dimensions[:, :3])
        further = dimensions.shape[1] - 3  # extra variables do not move the slider
        return Pieces(fitted.values, np.pad(fitted.gradients, ((0, 0), (0, 0), (0, further))), fitted.labels)

    def best_fit_phase_and_shift(self, mechanism: Mechanism, dimensions: Array) -> dict[str, Array]:
        """Return the best-fit phase (deg) and shift (mm), each if free, for designs (n, 3), by column."""
        best_fit: Fit = fit_target_motion(self._required_target, mechanism.sign, self.measure, dimensions[:, :3])
        columns = {}
        suffix = "_rms" if self.measure == "rms" else ""
        if self._required_target.phase == "free":
            columns[f"motion_phase{suffix}_deg"] = ANGLE.metric.factor * best_fit.phase
        if self._required_target.shift == "free":
            columns[f"motion_shift{suffix}_mm"] = LENGTH.metric.factor * best_fit.shift
        return columns


_deviation = partial(
    MotionDeviation,
    kind=LENGTH,
    group=Group.ACCURACY,
    section="12. Position error",
    source="derived there",
    picture="desired motion",
)
MOTION_DEVIATION = _deviation(
    name="motion_deviation",
    title="motion deviation, greatest",
    measure="greatest",
    place=280,
    sentence="The greatest distance between the slider and the points of the desired motion.",
    formula="max over the points of |x(theta_i + psi) + s - t_i|; psi and s are zero, or optimal where free",
    example="0.3 mm",
)
MOTION_DEVIATION_RMS = _deviation(
    name="motion_deviation_rms",
    title="motion deviation, root mean square over the points",
    measure="rms",
    place=290,
    sentence="The distance between the slider and the points of the desired motion, as a root mean square.",
    advice="A single outlier counts less than in the greatest deviation.",
    formula="sqrt(mean of (x(theta_i + psi) + s - t_i)^2)",
    example="0.2 mm",
)
DEVIATIONS = {each.name: each for each in (MOTION_DEVIATION, MOTION_DEVIATION_RMS)}
"""Facts about the quantities that a target motion creates, by name."""


def motion_deviations(target: TargetMotion) -> tuple[MotionDeviation, ...]:
    """Return the quantities for a target motion."""
    return tuple(replace(each, target=target) for each in DEVIATIONS.values())
