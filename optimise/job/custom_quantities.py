"""The tables [quantity.NAME] in a job file: custom functions and formulas, and functions from installed packages."""

import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.formula import formulas
from ...objectives.formula.expression import ARGUMENTS
from ...objectives.formula.formulas import identifiers_in
from ...objectives.kinds import TIME, Kind, kind_displayed_in
from ...objectives.own.quantity import (
    FUNCTION,
    LIMIT,
    Gradient,
    OwnQuantity,
    installed_quantity,
    quantity_entry_points,
    require_column_name,
)
from ...objectives.registry import FACTS
from ...objectives.units import is_number_with_any_unit, kind_of_any_unit, quote, value_of_one_si_unit_in
from .constraints_and_objectives import SLOW_STROKE, Stated
from .named_files import options_in, table_in
from .option_amounts import kinds_of_amounts, readable_amounts
from .part_kinds import Kinds
from .value_types import Part, Physical, optional_entry, required_entry


def _require_function_name(text: str) -> str:
    if not FUNCTION.fullmatch(text):
        raise InputError(
            f'must name a module and a function in it; got {quote(text)}; write it like "mymodule:myfunction", or '
            "give the function itself in Python"
        )
    return text


def _require_unit(text: str) -> str:
    try:
        kind_of_any_unit(text)
    except InputError as error:
        raise InputError(
            f'must be a unit; got {quote(text)}: {error}; write it like "N m", or "" for a ratio'
        ) from None
    return text


def require_one_line(text: str) -> str:
    """Return a text; reject one that is empty or has several lines."""
    if not text.strip() or not text.isprintable():
        raise InputError(f"must be one line of text, not empty; got {quote(text)}")
    return text


MOST_QUANTITIES = 20
"""Functions and named formulas of a job."""
Title = Annotated[str, Field(max_length=60), AfterValidator(require_one_line)]


class FunctionPart(Part):
    """A Python function as a quantity, whose name may be used in [objectives] and [constraints]."""

    function: Annotated[str, Field(max_length=200), AfterValidator(_require_function_name)] = required_entry(
        "module:function; the module is in the folder of the job file or installed", "mymodule:greatest_jerk"
    )
    unit: Annotated[str, Field(max_length=30), AfterValidator(_require_unit)] = optional_entry(
        'display unit; the function returns SI; "" for a ratio', "m/s^3", default=""
    )
    title: Title | None = optional_entry("title; default: the name", "greatest jerk of the slider")
    gradient: Gradient = optional_entry(
        "method for derivatives: complex step for a function that runs on complex numbers",
        "complex step",
        default="complex step",
    )
    limit: Annotated[float, Physical(TIME, "positive")] = optional_entry(
        "time limit of a call for up to 256 designs", "30 s", default=LIMIT
    )

    def build(self, name: str, folders: Iterable[str]) -> OwnQuantity:
        """Return the quantity for the problem."""
        return OwnQuantity(
            name=name,
            function=self.function,
            title=self.title or "",
            kind=kind_displayed_in(self.unit, value_of_one_si_unit_in(self.unit), kind_of_any_unit(self.unit)),
            gradient=self.gradient,
            folders=tuple(folders),
            limit=self.limit,
        )


class FormulaPart(Part):
    """A formula as a quantity; its name may be used in [objectives], [constraints] and other formulas."""

    formula: Annotated[str, Field(max_length=20_000)] = required_entry(
        "formula of quantities, dimensions, variables, numbers with units, + - * / ** and functions",
        "offset - crank",
    )
    title: Title | None = optional_entry("title; default: the name", "clearance beside the crank")
    unit: Annotated[str, Field(max_length=30), AfterValidator(_require_unit)] | None = optional_entry(
        "display unit; default: the usual unit for its kind", "mm"
    )

    def build(self) -> formulas.Stated:
        """Return the formula as stated; it is parsed once its names are known."""
        return formulas.Stated(self.formula, self.title, self.unit)


_KINDS = Kinds(
    {"function": FunctionPart, "formula": FormulaPart},
    'function = "mymodule:myfunction" or formula = "offset - crank"',
    "leave out one of the two",
)
QuantityPart = Annotated[
    Annotated[FunctionPart, Tag("(function)")] | Annotated[FormulaPart, Tag("(formula)")],
    Discriminator(_KINDS.kind_tag),
    BeforeValidator(_KINDS.require_one_kind),
]
"""A custom quantity of a job: a function, or a formula."""
Parts = dict[str, FunctionPart | FormulaPart]


def require_usable_names(parts: Parts) -> Parts:
    """Reject names that are already in use, or that cannot name a column."""
    for name, part in parts.items():
        if name in FACTS or name in (SLOW_STROKE, *DIMENSIONS, *ARGUMENTS):
            raise InputError(
                f"the name of a quantity must be new; got {quote(name)}, which exists already; choose another name"
            )
        require_column_name(name)
        if isinstance(part, FunctionPart):
            part.build(name, ())
    return parts


def function_quantities(parts: Parts, folder: Path | None) -> Iterator[OwnQuantity]:
    """Yield a job's functions in the form that the problem uses. folder: where to look for their modules."""
    for name, part in parts.items():
        if isinstance(part, FunctionPart):
            yield part.build(name, module_search_folders(folder))


def named_formulas(parts: Parts) -> dict[str, formulas.Stated]:
    """Return the named formulas of a job."""
    return {name: part.build() for name, part in parts.items() if isinstance(part, FormulaPart)}


@dataclass(frozen=True)
class Declared:
    """The quantities that a job adds to the built-in ones.

    tables: facts by name, for the keys of [objectives] and [constraints]. installed: functions from packages. formulas:
    names of formulas.
    """

    tables: Mapping[str, Stated]
    installed: tuple[OwnQuantity, ...]
    formulas: tuple[str, ...] = ()


def declared_quantities(data: Mapping[str, Any], *, allowed: bool) -> Declared:
    """Return the quantities that a job declares or takes from packages; raise JobError for code that is not allowed.

    It ignores other mistakes in a declaration, because validation reports them.
    """
    parts = data.get("quantity", {})
    names = _formula_names(parts)
    if parts and not allowed and len(names) < len(parts):
        raise JobError(
            f"quantity: custom functions are not run here; got {quote(parts)}; leave the table out, or have them "
            "installed as a package with entry points in slidercrank.quantities"
        )
    parts = parts if isinstance(parts, Mapping) else {}
    tables: dict[str, Stated] = {}
    for name, part in itertools.islice(parts.items(), MOST_QUANTITIES):  # more are refused
        if name in names:
            continue
        unit = part.get("unit", "") if isinstance(part, Mapping) else ""
        try:
            kind = kind_of_any_unit(unit if isinstance(unit, str) else "")
        except InputError:
            kind = kind_of_any_unit("")
        is_taken = name in FACTS or name == SLOW_STROKE
        if not is_taken and name.isidentifier() and not name.startswith("_"):
            tables[name] = _quantity_facts(name.replace("_", " "), kind)
    tables |= {
        name: _quantity_facts(name.replace("_", " "), kind)
        for name, kind in kinds_of_amounts(readable_amounts(data)).items()
        if name not in FACTS and name != SLOW_STROKE and name.isidentifier() and not name.startswith("_")
    }
    limits = (table_in(part, "constraints") for part in (data, *options_in(data)))
    requested = [name for table in (table_in(data, "objectives"), *limits) for name in _used_names(table)]
    requested += [word for name in names for word in identifiers_in(parts[name]["formula"])]
    known_names = {*FACTS, *tables, *names, *DIMENSIONS, SLOW_STROKE}
    # Formulas are looked up first, because finding packages takes longer than reading a job.
    unknown = [name for name in dict.fromkeys(requested) if name not in known_names and name.isidentifier()]
    packages = quantity_entry_points() if unknown else {}
    installed_quantities = tuple(installed_quantity(name) for name in unknown if name in packages)
    for quantity in installed_quantities:
        tables[quantity.name] = _quantity_facts(quantity.title, kind_of_any_unit(quantity.unit.symbol))
    return Declared(tables, installed_quantities, names)


def _formula_names(parts: object) -> tuple[str, ...]:
    """Return the names of the parts that are only formulas."""
    entries = parts.items() if isinstance(parts, Mapping) else ()
    return tuple(
        name
        for name, part in entries
        if isinstance(name, str) and isinstance(part, Mapping) and "formula" in part and "function" not in part
    )


def _quantity_facts(title: str, kind: Kind) -> Stated:
    return Stated(title, kind, kind.example if kind.unit else float(kind.example))


def _used_names(table: Mapping[str, Any]) -> Iterator[str]:
    """Yield the names in a table's keys and bounds, including those in formulas."""
    for key, value in table.items():
        yield from identifiers_in(key)
        for bound in value.values() if isinstance(value, Mapping) else ():
            if not (isinstance(bound, str) and is_number_with_any_unit(bound)):  # words in a value are units
                yield from identifiers_in(bound)


def module_search_folders(folder: Path | None) -> list[str]:
    """Return the folders to search for a job's modules: that of the job file, then the working directory."""
    return [str(place.resolve()) for place in ((folder,) if folder else ()) + (Path(),)]


def function_module_files(data: Mapping[str, Any], folder: Path) -> list[Path]:
    """Return the files beside a job file that contain its functions."""
    parts = data.get("quantity", {})
    functions = [part.get("function") for part in parts.values() if isinstance(part, Mapping)] if parts else []
    files = [folder / f"{text.partition(':')[0]}.py" for text in functions if isinstance(text, str)]
    return [file for file in dict.fromkeys(files) if file.is_file()]
