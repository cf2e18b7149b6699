"""Quantities of many designs by name as one array, with their derivatives with respect to the numbers in a design."""

from collections.abc import Callable, Sequence
from typing import Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Mask
from ...model.errors import InputError
from ...model.machine.mechanism import Mechanism
from ...model.signals.peaks import ANGLES
from ...model.swing.closure import swings_without_dead_point
from ...model.swing.swing import Swing
from ...model.swing.swing_batch import can_swing_despite_friction
from ...model.turning_cylinder.levers_of_designs import can_make_motion
from ..cycle_peak import screen_quantities
from ..formula.quantity import basic_quantities, values_with_formulas
from ..formula.resolve_names import resolve_quantities
from ..quantity import Array, Quantity, Values
from ..registry import QUANTITIES
from .design_input import (
    designs_as_array,
    has_finite_numbers,
    names_of_design_numbers,
    require_machine,
    warn_of_lengths,
)
from .swing_columns import require_motion_of_machine_kind, require_quantities_of_motion, require_swing_quantity

_ROUNDING = 1e-8
"""Relative tolerance: a design within this fraction of an allowable value meets it."""


def violations_of_allowables(mechanism: Mechanism, values_of: Callable[[str], ArrayLike | None]) -> dict[str, Array]:
    """Return the violation (n,) of each allowable value by designs, SI, by the name of the quantity.

    values_of: returns the values (n,) of a quantity by name, SI; NaN for a design without a value, None if no design
    has one. Zero for a design within the allowable value; quantities that no design violates are left out.
    """
    excesses = {}
    for name, quantity in QUANTITIES.items():
        values = np.atleast_1d(np.asarray(values_of(name) if quantity.allowed_by else None, dtype=np.float64))
        if np.isnan(values).all():
            continue
        allowable = quantity.allowable_value(mechanism)
        excess = values - allowable if quantity.better == "low" else allowable - values
        excess = np.where(excess > _ROUNDING * abs(allowable), excess, 0.0)  # zero also without a value
        if excess.any():
            excesses[name] = excess
    return excesses


@overload
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: Literal[False] = False,
    own: Sequence[Quantity] = (),
    swing: Swing | None = None,
) -> Array: ...
@overload
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: Literal[True],
    own: Sequence[Quantity] = (),
    swing: Swing | None = None,
) -> tuple[Array, Array]: ...
def evaluate(
    mechanism: Mechanism,
    designs: ArrayLike,
    quantities: Sequence[str],
    *,
    gradients: bool = False,
    own: Sequence[Quantity] = (),
    swing: Swing | None = None,
) -> Array | tuple[Array, Array]:
    """Return quantities (n, q) for designs (n, 3 + k), SI; with `gradients`, the Jacobian too.

    A design is crank, rod, offset, m, followed by the values of the machine's k variables. Any number of axes may
    precede the last: one design (3 + k,) gives (q,). A pandas table has these names as columns. quantities: names or
    formulas as in job files. own: custom quantities that may be named besides the built-in ones. swing: motion that
    designs must make instead of a full turn.

    The row of a design that does not rotate fully, or that contains NaN, is NaN. A quantity that is zero for every
    design of the machine, such as a torque without masses and loads, is 0 here but undefined in `analyse`. Where
    friction locks the linkage, quantities computed from forces take their worst value, as a search needs it: infinity,
    or zero for a safety factor. `analyse` then gives the reason instead of a value.

    Peaks come from the vectorised search of `screening`. If that does not support the signal, or the torque peak is at
    a kink, they come from the exact search in `peaks`. If two peaks tie, the slope is that of one of them.

    Raises `InputError` for an unknown name, for arrays of another width, and for a quantity that the machine does not
    define (a position error without tolerances). Also raises it for a full-turn quantity with a swing, and for the
    gradient of a function that has none. Warns once for each machine about lengths that are probably in mm.

    >>> from slidercrank import Mechanism, evaluate
    >>> evaluate(Mechanism(), [[0.04, 0.1, 0.02], [0.08, 0.1, 0.03]], ["stroke", "time_ratio"]).round(4)
    array([[0.082 , 1.1334],
           [   nan,    nan]])
    """
    require_machine(mechanism)
    array = designs_as_array(designs, names_of_design_numbers(mechanism))
    warn_of_lengths(mechanism, array)
    return quantities_as_array(mechanism, array, quantities, gradients=gradients, own=own, swing=swing)


def quantities_as_array(
    mechanism: Mechanism,
    designs: Array,
    quantities: Sequence[str],
    *,
    gradients: bool = False,
    own: Sequence[Quantity] = (),
    swing: Swing | None = None,
) -> Array | tuple[Array, Array]:
    """Return the values from `evaluate` for designs (..., 3 + k) as an array."""
    if isinstance(quantities, str):
        raise InputError(f"quantities must be a list of names; got {quantities!r}; write [{quantities!r}]")
    quantities = list(quantities)
    require_motion_of_machine_kind(mechanism, swing)
    require_quantities_of_motion(quantities, own, swing)
    chosen = resolve_quantities(quantities, mechanism, own, turning=swing is None)
    for item in chosen:
        if swing is not None:
            require_swing_quantity(item.name, item, swing)
        reason = item.undefined_because([mechanism])
        if reason:
            raise InputError(f"{item.name}: {reason}")
    rows, shape = np.ascontiguousarray(designs.reshape(-1, designs.shape[-1])), designs.shape[:-1]
    lacking = [item.name for item in chosen if not item.has_gradient]
    if gradients and lacking:
        raise InputError(
            f'{lacking[0]} has gradient = "none"; got gradients=True; leave it out, or set "finite differences"'
        )
    turns = designs_that_can_move(mechanism, swing, rows)
    turns &= has_finite_numbers(rows)
    all_turn = bool(turns.all())
    evaluations = _evaluate_leaves(mechanism, chosen, rows if all_turn else rows[turns], gradients)
    values = np.full((len(rows), len(chosen)), np.nan)
    jacobian = np.full((*values.shape, rows.shape[1]), np.nan) if gradients else None
    target_rows: slice | Mask = slice(None) if all_turn else turns
    for column, part in enumerate(evaluations):
        values[target_rows, column] = part.values
        if jacobian is not None and part.gradients is not None:
            jacobian[target_rows, column] = part.gradients
    values = values.reshape(*shape, len(chosen))
    return values if jacobian is None else (values, jacobian.reshape(*values.shape, rows.shape[1]))


def designs_that_can_move(mechanism: Mechanism, swing: Swing | None, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) rotate fully or, if a swing is given, can make it."""
    if swing is not None:
        return (can_make_motion if swing.of_lever else swings_without_dead_point)(mechanism, swing, designs)
    crank, rod, offset = designs[:, 0], designs[:, 1], designs[:, 2]
    with np.errstate(invalid="ignore"):
        return np.asarray((crank > 0.0) & (rod > crank + np.abs(offset)))


def can_run_despite_friction(mechanism: Mechanism, swing: Swing | None, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) rotate fully or, if a swing is given, can make it despite friction."""
    if swing is None or swing.of_lever:
        return designs_that_can_move(mechanism, swing, designs)
    return can_swing_despite_friction(mechanism, swing, designs)


def _evaluate_leaves(
    mechanism: Mechanism, quantities: Sequence[Quantity], designs: Array, gradients: bool
) -> list[Values]:
    leaves = basic_quantities(quantities)
    values = screen_quantities(leaves, mechanism, designs, gradients=gradients, certain=True, angles=ANGLES)
    for leaf in leaves:
        if leaf.name not in values:
            continue
        item = values[leaf.name]
        missed = ~np.isfinite(item.values)
        if missed.any():
            exact = leaf.evaluate(mechanism, designs[missed], gradients=gradients)
            item.values[missed] = exact.values
            if item.gradients is not None:
                item.gradients[missed] = exact.gradients
    values |= {q.name: q.evaluate(mechanism, designs, gradients=gradients) for q in leaves if q.name not in values}
    return values_with_formulas(quantities, values, mechanism, designs, gradients=gradients)
