"""Torque, transmission angle and slider motion of one design over the cycle, as data and as stacked panels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ...model.cycle.cycle import cycle
from ...model.dynamics.segments import crowding, uncrowded
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.signals.peaks import find_peaks
from ...model.signals.signals import Signal
from ...objectives.kinds import System, shown_in
from .drawing import least_transmission_crank_angle
from .numerals import shown, with_unit
from .style import BLUE, FRAME, INK, MUTED, SHADE, SMALL, TEXT, VERMILION, dress, limits

Array = NDArray[np.float64]
SAMPLES = 720


@dataclass(frozen=True)
class Curve:
    """A curve over the cycle. title: with unit. values: (n,), as shown. note: what the point is, if one is marked.

    point: crank angle in deg and value of the marked extremum, which lies on the curve.
    """

    title: str
    values: Array
    note: str
    point: tuple[float, float] | None


@dataclass(frozen=True)
class Curves:
    """The curves of one design. angles: (n,), deg. inner, outer: dead centres, deg. slow: the slow stroke."""

    angles: Array
    curves: tuple[Curve, ...]
    inner: float
    outer: float
    slow: str


def cycle_curves(mechanism: Mechanism, linkage: Linkage, *, torque: bool = True, system: System = "metric") -> Curves:
    """Return the curves of one fully turning linkage; all angles that are marked are among the sampled ones.

    system: of the units that they are in.

    Without a crank speed, velocity and acceleration are given for one radian per second: per unit of crank speed.
    """
    dimensions = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    moving = mechanism if mechanism.speed else replace(mechanism, speed=1.0)
    inner, outer = (float(angle) for angle in linkage.dead_centre_angles)
    least = least_transmission_crank_angle(linkage)

    def peak(of: Mechanism, signal: Signal) -> float:
        return float(find_peaks(of, signal, dimensions, kept=1).angles[0, 0])

    marked = [least, inner, outer, peak(moving, Signal.SLIDER_SPEED)]
    marked += [peak(moving, Signal.SLIDER_ACCELERATION)]
    marked += [peak(mechanism, Signal.TORQUE)] if torque else []
    kappa = crowding(*dimensions[0])
    crowded = [uncrowded(tau, kappa) for tau in np.linspace(0.0, 2.0 * np.pi, SAMPLES // 2)]
    turn = np.linspace(0.0, 2.0 * np.pi, SAMPLES + 1)
    angles = np.unique(np.concatenate([turn, np.mod(crowded, 2.0 * np.pi), marked]))
    motion = cycle(moving, linkage, angles)
    degrees = np.degrees(angles)

    def curve(title: str, unit: str, values: Array, word: str, angle: float, digits: int = 4) -> Curve:
        symbol, factor = shown_in(unit, system)
        title, values = with_unit(title, symbol), values * factor
        where = int(np.searchsorted(angles, angle))
        value = float(values[where])
        note = f"{word} {shown(value, digits)} at {shown(degrees[where])}°"
        return Curve(title, values, note, (float(degrees[where]), value))

    per, speed_unit, acceleration_unit, factor = "", "m/s", "m/s^2", 1.0
    if not mechanism.speed:
        per, speed_unit, acceleration_unit, factor = " per crank speed", "mm/rad", "mm/rad^2", 1e3
    length, one = shown_in("mm", system)
    curves = [
        curve("transmission angle", "deg", np.degrees(motion.transmission_angle), "least", marked[0]),
        Curve(
            with_unit("slider position", length),
            1e3 * one * motion.slider_position,
            "dead centres at " + " and ".join(shown(1e3 * one * x) for x in sorted(map(float, linkage.dead_centres))),
            None,
        ),
        curve(f"slider velocity{per}", speed_unit, factor * motion.slider_velocity, "peak", marked[3]),
        curve(
            f"slider acceleration{per}",
            acceleration_unit,
            factor * motion.slider_acceleration,
            "peak",
            marked[4],
        ),
    ]
    if torque:
        values = motion.torque if mechanism.speed else cycle(mechanism, linkage, angles).torque
        curves.insert(0, curve("drive torque", "N m", values, "peak", marked[5]))
    slow = str(linkage.slow_stroke(direction=mechanism.speed or 1.0))
    return Curves(degrees, tuple(curves), float(np.degrees(inner)), float(np.degrees(outer)), slow)


def draw_curves(panels: Sequence[Axes], curves: Curves) -> None:
    """Draw each curve into one of the panels, given from top to bottom."""
    for panel, curve in zip(panels, curves.curves, strict=True):
        dress(panel, up=6)
        panel.set_xticks(range(0, 361, 45))
        panel.tick_params(labelbottom=panel is panels[-1])
        for start, end in _slow_spans(curves):
            panel.axvspan(start, end, color=SHADE, linewidth=0, zorder=0)
        for angle in (curves.inner, curves.outer):
            panel.axvline(angle, color=MUTED, linewidth=0.9, linestyle=(0, (4, 2)), zorder=1)
        low, high = float(curve.values.min()), float(curve.values.max())
        if low < 0.0 < high:
            panel.axhline(0.0, color=FRAME, linewidth=0.8, zorder=1)
        panel.plot(curves.angles, curve.values, color=BLUE, linewidth=1.5, zorder=2)
        if curve.point is not None:
            panel.plot(
                *curve.point,
                marker="o",
                markersize=5.5,
                markerfacecolor="white",
                markeredgecolor=VERMILION,
                markeredgewidth=1.5,
                linestyle="none",
                clip_on=False,
                zorder=4,
            )
        panel.set_xlim(0, 360)
        panel.set_ylim(limits(low, high, 0.09))
        head: dict[str, Any] = {"transform": panel.transAxes, "va": "bottom", "fontsize": SMALL}
        panel.text(0.0, 1.03, curve.title, ha="left", color=INK, **head)
        colour = VERMILION if curve.point is not None else MUTED
        panel.text(1.0, 1.03, curve.note, ha="right", color=colour, **head)
    slow = f" (shaded: {curves.slow} stroke, the slow one)" if curves.slow != "equal" else ""
    panels[-1].set_xlabel(f"crank angle, deg{slow}", fontsize=TEXT)
    _name_dead_centres(panels[0], curves)


def _name_dead_centres(top: Axes, curves: Curves) -> None:
    """Write the dead centres over the uppermost panel, within its width and clear of each other."""
    named = sorted([(curves.inner, "inner"), (curves.outer, "outer")])
    close = named[1][0] - named[0][0] < 110.0
    for (angle, name), apart in zip(named, ("right", "left"), strict=True):
        within = "left" if angle < 70.0 else "right" if angle > 290.0 else "center"
        top.annotate(
            f"{name} dead centre {shown(angle)}°",
            xy=(angle, 1.0),
            xycoords=top.get_xaxis_transform(),
            xytext=(0, 17),
            textcoords="offset points",
            ha=apart if close and within == "center" else within,
            fontsize=SMALL,
            color=MUTED,
        )


def _slow_spans(curves: Curves) -> list[tuple[float, float]]:
    """Return the crank angles of the slow stroke: the greater part between the dead centres."""
    if curves.slow == "equal":
        return []
    low, high = sorted((curves.inner, curves.outer))
    return [(low, high)] if high - low > 180.0 else [(0.0, low), (high, 360.0)]
