"""The sheet of one design: drawn to scale, its numbers, and its curves over the cycle."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Mapping
from typing import Any

from matplotlib.figure import Figure

from ...model.linkage import Linkage
from ...model.mechanism import Mechanism
from ...objectives.kinds import System, shown_in
from .curves import cycle_curves, draw_curves
from .drawing import draw_mechanism
from .style import INK, MUTED, SMALL, TEXT, TITLE, new_figure, place, shown, unit_text, write

_WIDTH, _HEIGHT = 12.4, 7.4  # inches
_LEFT, _SPLIT, _RIGHT, _TOP, _BOTTOM = 0.25, 6.55, 0.3, 0.75, 0.6
_GAP = 0.34
_TABLE = 2.05

# Two columns of (title, column, unit), where there is a value.
_NUMBERS = (
    (
        ("crank", "crank_mm", "mm"),
        ("rod", "rod_mm", "mm"),
        ("offset", "offset_mm", "mm"),
        ("stroke", "stroke_mm", "mm"),
        ("rod to crank", "rod_to_crank", ""),
        ("rod to offset", "rod_to_offset", ""),
        ("time ratio", "time_ratio", ""),
        ("least transmission angle", "least_transmission_angle_deg", "deg"),
        ("footprint", "footprint_m2", "m^2"),
    ),
    (
        ("peak torque", "peak_torque_Nm", "N m"),
        ("RMS torque", "rms_torque_Nm", "N m"),
        ("position error", "position_error_mm", "mm"),
        ("peak pivot force", "peak_pivot_force_N", "N"),
        ("peak crank pin force", "peak_crank_pin_force_N", "N"),
        ("peak slider pin force", "peak_slider_pin_force_N", "N"),
        ("peak guide force", "peak_guide_force_N", "N"),
        ("peak slider speed", "peak_slider_speed_m_s", "m/s"),
        ("peak slider acceleration", "peak_slider_acceleration_m_s2", "m/s^2"),
    ),
)


def design_sheet(
    mechanism: Mechanism,
    linkage: Linkage,
    numbers: Mapping[str, Any],
    *,
    title: str,
    subtitle: str = "",
    bold: Collection[str] = (),
    torque: bool = True,
    system: System = "metric",
) -> Figure:
    """Return the sheet of one fully turning linkage.

    numbers: its row of the table of quantities; those that are missing or None are left out. bold: columns printed
    bold. torque: whether the drive torque is known. system: of the units that all is shown in.
    """
    figure = new_figure(_WIDTH, _HEIGHT)
    title = textwrap.shorten(title, 120, placeholder=" ...")
    write(figure, _LEFT, _HEIGHT - 0.33, title, fontsize=TITLE, weight="bold")
    write(figure, _LEFT, _HEIGHT - 0.53, subtitle, color=MUTED)

    picture = place(figure, _LEFT, _TABLE + 0.35, _SPLIT - _LEFT - 0.6, _HEIGHT - _TABLE - 1.05)
    draw_mechanism(picture, mechanism, linkage, system)
    caption = "Drawn where the transmission angle is least; dead centres in grey outline."
    write(figure, _LEFT, _TABLE + 0.18, caption, fontsize=SMALL, color=MUTED)
    for column, rows in enumerate(_NUMBERS):
        _column(figure, _LEFT + 2.95 * column, rows, numbers, bold, system)

    curves = cycle_curves(mechanism, linkage, torque=torque, system=system)
    count = len(curves.curves)
    height = (_HEIGHT - _TOP - _BOTTOM + _GAP) / count - _GAP
    width = _WIDTH - _SPLIT - _RIGHT
    feet = [_HEIGHT - _TOP - height - index * (height + _GAP) for index in range(count)]
    draw_curves([place(figure, _SPLIT, foot, width, height) for foot in feet], curves)
    return figure


def _column(
    figure: Figure,
    x: float,
    rows: tuple[tuple[str, str, str], ...],
    numbers: Mapping[str, Any],
    bold: Collection[str],
    system: System,
) -> None:
    y = _TABLE - 0.12
    for title, column, unit in rows:
        value = numbers.get(column)
        if value is None:
            continue
        unit, factor = shown_in(unit, system)
        weight = "bold" if column in bold else "normal"
        style = {"fontsize": TEXT, "weight": weight, "color": INK}
        write(figure, x, y, title, **style)
        write(figure, x + 2.2, y, shown(float(value) * factor, 5, zeros=True), ha="right", **style)
        if unit:
            write(figure, x + 2.26, y, unit_text(unit), **style)
        y -= 0.2
