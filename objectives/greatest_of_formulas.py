"""Quantities that are the maximum of one or more smooth formulas in a machine's numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers
from .quantity import Array, Pieces, Quantity, Values, undefined_values


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
