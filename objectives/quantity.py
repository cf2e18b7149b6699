"""The protocol of every quantity that can be an objective or stand in a constraint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..model.machine.mechanism import Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Unit:
    """How a quantity is shown. symbol: pint-readable ("mm"). factor: what one SI unit is in it (1000.0 for mm)."""

    symbol: str
    factor: float


RATIO = Unit("", 1.0)
MILLIMETRE = Unit("mm", 1e3)
SQUARE_METRE = Unit("m^2", 1.0)
DEGREE = Unit("deg", 180.0 / np.pi)
NEWTON_METRE = Unit("N m", 1.0)
NEWTON = Unit("N", 1.0)
WATT = Unit("W", 1.0)
KILOGRAM_SQUARE_METRE = Unit("kg m^2", 1.0)
METRE_PER_SECOND = Unit("m/s", 1.0)
METRE_PER_SECOND_SQUARED = Unit("m/s^2", 1.0)


@dataclass(frozen=True)
class Values:
    """A quantity of n designs.

    values: (n,), SI. gradients: (n, 3 + k), by crank, rod, offset and the machine's varying
    numbers; None unless asked for.
    """

    values: Array
    gradients: Array | None


@dataclass(frozen=True)
class Pieces:
    """A quantity as the greatest of smooth pieces: the local peaks of a curve over the cycle, highest first.

    values: (n, k), SI, -inf where a design has fewer than k pieces. gradients: (n, k, 3 + v) for v varying numbers.
    labels: (n, k), what tells the pieces of neighbouring designs apart: the crank angle of a peak, rad, or a number.
    A tie between two pieces is a kink of the quantity; a solver treats it as a minimax.
    least: the quantity is the least of its pieces instead, lowest first, +inf for absent ones.
    """

    values: Array
    gradients: Array
    labels: Array
    least: bool = False


class Quantity(Protocol):
    """A number that judges a design: its name, its unit, its values and gradients for a batch of designs.

    name: as in job files. field: the key of tables and JSON, carrying the unit. title: for people. unit: as shown.
    """

    @property
    def name(self) -> str:
        """Name in job files."""
        ...

    @property
    def field(self) -> str:
        """Key in tables and JSON."""
        ...

    @property
    def title(self) -> str:
        """Name for people."""
        ...

    @property
    def unit(self) -> Unit:
        """Unit in tables, JSON and figures."""
        ...

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k), each turning fully.

        Columns: crank, rod, offset, m, then the value of each of the machine's varying numbers, SI.
        """
        ...

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the quantity as the greatest of smooth pieces."""
        ...
