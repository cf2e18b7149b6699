"""Text and figures of analyses in inches: what is told in metric units, with every value and unit of it changed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from ...objectives.kinds import PRESSURE, SHOWN, TIME, unit_text
from ..figures.sheets import Line, Panel, Sheet
from .block import Block
from .exact_numbers import TAG, changed, plain

_NUMBER = rf"[-+−]?\d[\d.]*(?:e[-+]?\d+)?{TAG}"
_JOINED = rf"(?:± )?{_NUMBER}(?:(?:, | to | and | or | x | / | ± ){_NUMBER})*"
_LEAST_DIGITS = 4  # 0.7 mm is 0.02756 in


@cache
def _units() -> dict[str, tuple[str, float]]:
    """Return the inch unit and the factor of every metric one, as job files and as texts write it."""
    found = {"bar": (PRESSURE, 1e5), "s": (TIME, 1.0)}
    found |= {kind.metric.symbol: (kind, 1.0 / kind.metric.factor) for kind in SHOWN}
    found |= {unit_text(symbol): of for symbol, of in found.items()}
    return {
        symbol: (symbol, 1.0)
        if kind.inch is None
        else (unit_text(kind.inch.symbol) if symbol == unit_text(symbol) else kind.inch.symbol, size * kind.inch.factor)
        for symbol, (kind, size) in found.items()
    }


@cache
def _patterns() -> tuple[re.Pattern[str], re.Pattern[str]]:
    """Return what finds values with a unit in a sentence, and the unit at the end of a head."""
    units = "|".join(map(re.escape, sorted(_units(), key=len, reverse=True)))
    values = rf"(?<![\"“'\w.^])(?<![\"“'][-+−])(?<!\de[-+])({_JOINED}\)?) ({units})(?![\w^/²³])"
    return re.compile(values), re.compile(rf"(?:^|(?<=[\s,]))({units})$")


def sentence_in_inches(sentence: str) -> str:
    """Return a sentence with its values in inch units; what is quoted was typed by somebody, and stays."""
    return plain(_patterns()[0].sub(lambda found: _with_unit(found[1], found[2]), sentence))


def block_in_inches(block: Block) -> Block:
    """Return a sentence or table in inch units.

    A number of a table has the unit at the end of the head of its column, else that of the cell of its row that is
    nothing but a unit.
    """
    heads = [None if sentence_in_inches(head) != head else _patterns()[1].search(head) for head in block.heads]
    of_column = [None if found is None else found[1] for found in heads]
    told = tuple(
        sentence_in_inches(head) if found is None else f"{plain(head[: found.start()])}{_units()[found[1]][0]}"
        for head, found in zip(block.heads, heads, strict=True)
    )
    rows = tuple(_row(cells, of_column) for cells in block.rows)
    return replace(block, sentence=sentence_in_inches(block.sentence), heads=told, rows=rows)


def sheet_in_inches(sheet: Sheet) -> Sheet:
    """Return a figure whose axes have inch units."""
    panels = tuple(map(_panel, sheet.panels))
    return replace(sheet, subtitle=sentence_in_inches(sheet.subtitle), panels=panels)


def _panel(panel: Panel) -> Panel:
    """Return a panel in inch units; both axes end with their unit."""
    (title, up), (across, along) = map(_axis, (panel.title, panel.across))

    def scaled(line: Line) -> Line:
        return replace(line, label=sentence_in_inches(line.label), x=along * line.x, y=up * line.y)

    return replace(
        panel,
        title=title,
        across=across,
        lines=tuple(map(scaled, panel.lines)),
        names=tuple((text, along * x, up * y) for text, x, y in panel.names),
        level=None if panel.level is None else (panel.level[0], up * panel.level[1]),
        shaded=tuple((along * start, along * end) for start, end in panel.shaded),
        note=sentence_in_inches(panel.note),
        noted=tuple(up * value for value in panel.noted),
    )


def _axis(title: str) -> tuple[str, float]:
    """Return the title of an axis in inch units, and what one of its metric unit is in that."""
    found = _patterns()[1].search(title)
    if found is None:
        return title, 1.0
    unit, factor = _units()[found[1]]
    return f"{sentence_in_inches(title[: found.start()])}{unit}", factor


def _row(cells: Sequence[str], of_column: Sequence[str | None]) -> tuple[str, ...]:
    of_row = next((cell for cell in cells if cell in _units()), None)
    return tuple(_cell(cell, unit or of_row, own=unit is not None) for cell, unit in zip(cells, of_column, strict=True))


def _cell(cell: str, unit: str | None, *, own: bool) -> str:
    if unit is None:
        return sentence_in_inches(cell)
    if cell == unit and not own:
        return _units()[unit][0]
    return _scaled(cell, unit) if re.fullmatch(_JOINED, cell) else sentence_in_inches(cell)


def _with_unit(numbers: str, unit: str) -> str:
    return f"{_scaled(numbers, unit)} {_units()[unit][0]}"


def _scaled(numbers: str, unit: str) -> str:
    """Return numbers in the inch unit, with as many digits as they have, four at least."""
    return plain(re.sub(_NUMBER, lambda found: _number(found[0], _units()[unit][1]), numbers))


def _number(text: str, factor: float) -> str:
    if factor == 1.0:
        return text
    if exact := changed(text, factor, _LEAST_DIGITS):
        return exact
    value = float(text.replace("−", "-")) * factor
    digits = max(len(re.sub(r"e.*|[-+−.]", "", text).lstrip("0")), _LEAST_DIGITS)
    if "e" not in text:
        digits = max(digits, len(str(int(abs(value)))))
    return f"{value:{'+' if text.startswith('+') else ''}.{digits}g}"
