"""Variables and choices of a job file: [variables] and [[choice]].

A variable other than the three dimensions is named by the path of its number in the job, as in messages:
`mechanism.slider.mass = ["0.5 kg", "2 kg"]`, or `load.1.force` for the first [[load]]. The number in the job remains
the value for analyses of single designs.
"""

from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, model_validator

from ...model.errors import InputError
from ...objectives.formula.formulas import ROOTS
from ...objectives.units import quote, quoted_if_unprintable
from .constraints_and_objectives import ConstraintsPart
from .mistake_messages import DEEPEST
from .named_files import LARGEST, options_in, table_in, unread_file_error
from .option_amounts import Amounts
from .value_grids import states_value_grid
from .value_types import AnyRange, Part, PositiveRange, optional_entry, required_entry, with_entry_types

Table = dict[str, Any]
EXAMPLE = {"peak_torque": {"max": "40 N m"}, "rms_torque": {"max": "22 N m"}}
"""Example of an option's limits."""


def _variable_table(table_name: str, example: dict[str, Any]) -> Any:
    return optional_entry(f"numbers of {table_name} that may vary, by their keys in that table", example, default={})


class VariablesPart(Part):
    """Ranges of dimensions and other numbers: [lower, upper], or { choices = [...] }; one value fixes a dimension.

    Also their values, { min, max, step }, { min, max, series = "R20" } or { values = [...] }.
    """

    crank: PositiveRange = required_entry("crank pivot to crank pin", ["20 mm", "200 mm"])
    rod: PositiveRange = required_entry("crank pin to slider pin", ["60 mm", "600 mm"])
    offset: AnyRange = required_entry(
        "of the slider line from the crank pivot, along +y: positive to the left of the outward direction "
        "on the open branch, to its right on the crossed one",
        ["0 mm", "200 mm"],
    )
    mechanism: Table = _variable_table("[mechanism]", {"slider": {"mass": ["0.5 kg", "2 kg"]}})
    load: Table = _variable_table("a [[load]], by its position, 1 for the first,", {"1": {"force": ["100 N", "200 N"]}})
    friction: Table = _variable_table("[friction]", {"guide": [0.05, 0.15]})
    drive: Table = _variable_table("[drive]", {"gear_ratio": [10, 40]})
    tolerances: Table = _variable_table("[tolerances]", {"crank": ["0.02 mm", "0.1 mm"]})
    motion: Table = _variable_table("[motion]: where a swing starts", {"from": ["0 deg", "40 deg"]})
    cylinder: Table = _variable_table("[cylinder]", {"bore": ["40 mm", "63 mm"]})
    spring: Table = _variable_table("[spring] of a lever", {"force": ["300 N", "800 N"]})
    arm: Table = _variable_table("[arm]", {"ram": ["400 mm", "600 mm"]})
    sections: Table = _variable_table("[sections]", {"pins": {"crank_pin": ["10 mm", "20 mm"]}})

    @model_validator(mode="before")
    @classmethod
    def _unquote_paths(cls, data: Any) -> Any:
        """Treat a path in quotes as one without. Engineers see a dotted key in both; to TOML, the former is one key."""
        if not isinstance(data, Mapping):
            return data
        nested: dict[str, Any] = {}
        for key, value in data.items():
            steps = key.split(".") if isinstance(key, str) and key.partition(".")[0] in ROOTS else [key]
            if len(steps) > DEEPEST:
                raise InputError(f"a path must have at most {DEEPEST} words; got {quote(key)}; shorten it")
            _put_value(nested, steps, deepcopy(value), key)
        return nested

    @property
    def stated_values_by_path(self) -> dict[str, Any]:
        """The numbers that vary besides the dimensions, as stated, by path."""
        return {path: leaf for root in ROOTS for path, leaf in table_leaves(getattr(self, root), root)}


class OptionPart(Part):
    """One option of a choice."""

    name: Annotated[str, Field(min_length=1, max_length=60)] = required_entry(
        "name of the option, as in the table of designs", "bar 30 x 10"
    )
    values: Table = optional_entry(
        "numbers of the job that the option sets, by their paths; also crank, rod and offset",
        {"mechanism.rod.width": "30 mm", "mechanism.rod.depth": "10 mm"},
        default={},
    )
    constraints: ConstraintsPart = optional_entry(
        "constraints of the option in addition to those of the job, as in [constraints]",
        EXAMPLE,
        default=ConstraintsPart(),
    )

    amounts: Amounts = optional_entry(
        "numbers that limit nothing, such as a price, in any unit; their names may be objectives and constraints",
        {"price": "310 EUR"},
        default={},
    )
    notes: dict[str, Annotated[str, Field(max_length=200)]] = optional_entry(
        "text to store with designs, such as the manufacturer", {"maker": "Example Motors"}, default={}
    )
    searched: bool = optional_entry(
        "whether the search uses it; otherwise it is only named where it is the smallest sufficient option",
        False,
        default=True,
    )

    @property
    def values_by_path(self) -> dict[str, Any]:
        """The numbers that the option sets: path and value."""
        return dict(table_leaves(self.values, ""))


def _require_distinct_names(options: tuple[OptionPart, ...]) -> tuple[OptionPart, ...]:
    names = [option.name for option in options]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"options of a choice must have different names; got {quote(name)} twice; rename one")
    return options


class ChoicePart(Part):
    """A choice between options that each set several numbers, such as sections or gearmotors from a catalogue."""

    name: Annotated[str, Field(min_length=1, max_length=40, pattern=r"^[A-Za-z][A-Za-z0-9_ -]*$")] = required_entry(
        "name of the choice; its column in the table of designs is choice_<name>", "rod section"
    )
    option: Annotated[tuple[OptionPart, ...], AfterValidator(_require_distinct_names)] = optional_entry(
        "options to choose from, unless they are in a file",
        [
            {"name": "30 x 10", "values": {"mechanism.rod.width": "30 mm", "mechanism.rod.depth": "10 mm"}},
            {"name": "25 x 12", "values": {"mechanism.rod.width": "25 mm", "mechanism.rod.depth": "12 mm"}},
        ],
        default=(),
    )
    file: Annotated[str, Field(max_length=200)] | None = optional_entry(
        "instead of options: a CSV file beside the job file, one row per option, units in the header", "gearmotors.csv"
    )
    table: str | None = optional_entry(
        "instead of options: the text of such a file",
        "name,peak_torque max (N m),price (EUR)\nGM 40,40,310\nGM 200,200,840\n",
        max_length=LARGEST,
    )
    rows: Annotated[int, Field(strict=True, ge=1)] | None = optional_entry(
        "rows of the file from which the options were screened", 5000
    )

    @model_validator(mode="after")
    def _require_options(self) -> Self:
        if self.file is not None and self.table is None:
            raise unread_file_error(self.file, "options")
        if len(self.option) < (2 if self.rows is None and self.table is None else 1):
            raise InputError(
                f"must have two options or more, or a file; got {len(self.option)}; add [[choice.option]] tables"
            )
        return self


def choice_type_with_constraints(constraints: type[ConstraintsPart]) -> type[ChoicePart]:
    """Return the type of a choice whose options may also constrain custom quantities."""
    option: Any = with_entry_types(OptionPart, constraints=constraints)
    return with_entry_types(ChoicePart, option=Annotated[tuple[option, ...], AfterValidator(_require_distinct_names)])


def stated_variables(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers besides the dimensions that vary in an incomplete job: path and stated value."""
    varying: dict[str, Any] = {}
    for key, value in table_in(tables, "variables").items():
        if isinstance(key, str) and key.partition(".")[0] in ROOTS:
            varying |= dict(table_leaves({key: value}, ""))
    return varying


def paths_set_by_options(tables: Mapping[str, Any]) -> set[str]:
    """Return the paths of numbers that options of an incomplete job's choices set."""
    return {path for option in options_in(tables) for path in table_in(option, "values")}


def _put_value(table: dict[str, Any], steps: list[str], value: Any, key: str) -> None:
    """Set a value in nested tables."""
    for step in steps[:-1]:
        table = table.setdefault(step, {})
        if not isinstance(table, dict):
            raise InputError(
                f"{key} may be given only once; got it again as part of another key; leave out one of the two"
            )
    present = table.get(steps[-1])
    if isinstance(present, dict) and isinstance(value, Mapping):
        for inner, item in value.items():
            _put_value(present, [inner], item, f"{key}.{inner}")
    elif present is not None:
        raise InputError(f"{key} is given twice; leave out one of the two")
    else:
        table[steps[-1]] = value


def table_leaves(table: Mapping[str, Any], root: str) -> Iterator[tuple[str, Any]]:
    """Yield path and value of each entry in nested tables that is not a table. { choices } counts as a value."""
    for key, value in table.items():
        name = quoted_if_unprintable(str(key))  # no path has this name: it is for a message
        path = f"{root}.{name}" if root else name
        if isinstance(value, Mapping) and set(value) != {"choices"} and value and not states_value_grid(value):
            yield from table_leaves(value, path)
        else:
            yield path, value
