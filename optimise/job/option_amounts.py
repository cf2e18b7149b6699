"""Amounts of options: catalogue columns that are neither limits nor numbers of the job."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, GetJsonSchemaHandler
from pydantic_core import CoreSchema

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.catalogue_amount import Amount, kind_of_amount, number_and_unit_of_amount
from ...objectives.formula.expression import ARGUMENTS
from ...objectives.kinds import RATIO, Kind
from ...objectives.own.quantity import require_column_name
from ...objectives.registry import FACTS
from ...objectives.units import quote, to_si
from .constraints_and_objectives import SLOW_STROKE
from .named_files import options_in, table_in
from .value_types import Physical

_MOST = 1e15
_TOO = {"max": "more than the {} allowed", "min": "less than the {} required", "equals": "not the {} required"}


class _AmountMarker(Physical):
    """Marks an amount: a number with any unit, or a plain number."""

    def read(self, value: object) -> Any:
        amount = (
            None
            if isinstance(value, bool) or not isinstance(value, str | int | float)
            else number_and_unit_of_amount(value)
        )
        if amount is None or not abs(amount[0]) <= _MOST:
            raise InputError(f'must be a number with its unit, such as "310 EUR", or a number; got {quote(value)}')
        return value

    def __get_pydantic_json_schema__(self, _schema: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"type": "string"}, {"type": "number"}]}


def _amounts_by_name(amounts: dict[str, Any]) -> dict[str, Any]:
    for name in amounts:
        if name in FACTS or name in (SLOW_STROKE, *DIMENSIONS, *ARGUMENTS):
            raise InputError(f"an amount must have a unique name; got {name}; choose another name")
        require_column_name(name)
    return amounts


Amounts = Annotated[dict[str, Annotated[Any, _AmountMarker(RATIO)]], AfterValidator(_amounts_by_name)]
"""Amounts of an option by name."""


def kinds_of_amounts(options: Iterable[Mapping[str, Any]]) -> dict[str, Kind]:
    """Return the kinds of the options' amounts, by name. options: their amounts; invalid ones are ignored."""
    kinds: dict[str, Kind] = {}
    for amounts in options:
        for name, value in amounts.items():
            amount = (
                number_and_unit_of_amount(value) if name not in kinds and isinstance(value, str | int | float) else None
            )
            if amount is not None:
                kinds[name] = kind_of_amount(amount[1])
    return kinds


def readable_amounts(tables: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Return the amounts of a job's options, as far as they can be read."""
    return (table_in(option, "amounts") for option in options_in(tables))


def amounts_of_choices(
    choices: Mapping[str, list[Mapping[str, Any]]], custom_names: Collection[str]
) -> tuple[Amount, ...]:
    """Return the amounts that options of choices have, as quantities without values.

    choices: amounts of each choice's options, by name. custom_names: names of the job's custom quantities. Raises
    JobError for a name that is already in use or that two choices share.
    """
    amounts: dict[str, Amount] = {}
    owners: dict[str, str] = dict.fromkeys(custom_names, "the table [quantity]")
    for choice, options in choices.items():
        for name, kind in kinds_of_amounts(options).items():
            if name in owners:
                raise JobError(
                    f"choice {quote(choice)}: an amount must have a unique name; got {name}, which {owners[name]} has "
                    "too; rename one; a formula can add the two"
                )
            owners[name] = f"the choice {quote(choice)}"
            amounts[name] = Amount(
                name=name,
                kind=kind,
                sentence=f"{name.replace('_', ' ')} of the option of {choice}, from its catalogue.".capitalize(),
                source="this job",
                choice=choice,
                signed=any(
                    (number_and_unit_of_amount(option_amounts[name]) or (0.0,))[0] < 0.0
                    for option_amounts in options
                    if name in option_amounts
                ),
            )
    return tuple(amounts.values())


def excess_amount_text(name: str, value: object, word: str, bound: object) -> str:
    """Describe an amount beyond a bound: "price 450 EUR, more than the 400 EUR allowed"."""
    return f"{name.replace('_', ' ')} {value}, {_TOO[word].format(bound)}"


def amounts_of_option(
    amounts: Mapping[str, Any], quantities: Mapping[str, Amount], option_name: str
) -> tuple[tuple[str, float], ...]:
    """Return an option's amounts, SI. Raises JobError.

    quantities: the job's amounts. option_name: name of the option, for messages.
    """
    try:
        return tuple((name, to_si(value, quantities[name].kind)) for name, value in amounts.items())
    except InputError as error:
        raise JobError(f"{option_name}: amounts of one name must have one unit: {error}") from None
