"""Certificates of fronts as JSON has them, and in words: what `certify` prints and the API sends."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import LENGTH, System
from ..render.blocks import Value, joined, words
from ..render.formatting import format_text

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...optimise.certificate.certificate import Certificate
    from ...optimise.problem.problem import Problem
    from ..runs.result import Result, Row

SIZES = tuple(f"{name}_mm" for name in DIMENSIONS)
"""Columns of the dimensions."""
_SHOWN_NOTES = 8


def sizes_of(result: Result) -> NDArray[np.float64]:
    """Return crank, rod and offset of the designs of a run (n, 3), m."""
    import numpy as np

    return np.array([[row[name] for name in SIZES] for row in result.designs], dtype=np.float64).reshape(-1, 3) / 1e3


def infeasible_record(result: Result, *, proven: bool) -> dict[str, Any]:
    """Return the proof about a run that found no design, for JSON."""
    text = "no design of the ranges meets all requirements"
    message = f"proven: {text}" if proven else f"not proven that {text}; allow more time"
    return {"run": result.run, "name": result.name, "infeasible": proven, "message": message}


def certificate_record(found: Certificate, problem: Problem, run: str, rows: list[Row]) -> dict[str, Any]:
    """Return a certificate for JSON. run: whose front it is of. rows: the added designs, with all their numbers."""
    wanted = [problem.quantity(objective.quantity) for objective in problem.objectives]
    return {
        "run": run,
        "name": problem.name,
        "status": found.status,
        "message": found.message,
        "epsilon_asked": found.asked,
        "epsilon": found.epsilon,
        "epsilon_of_delivered": found.delivered,
        "gap_of_delivered": found.gap,
        "hole": _by_size(found.hole),
        "ranges": {of.field: float(span) * of.unit.factor for of, span in zip(wanted, found.span, strict=True)},
        "hypervolume_gap": found.hypervolume_gap,
        "boxes": found.boxes,
        "open_boxes": found.open,
        "remaining_share": found.remaining,
        "remaining_where": _by_size(found.where),
        "notes": list(found.notes),
        "seconds": found.seconds,
        "added": rows,
    }


def _by_size(values: NDArray[np.float64] | None) -> dict[str, Any] | None:
    return None if values is None else dict(zip(SIZES, (1e3 * values).tolist(), strict=True))


def sentences_of(found: Certificate, result: Result, system: System = "metric") -> list[str]:
    """Return a certificate in words, in a system of units, the message first."""
    lines = [f"{result.name}: {found.message}", f"Design box: {found.boxes:,} boxes in {found.seconds:.1f} s"]
    if found.open:
        lines[1] += f", {found.open:,} open ({100.0 * found.remaining:.3g} % of it)"
    if found.where is not None:
        ranges = [
            words("{name} {low} to {high}", name=name, low=Value(low, LENGTH, bare=True), high=Value(high, LENGTH))
            for name, (low, high) in zip(DIMENSIONS, found.where.tolist(), strict=True)
        ]
        lines.append(f"Farthest from proven: {format_text(joined(ranges), system)}")
    if found.hole is not None:
        sizes = [
            words("{name} {size}", name=name, size=Value(size, LENGTH))
            for name, size in zip(DIMENSIONS, found.hole.tolist(), strict=True)
        ]
        lines.append(f"Largest gap of the delivered front: {format_text(joined(sizes), system)}")
    if math.isfinite(found.hypervolume_gap):
        lines.append(
            f"Hypervolume: {result.hypervolume:.6g}, the true front's exceeds it by at most {found.hypervolume_gap:.3g}"
        )
    return lines + [f"Note: {note}" for note in found.notes[:_SHOWN_NOTES]]
