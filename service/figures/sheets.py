"""A sheet of panels with curves, as data: what the figure of a topic or of a published case shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CRANK_ANGLE = "crank angle, deg"
_TURN = 2.0 * np.pi
THIN, DASHED, FAINT, DOTS, SAMPLES = 5, 6, 7, 8, 9
"""Styles: full of detail, what that is compared with, swinging behind another line, points, points behind a line."""


@dataclass(frozen=True)
class Line:
    """A curve through (x, y), each (n,), as shown, with a gap where y is nan; single points if `points`.

    style: which of the line styles.
    """

    label: str
    x: Array
    y: Array
    style: int = 0
    points: bool = False


@dataclass(frozen=True)
class Panel:
    """Lines over a common axis. title, across: with unit. names: (text, x, y) of what is named in the drawing.

    equal: the same scale in both directions. turns: x is a crank angle in deg, ticked by quarter turns. level: a
    horizontal line, with its name. shaded: parts of the axis (from, to). note: at the right of the title, with {} for
    each of the values `noted`, in the unit of the title.
    """

    title: str
    across: str
    lines: tuple[Line, ...]
    names: tuple[tuple[str, float, float], ...] = ()
    equal: bool = False
    turns: bool = False
    level: tuple[str, float] | None = None
    shaded: tuple[tuple[float, float], ...] = ()
    note: str = ""
    noted: tuple[float, ...] = ()


@dataclass(frozen=True)
class Sheet:
    """Panels row by row, `columns` in each row. subtitle: what the mechanism is.

    width: of a panel with its margins, or of those of each column; height: likewise; inches. stacked: panels of a
    column have one axis, told at the lowest.
    """

    title: str
    subtitle: str
    panels: tuple[Panel, ...]
    columns: int = 1
    width: float | tuple[float, ...] = 6.2
    height: float = 2.35
    stacked: bool = False


def over_turn(
    title: str,
    *lines: Line,
    level: tuple[str, float] | None = None,
    note: str = "",
    noted: tuple[float, ...] = (),
) -> Panel:
    """Return a panel of lines over the crank angle."""
    return Panel(title, CRANK_ANGLE, lines, turns=True, level=level, note=note, noted=noted)


def turn(*marked: Sequence[float] | Array, samples: int = 720, turns: int = 1) -> Array:
    """Return crank angles, rad, over a turn or two, with those marked just before and just after: jumps stay upright.

    samples: of a turn. What is marked on one turn is so on each.
    """
    every = [np.asarray(angles) + number * _TURN for angles in marked for number in range(turns)]
    around = [np.mod(angles + side, turns * _TURN) for angles in every for side in (-1e-9, 1e-9)]
    return np.unique(np.concatenate([np.linspace(0.0, turns * _TURN, turns * samples + 1), *around]))
