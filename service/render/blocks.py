"""Sentences and tables as data. Their numbers keep their kind, so that the renderer selects the units."""

from __future__ import annotations

import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import LENGTH, RATIO, Kind, name_and_kind_of_key

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage


@dataclass(frozen=True)
class Value:
    """Number with its kind.

    number: number in SI; None if undefined. digits: number of significant digits shown. decimals: digits after the
    decimal point instead, in metric units. sign: whether a positive number gets a plus sign. bare: whether to omit the
    unit. missing: text for None and NaN.
    """

    number: float | None
    kind: Kind = RATIO
    digits: int = 6
    decimals: int | None = None
    sign: bool = False
    bare: bool = False
    missing: str = "undefined"


@dataclass(frozen=True)
class Unit:
    """Unit of a kind, alone in a cell, for the numbers in its row."""

    kind: Kind


@dataclass(frozen=True)
class Phrase:
    """Text that contains units, as written by a search, in each unit system."""

    metric: str
    inch: str


Part = str | Value | Unit | Phrase
Text = Part | tuple[Part, ...]
"""Text with values, which show their units. A value alone in a cell shows no unit: the column heading or the row states
it."""


@dataclass(frozen=True)
class Sentence:
    """Sentence. style: heading, plain text, or a note on the preceding block. apart: whether space precedes it."""

    text: Text
    style: Literal["heading", "plain", "note"] = "plain"
    space_before: bool = False


@dataclass(frozen=True)
class Column:
    """Table column. title: its heading. kind: kind of its numbers, if the heading shows their unit."""

    title: Text = ""
    kind: Kind | None = None
    right_aligned: bool = True


@dataclass(frozen=True)
class Table:
    """Table.

    rows: cells by column. ruled: whether a rule separates the headings. dim: positions of columns with remarks.

    indented: whether it is indented below its heading. apart: whether space precedes it, and columns are wide. bold:
    positions of bold rows.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[Text, ...], ...]
    ruled: bool = False
    indented: bool = False
    dim: tuple[int, ...] = ()
    space_before: bool = False
    bold: tuple[int, ...] = ()


Block = Sentence | Table


def words(template: str, **values: Text) -> Text:
    """Return a text from a template with a name in braces for each value: "{force} at {angle}"."""
    parts: list[Part] = []
    for text, name, _, _ in string.Formatter().parse(template):
        parts += [text] if text else []
        if name is not None:
            value = values[name]
            parts += value if isinstance(value, tuple) else [value]
    return tuple(parts)


def heading(template: str, **values: Text) -> Sentence:
    """Return a heading; see `words`."""
    return Sentence(words(template, **values), "heading")


def sentence(template: str, **values: Text) -> Sentence:
    """Return a sentence; see `words`."""
    return Sentence(words(template, **values))


def note(template: str, **values: Text) -> Sentence:
    """Return a note; see `words`."""
    return Sentence(words(template, **values), "note")


def joined(texts: Sequence[Text], separator: str = ", ") -> Text:
    """Return texts joined in sequence, without empty ones."""
    parts: list[Part] = []
    for text in texts:
        if text not in ("", ()):
            parts += [separator] if parts else []
            parts += text if isinstance(text, tuple) else [text]
    return tuple(parts)


def column(title: Text = "", kind: Kind | None = None, *, left: bool = False) -> Column:
    """Return a column of numbers, or of left-aligned words."""
    return Column(title, kind, right_aligned=not left)


def value_from_record(record: Mapping[str, Any], key: str, **look: Any) -> Value:
    """Return a number from a metric record, whose key names its unit. look: further fields of `Value`."""
    return values_from_record({key: [record[key]]}, key, **look)[0]


def values_from_record(record: Mapping[str, Any], key: str, **look: Any) -> list[Value]:
    """Return a list of numbers from a metric record; see `value_from_record`."""
    _, kind = name_and_kind_of_key(key)
    return [Value(None if number is None else number / kind.metric.factor, kind, **look) for number in record[key]]


NamedNumber = tuple[str, Text, Text]
"""Row with the name of a number, the number, and a remark."""


def named_number(record: Mapping[str, Any], key: str, remark: Text = "") -> NamedNumber:
    """Return a named number from a metric record, with the crank angle of a peak and a remark."""
    name, _ = name_and_kind_of_key(key)
    angle = f"{name}_angle_deg"
    at = (
        words("at {angle}", angle=value_from_record(record, angle, decimals=2)) if record.get(angle) is not None else ""
    )
    return name.replace("_", " ").replace("rms ", "RMS "), value_from_record(record, key), joined([at, remark])


def number_list(title: Text, numbers: Sequence[NamedNumber]) -> list[Block]:
    """Return a heading and a line for each number, with its unit and remark."""
    rows = []
    for name, number, remark in numbers:
        unit: Text = Unit(number.kind) if isinstance(number, Value) and number.number is not None else ""
        rows.append((name, number, unit, remark))
    columns = (column(left=True), column(), column(left=True), column(left=True))
    return [Sentence(title, "heading"), Table(columns, tuple(rows), indented=True, dim=(3,))]


def remark_with_value(record: Mapping[str, Any], key: str, remark: str) -> Text:
    """Return a remark with a number from a metric record: "12.5 N m without friction"; empty without the number."""
    value = value_from_record(record, key)
    return "" if value.number is None else words("{value} {remark}", value=value, remark=remark)


def dimensions_text(linkage: Linkage) -> Text:
    """Return crank, rod and offset of a linkage, and its branch if crossed."""
    crossed = "" if linkage.branch == "open" else ", crossed"
    sizes = {name: Value(float(getattr(linkage, name)), LENGTH) for name in DIMENSIONS}
    return words("crank {crank}, rod {rod}, offset {offset}{crossed}", crossed=crossed, **sizes)
