"""Design of a stored front with other numbers: quantities, unmet requirements, comparison with the front."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.tables.design_input import column_of_variable
from ...objectives.tables.evaluate_quantities import designs_that_can_move, quantities_as_array
from ...objectives.tables.swing_columns import linkage_that_can_move
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint
from ..runs.result import Result, Row, rows_of_columns
from .columns import find_column
from .design_selection_options import minimised_values, target_magnitudes
from .judged_requirements import deviations_in_words, ranges_as_requirements, requirements_of, unmet_columns
from .stored_designs import StoredDesign

_SAME = 1e-9  # relative to an objective's range over the front, or to a number: smaller differences are rounding
_ROUNDS = 30
_CONVERGED = 1e-12  # of a target
_HALVINGS = 12
_BISECTIONS = 12  # between a length that is reached and one that is not: to a 4,000th of the way

Lengths = tuple[float, float, float]


@dataclass(frozen=True)
class Variation:
    """Design with other numbers, judged against its job and front. row: every quantity and the slacks.

    broken: columns of constraints missed by more than is allowed for the design. deviations: those missed by less, in
    words. outside: columns whose range is left. dominated_by: positions of the front
    designs that dominate it. dominates: positions of the front designs that it dominates. Both lists begin with the
    largest difference.
    """

    row: Row
    design: StoredDesign
    broken: list[str]
    deviations: list[str]
    outside: list[str]
    dominated_by: list[int]
    dominates: list[int]


def design_with_numbers(
    design: StoredDesign, lengths: Sequence[float], values: Mapping[str, float] | None = None
) -> StoredDesign:
    """Return a design with other lengths, m, and other extra variables, by column in its unit; the rest is unchanged.

    Raises `InputError` for lengths that do not rotate fully, and for a number that is not variable or out of range.
    """
    numbers = list(design.values[3:])
    columns = [column_of_variable(item) for item in design.part.mechanism.varying]
    places = {column: place for place, (column, _) in enumerate(columns)}
    for column, value in (values or {}).items():
        if column not in places:
            raise InputError(
                f"only variables of this job may have other values: {', '.join(places) or 'there are none'}; got "
                f"{column!r}; leave it out"
            )
        item, unit = design.part.mechanism.varying[places[column]], columns[places[column]][1]
        numbers[places[column]] = number = value / unit.factor
        margin = _SAME * max(abs(item.lower), abs(item.upper))
        if not item.lower - margin <= number <= item.upper + margin:
            ends = f"{item.lower * unit.factor:.6g} to {item.upper * unit.factor:.6g} {unit.symbol}".rstrip()
            title = find_column(column, (column,)).title
            raise InputError(f"{title} must be within its range, {ends}; got {value:.6g}; correct it")
    changed = replace(design, values=(*lengths, *numbers))
    if changed.part.motion is None:
        changed.linkage.require_full_rotation()
    else:
        linkage_that_can_move(changed.mechanism, changed.linkage, changed.part.motion)
    return changed


def judged_variation(design: StoredDesign, result: Result, minimised: Array) -> Variation:
    """Return the variation for a design that need not be on the front.

    minimised: result of `minimised_values(result)`, computed once for many designs.
    """
    from ...optimise.search.assemble_front import columns_of_designs

    columns = columns_of_designs(design.part, np.zeros(1, dtype=np.int64), np.array([design.values]))
    row = rows_of_columns(columns)[0]
    rules = requirements_of(design.part, design.allowed)
    return Variation(
        row=row,
        design=design,
        broken=unmet_columns(rules, row)
        + (["slow_stroke"] if design.part.slow_stroke not in (None, row.get("slow_stroke")) else []),
        deviations=deviations_in_words(rules, row),
        outside=unmet_columns(ranges_as_requirements(design.part), row),
        **_dominating_and_dominated(result, row, minimised),
    )


def _dominating_and_dominated(result: Result, row: Row, minimised: Array) -> dict[str, list[int]]:
    """Return the positions of designs that dominate a row, and of those that the row dominates."""
    from ...optimise.front.saved_front import column_ranges

    values = minimised_values(replace(result, designs=[row], exact=None))[0]
    finite = np.where(np.isfinite(minimised), minimised, math.inf)
    bounded = np.isfinite(finite).all(axis=1)
    if not bounded.any() or not np.isfinite(values).all():
        return {"dominated_by": [], "dominates": []}
    span = column_ranges(finite[bounded], size=target_magnitudes(result))
    gain = (values - finite) / np.where(span > 0.0, span, 1.0)  # positive where the front design is better
    positions = {}
    for name, way in (("dominated_by", gain), ("dominates", -gain)):
        rows = np.flatnonzero(bounded & (way >= -_SAME).all(axis=1) & (way > _SAME).any(axis=1))
        positions[name] = rows[np.argsort(-way[rows].sum(axis=1), kind="stable")].tolist()
    return positions


def lengths_meeting_equalities(design: StoredDesign, lengths: Lengths, moved: str) -> Lengths:
    """Return lengths, m, near the given ones that meet every equality of the job; the changed length stays fixed.

    Uses Newton's method in the other free lengths. Each step is the shortest that meets the linearised equalities,
    halved until the linkage rotates fully or swings as required. Raises `InputError` if the iteration fails.
    """
    part = design.part
    equal = [constraint for constraint in part.constraints if constraint.equality]
    place = DIMENSIONS.index(moved)
    free = [n for n, name in enumerate(DIMENSIONS) if n != place and not getattr(part, name).fixed]
    values = np.array([*lengths, *design.values[3:]])
    if not equal:
        return lengths
    if not _rotates_or_swings(part, values):
        raise _no_solution_error(design, equal, moved, values[place])
    for _ in range(_ROUNDS):
        misses, slopes, sizes = _equality_residuals(design, equal, values)
        if not np.isfinite(misses).all() or not np.isfinite(slopes).all():
            break
        if (np.abs(misses) <= _CONVERGED * sizes).all():
            return float(values[0]), float(values[1]), float(values[2])
        step = np.zeros(len(values))
        step[free] = -np.linalg.lstsq(slopes[:, free] / sizes[:, None], misses / sizes, rcond=1e-10)[0]
        for _ in range(_HALVINGS):
            if _rotates_or_swings(part, values + step):
                break
            step *= 0.5
        else:
            break
        values = values + step
    raise _no_solution_error(design, equal, moved, values[place])


def nearest_lengths_meeting_equalities(design: StoredDesign, lengths: Lengths, moved: str) -> Lengths:
    """Return lengths that meet every equality; the nearest reachable ones if the changed length cannot be held.

    They lie between the design's own and the given ones. Raises `InputError` if the design's own length cannot be held
    either.
    """
    try:
        return lengths_meeting_equalities(design, lengths, moved)
    except InputError as error:
        refused = error
    place = DIMENSIONS.index(moved)
    own = (design.values[0], design.values[1], design.values[2])
    low, high = own[place], lengths[place]
    try:
        reached = lengths_meeting_equalities(design, own, moved)
    except InputError:
        raise refused from None
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        start = [*reached]
        start[place] = middle
        try:
            reached, low = lengths_meeting_equalities(design, (start[0], start[1], start[2]), moved), middle
        except InputError:
            high = middle
    return reached


def _equality_residuals(design: StoredDesign, equal: list[Constraint], values: Array) -> tuple[Array, Array, Array]:
    """Return the equality residuals (m,), their derivatives (m, 3 + k), and the magnitudes of the targets (m,)."""
    targets = np.array([constraint.lower or 0.0 for constraint in equal])
    part, names = design.part, [constraint.quantity for constraint in equal]
    # Not `Problem.evaluate`, which warns about lengths entered by users: these are intermediate.
    reached, slopes = quantities_as_array(
        part.mechanism, values[None], names, gradients=True, own=part.own, swing=part.motion
    )
    return reached[0] - targets, slopes[0], np.maximum(np.abs(targets), 1e-6)


def _rotates_or_swings(part: Problem, values: Array) -> bool:
    """Return whether a design rotates fully, or swings as far as its job requires."""
    if part.motion is not None:
        return bool(designs_that_can_move(part.mechanism, part.motion, values[None])[0])
    crank, rod, offset = values[:3]
    return bool(crank > 0.0 and rod > crank + abs(offset))


def _no_solution_error(design: StoredDesign, equal: list[Constraint], moved: str, value: float) -> InputError:
    rules = []
    for constraint in equal:
        quantity = design.part.quantity(constraint.quantity)
        target = (constraint.lower or 0.0) * quantity.unit.factor
        rules.append(f"{quantity.title} exactly {target:.6g} {quantity.unit.symbol}".strip())
    other_lengths = " and ".join(name for name in DIMENSIONS if name != moved)
    return InputError(
        f"{other_lengths} must change so that {' and '.join(rules)} still holds; no design was found with {moved} "
        f"{1e3 * value:.6g} mm; change {moved} less, or allow the rules to be broken"
    )
