"""Warnings before and after a search: a fast loaded stroke, and offsets that a slow stroke excludes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Mask
from ...model.cycle.stroke_times import slow_stroke
from ...model.linkage.linkage import Linkage, SlowStroke
from ...model.linkage.loaded_stroke import loaded_stroke
from ..problem.job_remark import Change, Remark
from ..problem.problem import Problem
from .designs_for_warnings import sampled_designs
from .elimination import offset_signs

if TYPE_CHECKING:
    from ..front.front import ParetoFront


def stroke_warnings(problem: Problem, *, certain: bool = False) -> list[str]:
    """Return the warnings for a problem: fast loaded strokes within its ranges, and excluded offsets.

    The first applies only if the problem requires no slow stroke, the second only if it does. certain: whether to warn
    only about strokes that are fast in every sampled design.
    """
    if problem.motion is not None:  # forward and return strokes differ only in their drive
        return []
    if problem.slow_stroke is not None or all(
        load.may_drive for load in problem.mechanism.loads
    ):  # this saves sampling
        return _excluded_offset_warnings(problem)
    fast, turning, sides = 0, 0, []
    for part, designs in sampled_designs(problem):
        if part.slow_stroke is not None or not len(designs):
            continue
        linkage = Linkage(designs[:, 0], designs[:, 1], designs[:, 2], part.mechanism.branch)
        slow = np.atleast_1d(slow_stroke(part.mechanism, linkage))
        loaded = loaded_stroke(part.mechanism, designs)
        is_fast = _has_fast_load(slow, loaded)
        fast, turning = fast + int(is_fast.sum()), turning + int((_is_one_stroke(slow) & _is_one_stroke(loaded)).sum())
        sides += [str(stroke) for stroke in loaded[is_fast]]
    if not fast or (certain and fast < turning):
        return _excluded_offset_warnings(problem)
    extent = "in every sampled design" if fast == turning else "in some sampled designs"
    return [*_excluded_offset_warnings(problem), _fast_stroke_warning(problem, extent, sides)]


def front_stroke_warnings(front: ParetoFront) -> list[str]:
    """Return the warnings for a front: fast loaded strokes of its designs, and excluded offsets."""
    if not len(front):
        return []
    free = np.array([front.part(row).slow_stroke is None for row in range(len(front))])
    if front.problem.motion is not None:
        return []
    slow, loaded = (front.columns[name] for name in ("slow_stroke", "loaded_stroke"))
    is_fast = free & _has_fast_load(slow, loaded)
    if not is_fast.any():
        return _excluded_offset_warnings(front.problem)
    count = int(is_fast.sum())
    extent = f"in {count} of {len(front)} designs" if len(front) > 1 else "in this design"
    return [
        *_excluded_offset_warnings(front.problem),
        _fast_stroke_warning(front.problem, extent, [str(stroke) for stroke in loaded[is_fast]]),
    ]


def _excluded_offset_warnings(problem: Problem) -> list[str]:
    """Return the warning about a slow stroke that excludes the larger part of a range of offsets."""
    for part in problem.parts():
        side, lower, upper = part.slow_side(), part.offset.lower, part.offset.upper
        if side is None or not lower < 0.0 < upper:
            continue
        low, high = (0.0, upper) if side > 0.0 else (lower, 0.0)
        if high - low < 0.5 * (upper - lower):
            turning, opposite = "counter-clockwise", "clockwise"
            if part.mechanism.direction < 0.0:
                turning, opposite = opposite, turning
            left = [f"{1e3 * end:.10g} mm" for end in (low, high)]
            sentence = (
                f'slow_stroke = "{part.slow_stroke}" leaves only offsets from {1e3 * low:.6g} to {1e3 * high:.6g} mm '
                f"of the range from {1e3 * lower:.6g} to {1e3 * upper:.6g} mm, because the crank turns {turning}; if "
                f"you mean the others, let it turn {opposite}"
            )
            if any(item.name == "offset" for item in problem.discrete):
                return [sentence]
            return [Remark(sentence, Change("variables.offset", left, f"Search offsets from {left[0]} to {left[1]}"))]
    return []


def _has_fast_load(slow: NDArray[np.str_], loaded: NDArray[np.str_]) -> Mask:
    return np.asarray(_is_one_stroke(slow) & _is_one_stroke(loaded) & (slow != loaded))


def _is_one_stroke(strokes: NDArray[np.str_]) -> Mask:
    return np.isin(strokes, ("outward", "inward"))


def _fast_stroke_warning(problem: Problem, extent: str, loaded: list[str]) -> str:
    stroke: SlowStroke = "outward" if 2 * loaded.count("outward") >= len(loaded) else "inward"
    has = any(offset_signs(replace(part, slow_stroke=stroke)) for part in problem.parts())
    turn = "" if has else ", with the opposite sign of the offset or direction of rotation"
    opposite = "inward" if stroke == "outward" else "outward"
    required = stroke if has else opposite
    return Remark(
        f"{extent} the loaded stroke (the {stroke} one, against the load) is the faster one; for a slow loaded stroke "
        f'require slow_stroke = "{stroke}" among the constraints{turn}; if it should be fast, require '
        f'slow_stroke = "{opposite}"',
        Change("constraints.slow_stroke", required, f"Require a slow {required} stroke"),
    )
