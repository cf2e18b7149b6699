"""Quantities of very many designs as one array, with their derivatives by the design's numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.errors import InputError
from ...model.machine.mechanism import Mechanism
from ...model.signals.dead_centres import torque_at_dead_centres
from ...model.signals.peaks import ANGLES
from ...model.signals.screening import screen, screens
from ...model.signals.signals import Signal
from ...model.signals.watch import stroke_dependent
from ..cycle_peak import CyclePeak
from ..own.quantity import OwnQuantity
from ..quantity import Array, Quantity, Values

_NEAR = 0.02
"""Share of the greatest torque within which that of a dead centre calls for the exact search: the peak may be its kink,
or lie between it and the next sample. Of 600,000 random machines with loads that change there it missed none."""


def evaluate_quantities(
    mechanism: Mechanism, quantities: Sequence[Quantity], designs: object, *, gradients: bool
) -> tuple[Array, Array | None]:
    """Return values (..., q), SI, and the Jacobian (..., q, 3 + k) of designs (..., 3 + k).

    Without `gradients` the Jacobian is None. Columns of a design: crank, rod, offset, m, and the values of the
    machine's k varying numbers, SI. Rows of designs that do not turn fully, or that are not finite, are NaN; a
    quantity is infinite where friction locks the linkage. Peaks come from the vectorised search of `screening`, and
    from the exact one of `peaks` where that does not take the signal or the torque has its peak on a kink. At a tie
    of two peaks the slope is that of one of them.
    Raises `InputError` for arrays of another width, and for the gradient of a quantity that has none.
    """
    rows, shape = _rows(mechanism, designs)
    lacking = [item.name for item in quantities if isinstance(item, OwnQuantity) and item.gradient == "none"]
    if gradients and lacking:
        raise InputError(
            f'{lacking[0]} has gradient = "none"; got gradients=True; leave it out, or set "finite differences"'
        )
    with np.errstate(invalid="ignore"):
        turns = (rows[:, 1] > rows[:, 0] + np.abs(rows[:, 2])) & (rows[:, 0] > 0.0)
    turns &= np.isfinite(rows).all(axis=1)
    whole = bool(turns.all())
    found = _found(mechanism, quantities, rows if whole else rows[turns], gradients)
    values = np.full((len(rows), len(quantities)), np.nan)
    jacobian = np.full((*values.shape, rows.shape[1]), np.nan) if gradients else None
    where: slice | NDArray[np.bool_] = slice(None) if whole else turns
    for column, item in enumerate(found):
        values[where, column] = item.values
        if jacobian is not None and item.gradients is not None:
            jacobian[where, column] = item.gradients
    values = values.reshape(*shape, len(quantities))
    return values, None if jacobian is None else jacobian.reshape(*values.shape, rows.shape[1])


def _rows(mechanism: Mechanism, designs: object) -> tuple[Array, tuple[int, ...]]:
    """Return designs as rows (n, 3 + k), and the shape that they stand in. Raises `InputError`."""
    width = 3 + len(mechanism.varying)
    names = ", ".join(["crank, rod, offset", *(item.name for item in mechanism.varying)])
    try:
        given = np.asarray(designs)
        if np.iscomplexobj(given):
            raise TypeError
        given = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            f"designs are arrays of real numbers, SI; got {type(designs).__name__} of others; give {names} of each"
        ) from None
    if given.ndim == 0 or given.shape[-1] != width:
        raise InputError(
            f"designs need {width} numbers each ({names}), as the last axis; got an array of shape {given.shape}"
        )
    return np.ascontiguousarray(given.reshape(-1, width)), given.shape[:-1]


def _found(mechanism: Mechanism, quantities: Sequence[Quantity], designs: Array, gradients: bool) -> list[Values]:
    quick = [q for q in quantities if isinstance(q, CyclePeak) and screens(mechanism, q.signal, during=q.during)]
    found: dict[str, Values] = {}
    if quick:
        signals = tuple(dict.fromkeys(quantity.signal for quantity in quick))
        screened = dict(
            zip(signals, screen(mechanism, signals, designs, gradients=gradients, angles=ANGLES), strict=True)
        )
        for quantity in quick:
            item = screened[quantity.signal]
            found[quantity.name] = Values(item.values, item.gradients)
            kinks = quantity.signal is Signal.TORQUE and stroke_dependent(mechanism)
            missed = ~np.isfinite(item.values)
            if kinks:
                missed |= np.abs(torque_at_dead_centres(mechanism, designs)).max(axis=1) >= item.values * (1.0 - _NEAR)
            if missed.any():
                exact = quantity.evaluate(mechanism, designs[missed], gradients=gradients)
                item.values[missed] = exact.values
                if item.gradients is not None:
                    item.gradients[missed] = exact.gradients
    return [found.get(q.name) or q.evaluate(mechanism, designs, gradients=gradients) for q in quantities]
