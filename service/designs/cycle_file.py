"""The curves of one design over the cycle as CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...objectives.kinds import System
from ..runs.result import csv_text, rows_of
from .shown_units import rows_in

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

_ANGLES = 360
_MOTION = (
    *("crank_angle", "slider_position", "slider_velocity", "slider_acceleration", "slider_jerk"),
    *("rod_angle", "transmission_angle"),
)


def cycle_csv(mechanism: Mechanism, linkage: Linkage, system: System = "metric", *, machine: bool = True) -> str:
    """Return a row for each of 360 crank angles, a column for each curve of `cycle_curves`; empty where not defined.

    machine: whether masses, loads and tolerances are known; else only the motion is given.
    """
    from ...objectives.tables.cycle_curves import cycle_curves, even_angles

    curves = cycle_curves(mechanism, linkage, even_angles(_ANGLES))
    columns = {
        curve.field: (curve.shown.factor * curve.values).tolist()
        for curve in curves
        if machine or curve.name in _MOTION
    }
    return csv_text(rows_in(rows_of(columns), system))
