"""Adjustment of lengths after one was changed, so that the equality constraints still hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...model.errors import InputError
from ...model.swing.closure import passes
from ...objectives.tables.evaluate import evaluated

if TYPE_CHECKING:
    from ...model.arrays import Array
    from ...optimise.problem.problem import Problem
    from ...optimise.problem.requirements import Constraint
    from .stored_designs import StoredDesign

_LENGTHS = ("crank", "rod", "offset")
_ROUNDS = 30
_CONVERGED = 1e-12  # of a target
_HALVINGS = 12

Lengths = tuple[float, float, float]


def hold_equalities(design: StoredDesign, lengths: Lengths, moved: str) -> Lengths:
    """Return lengths, m, near the given ones that meet every equality of the job; the changed length stays as given.

    Newton's method in the other free lengths. Each step is the shortest that meets the linearised equalities, halved
    while the linkage would not rotate fully, or not swing as required. Raises `InputError` if it finds none.
    """
    part = design.part
    equal = [constraint for constraint in part.constraints if constraint.equality]
    place = _LENGTHS.index(moved)
    free = [n for n, name in enumerate(_LENGTHS) if n != place and not getattr(part, name).fixed]
    values = np.array([*lengths, *design.values[3:]])
    if not equal:
        return lengths
    if not _moves(part, values):
        raise _refused(design, equal, moved, values[place])
    for _ in range(_ROUNDS):
        misses, slopes, sizes = _misses(design, equal, values)
        if not np.isfinite(misses).all() or not np.isfinite(slopes).all():
            break
        if (np.abs(misses) <= _CONVERGED * sizes).all():
            return float(values[0]), float(values[1]), float(values[2])
        step = np.zeros(len(values))
        step[free] = -np.linalg.lstsq(slopes[:, free] / sizes[:, None], misses / sizes, rcond=1e-10)[0]
        for _ in range(_HALVINGS):
            if _moves(part, values + step):
                break
            step *= 0.5
        else:
            break
        values = values + step
    raise _refused(design, equal, moved, values[place])


def _misses(design: StoredDesign, equal: list[Constraint], values: Array) -> tuple[Array, Array, Array]:
    """Return the residuals of the equalities (m,), their slopes (m, 3 + k), and the sizes of the targets (m,)."""
    targets = np.array([constraint.lower or 0.0 for constraint in equal])
    part, names = design.part, [constraint.quantity for constraint in equal]
    # Not `Problem.evaluate`, which warns about lengths given by people: these are intermediate.
    reached, slopes = evaluated(part.mechanism, values[None], names, gradients=True, own=part.own, swing=part.motion)
    return reached[0] - targets, slopes[0], np.maximum(np.abs(targets), 1e-6)


def _moves(part: Problem, values: Array) -> bool:
    """Return whether a design rotates fully, or swings as far as its job requires."""
    if part.motion is not None:
        return bool(passes(part.mechanism, part.motion, values[None])[0])
    crank, rod, offset = values[:3]
    return bool(crank > 0.0 and rod > crank + abs(offset))


def _refused(design: StoredDesign, equal: list[Constraint], moved: str, value: float) -> InputError:
    rules = []
    for constraint in equal:
        quantity = design.part.quantity(constraint.quantity)
        target = (constraint.lower or 0.0) * quantity.unit.factor
        rules.append(f"{quantity.title} exactly {target:.6g} {quantity.unit.symbol}".strip())
    other_lengths = " and ".join(name for name in _LENGTHS if name != moved)
    return InputError(
        f"{other_lengths} must change so that {' and '.join(rules)} still holds; for {moved} {1e3 * value:.6g} mm no "
        "design was found; change it less, or allow the rules to be broken"
    )
