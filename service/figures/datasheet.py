"""Datasheet of one design: scale drawing, numbers, and curves over the cycle."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.column_keys import split_unit
from ...objectives.kinds import System, metric_unit_in, unit_text
from ...objectives.registry import QUANTITIES
from ..render.numerals import format_number
from .curves import cycle_curves, draw_curves
from .drawing import draw_mechanism
from .style import INK, MUTED, SMALL, TEXT, add_axes, heading, new_figure, write_text

_WIDTH, _HEIGHT = 12.4, 7.4  # inches
_LEFT, _SPLIT, _RIGHT, _TOP, _BOTTOM = 0.25, 6.55, 0.3, 0.75, 0.6
_GAP = 0.34
_TABLE = 2.05

_ROWS = 9  # of each of two columns
_LETTERS = 24  # of a title that fits beside its number


def design_datasheet(
    mechanism: Mechanism,
    linkage: Linkage,
    numbers: Mapping[str, Any],
    *,
    title: str,
    subtitle: str = "",
    bold: Mapping[str, str] | None = None,
    torque: bool = True,
    system: System = "metric",
) -> Figure:
    """Return the datasheet of one fully rotating linkage.

    numbers: its metric row of the table of quantities; missing numbers, None and NaN are omitted. bold: columns always
    shown, in bold, with their titles: the objectives. torque: whether the drive torque is known. system: system of
    units of the sheet.
    """
    figure = new_figure(_WIDTH, _HEIGHT)
    heading(figure, textwrap.shorten(title, 120, placeholder=" ..."), subtitle)

    picture = add_axes(figure, _LEFT, _TABLE + 0.35, _SPLIT - _LEFT - 0.6, _HEIGHT - _TABLE - 1.05)
    draw_mechanism(picture, mechanism, linkage, system)
    caption = "Drawn where the transmission angle is least; dead centres in grey outline."
    write_text(figure, _LEFT, _TABLE + 0.18, caption, fontsize=SMALL, color=MUTED)
    rows = _rows(numbers, bold or {})
    tall = max(_ROWS, math.ceil(len(rows) / 2))
    for column in range(2):
        x, y = _LEFT + 2.95 * column, _TABLE - 0.12
        for key, name in rows[tall * column : tall * (column + 1)]:
            unit, factor = metric_unit_in(split_unit(key)[1], system)
            style: dict[str, Any] = {"weight": "bold" if key in (bold or {}) else "normal", "color": INK}
            name = textwrap.shorten(name, 2 * _LETTERS, placeholder=" ...")
            write_text(figure, x, y, name, fontsize=TEXT * min(1.0, _LETTERS / len(name)), **style)
            write_text(
                figure, x + 2.38, y, format_number(float(numbers[key]) * factor, 5, zeros=True), ha="right", **style
            )
            if unit:
                write_text(figure, x + 2.44, y, unit_text(unit), **style)
            y -= 0.2 * _ROWS / tall

    curves = cycle_curves(mechanism, linkage, torque=torque)
    count = len(curves.panels)
    height = (_HEIGHT - _TOP - _BOTTOM + _GAP) / count - _GAP
    width = _WIDTH - _SPLIT - _RIGHT
    feet = [_HEIGHT - _TOP - height - index * (height + _GAP) for index in range(count)]
    draw_curves([add_axes(figure, _SPLIT, foot, width, height) for foot in feet], curves, system)
    return figure


def _rows(numbers: Mapping[str, Any], objectives: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return column and title of the table's entries: all objectives, and as many others as fit."""

    def has_value(key: str) -> bool:
        value = numbers.get(key)
        return value is not None and not math.isnan(float(value))

    usual = {f"{name}_mm": name for name in DIMENSIONS}
    usual |= {quantity.field: quantity.short_title for quantity in QUANTITIES.values() if quantity.on_datasheet}
    extra = {key: title for key, title in objectives.items() if key not in usual}
    defined = [key for key in usual if has_value(key)]
    free_rows = 2 * _ROWS - len([key for key in extra if has_value(key)])
    spare = [key for key in reversed(defined) if key not in objectives][: max(0, len(defined) - free_rows)]
    fitting = {key: title for key, title in usual.items() if key in defined and key not in spare}
    return list((fitting | {key: title for key, title in extra.items() if has_value(key)}).items())
