"""The curves of one design over the cycle as CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...objectives.kinds import System
from ..runs.result import csv_text, rows_of
from .cycle_table import cycle_table
from .shown_units import rows_in

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism


_MOTION = (
    *("crank_angle", "slider_position", "slider_velocity", "slider_acceleration", "slider_jerk"),
    *("rod_angle", "transmission_angle"),
)


def cycle_csv(mechanism: Mechanism, linkage: Linkage, system: System = "metric", *, machine: bool = True) -> str:
    """Return a row for each of 360 crank angles, a column for each curve of `cycle_table`; empty where not defined.

    machine: whether masses, loads and tolerances are known; else only the motion is given.
    """
    curves = [curve for curve in cycle_table(mechanism, linkage) if machine or curve.key.startswith(_MOTION)]
    return csv_text(rows_in(rows_of({curve.key: curve.values for curve in curves}), system))
