"""Assembly of the front from polished designs: the best of them, each with all its quantities."""

import itertools
from dataclasses import replace

import numpy as np

from ...model.arrays import Array, IntArray, Mask, sorted_unique
from ...model.kinematics.geometry import offset_without_rounding
from ...objectives.catalogue_amount import Amount
from ...objectives.formula.quantity import FormulaQuantity
from ...objectives.kinds import count_with_noun
from ..front.front import Columns, ParetoFront, Status
from ..front.hypervolume import (
    ReportProgress,
    choose_designs_by_hypervolume,
    hypervolume,
    ideal_and_range,
    ignore_progress,
)
from ..front.stationarity import STATIONARY, optimality_multipliers, slack_of
from ..problem.constraint_violation import constraints_with_floors
from ..problem.problem import Problem
from ..problem.table_columns import RESIDUAL, STATUS, choice_field, note_field, slack_field
from .candidates import FrontCandidates
from .cheapest_sufficient_option import cheapest_sufficient_options
from .checkpoints import software_versions
from .evaluation import Evaluator
from .piece_rows import ACTIVE
from .sample_and_zoom import Run

SELECTING, FINISHING = "selecting designs", "finishing designs"
"""Stages after the rounds: selecting the best designs, then computing all their quantities."""
_BATCH = 100  # designs to analyse between two polls for cancellation
_GLIMPSE = 40  # designs per round in the history of a cancelled search, because all would take seconds


def assemble_front(
    problem: Problem,
    evaluators: list[Evaluator],
    candidates: FrontCandidates,
    run: Run,
    rows: IntArray | None = None,
) -> ParetoFront:
    """Return the front of the best candidates; there must be at least one.

    rows: rows of the designs to return from a cancelled search.
    """
    status: Status = "done" if rows is None else "cancelled"
    best = candidates[_rows_to_deliver(problem, candidates, run.stage_reporter(SELECTING)) if rows is None else rows]
    best = best[np.lexsort(best.values.T[::-1])]
    values, dimensions = best.values, best.dimensions(evaluators)
    dimensions[:, 2] = offset_without_rounding(dimensions[:, 1], dimensions[:, 2])
    span = objective_ranges(problem, values) if len(best) > 1 else best.span
    goals, active = list(best.goals), list(best.active)
    residual = np.array(
        [
            optimality_multipliers(slopes * (best.span / span)[owner.astype(int)][:, None], edges)[0]
            for (owner, slopes), edges in zip(goals, active, strict=True)
        ]
    )
    if problem.without_gradient():  # slopes are unknown, and so are optimality and trade-off rates
        residual[:] = np.inf
        goals = [(owner, slopes[:, :0]) for owner, slopes in goals]
        active = [edges[:, :0] for edges in active]
    variants = np.array([evaluators[index].branch.variant for index in best.branch], dtype=np.int64)
    finishing = run.stage_reporter(FINISHING)
    columns = columns_of_designs(problem, variants, dimensions, finishing)
    columns[RESIDUAL] = residual
    proven = (residual <= STATIONARY) & ~_on_partly_described_kink(problem, variants, dimensions)
    columns[STATUS] = np.where(proven, "stationary", "best found")
    evaluated = sum(evaluator.evaluations for evaluator in evaluators)
    message = f"{count_with_noun(len(best), 'design')}, {evaluated} evaluated"
    if status == "cancelled":
        message = f"cancelled: {message}, the front may be incomplete"
    ideal = values.min(axis=0)
    return replace(
        empty_front(problem, evaluators, run, status, message),
        columns=columns,
        dimensions=dimensions,
        values=values,
        goals=tuple((owner, slopes * best.span[owner.astype(int)][:, None]) for owner, slopes in goals),
        active=tuple(active),
        hypervolume=hypervolume(values, ideal, span),
        history=run.history(
            ideal, span, _GLIMPSE if status == "cancelled" else None, lambda: finishing(len(best), len(best))
        ),
        variants=tuple(variants.tolist()) if problem.variants else (),
    )


def _on_partly_described_kink(problem: Problem, variants: IntArray, dimensions: Array) -> Mask:
    """Return which designs (n,) lie on a kink that their slopes describe only in part.

    For a formula with both kinds of kinks, such as a difference of peaks, slopes cover the kinks of one kind with the
    active piece of the other: where two of these tie, nothing is proven.
    """
    is_torn = np.zeros(len(dimensions), np.bool_)
    is_maximised = {item.quantity: item.sense == "maximise" for item in problem.objectives}
    formulas = [
        formula for formula in problem.own if isinstance(formula, FormulaQuantity) and formula.name in is_maximised
    ]
    for variant in sorted_unique(variants).tolist() if formulas else []:
        rows = np.flatnonzero(variants == variant)
        for formula in formulas:
            pieces = formula.pieces(problem.part(variant).mechanism, dimensions[rows])
            if pieces.opposite is not None:
                binding = pieces if is_maximised[formula.name] else pieces.opposite
                distances = np.abs(binding.values - binding.values[:, :1])
                ties = (distances <= ACTIVE * np.abs(binding.values[:, 0]).max()).sum(axis=1) > 1
                is_torn[rows] |= ties
    return is_torn


def _rows_to_deliver(problem: Problem, candidates: FrontCandidates, report: ReportProgress) -> IntArray:
    rows = candidates.nondominated_rows(report)
    if len(problem.objectives) == 1:
        return rows
    best = tuple(dict.fromkeys(np.argmin(candidates.values[rows], axis=0).tolist()))
    return rows[
        choose_designs_by_hypervolume(candidates.values[rows], problem.settings.designs, always=best, report=report)
    ]


def columns_of_designs(
    problem: Problem, variants: IntArray, dimensions: Array, report: ReportProgress = ignore_progress
) -> Columns:
    """Return all quantities of designs, their chosen options, and the slacks of their constraints.

    variants: (n,). dimensions: (n, 3 + v). report: called at least every second, with the number of designs done.
    """
    from ...objectives.tables import all_quantities, swing_columns

    parts: list[Columns] = []
    order, count = [], 0
    alike: dict[tuple[object, ...], list[int]] = {}  # variants with the same machine and rules are analysed together
    for variant in sorted_unique(variants).tolist():
        part = problem.part(variant)
        alike.setdefault((part.mechanism, part.constraints, part.own), []).append(variant)
    chosen = _choice_columns(problem, variants, dimensions)
    for same in alike.values():
        rows_of_machine = np.flatnonzero(np.isin(variants, same))
        part = problem.part(same[0])
        for rows in np.split(rows_of_machine, range(_BATCH, len(rows_of_machine), _BATCH)):
            report(count, len(dimensions))
            judged = all_quantities.analysis_columns if problem.motion is None else swing_columns.swing_columns
            columns = judged(part.mechanism, dimensions[rows], custom=part.own)
            report(count, len(dimensions))
            before = 3 + len(part.mechanism.varying)
            of_size = dict(itertools.islice(columns.items(), before))
            rest = dict(itertools.islice(columns.items(), before, None))
            of_choice: Columns = {name: column[rows] for name, column in chosen.items()}
            fields = [amount.field for amount in part.own if isinstance(amount, Amount)]
            of_choice |= {name: rest.pop(name) for name in fields}
            parts.append(of_size | of_choice | rest | _slack_columns(part, dimensions[rows]))
            count += len(rows)
            order.append(rows)
    if len(parts) == 1:
        return parts[0]
    place = np.argsort(np.concatenate(order))
    names = dict.fromkeys(name for part in parts for name in part)
    absent = [np.full(len(rows), np.nan) for rows in order]  # for a column that only other machines have
    return {
        name: np.concatenate([part.get(name, nothing) for part, nothing in zip(parts, absent, strict=True)])[place]
        for name in names
    }


def _choice_columns(problem: Problem, variants: IntArray, dimensions: Array) -> Columns:
    """Return the columns of choices: labels, notes, and the least sufficient options with their notes."""
    chosen = [problem.variants[variant] for variant in variants] if problem.variants else []
    columns: Columns = {
        choice_field(name): np.array([variant.labels[place] for variant in chosen])
        for place, name in enumerate(problem.choices)
    }
    columns |= cheapest_sufficient_options(problem, variants, dimensions)
    for name in problem.choices:
        for head in problem.heads(name):
            columns[note_field(name, head)] = np.array([variant.note(name, head) for variant in chosen])
    return columns


def _slack_columns(problem: Problem, dimensions: Array) -> Columns:
    slacks: Columns = {}
    for constraint in constraints_with_floors(problem):
        quantity = problem.quantity(constraint.quantity)
        values = quantity.evaluate(problem.mechanism, dimensions).values
        slacks[slack_field(quantity)] = slack_of(constraint, values) * quantity.unit.factor + 0.0  # no -0
    return slacks


def empty_front(problem: Problem, evaluators: list[Evaluator], run: Run, status: Status, message: str) -> ParetoFront:
    """Return a front without designs, with the reason."""
    m = len(problem.objectives)
    return ParetoFront(
        problem=problem,
        status=status,
        message=message,
        columns={},
        dimensions=np.zeros((0, 3)),
        values=np.zeros((0, m)),
        goals=(),
        active=(),
        hypervolume=0.0,
        history=tuple(run.round_reports),
        evaluations=sum(evaluator.evaluations for evaluator in evaluators),
        seconds=run.checkpoints.elapsed_seconds,
        seed=problem.settings.seed,
        versions=software_versions(),
    )


def objective_ranges(problem: Problem, values: Array) -> Array:
    """Return the ranges (m,) that scale the objectives (n, m); for a single objective, its magnitude."""
    _, span = ideal_and_range(values)
    sizes = np.array([abs(objective.target or 0.0) for objective in problem.objectives])
    if values.shape[1] == 1:
        best = np.abs(values.min(axis=0))
        return np.asarray(np.maximum(np.maximum(best, sizes), np.ptp(values, axis=0)) + 1e-300)
    # A target that the whole front meets has no range except rounding.
    return np.maximum(span, 1e-6 * sizes)
