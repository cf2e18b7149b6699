"""Amounts that come with a chosen option: the price or the mass of a gearmotor in a catalogue."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..model.errors import InputError
from ..model.machine.mechanism import Mechanism
from .kinds import RATIO, Kind, amount_in, kind_in
from .quantity import Array, Quantity, Values
from .units import kind_for, number_and_unit, per_si

_NONE = float("nan")


@dataclass(frozen=True, kw_only=True)
class Amount(Quantity):
    """A number that depends only on a choice. value: SI; NaN without a chosen option. choice: its name."""

    value: float = _NONE
    choice: str = ""

    @property
    def constant(self) -> bool:
        """True."""
        return True

    @property
    def blank(self) -> str:
        """Sentence for an option without this amount."""
        return "the catalogue has none for what is chosen"

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the amount for designs (n, 3 + k), with slopes of zero; see `Quantity`."""
        return Values(np.full(len(dimensions), self.value), np.zeros(np.shape(dimensions)) if gradients else None)


def with_amounts(quantity: Quantity, values: dict[str, float]) -> Quantity:
    """Return a quantity with the amounts in it, itself or its parts, replaced by those of a choice. values: SI."""
    if isinstance(quantity, Amount):
        return replace(quantity, value=values.get(quantity.name, _NONE))
    parts = tuple(with_amounts(part, values) for part in quantity.made_of)
    return quantity if parts == quantity.made_of else quantity.with_parts(parts)


def kind_of_amount(unit: str) -> Kind:
    """Return the kind of amounts in a unit: that of a known unit, else a new kind."""
    try:
        return kind_in(unit, per_si(unit), kind_for(unit)) if unit else RATIO
    except InputError:
        return amount_in(unit)


def amount_of(text: str | float) -> tuple[float, str] | None:
    """Return number and unit of an amount such as "280 EUR"; None if it is not one."""
    parts = number_and_unit(text) if isinstance(text, str) else (str(text), "")
    return None if parts is None else (float(parts[0]), parts[1])
