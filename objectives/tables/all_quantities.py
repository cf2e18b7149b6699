"""All quantities for designs, with the names and units of tables and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...model.cycle.stroke_times import slow_stroke, time_ratio
from ...model.kinematics.negligible_offset import offset_without_rounding
from ...model.linkage.linkage import Linkage
from ...model.linkage.loaded_stroke import loaded_stroke
from ...model.machine.mechanism import Mechanism
from ...model.signals.averages import torque_averages
from ...model.signals.first_peak import first_peaks
from ...model.signals.signals import Signal
from ..average_torque import MEAN_TORQUE, RMS_TORQUE
from ..motion_deviation import MotionDeviation
from ..peak_torque import PEAK_TORQUE
from ..proportions import STROKE
from ..quantity import Array, Quantity
from ..registry import QUANTITIES
from ..time_ratio import TIME_RATIO
from ..transmission_angle import TRANSMISSION_ANGLE
from .turn_columns import INNER_DEAD_CENTRE, LOADED_STROKE, OUTER_DEAD_CENTRE, PEAK_TORQUE_ANGLE, SLOW_STROKE
from .variable_columns import column_of_variable

if TYPE_CHECKING:
    import pandas as pd


def analyse(mechanism: Mechanism, dimensions: Array, *, custom: Sequence[Quantity] = ()) -> pd.DataFrame:
    """Return a table with every quantity for fully rotating designs (n, 3 + k): crank, rod, offset, m, and more.

    custom: quantities outside the registry; a free phase or shift of a target motion gets a column, too. The machine's
    k variables come after the offset, under the keys from `variable_columns`. Columns carry their unit. Dead centres
    are crank angles, deg; the slow stroke is that from `stroke_times.slow_stroke`, the loaded stroke that from
    `loaded_stroke`. Quantities that a machine does not define are NaN, such as position errors without tolerances.
    Raises `AssemblyError` for a linkage that does not rotate fully.
    """
    import pandas as pd

    return pd.DataFrame(analysis_columns(mechanism, dimensions, custom=custom))


def analysis_columns(
    mechanism: Mechanism, dimensions: Array, *, custom: Sequence[Quantity] = ()
) -> dict[str, NDArray[Any]]:
    """Return the columns (n,) of the `analyse` table: importing pandas takes longer than computing one design."""
    dimensions = np.atleast_2d(np.asarray(dimensions, dtype=np.float64))
    dimensions = dimensions.copy()
    dimensions[:, 2] = offset_without_rounding(dimensions[:, 1], dimensions[:, 2])
    linkage = Linkage(dimensions[:, 0], dimensions[:, 1], dimensions[:, 2], mechanism.branch)
    linkage.require_full_rotation()
    inner, outer = linkage.dead_centre_angles
    peak_torque, peak_torque_angle = first_peaks(mechanism, Signal.TORQUE, dimensions)
    averages = torque_averages(mechanism, dimensions)
    varying = [column_of_variable(item) for item in mechanism.varying]
    columns: dict[str, NDArray[Any]] = {
        "crank_mm": 1e3 * dimensions[:, 0],
        "rod_mm": 1e3 * dimensions[:, 1],
        "offset_mm": 1e3 * dimensions[:, 2],
        **{key: unit.factor * dimensions[:, 3 + place] for place, (key, unit) in enumerate(varying)},
        STROKE.field: 1e3 * linkage.stroke,
        TIME_RATIO.field: time_ratio(mechanism, linkage),
        SLOW_STROKE: slow_stroke(mechanism, linkage),
        LOADED_STROKE: loaded_stroke(mechanism, dimensions),
        OUTER_DEAD_CENTRE: np.degrees(outer),
        INNER_DEAD_CENTRE: np.degrees(inner),
        TRANSMISSION_ANGLE.field: np.degrees(linkage.least_transmission_angle),
        PEAK_TORQUE.field: peak_torque,
        PEAK_TORQUE_ANGLE: np.degrees(peak_torque_angle),
        RMS_TORQUE.field: averages.rms,
        MEAN_TORQUE.field: averages.mean,
    }
    for quantity in (*QUANTITIES.values(), *custom):
        if quantity.field not in columns:
            columns[quantity.field] = quantity.unit.factor * quantity.evaluate(mechanism, dimensions).values
        if quantity.undefined_because([mechanism]):
            columns[quantity.field] = np.full(len(dimensions), np.nan)
    for quantity in custom:
        if isinstance(quantity, MotionDeviation):
            columns |= quantity.settings(mechanism, dimensions)
    return columns
