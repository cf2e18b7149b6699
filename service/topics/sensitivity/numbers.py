"""Sensitivity of every quantity to each dimension."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

DIMENSIONS = ("crank", "rod", "offset")


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return the table of `objectives.tables.sensitivity` for one linkage, ready for JSON: None where not defined.

    quantities: one entry each with quantity, title, unit, value, and for each dimension its derivative
    (<dimension>_per_mm), percent per percent (<dimension>_percent) and change for its tolerance
    (<dimension>_tolerance), in the unit of the entry; each once more with _below, for the side of smaller values.
    """
    import numpy as np

    from ....objectives.tables.sensitivity import sensitivity
    from ...runs.result import finite, rows_of

    table = sensitivity(mechanism, np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)]))
    return {"quantities": finite(rows_of(table.to_dict("list")))}
