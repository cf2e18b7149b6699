"""A quantity with the opposite sign: the minimum of its pieces is the maximum of theirs."""

from dataclasses import dataclass

from ...model.machine.mechanism import Mechanism
from ..quantity import Array, Pieces, Quantity, Values


@dataclass(frozen=True, kw_only=True)
class NegatedQuantity(Quantity):
    """A quantity times -1."""

    inner: Quantity

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values = self.inner.evaluate(mechanism, dimensions, gradients=gradients)
        return Values(-values.values, None if values.gradients is None else -values.gradients)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return its pieces; see `Quantity`."""
        return negated_pieces(self.inner.pieces(mechanism, dimensions))


def negated_pieces(pieces: Pieces) -> Pieces:
    """Return pieces times -1; the minimum of some becomes a maximum."""
    return Pieces(-pieces.values, -pieces.gradients, pieces.labels, least=not pieces.least)
