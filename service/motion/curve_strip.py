"""A small picture of a curve over a crank turn, with dead centres and a line moved by a script."""

from __future__ import annotations

import math
from html import escape

from ...objectives.kinds import unit_text
from ...optimise.front.constant import is_constant
from ..designs.cycle_table import CurveColumn
from ..figures.numerals import shown

_WIDTH, _HEIGHT = 360.0, 64.0  # one unit a degree


def curve_strip(column: CurveColumn, inner: float, outer: float) -> str:
    """Return the picture as HTML. inner, outer: dead centres, deg."""
    known = [value for value in column.values if math.isfinite(value)]
    low, high = (min(known), max(known)) if known else (0.0, 1.0)
    span = (abs(high) or 1.0) if is_constant((low, high)) else high - low
    lines = [
        f'<line class="dead" x1="{angle:.2f}" x2="{angle:.2f}" y1="0" y2="{_HEIGHT:g}"/>' for angle in (inner, outer)
    ]
    if low < 0.0 < high:
        zero = _height(0.0, low, span)
        lines.append(f'<line class="zero" x1="0" x2="{_WIDTH:g}" y1="{zero:.2f}" y2="{zero:.2f}"/>')
    path, pen = [], "M"
    step = _WIDTH / len(column.values)
    for place in range(len(column.values) + 1):
        value = column.values[place % len(column.values)]
        if math.isfinite(value):
            path.append(f"{pen}{place * step:g} {_height(value, low, span):.2f}")
            pen = "L"
        else:
            pen = "M"
    return (
        f"<figure><figcaption>{escape(column.title)}, {escape(unit_text(column.unit))} "
        f"<small>{shown(low)} to {shown(high)}</small></figcaption>"
        f'<svg class="strip" viewBox="0 0 {_WIDTH:g} {_HEIGHT:g}" preserveAspectRatio="none" aria-hidden="true">'
        f'{"".join(lines)}<path d="{"".join(path)}"/>'
        f'<line class="now" x1="0" x2="0" y1="0" y2="{_HEIGHT:g}"/></svg></figure>'
    )


def _height(value: float, low: float, span: float) -> float:
    return 3.0 + (_HEIGHT - 6.0) * (1.0 - (value - low) / span)
