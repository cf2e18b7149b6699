"""Find a design like a given one that also meets further requirements: the nearest point on the remaining front.

The requirements are added to those of the problem. The result is the Pareto-optimal design of the extended problem that
is nearest to the given one. The measure is the Euclidean distance in the objectives, each divided by its range over the
given front.

A solver cannot search the set of Pareto-optimal designs directly, but the polish maps every point onto that set and
leaves its members unchanged. So samples cover the extended problem, and those nearest to the given design are polished,
followed by points around the nearest results, closer in every round. Every result is a polished design, stationary and
on its constraints to rounding. How near it is depends on the sampling, which the tests check against dense fronts.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError, warn_user
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage_values import implausible_length_text
from ..front.dominance import dominating
from ..front.front import ParetoFront, least_and_greatest_of_bounds, require_front
from ..front.hypervolume import ideal_and_range
from ..front.stationarity import STATIONARY
from ..job.mistake_messages import key_of_location
from ..methods.registry import require_gradients
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem, Settings
from ..problem.requirements import Constraint, Range
from ..search.assemble_front import assemble_front, empty_front
from ..search.candidates import FrontCandidates
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.recorded_polish import polish_on_engine
from ..search.sample_and_zoom import Archive, Run, enumerate_branches, sample_and_zoom, searched_evaluators
from ..search.sampling import random_generator
from ..solve import solve

Ends = tuple[float | None, float | None]

_STARTS = 48
"""Number of samples to polish first, the nearest ones."""
_PARENTS, _CHILDREN = 2, 8  # per round: nearest designs, and points around each
_WIDEST, _CLOSEST = 0.1, 1e-6  # spread in the unit box in the first and the last round
_ROUNDS = 30
_BEATEN = 1e-6  # relative to the objectives' range: a smaller domination is rounding


def distance_to_design(values: Array, reference: Array, span: Array) -> Array:
    """Return the distance (n,) of designs (n, m) from a given one (m,), with objectives divided by `span` (m,)."""
    return np.asarray(np.linalg.norm((values - reference) / span, axis=1))


def nearest_optimal_design(
    problem: Problem,
    row: Mapping[str, object],
    values: Array,
    span: Array,
    constraints: Sequence[Constraint] = (),
    ranges: Mapping[str, Ends] | None = None,
) -> ParetoFront:
    """Return a front with the extended problem's Pareto-optimal design that is nearest to a given one.

    row: the given design's row in the table of its front. values: its objectives (m,) as minimised, SI. span: (m,), the
    objectives' ranges over its front. constraints: constraints to add. ranges: least and greatest crank, rod or offset,
    m, None if unbounded. Residuals are scaled by `span`. If no design is feasible, the front is empty and its message
    names the requirements that contradict each other. Raises `InputError` if nothing is added, if the design already
    meets all requirements, or for a quantity without gradient.
    """
    ranges = ranges or {}
    _require_new_requirement(problem, row, constraints, ranges)
    extended_problem, contradiction = extend_problem(problem, constraints, ranges)
    require_gradients(extended_problem, "the search for a design like another")
    evaluators = [Evaluator(extended_problem, branch) for branch in elimination_branches(extended_problem)]
    run = Run(extended_problem, 1)
    if contradiction:
        return empty_front(
            extended_problem, evaluators, run, "infeasible", f"no design meets all requirements: {contradiction}"
        )
    finished = enumerate_branches(extended_problem, evaluators, run).only_enumerated(span)
    free = searched_evaluators(evaluators)
    archive = sample_and_zoom(extended_problem, free, run) if free else Archive.empty(len(span))
    order = np.argsort(distance_to_design(archive.values, values, span), kind="stable")[:_STARTS]
    for index, u in archive[order].points_by_branch(evaluators):
        finished.add_feasible(index, polish_on_engine(evaluators[index], u, span))
    if not len(finished):
        return _keep_nearest(solve(extended_problem), values, span)
    _add_nearer_designs(finished, free, archive, values, extended_problem.settings.seed)
    return assemble_front(extended_problem, evaluators, finished[_rank_by_distance(finished, archive, values)[:1]], run)


def like(
    front: ParetoFront, row: int, *constraints: Constraint, ranges: Mapping[str, Ends] | None = None
) -> ParetoFront:
    """Return, as a separate front, the design most like one of a front that also meets further requirements.

    It is the nearest one among the extended problem's Pareto-optimal designs. If the requirements contradict the rest,
    the front is empty and its message gives the reason. ranges: least and greatest crank, rod, offset, m: `like(front,
    3, Constraint(quantity="transmission_angle", lower=0.8), ranges={"crank": (0.04, None)})`. Warns about limits that
    were probably meant in mm.
    """
    require_front(front, "like")
    for item in constraints:
        if not isinstance(item, Constraint):
            raise InputError(
                f"a requirement passed to like() must be a Constraint; got {item!r}; write it like "
                'Constraint(quantity="time_ratio", lower=1.2)'
            )
    ranges = {name: least_and_greatest_of_bounds(name, ends) for name, ends in (ranges or {}).items()}
    front.part(row)  # raises an error for an unknown row
    ends = (np.array(ranges.get(name, ()), dtype=np.float64) for name in DIMENSIONS)
    if (doubt := implausible_length_text(ends)) is not None:
        warn_user(f"ranges of lengths are in m: {doubt}")
    table = {name: values[row] for name, values in front.columns.items()}
    return nearest_optimal_design(
        front.problem, table, front.values[row], ideal_and_range(front.values)[1], constraints, ranges
    )


def extend_problem(
    problem: Problem, constraints: Sequence[Constraint], ranges: Mapping[str, Ends]
) -> tuple[Problem, str | None]:
    """Return the problem with added requirements merged, and the contradictory one that was left out, if any."""
    constraints_by_name = {constraint.quantity: constraint for constraint in problem.constraints}
    dimensions = {name: getattr(problem, name) for name in DIMENSIONS}
    contradictions, keys = [], []
    for added in constraints:
        required = constraints_by_name.get(added.quantity)
        ends = intersect_ranges(
            (added.lower, added.upper), (required.lower, required.upper) if required else (None, None)
        )
        quantity = problem.quantity(added.quantity)
        if ends is None:
            assert required is not None
            unit = quantity.unit
            existing = f"{_ends_text((required.lower, required.upper), unit.factor, unit.symbol)} is already required"
            stricter = _ends_text((added.lower, added.upper), unit.factor, unit.symbol)
            contradictions.append(f"{quantity.title} {stricter}, where {existing}")
            keys.append(key_of_location(["constraints", added.quantity]))
        else:
            constraints_by_name[added.quantity] = Constraint(quantity=added.quantity, lower=ends[0], upper=ends[1])
    for name, requested in ranges.items():
        range_of_name = dimensions[name]
        ends = intersect_ranges(requested, (range_of_name.lower, range_of_name.upper))
        if ends is None:
            existing = f"{_ends_text((range_of_name.lower, range_of_name.upper), 1e3, 'mm')} is its range"
            contradictions.append(f"{name} {_ends_text(requested, 1e3, 'mm')}, where {existing}")
            keys.append(f"variables.{name}")
        else:
            assert ends[0] is not None
            assert ends[1] is not None
            dimensions[name] = Range(lower=ends[0], upper=ends[1])
    remedy = [f"choose other values, or change {' and '.join(keys)} in the job and solve it again"] if keys else []
    # An approximate search is enough here, whatever method made the front.
    settings = Settings(designs=problem.settings.designs, seed=problem.settings.seed)
    return (
        replace(problem, constraints=tuple(constraints_by_name.values()), settings=settings, **dimensions),
        "; ".join([*contradictions, *remedy]) or None,
    )


def intersect_ranges(first: Ends, second: Ends) -> Ends | None:
    """Return the intersection of two ranges, None if it is empty."""
    lower = max((end for end in (first[0], second[0]) if end is not None), default=None)
    upper = min((end for end in (first[1], second[1]) if end is not None), default=None)
    return None if lower is not None and upper is not None and lower > upper else (lower, upper)


def _ends_text(ends: Ends, factor: float, unit: str) -> str:
    lower, upper = (None if end is None else f"{end * factor:.6g} {unit}".rstrip() for end in ends)
    if lower == upper:
        return f"exactly {lower}"
    parts = ([f"at least {lower}"] if lower else []) + ([f"at most {upper}"] if upper else [])
    return " and ".join(parts)


def _require_new_requirement(
    problem: Problem, row: Mapping[str, object], constraints: Sequence[Constraint], ranges: Mapping[str, Ends]
) -> None:
    columns: list[tuple[str, float, Ends]] = []
    for item in constraints:
        quantity = problem.quantity(item.quantity)
        columns.append((quantity.field, quantity.unit.factor, (item.lower, item.upper)))
    for name, ends in ranges.items():
        if name not in DIMENSIONS:
            raise InputError(f"a range must name crank, rod or offset; got {name!r}; name one of them")
        if ends[0] is not None and ends[1] is not None and ends[0] > ends[1]:
            raise InputError(
                f"the range of {name} must be ascending; got {1e3 * ends[0]:g} mm to {1e3 * ends[1]:g} mm; put the "
                "smaller end first"
            )
        columns.append((f"{name}_mm", 1e3, ends))
    if not columns:
        raise InputError("nothing differs from the given design; add a constraint or a range")
    if all(key in row and _lies_within(row[key], ends, factor) for key, factor, ends in columns):
        raise InputError("the design already meets the added conditions; make them stricter")


def _lies_within(value: object, ends: Ends, factor: float) -> bool:
    lower, upper = (None if end is None else end * factor for end in ends)
    assert isinstance(value, float)
    return (lower is None or value >= lower - FEASIBLE * abs(lower)) and (
        upper is None or value <= upper + FEASIBLE * abs(upper)
    )


def _add_nearer_designs(
    finished: FrontCandidates, evaluators: list[Evaluator], archive: Archive, values: Array, seed: int
) -> None:
    """Add polished designs around the nearest ones, ever more closely."""
    random = random_generator(seed, 2000)
    width = _WIDEST
    for _ in range(_ROUNDS):
        parents = _rank_by_distance(finished, archive, values)[:_PARENTS]
        before = distance_to_design(finished.values[parents[:1]], values, finished.span)[0]
        for index, u in finished[parents].points_by_branch(evaluators):
            evaluator = evaluators[index]
            points = np.repeat(u, _CHILDREN, axis=0)
            points = np.clip(points + width * random.standard_normal(points.shape), 0.0, 1.0)
            points = points[evaluator.can_evaluate(points)]
            if len(points):
                finished.add_feasible(index, polish_on_engine(evaluator, points, finished.span))
        after = distance_to_design(
            finished.values[_rank_by_distance(finished, archive, values)[:1]], values, finished.span
        )[0]
        # A design that still moves nearer by about one step has not reached its nearest point yet.
        if before - after < 0.5 * width:
            width *= 0.5
        if width < _CLOSEST:
            break


def _rank_by_distance(finished: FrontCandidates, archive: Archive, values: Array) -> IntArray:
    """Return the rows of non-dominated designs, nearest first; stationary ones before all others."""
    rows = finished.nondominated_rows()
    if archive.is_feasible.any():  # samples within a band around the constraints prove nothing
        scaled, screened = finished.values[rows] / finished.span, archive.values[archive.is_feasible] / finished.span
        beaten = dominating(-scaled, -screened, clearly=_BEATEN)
        rows = rows[~beaten] if not beaten.all() else rows
    distances = distance_to_design(finished.values[rows], values, finished.span)
    return rows[np.lexsort((distances, finished.residual[rows] > STATIONARY))]


def _keep_nearest(front: ParetoFront, values: Array, span: Array) -> ParetoFront:
    """Return a front with only its nearest design; an empty front unchanged."""
    if not len(front):
        return front
    row = int(np.argmin(distance_to_design(front.values, values, span)))
    return replace(
        front,
        message=f"1 design, {front.evaluations} evaluated",
        columns={name: values[[row]] for name, values in front.columns.items()},
        dimensions=front.dimensions[[row]],
        values=front.values[[row]],
        goals=(front.goals[row],),
        active=(front.active[row],),
    )
