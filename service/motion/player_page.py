"""The moving linkage as one HTML file: drawing, curves and script in it, nothing fetched."""

from __future__ import annotations

import json
import math
from html import escape
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import unit_text
from ...optimise.front.constant import is_constant
from ..designs.cycle_table import CurveColumn, cycle_table
from ..drawings import layers as on
from ..drawings.parts import bar, block, in_words, look_of, scenery
from ..drawings.shapes import Circle, Shape
from ..drawings.svg import elements, group
from ..figures.numerals import shown as number

ANGLES = 360
_PLAYER = Path(__file__).parent / "player"
_READOUT = (
    "slider_position_mm",
    "slider_velocity",
    "slider_acceleration",
    "transmission_angle_deg",
    "torque_Nm",
)
"""Curves that are read out, and their strips, by how their keys begin."""
_STRIP = (360.0, 64.0)  # width, one unit a degree, and height
_STILL = (on.AXES, on.PATHS, on.INNER, on.OUTER, on.FRAME)


def player_page(mechanism: Mechanism, linkage: Linkage, *, name: str, design: str = "") -> bytes:
    """Return one fully turning linkage as an HTML file that plays its motion.

    The script turns the crank and looks up everything else, one degree apart, in curves that are in the file. name: of
    the run. design: which of it, "design 3". Raises `AssemblyError` for a linkage that does not turn fully.
    """
    curves = cycle_table(mechanism, linkage, angles=ANGLES)
    shown = [column for key in _READOUT for column in curves if column.key.startswith(key)]
    title = f"{name}, {design}" if design else name
    inner, outer = (math.degrees(float(angle)) for angle in linkage.dead_centre_angles)
    template = Template((_PLAYER / "player.html").read_text(encoding="utf-8"))
    page = template.substitute(
        title=escape(title),
        summary=escape(_summary(mechanism, linkage)),
        style=(_PLAYER / "player.css").read_text(encoding="utf-8"),
        script=(_PLAYER / "player.js").read_text(encoding="utf-8"),
        data=_data(mechanism, linkage, shown),
        drawing=_drawing(mechanism, linkage, title),
        strips="\n".join(_strip(column, inner, outer) for column in shown),
        readout="\n".join(_row(column) for column in shown),
    )
    return page.encode()


def _summary(mechanism: Mechanism, linkage: Linkage) -> str:
    rpm = mechanism.speed * 30.0 / math.pi
    turning = f"{abs(rpm):.6g} rpm, {'clockwise' if rpm < 0.0 else 'counter-clockwise'}" if rpm else "no crank speed"
    return f"{in_words(linkage, 6)}; {turning}"


def _data(mechanism: Mechanism, linkage: Linkage, shown: list[CurveColumn]) -> str:
    """Return the data of the script as JSON that may stand in HTML."""
    turn = linkage.at(np.arange(ANGLES) * (2.0 * math.pi / ANGLES))
    rod = np.degrees(np.unwrap(turn.rod_angle))
    record: dict[str, Any] = {
        "crank": 1e3 * float(linkage.crank),
        "offset": 1e3 * float(linkage.offset),
        "slider": [round(1e3 * float(x), 9) for x in turn.slider_position],
        "rod": [round(float(angle), 7) for angle in rod],
        "direction": -1 if mechanism.speed < 0.0 else 1,
        "turnsPerSecond": abs(mechanism.speed) / (2.0 * math.pi),
        "curves": {
            column.key: [float(f"{value:.7g}") if math.isfinite(value) else None for value in column.values]
            for column in shown
        },
    }
    return json.dumps(record, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def _drawing(mechanism: Mechanism, linkage: Linkage, title: str) -> str:
    look = look_of(mechanism, linkage)
    (left, low, right, high), size = look.extent, look.size
    margin = 0.04 * size
    frame = f"{left - margin:.9g} {-high - margin:.9g} {right - left + 2 * margin:.9g} {high - low + 2 * margin:.9g}"
    still = scenery(linkage, look, below=True)
    pin = (0.0, 0.0)
    moving: dict[str, Shape] = {  # each in its own coordinates
        "slider": block(on.SLIDER, pin, look.block),
        "rod": bar(on.ROD, pin, (look.rod, 0.0), look.rod_width),
        "crank": bar(on.CRANK, pin, (look.crank, 0.0), look.crank_width),
        **dict.fromkeys(("pivot", "crank-pin", "slider-pin"), Circle(on.PINS, pin, look.pin)),
    }
    lines = [f'<svg id="drawing" viewBox="{frame}" role="img" aria-label="{escape(title, quote=True)}, moving">']
    for layer in _STILL:
        lines.append(group(layer, size))
        lines += [line for shape in still if shape.layer is layer for line in elements(shape)]
        lines.append("</g>")
    for name, shape in moving.items():
        start = group(shape.layer, size).replace(f'id="{shape.layer.name}"', f'id="{name}" class="part"', 1)
        lines += [start, *elements(shape), "</g>"]
    return "\n".join([*lines, "</svg>"])


def _row(column: CurveColumn) -> str:
    return (
        f'<div><dt>{escape(column.title)}</dt><dd><output data-curve="{escape(column.key)}"></output> '
        f"<span>{escape(unit_text(column.unit))}</span></dd></div>"
    )


def _strip(column: CurveColumn, inner: float, outer: float) -> str:
    """Return a small picture of a curve with dead centres, deg, and a line that the script moves."""
    known = [value for value in column.values if math.isfinite(value)]
    low, high = (min(known), max(known)) if known else (0.0, 1.0)
    span = (abs(high) or 1.0) if is_constant((low, high)) else high - low
    lines = [
        f'<line class="dead" x1="{angle:.2f}" x2="{angle:.2f}" y1="0" y2="{_STRIP[1]:g}"/>' for angle in (inner, outer)
    ]
    if low < 0.0 < high:
        zero = _height(0.0, low, span)
        lines.append(f'<line class="zero" x1="0" x2="{_STRIP[0]:g}" y1="{zero:.2f}" y2="{zero:.2f}"/>')
    path, pen = [], "M"
    step = _STRIP[0] / len(column.values)
    for place in range(len(column.values) + 1):
        value = column.values[place % len(column.values)]
        if math.isfinite(value):
            path.append(f"{pen}{place * step:g} {_height(value, low, span):.2f}")
            pen = "L"
        else:
            pen = "M"
    return (
        f"<figure><figcaption>{escape(column.title)}, {escape(unit_text(column.unit))} "
        f"<small>{number(low)} to {number(high)}</small></figcaption>"
        f'<svg class="strip" viewBox="0 0 {_STRIP[0]:g} {_STRIP[1]:g}" preserveAspectRatio="none" aria-hidden="true">'
        f'{"".join(lines)}<path d="{"".join(path)}"/>'
        f'<line class="now" x1="0" x2="0" y1="0" y2="{_STRIP[1]:g}"/></svg></figure>'
    )


def _height(value: float, low: float, span: float) -> float:
    return 3.0 + (_STRIP[1] - 6.0) * (1.0 - (value - low) / span)
