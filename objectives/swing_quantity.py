"""Quantities over a limited swing of the crank.

They exist if the motion in a job is a swing; a `Problem` lists them among its own quantities.
"""

from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.swing.closure import (
    slider_travels,
    swept_crank_angles,
    swings_without_dead_point,
    transmission_angle_candidates,
)
from ..model.swing.peaks import SwingPeaks, holding_drive_peaks, peaks_of_negated_least_drive, swing_peaks
from ..model.swing.swing import Swing
from ..model.swing.swing_types import Driver, Stated
from ..model.swing.work import swing_efficiency, swing_work
from .machine_needs import Consequence
from .quantity import MECHANICS, Array, Pieces, Quantity, Values


@dataclass(frozen=True, kw_only=True)
class SwingQuantity(Quantity):
    """A quantity over a swing.

    swing: the swing; None before a job gives one, when the quantity has facts but no values. driver: required driver,
    any if None. timed: whether the swing must have a duration. tolerated: whether it comes from tolerances, including
    those of the actuator. rubbing: the quantity or number that it equals without friction, "" if there is none.
    """

    swing: Swing | None = None
    driver: Driver | None = field(default=None, compare=False)
    timed: bool = field(default=False, compare=False)
    tolerated: bool = field(default=False, compare=False)
    rubbing: str = field(default="", compare=False)
    turning: bool = field(default=False, compare=False)
    section: str = field(default="16. Crank not at constant speed", compare=False)
    source: str = field(default=MECHANICS, compare=False)
    table: ClassVar[str] = "motion"

    @property
    def _required_swing(self) -> Swing:
        assert self.swing is not None
        return self.swing

    def unfit_swing_reason(self, swing: Swing) -> str | None:
        """Return rule, value and remedy if a swing does not define the quantity; None if it does."""
        if swing.of_lever:
            from .registry import FACTS

            counterparts = (fact.name for fact in FACTS.values() if getattr(fact, "swing_counterpart", "") == self.name)
            remedy = next((f"use {name}" for name in counterparts), "leave it out")
            return f"it needs a crank with rod and slider; got a lever moved by a cylinder that turns; {remedy}"
        if self.driver is not None and swing.driver != self.driver:
            return (
                f'it needs a swing driven by the {self.driver}; got driver = "{swing.driver}"; use {self.instead}, '
                f'or set [motion] driver = "{self.driver}"'
            )
        if self.timed and swing.duration is None:
            return "a slow swing needs arbitrarily little power; got no duration; give [motion] a law and a duration"
        return None

    def unmet_need(self, mechanism: Mechanism, consequence: Consequence) -> str | None:
        """Return why a machine does not define it; see `Quantity`."""
        if consequence == "undefined" and self.swing is not None:
            reason = self.unfit_swing_reason(self.swing)
            if reason is not None:
                return reason
            if self.tolerated and not (
                mechanism.with_largest_variables.tolerances.are_stated or self.swing.actuator_tolerance
            ):
                return 'a position error needs tolerances; got none; for example, add [tolerances] crank = "0.05 mm"'
        if consequence == "equal" and self.rubbing and not mechanism.with_largest_variables.friction.acts:
            return (
                f"it is {self.rubbing} without friction; got none; for example, add [friction] guide = 0.1, or "
                "leave it "
                "out"
            )
        return super().unmet_need(mechanism, consequence)


@dataclass(frozen=True, kw_only=True)
class SwingPeak(SwingQuantity):
    """Maximum magnitude of a state over both strokes.

    state: state in `points`; None for the drive at rest at the ends. free: whether the drive at rest is taken without
    friction.
    """

    state: int | None
    free: bool = False

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        peaks = self._peaks(mechanism, dimensions, gradients, peak_count=1)
        return Values(peaks.values[:, 0], None if peaks.gradients is None else peaks.gradients[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the highest local peaks; see `Quantity`."""
        peaks = self._peaks(mechanism, dimensions, True, peak_count=6)
        assert peaks.gradients is not None
        return Pieces(peaks.values, peaks.gradients, peaks.places)

    def _peaks(self, mechanism: Mechanism, dimensions: Array, gradients: bool, *, peak_count: int) -> SwingPeaks:
        if self.state is None:
            return holding_drive_peaks(mechanism, self._required_swing, dimensions, free=self.free, gradients=gradients)
        return swing_peaks(
            mechanism, self._required_swing, self.state, dimensions, gradients=gradients, limit=peak_count
        )


@dataclass(frozen=True, kw_only=True)
class SwingLeast(SwingQuantity):
    """Minimum drive effort along the motion of one stroke, without inertia: negative where loads drive the linkage."""

    back: bool

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        negated_peaks = peaks_of_negated_least_drive(
            mechanism, self._required_swing, dimensions, back=self.back, gradients=gradients, limit=1
        )
        values = np.where(negated_peaks.values[:, 0] == np.inf, -np.inf, -negated_peaks.values[:, 0] + 0.0)
        return Values(values, None if negated_peaks.gradients is None else -negated_peaks.gradients[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the lowest local minima; see `Quantity`."""
        negated_peaks = peaks_of_negated_least_drive(
            mechanism, self._required_swing, dimensions, back=self.back, gradients=True
        )
        assert negated_peaks.gradients is not None
        return Pieces(-negated_peaks.values + 0.0, -negated_peaks.gradients, negated_peaks.places, least=True)


@dataclass(frozen=True, kw_only=True)
class SwingIntegral(SwingQuantity):
    """A quantity from the drive's work.

    integral: the work on the forward stroke, or the fraction needed without friction.
    """

    integral: Literal["work", "share"]

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        integrate = swing_work if self.integral == "work" else swing_efficiency
        integral = integrate(mechanism, self._required_swing, dimensions, gradients=gradients)
        return Values(integral.values, integral.gradients)


@dataclass(frozen=True, kw_only=True)
class ClosedFormSwingQuantity(SwingQuantity):
    """A closed form in lengths and ends: minimum transmission angle, slider travel, crank travel.

    stated: the side whose ends must not be given, as they already fix the value; None if either may be given.
    """

    measure: Literal["angle", "travel", "swing"]
    stated: Stated | None = field(default=None, compare=False)

    @property
    def depends_only_on_dimensions(self) -> bool:
        """True."""
        return True

    def unfit_swing_reason(self, swing: Swing) -> str | None:
        """Return rule, value and remedy if all designs have the same value; see `SwingQuantity`."""
        reason = super().unfit_swing_reason(swing)
        if reason is not None or swing.stated_for != self.stated:
            return reason
        stated_value = self.unit.factor * abs(swing.end - swing.start)
        keys = "from and to" if swing.stated_for == "crank" else "slider_from and slider_to"
        return (
            f"[motion] fixes it by {keys} for all designs; got {stated_value:.6g} {self.unit.symbol} there; leave "
            f"it out, or state {'the two slider positions' if swing.stated_for == 'crank' else 'crank angles'} "
            "instead and let it follow"
        )

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        pieces = self.pieces(mechanism, dimensions)
        return Values(pieces.values[:, 0], pieces.gradients[:, 0] if gradients else None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the angles at the candidate locations of the minimum, lowest first; see `Quantity`."""
        designs = np.ascontiguousarray(dimensions, dtype=np.float64)
        rows = np.flatnonzero(swings_without_dead_point(mechanism, self._required_swing, designs))
        if self.measure == "angle":
            angles = transmission_angle_candidates(mechanism, self._required_swing, designs[rows])
            passing_values, slopes = angles.values, angles.slopes
        else:
            closed_form = slider_travels if self.measure == "travel" else swept_crank_angles
            value, slope = closed_form(mechanism, self._required_swing, designs[rows])
            passing_values, slopes = value[:, None], slope[:, None]
        order = np.argsort(passing_values, axis=1, kind="stable")
        values = np.full((len(designs), passing_values.shape[1]), np.inf)
        values[:, 0] = np.nan
        gradients = np.zeros((*values.shape, designs.shape[1]))
        labels = np.zeros(values.shape)
        values[rows] = np.take_along_axis(passing_values, order, axis=1)
        gradients[rows] = np.take_along_axis(slopes, order[:, :, None], axis=1)
        labels[rows] = order
        return Pieces(values, gradients, labels, least=self.measure == "angle")
