"""The header line of a catalogue: meaning and unit of each column."""

import difflib
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.catalogue_amount import kind_of_amount
from ...objectives.formula.dimensional_analysis import kind_of_formula
from ...objectives.formula.expression import Name, formula_text, names_in
from ...objectives.formula.formulas import ROOTS, Units, unknown_name_error
from ...objectives.formula.parser import parse
from ...objectives.kinds import LENGTH, Kind
from ...objectives.own.quantity import LONGEST_NAME, quantity_entry_points
from ...objectives.registry import FACTS, QUANTITIES
from ...objectives.units import closest_word, quote, to_si

_UNIT = r"(?:\((?P<unit>[^()]*)\)|\[(?P<other>[^\[\]]*)\])?"
_COLUMN = re.compile(rf"(?P<name>[^#]+?)(?:\s+(?P<word>min|max|equals))?\s*{_UNIT}")
_PATH = re.compile(rf"(?:{'|'.join(DIMENSIONS)}|(?:{'|'.join(ROOTS)})(?:\.\w+)+)")
_LIMIT = {"min": "min", "minimum": "min", "max": "max", "maximum": "max", "equals": "equals"}
_SAID = "|".join(sorted(_LIMIT, reverse=True))
_MISPLACED = re.compile(rf"(?i)(?:(?P<first>{_SAID})\.?\s+(?P<after>.+)|(?P<before>.+?)\s+(?P<last>{_SAID})\.?)")
_RULE = (
    'must be a quantity or formula with min, max or equals, or the path of a number, and its unit, like "peak_torque '
    'max (N m)", or have a name of letters'
)
_GIVEN = {"motion", "proportions"}
"""Words in a formula that suggest a quantity with a desired value, for which neither more nor less is better."""
_NEAR = 0.85
"""Similarity above which a column's name counts as a misspelt quantity."""


@dataclass(frozen=True)
class Column:
    """A column. header: as written. name: name of a quantity, a path, or the name under which a column is stored.

    word: the limit's word; None for other columns. is_amount: whether it is neither a limit nor a number of the job.
    unit: as written. kind: kind of a limit or an amount; None if only the job knows it, and for text. added: whether
    the header lacks the word.
    """

    place: int
    header: str
    name: str
    word: str | None
    unit: str
    kind: Kind | None = None
    is_amount: bool = False
    added: bool = False

    def job_value_of_cell(self, cell: str) -> str | float:
        """Return a cell as a value for a job file."""
        return f"{cell} {self.unit}" if self.unit else float(cell)

    @property
    def looser_limit_allows_more(self) -> bool:
        """Whether a looser limit can only allow more designs."""
        quantity = QUANTITIES.get(self.name)
        return self.word == "min" or (self.word == "max" and (quantity is None or quantity.floor is None))

    @property
    def header_text(self) -> str:
        """Header that states how the column is read."""
        return f"{self.name} {self.word or ''} ({self.unit})".replace(" ()", "").replace("  ", " ")


def columns_of_header(header: Sequence[str], name: str, custom_names: frozenset[str]) -> list[Column]:
    """Return the columns that a header line names, without those that begin with #.

    A quantity without min, max or equals becomes a limit on its bad side. Other columns that set no number of the job
    are stored with designs, under names of lower-case letters, digits and _. name: name of the file. custom_names:
    names of the job's custom quantities. Raises JobError, naming column and remedy.
    """
    if header[0] != "name":
        remedy = "rename it" if header[0].casefold() == "name" else "rename or move it"
        raise JobError(f'{name}: the first column must be headed "name"; got {quote(header[0])}; {remedy}')
    columns: list[Column] = []
    for place, text in enumerate(header[1:], 1):
        if text.startswith("#"):
            continue
        column_name = f"{name}, column {quote(text)}"
        column = _read_column(place, text, column_name, custom_names)
        same = next(
            (earlier for earlier in columns if (earlier.name, earlier.word) == (column.name, column.word)), None
        )
        if same is not None:
            raise JobError(
                f"{column_name}: columns must differ; got it and {quote(same.header)}, which are both read as "
                f"{column.header_text.partition(' (')[0].strip()}; leave out or rename one"
            )
        columns.append(column)
    if not columns:
        raise JobError(f"{name} must have a column beside the name; got none; add one")
    return columns


def _read_column(place: int, text: str, column_name: str, custom_names: frozenset[str]) -> Column:
    parts = _COLUMN.fullmatch(text)
    if parts is None:
        raise JobError(f"{column_name}: {_RULE}; a column that begins with # is skipped")
    name, word, unit = parts["name"].strip(), parts["word"], (parts["unit"] or parts["other"] or "").strip()
    if word is not None:
        try:
            name, kind = _limited_quantity(
                name if name in custom_names else _quantity_names().get(identifier_from_text(name), name), custom_names
            )
        except InputError as error:
            key = identifier_from_text(name)
            if not re.fullmatch(r"[\w -]+", name) or closest_word(key, (*_quantity_names(), *custom_names)) is not None:
                raise JobError(f"{column_name}: {error}") from None
            raise JobError(
                f"{column_name}: a limit must be on a quantity; got {quote(name)}, which is not one; name the column "
                f'"{name}{f" ({unit})" if unit else ""}" and bound {key} in [constraints]'
            ) from None
        if kind is not None:
            _require_unit(unit, kind, column_name, text)
        return Column(place, text, name, word, unit, kind)
    if _PATH.fullmatch(name):
        return Column(place, text, name, None, unit)
    quantity = FACTS.get(_quantity_names().get(identifier_from_text(name), ""))
    if quantity is not None and not _GIVEN & set(quantity.offered):
        _require_unit(unit, quantity.kind, column_name, text)
        return Column(
            place, text, quantity.name, "max" if quantity.better == "low" else "min", unit, quantity.kind, added=True
        )
    _require_amount_name(text, name, unit, column_name, custom_names)
    return Column(place, text, identifier_from_text(name), None, unit, kind_of_amount(unit), is_amount=True)


def identifier_from_text(text: str) -> str:
    """Return a text as a name of lower-case letters, digits and _; empty if nothing remains."""
    plain = unicodedata.normalize("NFKD", text.casefold()).encode("ascii", "ignore").decode()
    return re.sub("[^a-z0-9]+", "_", plain).strip("_")


@cache
def _quantity_names() -> dict[str, str]:
    """Return the names of quantities by name and by title."""
    return {identifier_from_text(quantity.title): name for name, quantity in FACTS.items()} | {
        name: name for name in FACTS
    }


def _require_amount_name(text: str, name: str, unit: str, column_name: str, custom_names: frozenset[str]) -> None:
    """Reject a column without a name, or one that looks like a limit or a number of the job."""
    unit_text = f" ({unit})" if unit else ""
    misplaced = _MISPLACED.fullmatch(name)
    bare = (misplaced["after"] or misplaced["before"]) if misplaced is not None else ""
    limited = _quantity_names().get(identifier_from_text(bare), bare)
    if misplaced is not None and _is_quantity_or_formula(limited, custom_names):
        word = _LIMIT[(misplaced["first"] or misplaced["last"]).casefold()]
        raise JobError(
            f"{column_name}: min, max or equals must follow the quantity, in lower case; write {limited} "
            f"{word}{unit_text}"
        )
    quantity_name = _quantity_names().get(identifier_from_text(name), name)
    if quantity_name in FACTS or quantity_name in custom_names:
        raise JobError(
            f"{column_name}: a quantity needs min, max or equals; got none; write {quantity_name} max{unit_text} for "
            "its limit"
        )
    number_path = name.removeprefix("variables.")
    if number_path != name and _PATH.fullmatch(number_path):
        raise JobError(
            f"{column_name}: a number of the job must be named by its path; got {name}; write {number_path}{unit_text}"
        )
    for formula in (name, text):  # with text, because the brackets at its end may belong to a function
        if _is_quantity_or_formula(formula, custom_names):
            limited, _ = _limited_quantity(formula, custom_names)
            raise JobError(
                f"{column_name}: a formula needs min, max or equals; got none; write {limited} max for its limit"
            )
    key = identifier_from_text(name)
    if not key or not (name[0].isalpha() and key[0].isalpha()) or len(key) > LONGEST_NAME:
        raise JobError(f"{column_name}: {_RULE}; got neither; rename it, or let it begin with # to skip it")
    peak = f"peak_{identifier_from_text(bare)}"
    near = [peak] if peak in _quantity_names() else difflib.get_close_matches(key, _quantity_names(), n=1, cutoff=_NEAR)
    if near:
        raise JobError(
            f"{column_name}: must be the name of a quantity, or a name that resembles none; did you mean "
            f"{_quantity_names()[near[0]]}? "
            "rename it, or let it begin with # to skip it"
        )


def _is_quantity_or_formula(text: str, custom_names: frozenset[str]) -> bool:
    """Return whether a text is a quantity or a formula."""
    try:
        return bool(_limited_quantity(text, custom_names))
    except InputError:
        return False


def _limited_quantity(text: str, custom_names: frozenset[str]) -> tuple[str, Kind | None]:
    """Return the quantity or formula of a limit, as a job writes it, and its kind if known here.

    For custom quantities and extra variables, only the job knows the kind. Raises InputError.
    """
    known_names = frozenset((*FACTS, *DIMENSIONS, *custom_names))
    units = Units(known_names)
    node = parse(text, units)
    names = names_in(node)
    unknown = [name for name in names if name not in known_names and "." not in name]
    installed = quantity_entry_points() if unknown else {}
    for name in unknown:
        if name not in installed:
            raise unknown_name_error(name, known_names, units, text)
    if isinstance(node, Name) and node.name in FACTS:
        return node.name, FACTS[node.name].kind
    kinds = dict.fromkeys(DIMENSIONS, LENGTH) | {name: quantity.kind for name, quantity in FACTS.items()}
    if any(name not in kinds or name in custom_names for name in names):
        return formula_text(node), None
    return formula_text(node), kind_of_formula(node, {name: kinds[name] for name in names})


def _require_unit(unit: str, kind: Kind, column_name: str, head: str) -> None:
    """Reject a unit that does not fit the limited quantity. head: heading of the column, with the unit."""
    if kind.unit and not unit:
        heading = quote(f"{head} ({_unit_in_example(kind.example)})")
        raise JobError(f"{column_name}: the heading has no unit; write, for example, {heading}")
    try:
        to_si(f"1 {unit}" if kind.unit else 1.0, kind)
        if not kind.unit and unit:
            raise InputError("")
    except InputError:
        raise JobError(
            f"{column_name}: must have a unit of {kind.name}; got {quote(unit)}; "
            + (f"write it like ({_unit_in_example(kind.example)})" if kind.unit else "leave it out")
        ) from None


def _unit_in_example(example: str) -> str:
    return example.partition(" ")[2]
