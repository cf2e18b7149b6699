"""Formulas in a job that may be incomplete: the kind or the mistake of each, and the permitted names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from typing import Any

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.formula.dimensional_analysis import kind_of_formula
from ...objectives.formula.expression import names_in
from ...objectives.formula.formulas import Units, is_formula, unknown_name_error
from ...objectives.formula.parser import parse
from ...objectives.kinds import LENGTH, Kind
from ...objectives.registry import FACTS
from ...objectives.tables.design_input import words_of_number_name
from ...objectives.units import is_number_with_any_unit, kind_of_any_unit
from .catalogue import with_options
from .constraints_and_objectives import SLOW_STROKE, WORDS
from .mistake_messages import key_of_location
from .named_files import table_in
from .option_amounts import kinds_of_amounts, readable_amounts
from .variables import stated_variables

_MOST = 200
"""Maximum number of formulas to read, and of names to report."""


@dataclass(frozen=True)
class FormulaName:
    """A name that is specific to formulas in this job. kind: kind of its values; None while it is unknown."""

    name: str
    title: str
    kind: Kind | None


@dataclass(frozen=True)
class StatedFormula:
    """A formula in a job. key: its location, as in messages. kind: kind of its values, None if unknown.

    wrong: its mistake, as a sentence; None if there is none.
    """

    key: str
    kind: Kind | None
    wrong: str | None


def formula_names(tables: Mapping[str, Any]) -> list[FormulaName]:
    """Return the names that formulas may use in this job alone: its custom quantities and extra variables."""
    kinds = _Kinds(tables)
    names = [
        FormulaName(name, _part_title(name, part), kinds.quantity_kind(name)) for name, part in kinds.stated.items()
    ]
    names += [FormulaName(name, name.replace("_", " "), kind) for name, kind in kinds.amounts.items()]
    return [*names, *(FormulaName(path, words_of_number_name(path), kind) for path, kind in kinds.varying)]


def stated_formulas(tables: Mapping[str, Any]) -> list[StatedFormula]:
    """Return the formulas of a job: named ones, keys of [constraints] and [objectives], and bounds.

    Checks only units and names, because ranges and the machine may still be missing.
    """
    kinds = _Kinds(tables)
    return [_read_formula(key, text, kinds) for key, text in islice(_stated_formulas(tables, kinds), _MOST)]


def _read_formula(key: str, text: str, kinds: _Kinds) -> StatedFormula:
    try:
        return StatedFormula(key, kinds.formula_kind(text), None)
    except InputError as error:
        return StatedFormula(key, None, str(error))


def _stated_formulas(tables: Mapping[str, Any], kinds: _Kinds) -> Iterator[tuple[str, str]]:
    for name, part in kinds.stated.items():
        if isinstance(part.get("formula"), str):
            yield key_of_location(["quantity", name, "formula"]), part["formula"]
    for table in ("constraints", "objectives"):
        for name, bounds in table_in(tables, table).items():
            if not isinstance(name, str) or name == SLOW_STROKE:
                continue
            if name not in FACTS:
                yield key_of_location([table, name]), name
            for word in WORDS if isinstance(bounds, Mapping) else ():
                bound = bounds.get(word)
                if isinstance(bound, str) and is_formula(bound, kinds.names):
                    yield key_of_location([table, name, word]), bound


def _part_title(name: str, part: Mapping[str, Any]) -> str:
    title = part.get("title")
    return title if isinstance(title, str) and title.strip() else name.replace("_", " ")


class _Kinds:
    """Kinds of the names that formulas of a job may use. Incomplete names raise no error; their kind is None."""

    def __init__(self, tables: Mapping[str, Any]) -> None:
        with suppress(InputError):  # an invalid table, which validation reports
            tables = with_options(tables)[0]
        self.amounts = kinds_of_amounts(readable_amounts(tables))
        entries = islice(table_in(tables, "quantity").items(), _MOST)
        self.stated = {name: part for name, part in entries if isinstance(name, str) and isinstance(part, Mapping)}
        self.varying = [
            (path, _kind_of_first_value(value)) for path, value in islice(stated_variables(tables).items(), _MOST)
        ]
        self._known: dict[str, Kind | None] = dict.fromkeys(DIMENSIONS, LENGTH)
        self._known |= dict(self.varying) | {name: fact.kind for name, fact in FACTS.items()} | self.amounts
        self.names = frozenset((*self._known, *self.stated))
        self._units = Units(self.names)

    def formula_kind(self, text: str) -> Kind | None:
        """Return the kind of a formula; None while the kind of a name in it is unknown. Raises InputError."""
        if not text.strip():
            raise InputError('is missing; write a formula such as "offset - 2 * crank"')
        node = parse(text, self._units)
        kinds = {}
        for name in names_in(node):
            if name not in self.names:
                raise unknown_name_error(name, [*self._known, *self.stated], self._units, text)
            kinds[name] = self.quantity_kind(name)
        known_kinds = {name: kind for name, kind in kinds.items() if kind is not None}
        return kind_of_formula(node, known_kinds) if len(known_kinds) == len(kinds) else None

    def quantity_kind(self, name: str) -> Kind | None:
        """Return the kind of a custom quantity; None while it is unknown."""
        if name not in self._known:
            self._known[name] = None  # until it is determined; it stays None for a quantity that depends on itself
            self._known[name] = self._stated_kind(self.stated[name])
        return self._known[name]

    def _stated_kind(self, part: Mapping[str, Any]) -> Kind | None:
        unit, formula = part.get("unit"), part.get("formula")
        try:
            if isinstance(unit, str):
                return kind_of_any_unit(unit)
            return self.formula_kind(formula) if isinstance(formula, str) else None
        except InputError:
            return None


def _kind_of_first_value(value: object) -> Kind | None:
    """Return the kind of the first value with a unit in a range, choices or a table of values."""
    if isinstance(value, Mapping):
        return next((kind for item in value.values() if (kind := _kind_of_first_value(item))), None)
    if isinstance(value, list | tuple):
        return next((kind for item in value[:2] if (kind := _kind_of_first_value(item))), None)
    if not (isinstance(value, str) and is_number_with_any_unit(value)):
        return None
    return kind_of_any_unit(value.strip().lstrip("+-.0123456789eE").strip())
