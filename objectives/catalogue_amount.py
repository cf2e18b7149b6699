"""Amounts that come with a catalogue option, such as the price or the mass of a gearmotor."""

from dataclasses import dataclass, field, replace

import numpy as np

from ..model.errors import InputError
from ..model.machine.mechanism import Mechanism
from .kinds import RATIO, Kind, amount_kind, kind_displayed_in
from .quantity import Array, Quantity, Values
from .units import kind_of_any_unit, number_and_unit, value_of_one_si_unit_in

_NONE = float("nan")


@dataclass(frozen=True, kw_only=True)
class Amount(Quantity):
    """A number that depends only on the chosen option.

    value: SI; NaN if no option is chosen. choice: name of the choice.
    """

    value: float = _NONE
    choice: str = ""
    turning: bool = field(default=False, compare=False)

    @property
    def is_constant(self) -> bool:
        """True."""
        return True

    @property
    def no_value_reason(self) -> str:
        """Message for an option without this amount."""
        return "the catalogue has none for the chosen options"

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the amount for designs (n, 3 + k), with zero gradients; see `Quantity`."""
        return Values(np.full(len(dimensions), self.value), np.zeros(np.shape(dimensions)) if gradients else None)


def substitute_amounts(quantity: Quantity, values: dict[str, float]) -> Quantity:
    """Return a quantity with its amounts replaced by those of a chosen option. values: SI."""
    if isinstance(quantity, Amount):
        return replace(quantity, value=values.get(quantity.name, _NONE))
    parts = tuple(substitute_amounts(part, values) for part in quantity.component_quantities)
    return quantity if parts == quantity.component_quantities else quantity.with_parts(parts)


def kind_of_amount(unit: str) -> Kind:
    """Return the kind for amounts in a unit: the kind of a known unit, else a new kind."""
    try:
        return kind_displayed_in(unit, value_of_one_si_unit_in(unit), kind_of_any_unit(unit)) if unit else RATIO
    except InputError:
        return amount_kind(unit)


def number_and_unit_of_amount(text: str | float) -> tuple[float, str] | None:
    """Return number and unit of an amount such as "280 EUR"; None for other text."""
    parts = number_and_unit(text) if isinstance(text, str) else (str(text), "")
    return None if parts is None else (float(parts[0]), parts[1])
