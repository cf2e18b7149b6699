"""A report as a document: what it says, before it is HTML or PDF."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from matplotlib.figure import Figure

Tone = Literal["plain", "note", "good", "bad"]


@dataclass(frozen=True)
class Paragraph:
    """Text. tone: plain; note, in small; good or bad, for what was checked."""

    text: str
    tone: Tone = "plain"


@dataclass(frozen=True)
class Facts:
    """Names with what there is to say of each, one or more lines."""

    rows: Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class Table:
    """A table. heads: of the columns. right: which of them are aligned to the right. bold: rows, counted from 0.

    wide: shares of the width of the columns.
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
    """A figure that is drawn when it is needed.

    raster: as points instead of lines, for thousands of marks. tallest: on paper, inches.
    """

    title: str
    draw: Callable[[], Figure] = field(repr=False)
    raster: bool = False
    tallest: float = 6.9


Block = Paragraph | Facts | Table | Picture


@dataclass(frozen=True)
class Section:
    """A part of a report with its heading."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Report:
    """A report. made: when, in words. signatures: who signs."""

    title: str
    subtitle: str
    date: str
    sections: tuple[Section, ...]
    signatures: tuple[str, ...] = ("Prepared", "Reviewed", "Approved")
