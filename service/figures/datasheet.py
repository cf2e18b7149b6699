"""Datasheet of one design: scale drawing, numbers, and curves over the cycle."""

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...model.arrays import Array
from ...model.cycle.stroke_times import slow_stroke
from ...model.dynamics.segments import crank_angle_from_crowded, crowding_parameter
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.signals.first_peak import first_peaks
from ...model.signals.signals import Signal
from ...objectives.kinds import LENGTH, System, metric_unit_in, name_unit_and_factor_of_key, unit_text
from ...objectives.registry import QUANTITIES
from ...objectives.tables.cycle_curves import cycle_curves as all_curves
from ..render.blocks import Value, joined, words
from ..render.numerals import format_number
from .mechanism_drawing import draw_mechanism, least_transmission_crank_angle
from .panel_drawing import draw_panel
from .panel_figure import CRANK_ANGLE, Line, Panel, crank_angle_panel
from .style import INK, MUTED, SMALL, TEXT, add_axes, new_figure, write_heading, write_text

_WIDTH, _HEIGHT = 12.4, 7.4  # inches
_LEFT, _SPLIT, _RIGHT, _TOP, _BOTTOM = 0.25, 6.55, 0.3, 0.75, 0.6
_GAP = 0.34
_TABLE = 2.05

_ROWS = 9  # rows per column of a two-column table
_LETTERS = 24  # characters of a title that fit beside its number
SAMPLES = 720
_TURN = 2.0 * np.pi
_SIDE_STEP = 1e-7
"""Offset in rad between a peak and the samples beside it, which show its height where the curve jumps."""
_STEP = 1e-5  # relative to the value: smooth curves change less between these samples


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

    numbers: metric row of the design in the table of quantities; missing numbers, None and NaN are omitted. bold:
    columns always shown, in bold, with their titles: the objectives. torque: whether the drive torque is known. system:
    unit system of the datasheet.
    """
    figure = new_figure(_WIDTH, _HEIGHT)
    write_heading(figure, textwrap.shorten(title, 120, placeholder=" ..."), subtitle)

    picture = add_axes(figure, _LEFT, _TABLE + 0.35, _SPLIT - _LEFT - 0.6, _HEIGHT - _TABLE - 1.05)
    draw_mechanism(picture, mechanism, linkage, system)
    caption = "Drawn where the transmission angle is least; dead centres in grey outline."
    write_text(figure, _LEFT, _TABLE + 0.18, caption, fontsize=SMALL, color=MUTED)
    rows = _table_rows(numbers, bold or {})
    tall = max(_ROWS, math.ceil(len(rows) / 2))
    for column in range(2):
        x, y = _LEFT + 2.95 * column, _TABLE - 0.12
        for key, name in rows[tall * column : tall * (column + 1)]:
            unit, factor = metric_unit_in(name_unit_and_factor_of_key(key)[1], system)
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


def _table_rows(numbers: Mapping[str, Any], objectives: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return columns and titles of the table entries: all objectives, and as many other quantities as fit."""

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


@dataclass(frozen=True)
class Curves:
    """Curves of one design. angles: (n,), deg. inner, outer: dead centres of one revolution, deg.

    panels: one per curve, with the slow stroke shaded; a marked extremum is a second line with one point of the curve.
    """

    angles: Array
    panels: tuple[Panel, ...]
    inner: float
    outer: float

    @property
    def last_turn_end(self) -> float:
        """End of the last revolution, deg."""
        return 360.0 * round(float(self.angles[-1]) / 360.0)


def cycle_curves(mechanism: Mechanism, linkage: Linkage, *, torque: bool = True) -> Curves:
    """Return the curves of one fully rotating linkage; all marked angles are among the sampled ones.

    Without a crank speed, velocity and acceleration are for one radian per second, that is per unit of crank speed.
    """
    dimensions = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    moving = mechanism if mechanism.speed else replace(mechanism, speed=1.0)
    inner, outer = (float(angle) for angle in linkage.dead_centre_angles)

    def peak(machine: Mechanism, signal: Signal) -> tuple[str, float, float | None]:
        sizes, places = first_peaks(machine, signal, dimensions)
        return "peak", float(places[0]), float(sizes[0])

    extremes: dict[str, tuple[str, float, float | None] | None] = {
        **({"torque": peak(mechanism, Signal.TORQUE)} if torque else {}),
        "transmission_angle": ("least", least_transmission_crank_angle(linkage), None),
        "slider_position": None,
        "slider_velocity": peak(moving, Signal.SLIDER_SPEED),
        "slider_acceleration": peak(moving, Signal.SLIDER_ACCELERATION),
    }
    kappa = crowding_parameter(*dimensions[0])
    crowded = [crank_angle_from_crowded(tau, kappa) for tau in np.linspace(0.0, 2.0 * np.pi, SAMPLES // 2)]
    # At a load step, the curve has different values on the two sides of the peak.
    near_extremes = [
        extreme[1] + side for extreme in extremes.values() if extreme for side in (-_SIDE_STEP, 0.0, _SIDE_STEP)
    ]
    marked = [inner, outer, *(angle for angle in near_extremes if angle >= 0.0)]
    even, turns = np.linspace(0.0, _TURN, SAMPLES + 1), cycle_turns(mechanism)
    turn_angles = [*np.mod(crowded, _TURN), *even, inner, outer]
    angles = np.unique(np.concatenate([*(np.add(turn_angles, number * _TURN) for number in range(turns)), marked]))
    degrees = np.degrees(angles)
    ends = joined([Value(x, LENGTH, 4, bare=True) for x in sorted(map(float, linkage.dead_centres))], " and ")
    computed = {curve.name: curve for curve in all_curves(mechanism, linkage, angles)}
    dead = float(np.degrees(inner)), float(np.degrees(outer))
    slow = str(slow_stroke(mechanism, linkage))
    x_title, shaded = CRANK_ANGLE, tuple[tuple[float, float], ...]()
    if slow in ("outward", "inward"):
        x_title += f" (shaded: {slow} stroke, the slow one)"
        # For counter-clockwise rotation, the outward stroke runs from the inner to the outer dead centre.
        start, end = dead if (slow == "outward") == (mechanism.direction > 0.0) else dead[::-1]
        shaded = ((start, end),) if start < end else ((0.0, end), (start, 360.0))
    panels = []
    for name, extreme in extremes.items():
        computed_curve = computed[name]
        lines, note = [Line("", degrees, computed_curve.values)], words("dead centres at {ends}", ends=ends)
        if extreme is not None:
            word, angle, size = extreme
            at = int(np.searchsorted(angles, angle))
            value = float(computed_curve.values[at])
            around = computed_curve.values[max(at - 1, 0) : at + 2]
            highest = float(around[np.argmax(np.abs(around))])
            if size is not None and abs(highest) > (1.0 + _STEP) * abs(value):
                value = math.copysign(size, highest)
            lines.append(Line("", degrees[at : at + 1], np.array([value]), points=True))
            note = words(
                f"{word} {{value}} at {format_number(degrees[at])}°",
                value=Value(value, computed_curve.kind, 4, bare=True),
            )
        panels.append(
            replace(
                crank_angle_panel(computed_curve.title, *lines, kind=computed_curve.kind, note=note),
                x_title=x_title,
                shaded=shaded,
            )
        )
    return Curves(degrees, tuple(panels), *dead)


def draw_curves(panels: Sequence[Axes], curves: Curves, system: System = "metric") -> None:
    """Draw each curve into its panel, from top to bottom, in a unit system."""
    for axes, panel in zip(panels, curves.panels, strict=True):
        draw_panel(axes, panel, system, has_x_title=axes is panels[-1])
        ends = (curves.inner, curves.outer)
        for angle in (end + turn for turn in np.arange(0.0, curves.last_turn_end, 360.0) for end in ends):
            axes.axvline(angle, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)), zorder=1)
    _name_dead_centres(panels[0], curves)


def _name_dead_centres(top: Axes, curves: Curves) -> None:
    """Label the dead centres above the topmost panel, within its width and clear of each other."""
    named = sorted([(curves.inner, "inner"), (curves.outer, "outer")])
    turns = curves.last_turn_end / 360.0
    close = named[1][0] - named[0][0] < 110.0 * turns
    for (angle, name), alignment in zip(named, ("right", "left"), strict=True):
        edge_alignment = (
            "left" if angle < 70.0 * turns else "right" if angle > curves.last_turn_end - 70.0 * turns else "center"
        )
        top.annotate(
            f"{name} dead centre {format_number(angle)}°",
            xy=(angle, 1.0),
            xycoords=top.get_xaxis_transform(),
            xytext=(0, 17),
            textcoords="offset points",
            ha=alignment if close and edge_alignment == "center" else edge_alignment,
            fontsize=SMALL,
            color=MUTED,
        )
