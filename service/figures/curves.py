"""Torque, transmission angle and slider motion of one design over the cycle, as data and as stacked panels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ...model.cycle.stroke_times import slow_stroke
from ...model.dynamics.segments import crowding, uncrowded
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.machine.two_turns import cycle_turns
from ...model.signals.first_peak import first_peaks
from ...model.signals.signals import Signal
from ...objectives.kinds import LENGTH, System
from ...objectives.tables.cycle_curves import cycle_curves as all_curves
from ..render.blocks import Value, joined, words
from ..render.numerals import format_number
from .drawing import least_transmission_crank_angle
from .panel_figure import CRANK_ANGLE, Line, Panel, crank_angle_panel
from .panels import draw_panel
from .style import MUTED, SMALL

Array = NDArray[np.float64]
SAMPLES = 720
_TURN = 2.0 * np.pi
_SIDE_STEP = 1e-7
"""rad from a peak to the samples that show its height where the curve jumps there."""
_STEP = 1e-5  # of the value: smooth curves change less between these samples


@dataclass(frozen=True)
class Curves:
    """The curves of one design. angles: (n,), deg. inner, outer: dead centres of a turn, deg.

    panels: one per curve, the slow stroke shaded; a marked extremum is a second line with one point of the curve.
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

    Without a crank speed, velocity and acceleration are given for one radian per second: per unit of crank speed.
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
    kappa = crowding(*dimensions[0])
    crowded = [uncrowded(tau, kappa) for tau in np.linspace(0.0, 2.0 * np.pi, SAMPLES // 2)]
    # At a step of a load, the curve has different values on the two sides of the peak.
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
        # Counter-clockwise, the outward stroke runs from the inner to the outer dead centre.
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
    """Draw each curve into its panel, from top to bottom, in a system of units."""
    for axes, panel in zip(panels, curves.panels, strict=True):
        draw_panel(axes, panel, system, has_x_title=axes is panels[-1])
        ends = (curves.inner, curves.outer)
        for angle in (end + turn for turn in np.arange(0.0, curves.last_turn_end, 360.0) for end in ends):
            axes.axvline(angle, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)), zorder=1)
    _name_dead_centres(panels[0], curves)


def _name_dead_centres(top: Axes, curves: Curves) -> None:
    """Write the dead centres over the uppermost panel, within its width and clear of each other."""
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
