"""A design of a stored front with other lengths: numbers, broken requirements, and its place against the front."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...model.swing.swing import require_swing
from ..runs.result import Result, Row, rows_of
from .picking_options import minimised_values, sizes_of
from .requirements import ranges_of, requirements_of, unmet
from .stored_designs import StoredDesign

_SAME = 1e-9  # of an objective's range over the front: a difference below is rounding


@dataclass(frozen=True)
class Variation:
    """A design with other lengths, judged against its job and front. row: every quantity and the slacks.

    broken: columns of constraints that are not met. outside: of ranges left. dominated_by, dominates: positions in the
    front of designs that are as good in every objective and better in one, and of those that this one beats so, those
    of the greatest difference first.
    """

    row: Row
    design: StoredDesign
    broken: list[str]
    outside: list[str]
    dominated_by: list[int]
    dominates: list[int]


def with_lengths(design: StoredDesign, lengths: tuple[float, float, float]) -> StoredDesign:
    """Return a design with other lengths, m: choices and varying numbers stay. Raises `InputError` for lengths."""
    changed = replace(design, values=(*lengths, *design.values[3:]))
    if changed.part.motion is None:
        changed.linkage.require_full_rotation()
    else:
        require_swing(changed.mechanism, changed.linkage, changed.part.motion)
    return changed


def variation_of(design: StoredDesign, result: Result, minimised: Array) -> Variation:
    """Return all about a design that need not be in the front.

    minimised: of `minimised_values(result)`, so that it is made once for many.
    """
    from ...optimise.search.assemble import columns_of

    columns = columns_of(design.part, np.zeros(1, dtype=np.int64), np.array([design.values]))
    row = rows_of(columns)[0]
    return Variation(
        row=row,
        design=design,
        broken=unmet(requirements_of(design.part), row)
        + (["slow_stroke"] if design.part.slow_stroke not in (None, row.get("slow_stroke")) else []),
        outside=unmet(ranges_of(design.part), row),
        **_beside(result, row, minimised),
    )


def _beside(result: Result, row: Row, minimised: Array) -> dict[str, list[int]]:
    """Return the positions of designs that dominate a row, and of those that it dominates."""
    from ...optimise.front.constant import spread

    own = minimised_values(replace(result, designs=[row], exact=None))[0]
    finite = np.where(np.isfinite(minimised), minimised, math.inf)
    bounded = np.isfinite(finite).all(axis=1)
    if not bounded.any() or not np.isfinite(own).all():
        return {"dominated_by": [], "dominates": []}
    span = spread(finite[bounded], size=sizes_of(result))
    gain = (own - finite) / np.where(span > 0.0, span, 1.0)  # positive where the design of the front is better
    found = {}
    for name, way in (("dominated_by", gain), ("dominates", -gain)):
        rows = np.flatnonzero(bounded & (way >= -_SAME).all(axis=1) & (way > _SAME).any(axis=1))
        found[name] = rows[np.argsort(-way[rows].sum(axis=1), kind="stable")].tolist()
    return found
