"""The front of a problem with discrete numbers.

The continuous front comes first, because it shows what discrete values cost. If there are few enough combinations, all
are judged, and the answer is exact. If no unknown is free, a combination is a design; otherwise the free unknowns are
searched and polished for each combination. If there are too many combinations, those around the continuous front are
judged, then those around the best of these.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...model.arrays import Array, IntArray
from ...objectives.tables.design_input import columns_of_design_numbers
from ..front.dominance import nondominated
from ..front.front import ParetoFront, Status
from ..front.hypervolume import ReportProgress, choose_designs_by_hypervolume
from ..front.progress import DiscreteSearch
from ..front.rounded_design import drop_conversion_rounding
from ..problem.problem import Problem
from ..problem.robust_problem import has_robust_requirements
from ..problem.table_columns import STATUS
from .combinations import (
    Axes,
    FeasibleDesigns,
    best_near_designs,
    best_of_all_combinations,
    combinations_around,
    has_judged_neighbours,
    problem_with_combinations,
)
from .discrete_messages import failure_message, result_message

MOST, _MOST_ROBUST = 5_000_000, 1 << 13
"""Maximum number of complete combinations to judge exhaustively; robust quantities take a hundred times as long."""
_WINDOW = 1_000_000
"""If there are more combinations, this many around the continuous front are judged first."""
SOLVED = 64
"""Number of incomplete combinations to search: all if few, otherwise those next to the continuous front."""
_SAME = 1e-9  # relative to the objectives' range: designs nearer than this are the same
Search = Callable[[Problem], ParetoFront]
Chosen = list[tuple[int, Array]]


def discrete_front(
    problem: Problem, search: Search, nothing: Callable[[Status, str], ParetoFront], report: ReportProgress
) -> ParetoFront:
    """Return the front of a problem with discrete numbers.

    search: solves a continuous problem. nothing: makes an empty front from a status and a message. report: called
    between steps.
    """
    axes = [Axes.of_problem(part) for part in problem.parts()]
    is_complete, count = all(axis.has_no_free_number for axis in axes), sum(axis.combination_count for axis in axes)
    limit = (_MOST_ROBUST if has_robust_requirements(problem) else MOST) if is_complete else SOLVED
    exact = count <= limit
    judged: FeasibleDesigns | None = None
    chosen: Chosen = []
    judged_numbers: list[IntArray] = []
    if exact and is_complete:
        chosen, judged = _designs_to_deliver(problem, axes, [best_of_all_combinations(axis, report) for axis in axes])
        if not chosen:
            return nothing("infeasible", failure_message(problem, judged))
    continuous = search(replace(problem, discrete=()))
    if continuous.status == "cancelled":
        return nothing("cancelled", "cancelled before any design with discrete values was evaluated")
    if not exact and not len(continuous):
        return replace(continuous, problem=problem)
    if not is_complete:
        for index, axis in enumerate(axes):
            rows = (
                axis.combinations_between(0, axis.combination_count)
                if exact
                else combinations_around(axis, _designs_of_variant(continuous, index), SOLVED)
            )
            chosen += [(index, row) for row in rows]
        chosen = _first_of_each_variant(chosen)
        for index, axis in enumerate(axes):
            rows_of_axis = [row for owner, row in chosen if owner == index]
            judged_numbers.append(
                axis.indices_of_combinations(np.array(rows_of_axis)) if rows_of_axis else np.zeros(0, np.int64)
            )
    elif not exact:
        share, window = limit // len(axes), min(limit, _WINDOW) // len(axes)
        judged_parts = [
            best_near_designs(axis, _designs_of_variant(continuous, index), window, share, report)
            for index, axis in enumerate(axes)
        ]
        judged_numbers = [numbers for _, numbers in judged_parts]
        chosen, judged = _designs_to_deliver(problem, axes, [part for part, _ in judged_parts])
    if not chosen:
        return nothing("infeasible", failure_message(problem, judged or FeasibleDesigns.empty(axes[0].part)))
    summary = DiscreteSearch(
        exact=exact,
        combinations=count,
        judged=judged.judged if judged else len(chosen),
        rules={item.name: item.rule for item in problem.discrete},
        continuous=tuple(continuous.values.min(axis=0).tolist()) if len(continuous) else (),
    )
    front = search(problem_with_combinations(problem, chosen))
    if not exact and len(front):
        front = _downgrade_unproven(front, axes, chosen, judged_numbers)
    return _front_of_problem(problem, front, continuous, chosen, summary)


def _downgrade_unproven(
    front: ParetoFront, axes: list[Axes], chosen: Chosen, judged_numbers: list[IntArray]
) -> ParetoFront:
    """Return a front whose combinations count as stationary only if all their neighbours were judged."""
    combinations = [chosen[row] for row in front.variants]
    surrounded = np.array(
        [
            has_judged_neighbours(axes[variant], design[None], judged_numbers[variant])[0]
            for variant, design in combinations
        ],
        np.bool_,
    )
    status = np.where(surrounded, front.columns[STATUS], "best found")
    return replace(front, columns={**front.columns, STATUS: status})


def _designs_to_deliver(
    problem: Problem, axes: list[Axes], parts: list[FeasibleDesigns]
) -> tuple[Chosen, FeasibleDesigns]:
    """Return the designs to deliver: the non-dominated ones from all variants, at most the requested number."""
    together = parts[0]
    for part in parts[1:]:
        together = together.merge(part)
    owner = np.concatenate([np.full(len(part.values), index) for index, part in enumerate(parts)])
    values = together.values
    if not len(values):
        return [], together
    rows = nondominated(values)
    if values.shape[1] == 1:
        rows = rows[:1]
    else:
        rows = rows[_distinct_rows(values[rows])]
        best = tuple(dict.fromkeys(np.argmin(values[rows], axis=0).tolist()))
        rows = rows[choose_designs_by_hypervolume(values[rows], problem.settings.designs, always=best)]
    return [(int(owner[row]), together.dimensions[row]) for row in rows], together


def _distinct_rows(values: Array) -> Array:
    """Return the rows of objectives (n, m) that differ from earlier rows by more than rounding."""
    size = np.maximum(_SAME * np.ptp(values, axis=0), 1e-300)
    _, first = np.unique(np.round(values / size), axis=0, return_index=True)
    return np.sort(first)


def _designs_of_variant(front: ParetoFront, variant: int) -> Array:
    """Return the designs of a variant, best first in each objective in turn."""
    rows = np.flatnonzero(np.array(front.variants) == variant) if front.variants else np.arange(len(front))
    first = [row for row in front.extremes().values() if row in rows]
    order = [*dict.fromkeys(first), *(row for row in rows.tolist() if row not in first)]
    return front.dimensions[order]


def _first_of_each_variant(chosen: Chosen) -> Chosen:
    """Return at most `SOLVED` combinations, the first ones from each variant."""
    rank: dict[int, int] = {}
    order = []
    for place, (index, _) in enumerate(chosen):
        rank[index] = rank.get(index, -1) + 1
        order.append((rank[index], place))
    return [chosen[place] for _, place in sorted(order)[:SOLVED]]


def _front_of_problem(
    problem: Problem, front: ParetoFront, continuous: ParetoFront, chosen: Chosen, summary: DiscreteSearch
) -> ParetoFront:
    """Return a front of combinations as a front of the original problem."""
    columns = dict(front.columns)
    for place, (name, (column, unit)) in enumerate(columns_of_design_numbers(problem.mechanism.varying).items()):
        if column in columns and any(item.name == name for item in problem.discrete):
            displayed = front.dimensions[:, place] * unit.factor
            columns[column] = np.array([drop_conversion_rounding(value) for value in displayed.tolist()])
    # A design with discrete values is also a design of the continuous problem.
    best = front.values.min(axis=0, initial=np.inf).tolist()
    least = tuple(
        min(previous, discrete_best) for previous, discrete_best in zip(summary.continuous, best, strict=False)
    )
    summary = replace(summary, continuous=least)
    stated = replace(
        front,
        problem=problem,
        columns=columns,
        variants=tuple(chosen[row][0] for row in front.variants) if problem.variants else (),
        evaluations=continuous.evaluations + front.evaluations + summary.judged,
        discrete=summary,
    )
    if front.status == "cancelled":
        return stated
    return replace(
        stated, message=result_message(stated) if len(stated) else f"{result_message(stated)}; {front.message}"
    )
