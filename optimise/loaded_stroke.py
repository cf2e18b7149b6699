"""Warnings of a loaded stroke that is the fast one, before a search and after it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..model.linkage import Linkage, SlowStroke
from ..model.loaded_stroke import loaded_stroke
from .elimination import sheets
from .problem import Problem
from .sampling import first_samples

if TYPE_CHECKING:
    from .front import ParetoFront

_SAMPLES = 32
"""Designs of a sheet that are looked at."""
_SHEETS = 20
"""Sheets that are looked at: of very many choices the first ones."""


def expected_warnings(problem: Problem) -> list[str]:
    """Return the warning of a problem, if designs within its ranges have their loaded stroke as the fast one.

    No warning where the problem says which stroke is to be the slow one.
    """
    fast, turning, sides = 0, 0, []
    for index, sheet in enumerate(sheets(problem)[:_SHEETS]):
        part = problem.part(sheet.variant)
        designs = sheet.dimensions(first_samples(_SAMPLES, len(sheet.free), 1, index))
        crank, rod, offset = designs.T[:3]
        with np.errstate(invalid="ignore"):
            designs = designs[(crank > 0.0) & (rod > crank + np.abs(offset))]
        if part.slow_stroke is not None or not part.mechanism.loads or not len(designs):
            continue
        linkage = Linkage(designs[:, 0], designs[:, 1], designs[:, 2], part.mechanism.branch)
        slow = np.atleast_1d(linkage.slow_stroke(direction=part.mechanism.direction))
        loaded = loaded_stroke(part.mechanism, designs)
        found = _fast(slow, loaded)
        fast, turning = fast + int(found.sum()), turning + int(((slow != "equal") & (loaded != "equal")).sum())
        sides += [str(stroke) for stroke in loaded[found]]
    if not fast:
        return []
    where = "in every design" if fast == turning else "in a part of the designs"
    return [_sentence(problem, where, sides)]


def front_warnings(front: ParetoFront) -> list[str]:
    """Return the warning of a front, if designs of it have their loaded stroke as the fast one."""
    if not len(front):
        return []
    free = np.array([front.part(row).slow_stroke is None for row in range(len(front))])
    slow, loaded = (front.designs[name].to_numpy(dtype=str) for name in ("slow_stroke", "loaded_stroke"))
    found = free & _fast(slow, loaded)
    if not found.any():
        return []
    count = int(found.sum())
    where = f"in {count} of {len(front)} designs" if len(front) > 1 else "in this design"
    return [_sentence(front.problem, where, [str(stroke) for stroke in loaded[found]])]


def _fast(slow: NDArray[np.str_], loaded: NDArray[np.str_]) -> NDArray[np.bool_]:
    return np.asarray((slow != "equal") & (loaded != "equal") & (slow != loaded))


def _sentence(problem: Problem, where: str, loaded: list[str]) -> str:
    stroke: SlowStroke = "outward" if 2 * loaded.count("outward") >= len(loaded) else "inward"
    has = any(_may_be_slow(part, stroke) for part in problem.parts())
    turn = "" if has else ", with an offset of the other sign or the crank turning the other way"
    other = "inward" if stroke == "outward" else "outward"
    return (
        f"{where} the stroke that the load acts against, the {stroke} one, is the fast one; if it is to be slow, "
        f'require slow_stroke = "{stroke}" among the constraints{turn}; if it is meant so, require '
        f'slow_stroke = "{other}"'
    )


def _may_be_slow(part: Problem, stroke: SlowStroke) -> bool:
    """Whether the ranges of a part have designs with this stroke as the slow one."""
    side = replace(part, slow_stroke=stroke).slow_side() or 1.0
    return side * part.offset.upper > 0.0 or side * part.offset.lower > 0.0
