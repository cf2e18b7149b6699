"""Animated linkage as one HTML file with embedded drawing, curves and script, without downloads."""

import json
import math
from dataclasses import replace
from html import escape
from pathlib import Path
from string import Template

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...objectives.kinds import System, metric_unit_in, unit_text
from ...optimise.front.saved_front import is_constant
from ..designs.design_curves import CurveColumn
from ..drawings import layers as on
from ..drawings.svg import opening_tag, svg_elements
from ..render.numerals import format_number as number
from .playback import ANGLES, Playback, lever_playback, swing_playback, turn_playback

_PLAYER = Path(__file__).parent / "player"
_STRIP = (float(ANGLES), 64.0)  # width, one unit per degree of one revolution, and height
_STILL = (on.AXES, on.PATHS, on.INNER, on.OUTER, on.START, on.END, on.FRAME, on.CYLINDER)


def player_page(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    name: str,
    design: str = "",
    swing: Swing | None = None,
    system: System = "metric",
) -> bytes:
    """Return one linkage as an HTML file that plays its motion.

    The script turns the crank and looks up everything else in curves stored in the file. Their points are one degree
    apart or, for a swinging linkage, at evenly spaced times of its motion back and forth. name: name of the run.
    design: design label, such as "design 3". swing: swing of the crank instead of full rotation. system: unit system of
    the numbers shown. Raises `AssemblyError` for a linkage that does not rotate fully, or the errors of
    `require_swing`.
    """
    if swing is None:
        play = turn_playback(mechanism, linkage, system)
    else:
        play = (swing_playback if mechanism.lever is None else lever_playback)(mechanism, linkage, swing, system)
    factors = {column.key: metric_unit_in(column.unit, system)[1] for column in play.columns}
    play = replace(
        play,
        columns=[_column_in_units(column, system) for column in play.columns],
        ends={
            key: (factor * play.ends[key][0], factor * play.ends[key][1])
            for key, factor in factors.items()
            if key in play.ends
        },
    )
    title = f"{name}, {design}" if design else name
    readout = (
        f'<div><dt>{escape(column.title)}</dt><dd><output data-curve="{escape(column.key)}"></output> '
        f"<span>{escape(unit_text(column.unit))}</span></dd></div>"
        for column in play.columns
    )
    template = Template((_PLAYER / "player.html").read_text(encoding="utf-8"))
    page = template.substitute(
        title=escape(title),
        summary=escape(play.summary),
        style=(_PLAYER / "player.css").read_text(encoding="utf-8"),
        script=(_PLAYER / "player.js").read_text(encoding="utf-8"),
        data=_script_data(play),
        drawing=_drawing(play, title),
        strips="\n".join(_curve_strip(column, play) for column in play.columns),
        degrees=360 * play.turns,
        readout="\n".join(readout),
        control=play.words.control,
        times=play.words.times,
        over=play.words.span_name,
        note=play.words.note,
    )
    return page.encode()


def _column_in_units(column: CurveColumn, system: System) -> CurveColumn:
    """Return a curve with its values in a unit system. Its key stays the same: the script finds the curve by it."""
    unit, factor = metric_unit_in(column.unit, system)
    return replace(column, unit=unit, values=[factor * value for value in column.values])


def _script_data(play: Playback) -> str:
    """Return the data for the script as JSON that is safe inside HTML."""
    curves = {
        column.key: [float(f"{value:.7g}") if math.isfinite(value) else None for value in column.values]
        for column in play.columns
    }
    record = {**play.record, "turns": play.turns, "times": play.words.times, "curves": curves}
    return json.dumps(record, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def _drawing(play: Playback, title: str) -> str:
    (left, low, right, high), size = play.extent, play.size
    margin = 0.04 * size
    frame = f"{left - margin:.9g} {-high - margin:.9g} {right - left + 2 * margin:.9g} {high - low + 2 * margin:.9g}"
    lines = [f'<svg id="drawing" viewBox="{frame}" role="img" aria-label="{escape(title, quote=True)}, moving">']
    for layer in _STILL:
        shapes = [shape for shape in play.still if shape.layer is layer]
        if shapes:
            lines += [opening_tag(layer, size), *(line for shape in shapes for line in svg_elements(shape)), "</g>"]
    for name, shapes in play.moving.items():
        layer = shapes[0].layer
        lines.append(opening_tag(layer, size).replace(f'id="{layer.name}"', f'id="{name}" class="part"', 1))
        lines += [*(line for shape in shapes for line in svg_elements(shape)), "</g>"]
    return "\n".join([*lines, "</svg>"])


def _curve_strip(column: CurveColumn, play: Playback) -> str:
    """Return a strip chart of a curve with the marks of a motion and a cursor that the script moves."""
    marks = (angle / play.turns for angle in play.marks)
    finite = [value for value in column.values if math.isfinite(value)]
    low, high = (min(finite), max(finite)) if finite else (0.0, 1.0)
    least, greatest = play.ends.get(column.key, (low, high))
    span = (abs(high) or 1.0) if is_constant((low, high)) else high - low
    lines = [f'<line class="dead" x1="{angle:.2f}" x2="{angle:.2f}" y1="0" y2="{_STRIP[1]:g}"/>' for angle in marks]
    if low < 0.0 < high:
        zero = _relative_height(0.0, low, span)
        lines.append(f'<line class="zero" x1="0" x2="{_STRIP[0]:g}" y1="{zero:.2f}" y2="{zero:.2f}"/>')
    path, pen = [], "M"
    step = _STRIP[0] / len(column.values)
    for place in range(len(column.values) + 1):
        value = column.values[place % len(column.values)]
        if math.isfinite(value):
            path.append(f"{pen}{place * step:g} {_relative_height(value, low, span):.2f}")
            pen = "L"
        else:
            pen = "M"
    return (
        f"<figure><figcaption>{escape(column.title)}, {escape(unit_text(column.unit))} "
        f"<small>{number(least)} to {number(greatest)}</small></figcaption>"
        f'<svg class="strip" viewBox="0 0 {_STRIP[0]:g} {_STRIP[1]:g}" preserveAspectRatio="none" aria-hidden="true">'
        f'{"".join(lines)}<path d="{"".join(path)}"/>'
        f'<line class="now" x1="0" x2="0" y1="0" y2="{_STRIP[1]:g}"/></svg></figure>'
    )


def _relative_height(value: float, low: float, span: float) -> float:
    return 3.0 + (_STRIP[1] - 6.0) * (1.0 - (value - low) / span)
