"""All quantities for designs, with the names and units of tables and JSON.

Where friction locks a linkage, `Quantity.evaluate` gives the search the worst possible value: an infinite torque, a
safety factor of zero. An analysis shows no such substitute. It shows the values that are determined, and the reason for
each missing one. A quantity may be infinite by definition, such as the ratio of the rod to a zero offset; infinity is
then its value.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Mask
from ...model.cycle.self_locking import locking_margin, locking_reason
from ...model.cycle.stroke_times import slow_stroke, time_ratio
from ...model.kinematics.geometry import offset_without_rounding
from ...model.linkage.linkage import Linkage
from ...model.linkage.loaded_stroke import loaded_stroke
from ...model.machine.links_and_joints import Friction
from ...model.machine.mechanism import Mechanism
from ...model.signals.averages import torque_averages
from ...model.signals.first_peak import first_peaks
from ...model.signals.signals import Signal
from ...model.swing.swing import Swing
from ..force_transmission import SELF_LOCKING_MARGIN, TRANSMISSION_ANGLE
from ..formula.quantity import FormulaQuantity
from ..lengths_and_time_ratio import STROKE, TIME_RATIO
from ..motion_deviation import MotionDeviation
from ..own.quantity import OwnQuantity
from ..quantity import Array, Quantity
from ..registry import QUANTITIES
from ..robust.quantity import RobustQuantity
from ..torque_and_power import MEAN_TORQUE, PEAK_TORQUE, RMS_TORQUE
from .design_input import column_of_variable
from .evaluate_quantities import can_run_despite_friction
from .swing_columns import INNER_DEAD_CENTRE, LOADED_STROKE, OUTER_DEAD_CENTRE, PEAK_TORQUE_ANGLE, SLOW_STROKE

if TYPE_CHECKING:
    import pandas as pd


_LOCKED_SWING = (
    "a drive must be able to move the slider everywhere on the swing; got a place where none can; lengthen the rod, or "
    "reduce the swing, the offset or the friction"
)
_TOLERANCES = (
    "it needs every machine within the tolerances to run; got some that do not rotate fully, or that friction locks; "
    "lengthen the rod, or tighten the tolerances"
)
_FORMULA = "a formula must have a finite value; got an infinite one; change the design or the formula"


def missing_value_reason(
    quantity: Quantity, value: float, mechanism: Mechanism, linkage: Linkage, swing: Swing | None = None
) -> str:
    """Return the reason why a design has no value for a defined quantity; empty if it has one.

    value: value from `Quantity.evaluate`, in any unit. mechanism: machine with its variables fixed. swing: motion
    instead of a full turn.
    """
    designs = np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64)
    (reason,) = missing_value_reasons(quantity, np.array([value]), mechanism, designs, swing)
    return reason


def missing_value_reasons(
    quantity: Quantity, values: Array, mechanism: Mechanism, designs: Array, swing: Swing | None = None
) -> list[str]:
    """Return `missing_value_reason` for designs (n, 3) that can all make the motion. values: (n,)."""
    reasons = [""] * len(designs)
    locked = locked_designs(mechanism, designs, swing)
    rows = np.flatnonzero(locked)
    undetermined = rows[_undetermined_by_friction(quantity, mechanism, designs[rows])] if len(rows) else rows
    for row in undetermined.tolist():
        linkage = Linkage(*designs[row].tolist())
        why = _LOCKED_SWING if swing is not None else locking_reason(mechanism.friction, linkage)
        reasons[row] = f"friction locks this design: {why}"
    for row in np.flatnonzero(~np.isfinite(values)).tolist():
        reasons[row] = reasons[row] or _missing_value_reason(
            quantity, float(values[row]), mechanism, designs[row : row + 1]
        )
    return reasons


def locked_designs(mechanism: Mechanism, designs: Array, swing: Swing | None = None) -> Mask:
    """Return which designs (n, 3) friction locks, or may jam, at some crank angle."""
    if swing is not None:
        return ~can_run_despite_friction(mechanism, swing, designs)
    return np.asarray(~(locking_margin(mechanism.friction, designs)[0] > 0.0))


def _undetermined_by_friction(quantity: Quantity, mechanism: Mechanism, designs: Array) -> Mask:
    """Return the locked designs (n, 3) for which friction leaves a quantity or one of its parts undetermined.

    These designs have the worst possible value, infinite or zero, but another value without friction.
    """
    parts = [_undetermined_by_friction(part, mechanism, designs) for part in quantity.component_quantities]
    undetermined = np.any(parts, axis=0) if parts else np.zeros(len(designs), np.bool_)
    values = quantity.evaluate(mechanism, designs).values
    worst = ~np.isfinite(values) | ((values == 0.0) & (quantity.name != SELF_LOCKING_MARGIN.name))
    rows = np.flatnonzero(worst & ~undetermined)
    if isinstance(quantity, OwnQuantity):  # a function is not called for locked designs
        undetermined[rows] = True
    elif len(rows):
        without_friction = quantity.evaluate(replace(mechanism, friction=Friction()), designs[rows]).values
        undetermined[rows] = ~(
            (without_friction == values[rows]) | (np.isnan(without_friction) & np.isnan(values[rows]))
        )
    return undetermined


def _missing_value_reason(quantity: Quantity, value: float, mechanism: Mechanism, design: Array) -> str:
    """Return the reason why a moving design (1, 3) has no finite value; empty if infinity is its value."""
    if np.isnan(value):
        return quantity.no_value_reason
    finite = all(np.isfinite(part.evaluate(mechanism, design).values[0]) for part in quantity.component_quantities)
    if finite and isinstance(quantity, RobustQuantity):
        return _TOLERANCES
    return _FORMULA if finite and isinstance(quantity, FormulaQuantity) else ""


def analyse(mechanism: Mechanism, dimensions: Array, *, custom: Sequence[Quantity] = ()) -> pd.DataFrame:
    """Return a table with every quantity for fully rotating designs (n, 3 + k): crank, rod, offset, m, and more.

    custom: quantities outside the registry; a free phase or shift of a target motion gets a column, too. The machine's
    k variables come after the offset, under the keys from `design_input`. Columns carry their unit. Dead centres
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
            columns |= quantity.best_fit_phase_and_shift(mechanism, dimensions)
    return columns
