"""Report as a document: its content before rendering to HTML or PDF."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from matplotlib.figure import Figure

Tone = Literal["plain", "note", "good", "bad"]


@dataclass(frozen=True)
class Paragraph:
    """Paragraph. tone: "plain"; "note" in small print; "good" or "bad" for checks."""

    text: str
    tone: Tone = "plain"


@dataclass(frozen=True)
class Facts:
    """Names, each with one or more lines of text."""

    rows: Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class Table:
    """Table. heads: column headings. right: positions of right-aligned columns. bold: positions of bold rows, from 0.

    wide: relative widths of the columns.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    wide: tuple[float, ...]
    right: frozenset[int] = frozenset()
    bold: frozenset[int] = frozenset()
    small: bool = False


@dataclass(frozen=True)
class Picture:
    """Figure, drawn when needed.

    raster: whether to use pixels instead of vectors, for thousands of marks. tallest: maximum height on paper, inches.
    """

    title: str
    draw: Callable[[], Figure] = field(repr=False)
    raster: bool = False
    tallest: float = 6.9


Block = Paragraph | Facts | Table | Picture


@dataclass(frozen=True)
class Section:
    """Part of a report with its heading."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Report:
    """Report. made: date in words. signatures: roles of the people who sign."""

    title: str
    subtitle: str
    date: str
    sections: tuple[Section, ...]
    signatures: tuple[str, ...] = ("Prepared", "Reviewed", "Approved")
