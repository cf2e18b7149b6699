"""Columns in the table of designs, and names that custom quantities must not take."""

import re
from collections.abc import Iterable, Sequence

from ...model.errors import InputError
from ...model.machine.varying_numbers import Varying
from ...objectives.quantity import Quantity
from ...objectives.registry import FACTS
from ...objectives.tables.design_input import columns_of_design_numbers
from ...objectives.tables.swing_columns import OF_A_TURN

RESIDUAL, STATUS = "residual", "status"
"""Columns with the distance of a design from stationarity, and whether stationarity is proven."""
_EVERY = ("design", RESIDUAL, STATUS, *OF_A_TURN)
_SLACK = "slack_"
_CHOICE = "choice_"  # of texts: JSON and the page do not treat it as a number


def choice_field(name: str) -> str:
    """Return the key of the column with the chosen option."""
    return f"{_CHOICE}{re.sub('[^a-z0-9]+', '_', name.lower()).strip('_')}"


def sufficient_option_field(name: str) -> str:
    """Return the key of the column with a catalogue's least sufficient option."""
    return choice_field(f"least {name}")


def sufficient_amount_field(choice: str, quantity: Quantity) -> str:
    """Return the key of the column with an amount, such as the price, of the least sufficient option."""
    return f"{sufficient_option_field(choice).removeprefix(_CHOICE)}_{quantity.field}"


def note_field(choice: str, head: str) -> str:
    """Return the key of the column with a catalogue text, such as the maker of the chosen option."""
    return choice_field(f"{choice} {head}")


def slack_field(quantity: Quantity) -> str:
    """Return the key of the column with the slack of a requirement on a quantity."""
    return f"{_SLACK}{quantity.field}"


def require_free_columns(
    own: Iterable[Quantity], varying: Sequence[Varying], choices: Iterable[tuple[str, str]]
) -> None:
    """Raise `InputError` for a custom quantity or a choice whose column name is already in use.

    choices: columns of choices, each with its description.
    """
    owner = dict.fromkeys(_EVERY, "every table") | {of.field: name for name, of in FACTS.items()}
    owner |= {column: name for name, (column, _) in columns_of_design_numbers(varying).items()}
    for field, what in choices:
        if field in owner:
            raise InputError(
                f"columns of choices must differ; got {field} for {what} and for {owner[field]}; choose another name"
            )
        owner[field] = what
    for of in own:
        if of.name in FACTS or owner.get(of.field) == of.name:  # a dimension may be a formula
            continue
        other = "slacks" if of.field.startswith(_SLACK) else owner.get(of.field)
        if other is not None:
            raise InputError(
                f"the column of a custom quantity must be unique; got {of.name} with the column {of.field}, which "
                f"belongs to {other}; choose another name"
            )
        owner[of.field] = of.name
