"""The first line of a catalogue: what each column holds, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ...model.errors import InputError, JobError
from ...model.linkage.values import DIMENSIONS
from ...objectives.formula.dimensions import kind_of_formula
from ...objectives.formula.expression import Name, names_in, text_of
from ...objectives.formula.formulas import ROOTS, Units, unknown_name
from ...objectives.formula.parser import parse
from ...objectives.kinds import LENGTH, Kind
from ...objectives.own.quantity import own_quantities
from ...objectives.registry import FACTS, QUANTITIES
from ...objectives.units import shown, to_si

_UNIT = r"(?:\((?P<unit>[^()]*)\)|\[(?P<other>[^\[\]]*)\])?"
_COLUMN = re.compile(rf"(?P<name>[^#]+?)(?:\s+(?P<word>min|max|equals))?\s*{_UNIT}")
_PATH = re.compile(rf"(?:{'|'.join(DIMENSIONS)}|(?:{'|'.join(ROOTS)})(?:\.\w+)+)")
_LIMIT = {"min": "min", "minimum": "min", "max": "max", "maximum": "max", "equals": "equals"}
_SAID = "|".join(sorted(_LIMIT, reverse=True))
_MISPLACED = re.compile(rf"(?i)(?:(?P<first>{_SAID})\s+(?P<after>.+)|(?P<before>.+?)\s+(?P<last>{_SAID}))")
_RULE = (
    'must be a quantity or formula with min, max or equals, or the path of a number, and its unit, like "peak_torque '
    'max (N m)"'
)


@dataclass(frozen=True)
class Column:
    """A column of numbers. header: as it is written. word: of a limit; None for a number of the job."""

    place: int
    header: str
    name: str
    word: str | None
    unit: str

    def value(self, cell: str) -> str | float:
        """Return a cell as a job has it."""
        return f"{cell} {self.unit}" if self.unit else float(cell)

    @property
    def monotone(self) -> bool:
        """Whether a looser limit only ever allows more designs."""
        of = QUANTITIES.get(self.name)
        return self.word == "min" or (self.word == "max" and (of is None or of.floor is None))


def columns_of(header: Sequence[str], name: str, own: frozenset[str]) -> list[Column]:
    """Return the columns that a first line names, those that begin with # left out.

    name: of the file, for messages. own: names of the job's own quantities. Raises JobError, naming column and remedy.
    """
    if header[0] != "name":
        raise JobError(f"{name} must have the column name first; got {shown(header[0])}; rename or move it")
    found: list[Column] = []
    for place, text in enumerate(header[1:], 1):
        if text.startswith("#"):
            continue
        where = f"{name}, column {shown(text)}"
        column = _column(place, text, where, own)
        if any((column.name, column.word) == (other.name, other.word) for other in found):
            raise JobError(f"{where}: columns must differ; got it twice; leave out one")
        found.append(column)
    if not found:
        raise JobError(f"{name} must have a column of numbers beside the name; got none; add one")
    return found


def _column(place: int, text: str, where: str, own: frozenset[str]) -> Column:
    parts = _COLUMN.fullmatch(text)
    if parts is None:
        raise JobError(f"{where}: {_RULE}; a column to be passed over begins with #")
    name, word, unit = parts["name"].strip(), parts["word"], (parts["unit"] or parts["other"] or "").strip()
    if word is None:
        _require_path(text, name, unit, where, own)
        return Column(place, text, name, None, unit)
    try:
        name, kind = _limited(name, own)
    except InputError as error:
        raise JobError(f"{where}: {error}") from None
    if kind is not None:
        _require_unit(unit, kind, where)
    return Column(place, text, name, word, unit)


def _require_path(text: str, name: str, unit: str, where: str, own: frozenset[str]) -> None:
    """Refuse a column of no limit that is no number of the job either."""
    if _PATH.fullmatch(name):
        return
    behind = f" ({unit})" if unit else ""
    misplaced = _MISPLACED.fullmatch(name)
    if misplaced is not None:
        word = _LIMIT[(misplaced["first"] or misplaced["last"]).casefold()]
        limited = misplaced["after"] or misplaced["before"]
        raise JobError(
            f"{where}: min, max or equals stands after the quantity, in small letters; got it otherwise; write "
            f"{limited} {word}{behind}"
        )
    if name in FACTS or name in own:
        raise JobError(
            f"{where}: a quantity needs min, max or equals; got none; write {name} max{behind} for its limit"
        )
    own_path = name.removeprefix("variables.")
    if own_path != name and _PATH.fullmatch(own_path):
        raise JobError(f"{where}: a number of the job has its own path; got {name}; write {own_path}{behind}")
    for formula in (name, text):  # text: the brackets at its end may be those of a function
        try:
            limited, _ = _limited(formula, own)
        except InputError:
            continue
        raise JobError(f"{where}: a formula needs min, max or equals; got none; write {limited} max for its limit")
    raise JobError(f"{where}: {_RULE}; got neither; rename it, or let it begin with # to pass it over")


def _limited(text: str, own: frozenset[str]) -> tuple[str, Kind | None]:
    """Return quantity or formula of a limit, as a job writes it, and its kind as far as it is known here.

    That of the job's own quantities and of numbers that vary the job knows. Raises InputError.
    """
    known = frozenset((*FACTS, *DIMENSIONS, *own))
    units = Units(known)
    node = parse(text, units)
    names = names_in(node)
    unknown = [name for name in names if name not in known and "." not in name]
    installed = own_quantities() if unknown else {}
    for name in unknown:
        if name not in installed:
            raise unknown_name(name, known, units)
    if isinstance(node, Name) and node.name in FACTS:
        return node.name, FACTS[node.name].kind
    kinds = dict.fromkeys(DIMENSIONS, LENGTH) | {name: of.kind for name, of in FACTS.items()}
    if any(name not in kinds or name in own for name in names):
        return text_of(node), None
    return text_of(node), kind_of_formula(node, {name: kinds[name] for name in names})


def _require_unit(unit: str, kind: Kind, where: str) -> None:
    """Refuse a limit's unit that is none of its quantity."""
    if kind.unit and not unit:
        raise JobError(
            f"{where}: must have the unit of {kind.name} in brackets; got none; write it like ({_unit(kind.example)})"
        )
    try:
        to_si(f"1 {unit}" if kind.unit else 1.0, kind)
        if not kind.unit and unit:
            raise InputError("")
    except InputError:
        raise JobError(
            f"{where}: must have a unit of {kind.name}; got {shown(unit)}; "
            + (f"write it like ({_unit(kind.example)})" if kind.unit else "leave it out")
        ) from None


def _unit(example: str) -> str:
    return example.partition(" ")[2]
