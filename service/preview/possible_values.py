"""Values that a job's ranges allow, from samples: rotation, stroke, time ratio, transmission angle, feasible fraction.

The samples are a few hundred designs. Equality requirements are met exactly, so the samples lie where the search looks.
Fractions are those of uniform samples; others lie on faces and edges of the box. Extremes are searched for
around the best samples and polished: each belongs to an actual design.
"""

import math
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...model.cycle.stroke_times import massless_machine, slow_stroke
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...objectives.registry import QUANTITIES
from ...optimise.feasibility.best_value import with_single_objective
from ...optimise.problem.constraint_violation import FEASIBLE, constraints_with_floors
from ...optimise.problem.problem import Problem
from ...optimise.problem.requirements import Constraint, Objective
from ...optimise.search.elimination import EliminationBranch, elimination_branches
from ...optimise.search.evaluation import Evaluator
from ...optimise.search.polish import polish_designs
from ...optimise.search.sampling import first_samples, random_generator
from .partial_job import depends_on_dimensions_only
from .samples import BATCH, SAMPLES, sampled_designs, screened_samples

T = TypeVar("T")
Ends = tuple[float, float]

PATIENCE = 0.12  # s; requirements that take longer are not checked
_WIDTHS = (0.1, 0.05, 0.025, 0.012, 0.006, 0.003, 0.0015)
_ON_EDGE = 128
_PARENTS, _CHILDREN = 12, 12
_STAYS = 0.4
_POLISHED = 4  # number of best designs to polish for each end of a range
_FLATTEST = math.radians(0.1)
"""Minimum transmission angle considered: designs nearer to locking are of no interest."""
_CLOSE = 1e-6
"""Relative violation of a requirement that still counts as met: samples on a surface lie on it within rounding."""
_ONE = threading.Lock()
"""Lock for background work: kernels new to a machine compile for up to a minute, once."""


@dataclass(frozen=True, kw_only=True)
class Feasibility:
    """Designs that the ranges of a job allow.

    feasible: fraction of the `sampled` ones that meet every checked requirement. met_by_all: requirements that every
    sample meets: exact values and narrow bands. example: crank, rod and offset, m; None if no design makes the motion.
    unchecked: requirements too slow to check, or that need the rest of the job.
    """

    feasible: float
    sampled: int
    met_by_all: tuple[str, ...]
    example: tuple[float, float, float] | None
    example_feasible: bool
    unchecked: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Possible(Feasibility):
    """Values that the ranges of a job allow. turning: fraction of the box that rotates fully.

    stroke (m), time_ratio, transmission_angle (rad): range bounds, subject to all other requirements on the dimensions;
    None if no sample meets these. They respect the default minimum transmission angle if there is no other requirement
    on it. slow_strokes: slow strokes of the designs that meet every checked requirement, or else of those that rotate
    fully; "equal" only if no design has a slow stroke. hardest: requirement that the fewest fully rotating designs
    meet, and their fraction. nearest: value of its quantity, SI, that one in ten samples that meet all others reach, if
    none meets all. The example is near the middle of the feasible designs; if there are none, it is the least
    infeasible one.
    """

    turning: float
    stroke: Ends | None
    time_ratio: Ends | None
    transmission_angle: Ends | None
    slow_strokes: tuple[str, ...]
    hardest: tuple[str, float] | None
    nearest: float | None


def possible_values(problem: Problem) -> Possible:
    """Return the values that the ranges of a problem from `partial_job.problem_in_crank_rod_offset` allow."""
    free = replace(problem, constraints=())
    box, is_uniform = sampled_designs(free)
    turning = _rotates_fully(box)
    uniform = box[turning & is_uniform]
    light, costly = _dimensional_problem(problem)
    screening = run_within(PATIENCE, lambda: screened_samples(problem)) if costly else None
    sample = screened_samples(light) if screening is None else screening
    feasible = sample.is_feasible
    if screening is None:
        hardest = _hardest_requirement(light, uniform)
    else:
        hardest = run_within(PATIENCE, lambda: _hardest_requirement(problem, uniform[:BATCH]))
    return Possible(
        turning=float(turning[is_uniform].mean()),
        stroke=_possible_ends(light, "stroke"),
        time_ratio=_possible_ends(light, "time_ratio"),
        transmission_angle=_possible_ends(light, "transmission_angle"),
        slow_strokes=_slow_strokes(light, sample.designs[feasible] if feasible.any() else box[turning]),
        feasible=sample.feasible_fraction,
        sampled=sample.uniform_sample_count,
        met_by_all=sample.met_by_all,
        hardest=hardest,
        nearest=None
        if hardest is None or feasible.any()
        else run_within(PATIENCE, partial(_nearest_value, light if screening is None else problem, hardest[0])),
        example=lengths_of(example_design(sample.designs, sample.violation, box[turning])),
        example_feasible=bool(feasible.any()),
        unchecked=costly if screening is None else (),
    )


def _dimensional_problem(problem: Problem) -> tuple[Problem, tuple[str, ...]]:
    """Return the problem with only the requirements on the dimensions, and the names of the others."""
    machine = massless_machine(problem.mechanism)
    closed = tuple(c for c in problem.constraints if depends_on_dimensions_only(c.quantity))
    costly = tuple(c.quantity for c in constraints_with_floors(problem) if not depends_on_dimensions_only(c.quantity))
    return replace(problem, mechanism=machine, constraints=closed), costly


def _slow_strokes(problem: Problem, designs: Array) -> tuple[str, ...]:
    """Return the slow strokes among fully rotating designs (n, 3); "equal" only if there are no others."""
    if not len(designs):
        return ()
    machine = problem.mechanism
    crank, rod, offset = designs.T
    strokes = {str(stroke) for stroke in slow_stroke(machine, Linkage(crank, rod, offset, machine.branch))}
    return tuple(sorted(strokes - {"equal"} or strokes))


def _rotates_fully(designs: Array) -> NDArray[np.bool_]:
    crank, rod, offset = designs.T
    with np.errstate(invalid="ignore"):
        return np.asarray((crank > 0.0) & (rod > crank + np.abs(offset)))


@lru_cache(maxsize=48)  # most edits between previews change neither ranges nor requirements
def _possible_ends(problem: Problem, name: str) -> Ends | None:
    """Return the range of a closed-form quantity subject to the other requirements on the dimensions."""
    constraints = tuple(
        c for c in constraints_with_floors(problem) if depends_on_dimensions_only(c.quantity) and c.quantity != name
    )
    if name == "transmission_angle":
        constraints = (*constraints, Constraint(quantity=name, lower=_FLATTEST))
    alone = replace(problem, constraints=constraints)
    ends = [_ends_on_branch(alone, name, branch, index) for index, branch in enumerate(elimination_branches(alone))]
    pairs = [pair for pair in ends if pair is not None]
    return (min(low for low, _ in pairs), max(high for _, high in pairs)) if pairs else None


def _ends_on_branch(problem: Problem, name: str, branch: EliminationBranch, index: int) -> Ends | None:
    """Return the minimum and maximum on a branch, sampled ever more densely around the best samples."""
    points = np.concatenate(
        [first_samples(SAMPLES, len(branch.free), 1, index), *_points_at_limits_of_requirements(problem, branch)]
    )
    values = _closed_form_values(problem, name, branch.designs_at_points(points)[:, :3])
    if not np.isfinite(values).any():
        return None
    random = random_generator(1, 100 + index)
    ends = []
    for sign in (-1.0, 1.0):
        best, merits = points, np.where(np.isfinite(values), sign * values, -np.inf)
        for width in _WIDTHS if len(branch.free) else ():
            rows = np.argsort(-merits, kind="stable")[:_PARENTS]
            rows = rows[np.isfinite(merits[rows])]
            children = np.repeat(best[rows], _CHILDREN, axis=0)
            step = width * random.standard_normal(children.shape)
            stays = random.random(children.shape) < _STAYS  # extremes lie on faces and edges; moves follow these
            children = np.clip(children + np.where(stays, 0.0, step), 0.0, 1.0)
            child_values = _closed_form_values(problem, name, branch.designs_at_points(children)[:, :3])
            best = np.concatenate([best[rows], children])
            merits = np.concatenate([merits[rows], np.where(np.isfinite(child_values), sign * child_values, -np.inf)])
        start = best[np.argsort(-merits, kind="stable")[:_POLISHED]]
        ends.append(sign * max(float(merits.max()), _polished_extreme(problem, name, branch, sign, start)))
    return ends[0], ends[1]


def _polished_extreme(problem: Problem, name: str, branch: EliminationBranch, sign: float, start: Array) -> float:
    """Return the maximum of `sign` times a closed-form quantity near points (n, k) of a branch.

    It is -inf if no design is found. All requirements of the problem apply, except those on the quantity itself.
    """
    objective = Objective(quantity=name, sense="maximise" if sign > 0.0 else "minimise")
    evaluator = Evaluator(replace(problem, objectives=(objective,)), branch)
    start = start[evaluator.can_evaluate(start)]
    if not branch.free or not len(start):
        return -np.inf
    polished = polish_designs(evaluator, start, np.ones(1))
    good = polished.violation <= FEASIBLE
    return float(-polished.values[good, 0].min()) if good.any() else -np.inf


def _points_at_limits_of_requirements(problem: Problem, branch: EliminationBranch) -> Iterator[Array]:
    """Yield points of a branch (n, k) at the limit of a requirement.

    Extremes lie there, and the feasible bands are thin.
    """
    for place, constraint in enumerate(problem.constraints):
        for end in (constraint.lower, constraint.upper):
            if end is None or constraint.equality or not branch.free:
                continue
            edge = replace(constraint, lower=end, upper=end)
            rest = (*problem.constraints[:place], edge, *problem.constraints[place + 1 :])
            for branch_on_edge in elimination_branches(replace(problem, constraints=rest)):
                designs = branch_on_edge.designs_at_points(first_samples(_ON_EDGE, len(branch_on_edge.free), 1, place))[
                    :, :3
                ]
                designs = designs[_rotates_fully(designs) & _is_within_ranges(problem, designs)]
                if branch_on_edge.sign == branch.sign and len(designs):
                    columns = [np.abs(designs[:, DIMENSIONS.index(free)]) for free in branch.free]
                    points = (np.stack(columns, axis=1) - branch.lower) / (branch.upper - branch.lower)
                    yield np.clip(points, 0.0, 1.0)


def _closed_form_values(problem: Problem, name: str, designs: Array) -> Array:
    """Return a closed-form quantity of designs (n, 3); NaN if one does not rotate fully or violates a dimension."""
    values = np.full(len(designs), np.nan)
    rows = np.flatnonzero(_rotates_fully(designs) & _is_within_ranges(problem, designs))
    for constraint in problem.constraints:
        constrained = QUANTITIES[constraint.quantity].evaluate(problem.mechanism, designs[rows]).values
        rows = rows[_meets_constraint(constraint, constrained)]
    values[rows] = QUANTITIES[name].evaluate(problem.mechanism, designs[rows]).values
    return values


def _is_within_ranges(problem: Problem, designs: Array) -> NDArray[np.bool_]:
    """Whether dimensions computed from equalities lie within their ranges."""
    good = np.ones(len(designs), dtype=bool)
    for column, name in enumerate(DIMENSIONS):
        ends = getattr(problem, name)
        slack = _CLOSE * max(abs(ends.lower), abs(ends.upper))
        with np.errstate(invalid="ignore"):
            good &= (designs[:, column] >= ends.lower - slack) & (designs[:, column] <= ends.upper + slack)
    return good


def _meets_constraint(constraint: Constraint, values: Array) -> NDArray[np.bool_]:
    good = ~np.isnan(values)
    if constraint.lower is not None:
        good &= values >= constraint.lower - _CLOSE * abs(constraint.lower)
    if constraint.upper is not None:
        good &= values <= constraint.upper + _CLOSE * abs(constraint.upper)
    return np.asarray(good)


def _hardest_requirement(problem: Problem, designs: Array) -> tuple[str, float] | None:
    """Return the requirement that the fewest designs meet, equalities aside, and their fraction."""
    shares = {
        constraint.quantity: float(
            _meets_constraint(
                constraint, QUANTITIES[constraint.quantity].evaluate(problem.mechanism, designs).values
            ).mean()
        )
        for constraint in constraints_with_floors(problem)
        if not constraint.equality and len(designs)
    }
    return min(shares.items(), key=lambda item: item[1]) if shares else None


def _nearest_value(problem: Problem, name: str) -> float | None:
    """Return a value of a quantity, SI, near its requirement.

    One in ten samples that meet all other requirements is at least as near. Only very few designs meet the nearest
    value itself, so the samples of a job that requires it might contain none.
    """
    constraint = next(item for item in constraints_with_floors(problem) if item.quantity == name)
    others = tuple(item for item in problem.constraints if item.quantity != name)
    if constraint.lower is not None and constraint.upper is not None:
        sought = with_single_objective(problem, name, "target", 0.5 * (constraint.lower + constraint.upper))
    else:
        sought = with_single_objective(problem, name, "minimise" if constraint.lower is None else "maximise")
    sample = screened_samples(replace(sought, constraints=others))
    rows = np.flatnonzero(sample.is_feasible)
    if not len(rows):
        return None
    row = rows[np.argsort(sample.objectives[rows, 0])[len(rows) // 10]]
    value = float(QUANTITIES[name].evaluate(problem.mechanism, sample.designs[[row]]).values[0])
    return value if math.isfinite(value) else None


def example_design(designs: Array, violation: Array, fallback: Array) -> Array | None:
    """Return the most central feasible design, or else the least infeasible, or else the middle of the fallback."""
    if (feasible := violation <= FEASIBLE).any():
        return _most_central_design(designs[feasible])
    if np.isfinite(violation).any():
        return _most_central_design(designs[[int(np.nanargmin(violation))]])
    return _most_central_design(fallback) if len(fallback) else None


def lengths_of(design: Array | None) -> tuple[float, float, float] | None:
    """Return crank, rod and offset of a design."""
    return None if design is None else (float(design[0]), float(design[1]), float(design[2]))


def _most_central_design(designs: Array) -> Array:
    """Return the design nearest to the centre of some designs, with each number on its own scale."""
    size = np.abs(designs).max(axis=0) + 1e-300
    scaled = designs / size
    return np.asarray(designs[int(np.argmin(((scaled - np.median(scaled, axis=0)) ** 2).sum(axis=1)))])


def run_within(seconds: float, work: Callable[[], T]) -> T | None:
    """Return the result of background work; None if it takes too long, or earlier work is still running."""
    results: list[T] = []
    failed: list[Exception] = []

    def run() -> None:
        try:
            results.append(work())
        except Exception as error:  # noqa: BLE001 - raised again where it is waited for
            failed.append(error)
        finally:
            _ONE.release()

    if not _ONE.acquire(timeout=seconds):
        return None
    thread = threading.Thread(target=run, daemon=True, name="preview")
    thread.start()
    thread.join(seconds)
    if failed:
        raise failed[0]
    return results[0] if results else None
