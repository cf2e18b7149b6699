"""Quantities of a lever and a cylinder that turns, over its swing, or over a full turn as a crank."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..model.kernel.arithmetic import STEP
from ..model.kernel.batches import run_in_chunks
from ..model.machine.mechanism import Mechanism
from ..model.machine.memoise import memoise_by_batch
from ..model.swing.swing import Swing
from ..model.swing.swing_types import SwingDriver
from ..model.turning_cylinder.curve_peaks import LeverPeaks, lever_peaks
from ..model.turning_cylinder.lever_state import LeverNumbers
from ..model.turning_cylinder.levers_of_designs import can_make_motion, lever_batch
from ..model.turning_cylinder.rms_crank_torque import rms_torque
from .machine_needs import Consequence
from .quantity import Array, Pieces, Quantity, Values
from .swing_quantity import SwingQuantity

Form = Callable[[LeverNumbers, Any], Any]
"""A formula in the numbers of a lever and the greatest ds/dt of its motion law."""
_CHUNK = 512
_PEAKS = 4
_LABEL_STEP = 20.0  # between the labels of different curves, which are places of up to 4


@dataclass(frozen=True, kw_only=True)
class LeverQuantity(SwingQuantity):
    """A number of a lever's motion.

    known: numbers of its cylinder or arm that it needs, or either of two. moved_by: drivers of motions that have it.
    swing_counterpart: name of the same quantity for a slider-crank that swings; empty if there is none.
    """

    known: tuple[str, ...] = field(default=(), compare=False)
    moved_by: tuple[SwingDriver, ...] = field(default=("cylinder",), compare=False)
    swing_counterpart: str = field(default="", compare=False)
    smooth_at_zero_offset: bool = field(default=True, compare=False)

    @property
    def job_requirements_text(self) -> str:
        """Requirements on a job, in words; see `Quantity`."""
        if "turning crank" not in self.moved_by:
            return super().job_requirements_text
        turning = "" if "cylinder" in self.moved_by else ", and no table [motion]"
        needs = (need.rule for need in self.needs)
        return "; ".join([f'it needs [mechanism] inversion = "turning cylinder"{turning}', *needs])

    def unfit_swing_reason(self, swing: Swing) -> str | None:
        """Return rule, value and remedy if a swing does not define the quantity; None if it does."""
        if not swing.of_lever:
            return (
                "it needs a lever moved by a cylinder that turns; got a slider-crank; set [mechanism] "
                'inversion = "turning cylinder", or leave the quantity out'
            )
        if swing.driver not in self.moved_by:
            if swing.of_full_turn:
                return (
                    "it needs a lever that its cylinder swings; got a crank that rotates fully; add [motion] "
                    'kind = "swing" with from and to, or leave the quantity out'
                )
            return "it needs a crank that rotates fully; got a swing of the lever; leave out [motion], or the quantity"
        if self.timed and swing.duration is None:
            return "it needs a swing with a duration; got a slow one; give [motion] a law and a duration"
        return None

    def unmet_need(self, mechanism: Mechanism, consequence: Consequence) -> str | None:
        """Return why a machine does not define it; see `Quantity`."""
        lever = mechanism.with_largest_variables.lever
        if consequence == "undefined" and lever is not None:
            for name in self.known:
                part = "arm" if name == "ram" else "cylinder"
                if all(getattr(getattr(lever, part), either) is None for either in name.split(" or ")):
                    words = name.replace("_", " ")
                    return f"it needs the {words} of the {part}; got none; give [{part}] {name}"
            if self.tolerated:
                stated = mechanism.with_largest_variables.tolerances.are_stated or lever.cylinder.length_tolerance > 0.0
                return None if stated else 'it needs tolerances; got none; for example, add [tolerances] crank = "1 mm"'
        return Quantity.unmet_need(self, mechanism, consequence)

    def _designs_and_movable_rows(self, mechanism: Mechanism, dimensions: Array) -> tuple[Array, Any]:
        designs = np.ascontiguousarray(dimensions, dtype=np.float64)
        return designs, np.flatnonzero(can_make_motion(mechanism, self._required_swing, designs))


@dataclass(frozen=True, kw_only=True)
class LeverPeak(LeverQuantity):
    """The greatest value of some curves of `turning_cylinder.peaks` over the swing.

    curves: their names. divisors: positive number of a lever for each, by which it is divided; none by default.
    least_value: value where it would be less. inverse: whether the quantity is the inverse of that value: a margin,
    which is infinite where nothing loads the cylinder.
    """

    curves: tuple[str, ...]
    divisors: tuple[Callable[[LeverNumbers], Any], ...] = ()
    least_value: float | None = None
    inverse: bool = False

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        pieces = self._peak_pieces(mechanism, dimensions, gradients, 1)
        best = (np.argmin if pieces.least else np.argmax)(pieces.values, axis=1)
        rows = np.arange(len(best))
        return Values(pieces.values[rows, best], pieces.gradients[rows, best] if gradients else None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the highest local peaks; see `Quantity`."""
        return self._peak_pieces(mechanism, dimensions, True, _PEAKS)

    def _peak_pieces(self, mechanism: Mechanism, dimensions: Array, gradients: bool, limit: int) -> Pieces:
        designs, rows = self._designs_and_movable_rows(mechanism, dimensions)
        arguments = self._required_swing, self.curves, limit
        peaks = _peaks_of_designs(mechanism, np.ascontiguousarray(designs[rows]), *arguments, gradients=gradients)
        found, slope = self._divided(mechanism, designs[rows], peaks)
        width = found.shape[1]
        absent = np.inf if self.inverse else -np.inf
        floor = [] if self.least_value is None else [self.least_value]
        values = np.full((len(designs), width + len(floor)), absent)
        values[:, width:] = floor
        labels = np.full(values.shape, -_LABEL_STEP)
        slopes = np.zeros((*values.shape, designs.shape[1] if gradients else 0))
        values[np.setdiff1d(np.arange(len(designs)), rows), 0] = np.nan
        curve_labels = np.repeat(_LABEL_STEP * np.arange(len(self.curves)), width // len(self.curves))
        labels[rows, :width] = np.nan_to_num(peaks.places) + curve_labels
        if self.inverse:
            is_loaded = found > 0.0
            found = np.where(is_loaded, 1.0 / np.where(is_loaded, found, 1.0), np.inf)
            slope = np.where(is_loaded[..., None], -slope * np.where(is_loaded, found, 0.0)[..., None] ** 2, 0.0)
        values[rows, :width] = found
        if gradients:
            _, numbers = lever_batch(mechanism, designs[rows], self._required_swing, gradients=True)
            slopes[rows, :width] = numbers.gradients_by_design_numbers(slope)
        return Pieces(values, slopes, labels, least=self.inverse)

    def _divided(self, mechanism: Mechanism, designs: Array, peaks: LeverPeaks) -> tuple[Array, Array]:
        """Return the peaks (n, k) over the divisors of their curves, and gradients (n, k, v) by the raw numbers."""
        if not self.divisors:
            return peaks.values, peaks.gradients
        has_gradients = peaks.gradients.shape[2] > 0
        batch, _ = lever_batch(mechanism, designs, self._required_swing, gradients=has_gradients)
        each = peaks.values.shape[1] // len(self.curves)
        divisor = np.repeat(np.stack([of(batch.plain) for of in self.divisors], axis=1), each, axis=1)
        found, slope = peaks.values / divisor, peaks.gradients / divisor[:, :, None]
        for place, numbers in enumerate(batch.stepped if has_gradients else ()):
            rate = np.repeat(np.stack([of(numbers).imag / STEP for of in self.divisors], axis=1), each, axis=1)
            slope[:, :, place] -= np.where(np.isfinite(found), found, 0.0) * rate / divisor
        return found, slope


@memoise_by_batch
def _peaks_of_designs(
    mechanism: Mechanism, designs: Array, /, swing: Swing, curves: tuple[str, ...], limit: int, *, gradients: bool
) -> LeverPeaks:
    """Return the peaks of curves of designs (n, 3 + k), with gradients (n, k, v) by the raw numbers."""
    batch, numbers = lever_batch(mechanism, designs, swing, gradients=gradients)
    shape = len(designs), len(curves) * (limit + (0 if swing.law == "slow" else 2))
    values, places = np.empty(shape), np.empty(shape)
    slopes = np.empty((*shape, len(numbers.columns) if gradients else 0))

    def work(begin: int, end: int) -> None:
        part = lever_peaks(batch.levers_between(begin, end), curves, gradients=gradients, limit=limit)
        values[begin:end], places[begin:end], slopes[begin:end] = part.values, part.places, part.gradients

    run_in_chunks(len(designs), work, size=_CHUNK)
    return LeverPeaks(values, places, slopes)


@dataclass(frozen=True, kw_only=True)
class LeverForm(LeverQuantity):
    """The greatest, or least, of closed forms in a lever's numbers."""

    forms: tuple[Form, ...]
    least: bool = False

    @property
    def depends_only_on_dimensions(self) -> bool:
        """True."""
        return True

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        pieces = self._form_pieces(mechanism, dimensions, gradients)
        best = (np.argmin if self.least else np.argmax)(pieces.values, axis=1)
        rows = np.arange(len(best))
        return Values(pieces.values[rows, best], pieces.gradients[rows, best] if gradients else None)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return its forms; see `Quantity`."""
        return self._form_pieces(mechanism, dimensions, True)

    def _form_pieces(self, mechanism: Mechanism, dimensions: Array, gradients: bool) -> Pieces:
        designs, rows = self._designs_and_movable_rows(mechanism, dimensions)
        batch, numbers = lever_batch(mechanism, designs[rows], self._required_swing, gradients=gradients)
        count = len(self.forms)
        values = np.full((len(designs), count), np.nan)
        slopes = np.zeros((*values.shape, designs.shape[1] if gradients else 0))
        values[rows] = self._evaluate_forms(batch.plain).real
        if gradients:
            by_number = [self._evaluate_forms(stepped).imag / STEP for stepped in batch.stepped]
            slopes[rows] = numbers.gradients_by_design_numbers(np.stack(by_number, axis=-1))
        labels = np.broadcast_to(np.arange(float(count)), values.shape)
        return Pieces(values, slopes, labels, least=self.least)

    def _evaluate_forms(self, numbers: LeverNumbers) -> Any:
        top = self._required_swing.greatest_travel_rate
        return np.stack([form(numbers, top) + 0j * numbers.crank for form in self.forms], axis=1)


@dataclass(frozen=True, kw_only=True)
class LeverRms(LeverQuantity):
    """The root mean square of the torque on a crank over its turn."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        designs, rows = self._designs_and_movable_rows(mechanism, dimensions)
        batch, numbers = lever_batch(mechanism, designs[rows], self._required_swing, gradients=gradients)
        values, slopes = np.full(len(designs), np.nan), np.zeros(designs.shape)
        by_number = np.zeros((len(rows), len(numbers.columns) if gradients else 0))

        def work(begin: int, end: int) -> None:
            levers = batch.levers_between(begin, end)
            values[rows[begin:end]], by_number[begin:end] = rms_torque(levers, gradients=gradients)

        run_in_chunks(len(rows), work, size=_CHUNK)
        if not gradients:
            return Values(values, None)
        slopes[rows] = numbers.gradients_by_design_numbers(by_number)
        return Values(values, slopes)
