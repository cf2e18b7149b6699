"""Columns of the table of designs, and what quantities of a problem's own must leave to others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from ...model.errors import InputError
from ...model.machine.varying import Varying
from ...objectives.quantity import Quantity
from ...objectives.registry import FACTS
from ...objectives.tables.of_a_turn import OF_A_TURN
from ...objectives.tables.varying_column import columns_of_numbers

RESIDUAL, STATUS = "residual", "status"
"""Columns that say how far from stationary a design is, and whether that is proven."""
_EVERY = ("design", RESIDUAL, STATUS, *OF_A_TURN)
_SLACK = "slack_"


def choice_field(name: str) -> str:
    """Return the key of the column that says what was chosen."""
    return f"choice_{re.sub('[^a-z0-9]+', '_', name.lower()).strip('_')}"


def slack_field(of: Quantity) -> str:
    """Return the key of the column with the slack of a requirement on a quantity."""
    return f"{_SLACK}{of.field}"


def require_own_columns(own: Iterable[Quantity], varying: Sequence[Varying], choices: Iterable[str]) -> None:
    """Raise `InputError` for a quantity of a problem's own whose column is that of another number."""
    taken = dict.fromkeys(_EVERY, "one of every table") | {of.field: f"that of {name}" for name, of in FACTS.items()}
    taken |= {column: f"that of {name}" for name, (column, _) in columns_of_numbers(varying).items()}
    taken |= {choice_field(name): f"that of the choice {name}" for name in choices}
    for of in own:
        if of.name in FACTS:
            continue
        what = "how columns of slacks begin" if of.field.startswith(_SLACK) else taken.get(of.field)
        if what is not None:
            raise InputError(
                "the column of a quantity of the job must be that of no other number; got "
                f"{of.name} with the column {of.field}, which is {what}; choose another name"
            )
        taken[of.field] = f"that of {of.name}"
