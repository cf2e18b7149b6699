"""Job for a search near a design: ranges around its lengths, also outside the job's ranges."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...optimise.problem.problem import Problem

SHARE = 0.1
"""Of a length, on either side of it."""
_LONGEST_NAME = 80  # of a job


def job_near_lengths(
    problem: Problem, tables: Mapping[str, Any], lengths: tuple[float, float, float], *, share: float = SHARE
) -> dict[str, Any]:
    """Return the tables of a job whose crank, rod and offset vary around lengths, mm. Lengths that the job fixes stay.

    share: fraction of each length, on either side; for the offset at least that fraction of the crank. Raises
    `InputError` if the job fixes all three.
    """
    part = problem.parts()[0]
    free = [name for name in DIMENSIONS if (bounds := getattr(part, name)).lower < bounds.upper]
    if not free:
        raise InputError("a search near a design needs a variable length; this job fixes all three; give one a range")
    job = deepcopy(dict(tables))
    length_of = dict(zip(DIMENSIONS, lengths, strict=True))
    for name in free:
        margin = share * max(abs(length_of[name]), length_of[DIMENSIONS[0]])
        if name != DIMENSIONS[2]:
            margin = share * length_of[name]
        job["variables"][name] = [f"{length_of[name] - margin:.6g} mm", f"{length_of[name] + margin:.6g} mm"]
    sizes = ", ".join(f"{length_of[name]:.4g}" for name in DIMENSIONS)
    name = f"{tables['name']}, near {sizes} mm"
    job["name"] = name if len(name) <= _LONGEST_NAME else tables["name"]
    return job
