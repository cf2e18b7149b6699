"""A report laid out on A4 pages: from the top down, tables broken between rows, figures where they fit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D

from ...objectives.kinds import SHOWN, unit_text
from ..figures.style import INK, MUTED, new_figure, write
from .document import Facts, Paragraph, Picture, Report, Section, Table, Tone

WIDTH, HEIGHT = 8.27, 11.69  # inches, A4
_LEFT, _RIGHT, _TOP, _BOTTOM = 0.75, 0.75, 0.75, 0.85
_ACROSS = WIDTH - _LEFT - _RIGHT
_TEXT, _SMALL, _HEAD, _TITLE = 8.8, 7.0, 12.0, 16.0  # points
_LEADING = 1.38 / 72.0  # inches of a line, by the size of its text
_NAMES = 1.45  # width of the names of facts
_INKS: dict[Tone, str] = {"plain": INK, "note": MUTED, "good": "#1c6b30", "bad": "#a8321f"}
_MARKS: dict[Tone, str] = {"plain": "", "note": "", "good": "✓ ", "bad": "✗ "}
_TALLEST = 6.6  # of a figure
_SHRUNK = 0.7  # of its size, rather than leaving the foot of a page empty
_BETWEEN = 0.09  # columns
_HEADED = 0.2 + _HEAD * _LEADING + 0.09  # height of a heading
_TITLED = 0.4  # height of the title of a figure, and of what is left around it
_UNITS = sorted({unit_text(face.symbol) for of in SHOWN for face in (of.metric, of.inch) if face}, key=len)[::-1]
_UNIT = "|".join(map(re.escape, [*_UNITS, "%"]))
_OF_NUMBER = re.compile(rf"(?<=\d) (?:{_UNIT})(?![\w/])|(?<=,) (?:{_UNIT})$|^(?:{_UNIT})$")
"""A unit behind its number, at the end of a head, or alone."""
_KEPT = "\u00a0"  # a space at which no line is broken


@dataclass(frozen=True)
class Inset:
    """A figure on a page. left, bottom: inches. scale: of its own size."""

    figure: Figure
    left: float
    bottom: float
    scale: float
    raster: bool


@dataclass
class Page:
    """A page: texts and lines on a figure of its size, and other figures on it."""

    figure: Figure = field(default_factory=lambda: new_figure(WIDTH, HEIGHT))
    insets: list[Inset] = field(default_factory=list)


def pages(report: Report) -> list[Page]:
    """Return the pages of a report."""
    layout = _Layout()
    layout.lines(wrapped(report.title, _TITLE, _ACROSS, bold=True), _TITLE, bold=True)
    layout.lines(wrapped(f"{report.subtitle}; {report.made}", _TEXT, _ACROSS), _TEXT, ink=MUTED)
    layout.rule(INK, 1.2)
    for place, section in enumerate(report.sections):
        layout.section(section)
        if place == 0:
            layout.signatures(report.signatures)
    count = len(layout.pages)
    for number, page in enumerate(layout.pages, 1):
        foot = wrapped(report.title, _SMALL, _ACROSS - 1.2)[0]
        write(page.figure, _LEFT, 0.45, foot, fontsize=_SMALL, color=MUTED)
        write(page.figure, WIDTH - _RIGHT, 0.45, f"{number} of {count}", fontsize=_SMALL, color=MUTED, ha="right")
    return layout.pages


class _Layout:
    """Pages as they are filled. y: where the next thing begins, inches from the bottom."""

    def __init__(self) -> None:
        self.pages: list[Page] = [Page()]
        self.y = HEIGHT - _TOP

    def room(self, height: float) -> None:
        """Begin another page unless so much fits on this one."""
        if self.y - height < _BOTTOM and self.y < HEIGHT - _TOP:
            self.pages.append(Page())
            self.y = HEIGHT - _TOP

    def lines(
        self, lines: Sequence[str], size: float, *, left: float = _LEFT, bold: bool = False, ink: str = INK
    ) -> None:
        """Write lines of text below one another."""
        for line in lines:
            self.room(size * _LEADING)
            self.y -= size * _LEADING
            self._text(left, line, size, bold=bold, ink=ink)

    def rule(self, ink: str, width: float, *, below: float = 0.05) -> None:
        """Draw a line across."""
        self.y -= below
        ends = (_LEFT / WIDTH, 1.0 - _RIGHT / WIDTH)
        self.pages[-1].figure.add_artist(Line2D(ends, (self.y / HEIGHT,) * 2, color=ink, linewidth=width))

    def section(self, section: Section) -> None:
        """Write a heading and what is below it."""
        # A heading is not left alone at the foot of a page.
        first, *others = section.blocks
        told = isinstance(first, Paragraph) and bool(others) and isinstance(others[0], Table)
        headed = first if isinstance(first, Picture) else None
        figure = headed.draw() if headed is not None else None
        self.room(2.6 if told else 1.3 if figure is None else self._tall(figure, above=_HEADED) + _HEADED)
        self.y -= 0.2
        self.lines([section.title], _HEAD, bold=True)
        self.rule("#c8c8c8", 0.8)
        self.y -= 0.04
        if headed is not None and figure is not None:
            self.picture(headed.title, figure, raster=headed.raster)
        for block, after in zip(section.blocks, (*section.blocks[1:], None), strict=True):
            if isinstance(block, Paragraph) and isinstance(after, Table):
                self.room(1.3)  # what is said of a table stays with it
            if isinstance(block, Facts):
                self.facts(block, tail=2.0 * _TEXT * _LEADING if isinstance(after, Paragraph) else 0.0)
            elif isinstance(block, Paragraph):
                self.paragraph(block)
            elif isinstance(block, Table):
                self.table(block)
            elif block is not headed:
                self.picture(block.title, block.draw(), raster=block.raster)

    def paragraph(self, paragraph: Paragraph) -> None:
        """Write text in the size and ink of its tone."""
        size, bold = _SMALL + 0.4 if paragraph.tone == "note" else _TEXT, paragraph.tone == "bad"
        self.y -= 0.03
        text = wrapped(_MARKS[paragraph.tone] + paragraph.text, size, _ACROSS, bold=bold)
        self.lines(text, size, ink=_INKS[paragraph.tone], bold=bold)
        self.y -= 0.03

    def facts(self, facts: Facts, *, tail: float) -> None:
        """Write names with what there is to say beside them. tail: inches of what stays with the last of them."""
        for place, (name, texts) in enumerate(facts.rows.items(), 1):
            lines = [line for text in texts for line in wrapped(text, _TEXT, _ACROSS - _NAMES)]
            self.room(min(len(lines), 4) * _TEXT * _LEADING + (tail if place == len(facts.rows) else 0.0))
            top = self.y - _TEXT * _LEADING
            page = self.pages[-1]
            write(page.figure, _LEFT, top, name, fontsize=_TEXT, color=MUTED)
            self.lines(lines, _TEXT, left=_LEFT + _NAMES)
            self.y -= 0.03

    def table(self, table: Table) -> None:
        """Write a table, its heads again on every page."""
        size = _SMALL if table.small else _TEXT - 0.6
        widths = _widths(table, size)
        cells = [self._cells(row, widths, size, bold=place in table.bold) for place, row in enumerate(table.rows)]
        heads = self._cells(table.heads, widths, size, bold=True)
        self.room((4 + max(map(len, heads))) * size * _LEADING + 0.3)
        if table.title:
            self.y -= 0.07
            self.lines([table.title], _TEXT, bold=True)
        self._row(table, heads, widths, size, bold=True)
        self.rule(INK, 0.8, below=0.045)
        for place, row in enumerate(cells):
            before = len(self.pages)
            self.room(max(map(len, row)) * size * _LEADING + 0.08)
            if len(self.pages) > before:
                self._row(table, heads, widths, size, bold=True)
                self.rule(INK, 0.8, below=0.045)
            self._row(table, row, widths, size, bold=place in table.bold)
            self.rule("#e2e2e2", 0.5, below=0.04)
        self.y -= 0.1

    def _cells(self, row: Sequence[str], widths: Sequence[float], size: float, *, bold: bool) -> list[list[str]]:
        return [wrapped(cell, size, width - _BETWEEN, bold=bold) for cell, width in zip(row, widths, strict=True)]

    def _row(self, table: Table, cells: list[list[str]], widths: Sequence[float], size: float, *, bold: bool) -> None:
        left, top = _LEFT, self.y - 0.02
        for place, (lines, width) in enumerate(zip(cells, widths, strict=True)):
            right = place in table.right
            for line, text in enumerate(lines, 1):
                self.y = top - line * size * _LEADING
                self._text(left + width - _BETWEEN if right else left, text, size, bold=bold, right=right)
            left += width
        self.y = top - max(map(len, cells)) * size * _LEADING

    def picture(self, title: str, figure: Figure, *, raster: bool) -> None:
        """Put a figure where it fits, its title above it."""
        height = self._tall(figure)
        self.room(height)
        self.y -= 0.06
        self.lines([title], _TEXT, bold=True)
        self.y -= height - _TITLED + 0.06
        self.pages[-1].insets.append(Inset(figure, _LEFT, self.y, (height - _TITLED) / figure.get_figheight(), raster))
        self.y -= 0.08

    def _tall(self, figure: Figure, *, above: float = 0.0) -> float:
        """Return the height of a figure and its title, a little smaller if it fits so below what stands above it."""
        width, height = figure.get_size_inches()
        scale = min(_ACROSS / width, _TALLEST / height, 1.0)
        left = self.y - _BOTTOM - _TITLED - 0.02 - above
        if _SHRUNK * scale * height <= left < scale * height:
            scale = left / height
        return float(scale * height) + _TITLED

    def signatures(self, names: Sequence[str]) -> None:
        """Leave room for names, dates and signatures."""
        self.room(1.0)
        self.y -= 0.75
        width = _ACROSS / len(names)
        for place, name in enumerate(names):
            left = _LEFT + place * width
            ends = (left / WIDTH, (left + width - 0.25) / WIDTH)
            figure = self.pages[-1].figure
            figure.add_artist(Line2D(ends, (self.y / HEIGHT,) * 2, color=INK, linewidth=0.7))
            write(figure, left, self.y - 0.15, f"{name} by, date", fontsize=_SMALL, color=MUTED)
        self.y -= 0.2

    def _text(
        self, x: float, text: str, size: float, *, bold: bool = False, ink: str = INK, right: bool = False
    ) -> None:
        style = {"fontsize": size, "color": ink, "ha": "right" if right else "left"}
        write(self.pages[-1].figure, x, self.y, text, weight="bold" if bold else "normal", **style)


def _widths(table: Table, size: float) -> list[float]:
    """Return the widths of a table's columns, inches: the shares it asks for, wider where a word would be broken."""
    asked = [share * _ACROSS for share in table.wide]
    least = []
    for place, head in enumerate(table.heads):
        words = [_longest_word(head, size, bold=True)]
        words += [_longest_word(row[place], size, bold=number in table.bold) for number, row in enumerate(table.rows)]
        least.append(max(words) + _BETWEEN + 1e-6)
    short = sum(max(need - width, 0.0) for need, width in zip(least, asked, strict=True))
    spare = sum(max(width - need, 0.0) for need, width in zip(least, asked, strict=True))
    if short > spare:
        return asked
    given = short / spare if spare > 0.0 else 0.0
    return [need if need >= width else width - given * (width - need) for need, width in zip(least, asked, strict=True)]


def wrapped(text: str, size: float, width: float, *, bold: bool = False) -> list[str]:
    """Return a text in lines of at most `width` inches at `size` points; a word too long is broken, a unit never."""
    lines: list[str] = []
    line = ""
    for word in _words(text):
        joined = f"{line} {word}".lstrip()
        if _width(joined, size, bold) <= width:
            line = joined
            continue
        if line:
            lines.append(line)
        line = word
        while _width(line, size, bold) > width and len(line) > 1:
            fits = len(line) - 1
            while fits > 1 and _width(line[:fits], size, bold) > width:
                fits -= 1
            lines.append(line[:fits])
            line = line[fits:]
    return [*lines, line] if line or not lines else lines


def _words(text: str) -> list[str]:
    """Return what lines may be broken between: words, a unit with its number."""
    kept = _OF_NUMBER.sub(lambda found: found[0].replace(" ", _KEPT), " ".join(text.split()))
    return [word for word in kept.split(" ") if word]


def _longest_word(text: str, size: float, *, bold: bool = False) -> float:
    """Return the width of the longest word of a text, inches, in letters of `size` points."""
    return max((_width(word, size, bold) for word in _words(text)), default=0.0)


def _width(text: str, size: float, bold: bool) -> float:
    """Return the width of a line, inches; letters moved together for looks would make it a little less."""
    return sum(_letter(letter, bold) for letter in text) * size


@cache
def _letter(letter: str, bold: bool) -> float:
    """Return the width of a letter of a font of one point, inches."""
    renderer, plain, heavy = _measure()
    return float(renderer.get_text_width_height_descent(letter, heavy if bold else plain, False)[0]) / 72.0 / 100.0


@cache
def _measure() -> tuple[Any, Any, Any]:
    """Return a renderer that measures text, and fonts of 100 points, normal and bold."""
    renderer: Any = RendererAgg(10, 10, 72.0)  # type: ignore[no-untyped-call]
    return renderer, FontProperties(size=100.0), FontProperties(size=100.0, weight="bold")
