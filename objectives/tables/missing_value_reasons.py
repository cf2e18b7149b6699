"""Reasons why a design has no value for a quantity that its machine defines.

Where friction locks a linkage, `Quantity.evaluate` gives the search the worst possible value: an infinite torque, a
safety factor of zero. An analysis shows no such substitute. It shows the values that are determined, and the reason for
each missing one. A quantity may be infinite by definition, such as the ratio of the rod to a zero offset; infinity is
then its value.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...model.arrays import Mask
from ...model.cycle.self_locking import locking_margin, locking_reason
from ...model.linkage.linkage import Linkage
from ...model.machine.friction import Friction
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ..formula.quantity import FormulaQuantity
from ..own.quantity import OwnQuantity
from ..quantity import Array, Quantity
from ..robust.quantity import RobustQuantity
from ..self_locking import SELF_LOCKING_MARGIN
from .evaluate_quantities import can_run_despite_friction

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
