"""Quantities with a closed form: a formula, or the maximum of smooth formulas in a machine's numbers."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ..model.kinematics.closed_forms import ClosedForm, closed_form_value, evaluate_closed_form
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers, require_design_columns
from .bounds_over_ranges import QuantityBounds
from .quantity import Array, Formula, Number, Pieces, Quantity, Values, display_only_field, undefined_values


@dataclass(frozen=True, kw_only=True)
class ClosedFormQuantity(Quantity):
    """A quantity given by one closed form, or by the maximum of several (`forms`).

    rises: whether it rises with crank, rod and |offset|, if each derivative has the same sign for all fully rotating
    designs.
    """

    section: str = display_only_field("2. Closed forms")
    on_datasheet: bool = display_only_field(True)
    forms: tuple[ClosedForm, ...]
    rises: tuple[bool, bool, bool] | None = field(default=None, compare=False)

    @property
    def depends_only_on_dimensions(self) -> bool:
        """True."""
        return True

    def closed_form_holds(self, mechanism: Mechanism) -> bool:
        """Return whether the closed form, and hence `rises` and `reach`, holds for a machine."""
        return True

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return its closed forms if they hold for a machine; see `Quantity`."""
        return [partial(_closed_form_value, form) for form in self.forms] if self.closed_form_holds(mechanism) else ()

    def bounds_for(self, mechanism: Mechanism) -> QuantityBounds | None:
        """Return its bounds if the closed form holds for a machine."""
        return self.bounds if self.closed_form_holds(mechanism) else None

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = _evaluate_closed_form(self.forms[0], mechanism, dimensions, gradients)
        for form in self.forms[1:]:
            other_values, other_slopes = _evaluate_closed_form(form, mechanism, dimensions, gradients)
            if slopes is not None and other_slopes is not None:
                slopes = np.where((other_values > values)[:, None], other_slopes, slopes)
            values = np.maximum(values, other_values)
        return Values(values, slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the maximum of its closed forms; see `Quantity`."""
        parts = [_evaluate_closed_form(form, mechanism, dimensions, True) for form in self.forms]
        values, slopes = parts[0]
        if slopes is not None and len(parts) == 1:
            return Pieces(values[:, None], slopes[:, None], np.zeros((len(values), 1)))
        values = np.stack([values for values, _ in parts], axis=1)
        labels = np.broadcast_to(np.arange(len(parts), dtype=np.float64), values.shape)
        return Pieces(values, np.stack([slopes for _, slopes in parts if slopes is not None], axis=1), labels)


def _closed_form_value(form: ClosedForm, number: Number) -> Any:
    return closed_form_value(int(form), number(Raw.CRANK), number(Raw.ROD), number(Raw.OFFSET))


def _evaluate_closed_form(
    form: ClosedForm, mechanism: Mechanism, designs: Array, gradients: bool
) -> tuple[Array, Array | None]:
    """Return values (n,) and gradients (n, 3 + k); a closed form depends on the three dimensions alone."""
    designs = np.asarray(designs, dtype=np.float64)
    require_design_columns(mechanism, designs)
    values, slopes = evaluate_closed_form(form, designs[:, :3], gradients=gradients)
    if slopes is None or not mechanism.varying:
        return values, slopes
    return values, np.pad(slopes, ((0, 0), (0, len(mechanism.varying))))


@dataclass(frozen=True, kw_only=True)
class GreatestOfFormulas(Quantity):
    """Maximum of its `formulas`, with exact derivatives with respect to all variables; NaN if any formula is NaN.

    A formula accepts complex numbers and, for bounds over ranges, enclosures, so it must not branch on a design's
    numbers.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        values, slopes = self._evaluate_formulas(mechanism, dimensions, gradients)
        first, rows = np.argmax(values, axis=1), np.arange(len(values))
        return Values(values[rows, first], None if slopes is None else slopes[rows, first])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return all formulas; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        values, slopes = self._evaluate_formulas(mechanism, dimensions, True)
        assert slopes is not None
        return Pieces(values, slopes, np.tile(np.arange(values.shape[1], dtype=float), (len(values), 1)))

    def _evaluate_formulas(
        self, mechanism: Mechanism, dimensions: Array, gradients: bool
    ) -> tuple[Array, Array | None]:
        designs = np.asarray(dimensions, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            evaluations = [
                evaluate_formula_of_raw_numbers(mechanism, designs, formula, gradients=gradients)
                for formula in self.formulas(mechanism)
            ]
        values = np.stack([value for value, _ in evaluations], axis=1)
        slopes = [formula_slopes for _, formula_slopes in evaluations if formula_slopes is not None]
        if not gradients:
            return values, None
        return values, np.where(np.isnan(values)[:, :, None], np.nan, np.stack(slopes, axis=1))
