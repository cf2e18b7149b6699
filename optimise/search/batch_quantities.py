"""Quantities of many designs for an evaluator, row by row, so that any process can judge rows."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from ...model.machine.mechanism import Mechanism
from ...objectives.cycle_peak import CyclePeak, screen_peaks
from ...objectives.formula.quantity import basic_quantities, values_with_formulas
from ...objectives.quantity import Array, Pieces, Quantity, Values
from ...objectives.robust.quantity import RobustQuantity


class QuantitySource(Protocol):
    """A problem, or an evaluator of one."""

    @property
    def mechanism(self) -> Mechanism:
        """Machine of the designs."""
        ...

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a given name."""
        ...


def screen_quantities(problem: QuantitySource, names: tuple[str, ...], dimensions: Array) -> list[Array]:
    """Return quantities (n,) of designs; peaks are screened, robust quantities estimated."""
    quantities = [problem.quantity(name) for name in names]
    leaves = basic_quantities(quantities)
    peaks = [quantity for quantity in leaves if isinstance(quantity, CyclePeak)]
    screened = dict(zip((peak.name for peak in peaks), screen_peaks(peaks, problem.mechanism, dimensions), strict=True))
    values_by_leaf = {
        quantity.name: Values(_estimate_robust(quantity, problem.mechanism, dimensions), None)
        if isinstance(quantity, RobustQuantity)
        else screened.get(quantity.name) or quantity.evaluate(problem.mechanism, dimensions)
        for quantity in leaves
    }
    return [item.values for item in values_with_formulas(quantities, values_by_leaf, problem.mechanism, dimensions)]


def _estimate_robust(quantity: RobustQuantity, mechanism: Mechanism, dimensions: Array) -> Array:
    """Return the first-order estimate of a robust quantity: one evaluation per design instead of a dozen."""
    inner = quantity.inner
    if isinstance(inner, CyclePeak):
        values = screen_peaks([inner], mechanism, dimensions, gradients=True)[0]
    else:
        values = inner.evaluate(mechanism, dimensions, gradients=True)
    return quantity.first_order_estimate(mechanism, dimensions, values)


def evaluate_pieces(problem: QuantitySource, names: tuple[str, ...], dimensions: Array) -> list[Pieces]:
    """Return the pieces of quantities for designs."""
    return [problem.quantity(name).pieces(problem.mechanism, dimensions) for name in names]


def join_batches(parts: list[list[Pieces]]) -> list[Pieces]:
    """Return the joined pieces of consecutive designs, padded with absent pieces where some have fewer."""
    return [_join_pieces(batch) for batch in zip(*parts, strict=True)] if len(parts) > 1 else parts[0]


def _join_pieces(parts: Sequence[Pieces]) -> Pieces:
    widest, least = max(part.values.shape[1] for part in parts), parts[0].least

    def stack_columns(columns: list[Array], absent: float = 0.0) -> Array:
        padding = [[(0, 0), (0, widest - column.shape[1]), *[(0, 0)] * (column.ndim - 2)] for column in columns]
        filled = [
            np.pad(column, widths, constant_values=absent) for column, widths in zip(columns, padding, strict=True)
        ]
        return np.concatenate(filled)

    opposite = [_opposite_pieces(part) for part in parts] if any(part.opposite for part in parts) else []
    return Pieces(
        stack_columns([part.values for part in parts], np.inf if least else -np.inf),
        stack_columns([part.gradients for part in parts]),
        stack_columns([part.labels for part in parts]),
        least,
        _join_pieces(opposite) if opposite else None,
    )


def _opposite_pieces(part: Pieces) -> Pieces:
    """Return a quantity's pieces from the other side; if the designs have none, only its active piece."""
    if part.opposite is not None:
        return part.opposite
    active = (np.argmin if part.least else np.argmax)(part.values, axis=1)
    return replace(part.select_pieces(active[:, None]), least=not part.least)
