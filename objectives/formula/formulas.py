"""Formulas in a job: parsed, checked against the meaning of their names, and converted to quantities."""

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.machine.mechanism import Mechanism
from ...model.machine.raw_numbers_of_designs import unit_of_number
from ..bounds_over_ranges import CLEAR, KnownBounds, QuantityBounds
from ..bounds_over_ranges import LengthRanges as Box
from ..kinds import LENGTH, Kind, kind_displayed_in
from ..quantity import Quantity
from ..registry import FACTS, QUANTITIES, first_names_text
from ..units import (
    closest_word,
    dimension_of,
    is_number_with_any_unit,
    kind_of_any_unit,
    kind_of_symbol,
    number_in_si,
    quote,
    to_si,
    value_of_one_si_unit_in,
)
from .dimensional_analysis import kind_of_formula
from .expression import (
    ARGUMENTS,
    Linear,
    Name,
    Node,
    formula_text,
    linear_form_of_node,
    linear_form_of_unknown,
    names_in,
)
from .parser import parse
from .quantity import FormulaQuantity, basic_quantities, column_key_of_formula
from .ranges import FormulaBounds, Interval

ROOTS = ("mechanism", "cylinder", "arm", "spring", "load", "friction", "drive", "tolerances", "sections", "motion")
"""Tables whose numbers may vary, and then begin the names in formulas."""
_WORD = re.compile(r"[A-Za-z_]\w*(?:\.\w+)*")
_NEAREST = 3


@dataclass(frozen=True)
class Stated:
    """A named formula as stated in its table. unit: display unit; None for the display unit of its kind."""

    formula: str
    title: str | None
    unit: str | None


@dataclass(frozen=True)
class Units:
    """Units that numbers may have. names: names that are never units, even after a number and an operator."""

    names: frozenset[str]

    def is_unit(self, name: str) -> bool:
        """Return whether a name is a unit."""
        if name in self.names:
            return False
        try:
            dimension_of(name)
        except InputError:
            return False
        return True

    def number_in_si(self, digits: str, unit: str) -> float:
        """Return a number in SI. Raises InputError for an unknown unit."""
        first = unit.split(" ")[0]
        if first in self.names:
            raise InputError(f"one of + - * / ** is missing between {digits} and {first}")
        return number_in_si(digits, unit)


def is_formula(text: str, names: Iterable[str] = ()) -> bool:
    """Return whether a bound is meant as a formula: it contains a name or a misspelt one.

    names: names that bounds may use besides the quantities available in every job.
    """
    if is_number_with_any_unit(text):
        return False
    known_names = {*FACTS, *DIMENSIONS, *ARGUMENTS, *names}
    return any(
        word in known_names or "." in word or (len(word) > 3 and closest_word(word, known_names))
        for word in identifiers_in(text)
    )


def identifiers_in(text: object) -> list[str]:
    """Return the words in a formula (names and units), or an empty list if it is not a string."""
    return _WORD.findall(text) if isinstance(text, str) else []


def unknown_name_error(name: str, names: Iterable[str], units: Units, formula: str) -> InputError:
    """Return the error for a name in a formula that is not a quantity, a dimension or a variable.

    names: known names, in which - is accepted for _.
    """
    every, written = list(names), re.sub(r"\s*-\s*", "_", formula.strip())
    same = [candidate for candidate in every if candidate.casefold() in (name.casefold(), written.casefold())]
    near = same or difflib.get_close_matches(name[:60], every, n=_NEAREST)
    hint = f"did you mean {' or '.join(near)}?" if near else f"the names are {first_names_text(every)}"
    if "." in name and not near:
        hint = "let the number vary in [variables], or write its value"
    elif name in ARGUMENTS:
        hint = f"write it with its arguments in brackets: {name}(...)"
    elif units.is_unit(name):
        hint = f"a unit must follow its number directly: 1 {name}"
    return InputError(f"no quantity, dimension or variable is called {quote(name)}; {hint}")


class Ends(Protocol):
    """Range of a number, SI."""

    @property
    def lower(self) -> float:
        """Least value."""

    @property
    def upper(self) -> float:
        """Greatest value."""


class Formulas:
    """Formulas in a job, with the meaning of their names.

    made: quantities already built from formulas, in order of request.
    """

    def __init__(
        self,
        custom: Iterable[Quantity],
        machine: Mechanism,
        ranges: Mapping[str, Ends] | None,
        named: Mapping[str, Stated],
        *,
        turning: bool = True,
    ) -> None:
        """Take a job's custom quantities, its machine, the ranges of the dimensions, and the named formulas.

        ranges: None if only values are needed and nothing is known about the designs. turning: whether the crank must
        rotate fully, which narrows the dimensions. Raises JobError if a named formula is wrong.
        """
        self.formula_quantities: dict[str, FormulaQuantity] = {}
        self._machine, self._stated = machine, named
        self._open: list[str] = []
        self._turning = turning
        self._quantities: dict[str, Quantity] = QUANTITIES | {item.name: item for item in custom}
        self._places = {name: place for place, name in enumerate((*DIMENSIONS, *(v.name for v in machine.varying)))}
        self._kinds = dict.fromkeys(DIMENSIONS, LENGTH)
        self._kinds |= {item.name: kind_of_symbol(unit_of_number(item.paths[0])) for item in machine.varying}
        self._has_ranges = ranges is not None
        self._intervals = {name: Interval(ends.lower, ends.upper) for name, ends in (ranges or {}).items()}
        self._intervals |= {item.name: Interval(item.lower, item.upper) for item in machine.varying}
        self._linears: dict[str, Linear | None] = {name: linear_form_of_unknown(name) for name in self._places}
        self._units = Units(frozenset((*self._quantities, *self._places, *named)))
        for name in named:
            self._resolve_stated_formula(name)

    def quantity_of_text(self, text: str, key: str) -> Quantity:
        """Return the quantity for a name or a formula. key: key in the job, for messages.

        Raises JobError for an error in it, or if every design would have the same value.
        """
        try:
            quantity = self._resolve_text(text)
        except InputError as error:
            raise JobError(f"{key}: {error}") from None
        if isinstance(quantity, FormulaQuantity) and quantity.is_constant and not basic_quantities([quantity]):
            raise JobError(
                f"{key}: a formula must name a quantity, dimension or variable; got {quantity.formula}, which is "
                "the same for every design; leave it out"
            )
        return quantity

    def quantity_and_bound(self, quantity: Quantity, value: object, key: str) -> tuple[Quantity, float]:
        """Return the quantity and its bound; if the bound is a formula, return their difference and 0.

        Raises JobError.
        """
        try:
            if isinstance(value, str) and is_formula(value, self._units.names):
                return self._resolve_text(f"({quantity.name}) - ({value})"), 0.0
            return quantity, to_si(value, quantity.kind)
        except InputError as error:
            raise JobError(f"{key}: {error}") from None

    # ---- conversion of a formula to a quantity ---------------------------------------------------------------------

    def _resolve_text(self, text: str) -> Quantity:
        node = parse(text, self._units)
        if isinstance(node, Name) and node.name not in self._places:
            return self._resolve_name(node.name, node.name)
        name = formula_text(node)
        if name not in self.formula_quantities:
            self.formula_quantities[name] = self._formula_quantity(
                node, name, title=name, key=column_key_of_formula(name)
            )
        return self.formula_quantities[name]

    def _resolve_stated_formula(self, name: str) -> FormulaQuantity:
        """Return the quantity for a named formula, after resolving the formulas that it names. Raises JobError."""
        if name in self.formula_quantities:
            return self.formula_quantities[name]
        if name in self._open:
            through = " by ".join((*self._open[self._open.index(name) :], name))
            raise InputError(f"formulas must not refer to themselves; got {through}; write one of them out in full")
        self._open.append(name)
        stated = self._stated[name]
        try:
            node = parse(stated.formula, self._units)
            self.formula_quantities[name] = self._formula_quantity(node, name, title=stated.title or "", key=name)
            if stated.unit is not None:
                self.formula_quantities[name] = self._with_stated_unit(self.formula_quantities[name], node, stated)
        except JobError:
            raise
        except InputError as error:
            raise JobError(f"quantity.{name}.formula: {error}") from None
        self._open.pop()
        self._quantities[name] = self.formula_quantities[name]
        return self.formula_quantities[name]

    def _with_stated_unit(self, formula: FormulaQuantity, node: Node, stated: Stated) -> FormulaQuantity:
        unit = stated.unit or ""
        if dimension_of(unit) != dimension_of(formula.kind.unit):
            name = formula.name
            raise JobError(
                f"quantity.{name}.unit: a formula must be shown in a unit of its kind; got {quote(unit)} for "
                f'{formula.kind.name}; write it like "{formula.kind.metric.symbol}", or leave it out'
            )
        kind = kind_displayed_in(unit, value_of_one_si_unit_in(unit), kind_of_any_unit(unit))
        return self._formula_quantity(node, formula.name, title=formula.title, key=formula.key, kind=kind)

    def _formula_quantity(
        self, node: Node, name: str, *, title: str, key: str, kind: Kind | None = None
    ) -> FormulaQuantity:
        names = names_in(node)
        parts = tuple(self._resolve_name(item, formula_text(node)) for item in names if item not in self._places)
        for part in parts:
            reason = part.undefined_because([self._machine])
            if reason:
                raise InputError(f"{part.name} is not defined here: {reason}")
        kinds = {item: self._kinds[item] for item in names if item in self._places}
        kind = kind or kind_of_formula(node, kinds | {part.name: part.kind for part in parts})
        interval = self._bounds_of_formula(node, parts)
        wider = f"a wider range of {' or of '.join(DIMENSIONS)}"
        self._intervals[name] = interval
        self._linears[name] = linear_form_of_node(node, self._linears)
        text = formula_text(node)
        return FormulaQuantity(
            name=name,
            title=title,
            kind=kind,
            key=key,
            sentence=f"A formula of this job: {text}.",
            formula=text,
            source="this job",
            section="11. Peaks, averages and derivatives",
            signed=interval.lower < 0.0,
            bounds=QuantityBounds(compute=KnownBounds(interval.lower, interval.upper), to_raise=wider, to_lower=wider),
            about_tolerances=any(part.about_tolerances for part in parts),
            expression=node,
            parts=parts,
            dimensions=tuple(item for item in names if item in DIMENSIONS),
            varying=tuple(item for item in self._machine.varying if item.name in names),
            signs=tuple((item, sign) for item in names if item in self._places and (sign := self._known_sign_of(item))),
        )

    def _bounds_of_formula(self, node: Node, parts: tuple[Quantity, ...]) -> Interval:
        if not self._has_ranges:
            return Interval(-float("inf"), float("inf"))
        for part in parts:
            if part.name not in self._intervals:
                self._intervals[part.name] = self._bounds_of_quantity(part)
                self._linears.setdefault(part.name, None)
        linears = self._linears if self._turning else dict.fromkeys(self._linears)
        off_zero = {name: self._remedy_for_zero_divisor(name) for name in names_in(node)}
        return FormulaBounds(self._intervals, linears, off_zero).bounds_of_formula(node)

    def _known_sign_of(self, name: str) -> int:
        interval = self._intervals.get(name, Interval(-1.0, 1.0))
        return 1 if interval.lower >= 0.0 else -1 if interval.upper <= 0.0 else 0

    def _resolve_name(self, name: str, formula: str) -> Quantity:
        if name in self._stated:
            return self._resolve_stated_formula(name)
        if name in self._quantities:
            return self._quantities[name]
        if name in FACTS:
            raise InputError(f"{name} needs the table [{FACTS[name].table}]; got none; add it, or leave {name} out")
        raise unknown_name_error(name, [*self._quantities, *self._places, *self._stated], self._units, formula)

    def _bounds_of_quantity(self, quantity: Quantity) -> Interval:
        """Return bounds of a quantity within the ranges; one that is never negative counts as nonzero."""
        if quantity.zero_because([self._machine]):
            return Interval(0.0, 0.0)
        low = -float("inf") if quantity.signed else 0.0 if quantity.domain is None else max(quantity.domain.lower, 0.0)
        sign_interval = Interval(low, float("inf"), not quantity.signed)
        crank, rod, offset = (self._intervals[name] for name in DIMENSIONS)
        sizes = sorted((abs(offset.lower), abs(offset.upper)))
        least = 0.0 if offset.spans_zero else sizes[0]
        length_bounds = quantity.bounds_for(self._machine)
        if length_bounds is None or not self._turning or rod.upper <= (crank.lower + least) * CLEAR:
            return sign_interval
        lower, upper = length_bounds.compute(Box(crank.lower, crank.upper, rod.lower, rod.upper, least, sizes[1]))
        return Interval(lower, upper, sign_interval.excludes_zero)

    def _remedy_for_zero_divisor(self, name: str) -> str:
        """Return advice on how to keep a number away from zero."""
        if name in self._places:
            interval = self._intervals[name]
            return f"keep variables.{name} away from zero: its range is {_interval_text(interval, self._kinds[name])}"
        instead = self._quantities[name].instead_of_quotient if name in self._quantities else ""
        if instead:
            return f"use {instead} instead: work output divided by work input, also for prime movers such as engines"
        return "divide by a quantity that is never zero, or constrain the product instead"


def _interval_text(interval: Interval, kind: Kind) -> str:
    unit = kind.metric
    return f"{interval.lower * unit.factor:.6g} to {interval.upper * unit.factor:.6g} {unit.symbol}".rstrip()
