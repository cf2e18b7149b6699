"""A design of a stored front with other numbers: quantities, broken requirements, comparison with the front."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.swing.swing import require_swing
from ...objectives.tables.varying_column import varying_column
from ..runs.result import Result, Row, rows_of
from .choice_options import minimised_values, target_sizes
from .judged_requirements import ranges_of, requirements_of, unmet_columns
from .stored_designs import StoredDesign

_SAME = 1e-9  # of an objective's range over the front, or of a number: a difference below is rounding


@dataclass(frozen=True)
class Variation:
    """A design with other numbers, judged against its job and front. row: every quantity and the slacks.

    broken: columns of constraints that are not met. outside: columns of ranges left. dominated_by: positions in the
    front of designs at least as good in every objective and better in one. dominates: positions of designs that this
    one beats in the same sense. Both list the greatest difference first.
    """

    row: Row
    design: StoredDesign
    broken: list[str]
    outside: list[str]
    dominated_by: list[int]
    dominates: list[int]


def with_numbers(
    design: StoredDesign, lengths: Sequence[float], values: Mapping[str, float] | None = None
) -> StoredDesign:
    """Return a design with other lengths, m, and other extra variables, by column in its unit; the rest stays.

    Raises `InputError` for lengths that do not rotate fully, and for a number that does not vary or leaves its range.
    """
    numbers = list(design.values[3:])
    columns = [varying_column(item) for item in design.part.mechanism.varying]
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
            raise InputError(f"{item.name} must be within its range, {ends}; got {value:.6g}; correct it")
    changed = replace(design, values=(*lengths, *numbers))
    if changed.part.motion is None:
        changed.linkage.require_full_rotation()
    else:
        require_swing(changed.mechanism, changed.linkage, changed.part.motion)
    return changed


def variation_of(design: StoredDesign, result: Result, minimised: Array) -> Variation:
    """Return the variation of a design that need not be in the front.

    minimised: objectives from `minimised_values(result)`, computed once for many designs.
    """
    from ...optimise.search.assemble import columns_of

    columns = columns_of(design.part, np.zeros(1, dtype=np.int64), np.array([design.values]))
    row = rows_of(columns)[0]
    return Variation(
        row=row,
        design=design,
        broken=unmet_columns(requirements_of(design.part), row)
        + (["slow_stroke"] if design.part.slow_stroke not in (None, row.get("slow_stroke")) else []),
        outside=unmet_columns(ranges_of(design.part), row),
        **_dominance(result, row, minimised),
    )


def _dominance(result: Result, row: Row, minimised: Array) -> dict[str, list[int]]:
    """Return the positions of designs that dominate a row, and of those that it dominates."""
    from ...optimise.front.constant_numbers import column_ranges

    values = minimised_values(replace(result, designs=[row], exact=None))[0]
    finite = np.where(np.isfinite(minimised), minimised, math.inf)
    bounded = np.isfinite(finite).all(axis=1)
    if not bounded.any() or not np.isfinite(values).all():
        return {"dominated_by": [], "dominates": []}
    span = column_ranges(finite[bounded], size=target_sizes(result))
    gain = (values - finite) / np.where(span > 0.0, span, 1.0)  # positive where the design of the front is better
    positions = {}
    for name, way in (("dominated_by", gain), ("dominates", -gain)):
        rows = np.flatnonzero(bounded & (way >= -_SAME).all(axis=1) & (way > _SAME).any(axis=1))
        positions[name] = rows[np.argsort(-way[rows].sum(axis=1), kind="stable")].tolist()
    return positions
