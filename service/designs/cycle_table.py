"""Curves of one design over a crank revolution, as CSV and as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...objectives.kinds import System
from ..runs.result import csv_text, rows_of
from .display_units import rows_in

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

LEAST, MOST = 4, 3600
_ANGLES = 360
_MOTION = (
    *("crank_angle", "slider_position", "slider_velocity", "slider_acceleration", "slider_jerk"),
    *("rod_angle", "transmission_angle"),
)
_LEFT_OUT = ("slider_jerk", "rod_angle", "power")


@dataclass(frozen=True)
class CurveColumn:
    """A curve. key: key in JSON. values: values over the crank angles; NaN where friction leaves it undetermined."""

    key: str
    title: str
    unit: str
    values: list[float]


def cycle_table(mechanism: Mechanism, linkage: Linkage, *, angles: int = 360, turns: int = 1) -> list[CurveColumn]:
    """Return the curves of one fully rotating linkage at evenly spaced crank angles from 0 deg, in metric units.

    turns: crank revolutions that the angles span. The curves are those of `objectives.tables.cycle_curves`;
    raises `InputError` for too few or too many angles.
    """
    from ...objectives.tables.cycle_curves import cycle_curves, even_angles

    curves = cycle_curves(mechanism, linkage, turns * even_angles(angles, MOST))
    return [
        CurveColumn(curve.field, curve.title, metric.symbol, (metric.factor * curve.values).tolist())
        for curve, metric in ((curve, curve.kind.metric) for curve in curves)
        if curve.name not in _LEFT_OUT
    ]


def cycle_csv(mechanism: Mechanism, linkage: Linkage, system: System = "metric", *, machine: bool = True) -> str:
    """Return a row for each degree of a cycle, a column for each curve of `cycle_curves`; empty where undefined.

    machine: whether masses, loads and tolerances are known; else only the motion is returned.
    """
    from ...model.machine.two_turns import cycle_turns
    from ...objectives.tables.cycle_curves import cycle_curves, even_angles

    turns = cycle_turns(mechanism)
    curves = cycle_curves(mechanism, linkage, turns * even_angles(turns * _ANGLES))
    columns = {
        curve.field: (curve.kind.metric.factor * curve.values).tolist()
        for curve in curves
        if machine or curve.name in _MOTION
    }
    return csv_text(rows_in(rows_of(columns), system))
