"""Warnings about the strokes: a fast loaded one, excluded offsets, a part longer than the stroke."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array, Mask
from ...model.cycle.stroke_times import slow_stroke
from ...model.linkage.linkage import Linkage, SlowStroke
from ...model.linkage.loaded_stroke import loaded_stroke
from ...model.machine.loads.load import Load
from ...model.machine.loads.position_table import PositionTable
from ...objectives.lengths_and_time_ratio import STROKE
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..problem.question_registry import Change, Remark
from ..problem.requirements import Constraint
from .elimination import EliminationBranch, elimination_branches, offset_signs
from .evaluation import Evaluator
from .sampling import first_samples

if TYPE_CHECKING:
    from ..front.front import ParetoFront


_SAMPLES = 32
"""Number of designs per branch, besides those with extreme numbers and stroke."""
_TRIED = 4096
"""Number of points over all branches from which these are taken: checks that need no cycle cost a microsecond per
point."""
_BRANCHES = 20
"""Maximum number of branches; with very many choices, the first ones."""
_NARROW = 0.1
"""Relative width of a range that points rarely hit; its middle is required instead."""


def sampled_designs(problem: Problem) -> Iterator[tuple[Problem, Array]]:
    """Yield designs (n, 3 + k) that make the required motion, with the problem for their choices.

    They meet the requirements on lengths, stroke and everything else that needs no cycle. If no point does, those with
    the least violation count.
    """
    branches = elimination_branches(problem)[:_BRANCHES]
    count = max(_SAMPLES, _TRIED // len(branches))
    for branch in branches:
        part = problem.part(branch.variant)
        tried = [_try_points(part, branch, count)]
        if not _has_feasible(tried[0]):
            middle = replace(part, constraints=tuple(map(_middle_of_narrow_range, part.constraints)))
            tried += [
                _try_points(middle, middle_branch, count)
                for middle_branch in elimination_branches(middle)
                if middle_branch.sign == branch.sign
            ]
        designs, misses = next(filter(_has_feasible, tried), tried[0])
        order = np.argsort(np.maximum(misses, FEASIBLE), kind="stable")
        count_feasible = np.count_nonzero(misses <= FEASIBLE) or _SAMPLES
        yield part, _representative_rows(part, designs[order][:count_feasible])


def _try_points(part: Problem, branch: EliminationBranch, count: int) -> tuple[Array, Array]:
    """Return designs (n, 3 + k) of a branch that make the required motion, and their violation (n,)."""
    evaluator = Evaluator(part, branch)
    points = first_samples(count, len(branch.free), 0, 0)
    points = points[evaluator.can_evaluate(points)]
    return branch.designs_at_points(points), evaluator.violation_without_cycle(points)


def _has_feasible(tried: tuple[Array, Array]) -> bool:
    return bool((tried[1] <= FEASIBLE).any())


def _middle_of_narrow_range(constraint: Constraint) -> Constraint:
    """Return the middle of a narrow range as a required value."""
    lower, upper = constraint.lower, constraint.upper
    if lower is None or upper is None or upper - lower > _NARROW * max(abs(lower), abs(upper)):
        return constraint
    return replace(constraint, lower=0.5 * (lower + upper), upper=0.5 * (lower + upper))


def _representative_rows(part: Problem, designs: Array) -> Array:
    """Return the first designs and those with extreme numbers and stroke."""
    if not len(designs):
        return designs
    stroke = STROKE.evaluate(part.mechanism, designs).values
    columns = np.column_stack([designs, np.where(np.isfinite(stroke), stroke, designs[:, 0])])
    rows = {*range(min(_SAMPLES, len(designs))), *columns.argmin(axis=0).tolist(), *columns.argmax(axis=0).tolist()}
    return designs[sorted(rows)]


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


_ROUNDING = 1e-9
"""Relative: a part that is longer by less is the whole stroke, as intended."""


def overlong_part_warnings(problem: Problem) -> list[str]:
    """Return a warning for each force whose part of the stroke is longer than every sampled stroke.

    Does not apply to a swing, which need not have dead centres.
    """
    if problem.motion is not None or not any(
        _part_length(load) for part in problem.parts() for load in part.mechanism.loads
    ):
        return []
    machines, longest = [], 0.0
    for part, designs in sampled_designs(problem):
        strokes = STROKE.evaluate(part.mechanism, designs).values
        machines.append(part.mechanism)
        longest = max([longest, *strokes[np.isfinite(strokes)].tolist()])
    warnings = []
    for k, load in enumerate(problem.mechanism.loads):
        least = min(_part_length(machine.loads[k]) for machine in machines)
        if isinstance(load, PositionTable) and least > longest * (1.0 + _ROUNDING) > 0.0:
            place = "last" if (load.datum, load.during) in _LAST else "first"
            warnings.append(
                f"load #{k + 1} acts over the {place} {1e3 * least:.6g} mm of the {load.during}, but the longest "
                f"stroke of the sampled designs is {1e3 * longest:.4g} mm, so it acts over the whole stroke; shorten "
                "this part, or leave it out"
            )
    return warnings


_LAST = {("outer dead centre", "outward stroke"), ("inner dead centre", "inward stroke")}


def _part_length(load: Load) -> float:
    """Return the length, m, over which a constant force acts in a stroke; 0 for any other load."""
    if not isinstance(load, PositionTable) or load.during == "cycle" or load.datum == "crank pivot":
        return 0.0
    first, *others = load.positions
    is_constant = len(others) == 2 and first == 0.0 and load.forces[0] == load.forces[1] and load.forces[2] == 0.0
    return others[0] if is_constant and others[0] == others[1] else 0.0
