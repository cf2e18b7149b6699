"""Quantities that a closed formula gives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.closed_forms import ClosedForm, evaluate_closed_form
from ..model.mechanism import Mechanism
from .quantity import Array, Pieces, Unit, Values


@dataclass(frozen=True)
class ClosedFormQuantity:
    """A quantity given by one closed form, or by the greatest of several (`forms`)."""

    name: str
    field: str
    title: str
    unit: Unit
    forms: tuple[ClosedForm, ...]

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3); see `Quantity`."""
        values, slopes = evaluate_closed_form(self.forms[0], dimensions, gradients=gradients)
        for form in self.forms[1:]:
            others, other_slopes = evaluate_closed_form(form, dimensions, gradients=gradients)
            if slopes is not None and other_slopes is not None:
                slopes = np.where((others > values)[:, None], other_slopes, slopes)
            values = np.maximum(values, others)
        return Values(values, slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the greatest of its forms; see `Quantity`."""
        parts = [evaluate_closed_form(form, dimensions, gradients=True) for form in self.forms]
        values = np.stack([values for values, _ in parts], axis=1)
        labels = np.broadcast_to(np.arange(len(parts), dtype=np.float64), values.shape)
        return Pieces(values, np.stack([slopes for _, slopes in parts if slopes is not None], axis=1), labels)
