"""Figure of panels with curves, as data: for a topic or a published case."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...objectives.kinds import DisplayUnit, Kind, System, unit_text
from ..render.blocks import Text
from ..render.formatting import format_text

CRANK_ANGLE = "crank angle, deg"
_TURN = 2.0 * np.pi
SOLID, DASHED, FAINT, DOTS, SAMPLES = 5, 6, 7, 8, 9
"""Styles: finely detailed curve, reference for comparison, oscillating background line, points, points behind a
line."""


@dataclass(frozen=True)
class Line:
    """Curve through (x, y), each (n,), in the units of its panel; NaN in y leaves a gap.

    points: whether to draw single points instead of a line.

    style: index of the line style.
    """

    label: Text
    x: Array
    y: Array
    style: int = 0
    points: bool = False


@dataclass(frozen=True)
class Panel:
    """Lines over a common axis.

    title, x_title: titles of the axes. kind, x_kind: kinds of the numbers y and x, which are then in SI; without a
    kind, numbers are drawn unchanged and the title contains their unit. names: (text, x, y) of named points. equal:
    whether both directions have the same scale. turns: whether x is a crank angle in deg, with ticks at fractions of a
    revolution. level: horizontal line with its name. shaded: parts of the x axis (from, to). note: text at the right of
    the title.
    """

    title: Text
    x_title: Text
    lines: tuple[Line, ...]
    kind: Kind | None = None
    x_kind: Kind | None = None
    names: tuple[tuple[str, float, float], ...] = ()
    equal: bool = False
    turns: bool = False
    level: tuple[str, float] | None = None
    shaded: tuple[tuple[float, float], ...] = ()
    note: Text = ""


@dataclass(frozen=True)
class PanelFigure:
    """Panels row by row, with `columns` panels per row. subtitle: description of the mechanism.

    width: width of a panel with its margins, or of the panels in each column, inches; height: likewise. stacked:
    whether the panels in a column share one axis, labelled below the lowest.
    """

    title: Text
    subtitle: Text
    panels: tuple[Panel, ...]
    columns: int = 1
    width: float | tuple[float, ...] = 6.2
    height: float = 2.35
    stacked: bool = False


def crank_angle_panel(
    title: Text, *lines: Line, kind: Kind | None = None, level: tuple[str, float] | None = None, note: Text = ""
) -> Panel:
    """Return a panel of lines against the crank angle, deg. kind: kind of the numbers y, in SI; see `Panel`."""
    return Panel(title, CRANK_ANGLE, lines, kind, turns=True, level=level, note=note)


def panel_in_units(panel: Panel, system: System) -> Panel:
    """Return a panel ready to draw: numbers in a unit system, and texts with these units."""
    x, y = (None if kind is None else kind.display_unit(system) for kind in (panel.x_kind, panel.kind))
    x_factor, y_factor = (1.0 if unit is None else unit.factor for unit in (x, y))

    def text(title: Text, unit: DisplayUnit | None = None) -> str:
        words = format_text(title, system, printed=True)
        return f"{words}, {unit_text(unit.symbol)}" if unit is not None and unit.symbol else words

    return replace(
        panel,
        title=text(panel.title, y),
        x_title=text(panel.x_title, x),
        lines=tuple(
            replace(line, label=text(line.label), x=x_factor * line.x, y=y_factor * line.y) for line in panel.lines
        ),
        kind=None,
        x_kind=None,
        names=tuple((name, x_factor * at, y_factor * height) for name, at, height in panel.names),
        level=None if panel.level is None else (panel.level[0], y_factor * panel.level[1]),
        shaded=tuple((x_factor * start, x_factor * end) for start, end in panel.shaded),
        note=text(panel.note),
    )


def sampled_crank_angles(*marked: Sequence[float] | Array, samples: int = 720, turns: int = 1) -> Array:
    """Return crank angles, rad, over one revolution or two; pairs of angles at each mark keep jumps vertical.

    samples: number of samples per revolution. Marks within one revolution apply to every revolution.
    """
    every = [np.asarray(angles) + number * _TURN for angles in marked for number in range(turns)]
    near_marks = [np.mod(angles + side, turns * _TURN) for angles in every for side in (-1e-9, 1e-9)]
    return np.unique(np.concatenate([np.linspace(0.0, turns * _TURN, turns * samples + 1), *near_marks]))
