"""All quantities by name, found in the modules of this folder; their `place` gives their order in tables."""

import copyreg
import difflib
import pkgutil
from collections.abc import Collection
from dataclasses import fields, replace
from importlib import import_module
from typing import Any

from ..model.errors import InputError
from .quantity import Quantity


def declared_quantities(package: str) -> tuple[Quantity, ...]:
    """Return every quantity that a package's modules declare, without sub-packages, ordered by `place`."""
    quantities: dict[str, Quantity] = {}
    for module in pkgutil.iter_modules(import_module(package).__path__):
        if not module.ispkg and f"{package}.{module.name}" != __name__:
            values = vars(import_module(f"{package}.{module.name}")).values()
            quantities |= {value.name: value for value in values if isinstance(value, Quantity)}
    return tuple(sorted(quantities.values(), key=lambda quantity: quantity.place))


_MOST_NAMES = 12  # of a message

FACTS: dict[str, Quantity] = {quantity.name: quantity for quantity in declared_quantities(__package__)}
"""All quantities, including those whose values need a table in the job."""
QUANTITIES: dict[str, Quantity] = {name: quantity for name, quantity in FACTS.items() if not quantity.table}
"""Quantities that every problem has."""


def _built_in_quantity(name: str, changes: dict[str, Any]) -> Quantity:
    return replace(FACTS[name], **changes) if changes else FACTS[name]


def _pickled_form(quantity: Quantity) -> tuple[Any, ...] | str:
    """Return the pickled form of a quantity: for a built-in one, its name and the changes to it.

    Its formulas and the conditions of its needs may not be picklable.
    """
    fact = FACTS.get(quantity.name)
    if type(fact) is not type(quantity):
        return object.__reduce_ex__(quantity, 4)
    facts = (field.name for field in fields(quantity) if field.init)
    changes = {name: getattr(quantity, name) for name in facts if getattr(quantity, name) is not getattr(fact, name)}
    return _built_in_quantity, (quantity.name, changes)


for _kind in {type(of) for of in FACTS.values()}:
    copyreg.pickle(_kind, _pickled_form)


def first_names_text(names: Collection[str]) -> str:
    """Return the first names for a message, a job's own names first, and where to find the full list."""
    few = ", ".join(sorted(names, key=FACTS.__contains__)[:_MOST_NAMES])
    left_over = len(names) - _MOST_NAMES
    return (
        f"{few} and {left_over} more, all in `slidercrank quantities` and slidercrank.quantities()"
        if left_over > 0
        else few
    )


def quantity(name: str, custom: Collection[Quantity] = ()) -> Quantity:
    """Return the quantity of a given name; raise `InputError` with the closest names for an unknown one.

    custom: a problem's quantities besides the built-in ones. With a problem at hand, use `Problem.quantity`, which
    includes its custom quantities.
    """
    match = next((of for of in custom if of.name == name), None) or QUANTITIES.get(name)
    if match is None:
        names = list(dict.fromkeys([*QUANTITIES, *(of.name for of in custom)]))
        near = difflib.get_close_matches(str(name)[:60], names, n=1)
        hint = f"did you mean {near[0]}?" if near else f"choose from {first_names_text(names)}"
        raise InputError(f"no quantity is called {name!r}; {hint}")
    return match
