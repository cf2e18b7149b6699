"""From a problem to its front: eliminate, search by the method asked for, deliver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from .assemble import empty
from .certificate.infeasible import prove_infeasible
from .deliver import as_found, deliver, planned
from .elimination import Sheet, sheets
from .engine.engine import Engine
from .evaluation import Evaluator
from .front import ParetoFront, Progress
from .gradients import require_gradients
from .identity import identity_of
from .infeasibility import diagnose
from .ledger import Cancelled, Ledger, Record
from .methods.registry import require_eliminated, require_fit, search_of
from .problem import Problem
from .search import WIDTHS, Archive, Callback, Run, explore, zoom
from .so_far import so_far
from .stationarity import Array


def solve(
    problem: Problem,
    *,
    progress: Callback | None = None,
    stages: Callback | None = None,
    fronts: Callable[[Array], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    resume: Sequence[Record] = (),
    keep: Callable[[Record], None] | None = None,
    engine: Engine | None = None,
) -> ParetoFront:
    """Return the Pareto front of a problem.

    progress: called after every round. stages: called about twice a second in a long stage between two rounds, or after
    the last. fronts: called just before `progress` with the objectives of the front so far, see `Run.front_so_far`.
    cancelled: asked many times a second; when it says so, what was found so far is
    returned with status "cancelled". The same problem with the same seed gives the same designs, bit for bit.
    keep: called with what a later run needs to go on from here: after every round, before its progress is told, and
    about every second of a long one. resume: all records that an earlier run of this problem kept, in order, however
    many; the run goes on from them and gives what it would have given without a stop, bit for bit.
    engine: where heavy work is done, in this process by default; it does not show in the front. Who gives it closes it.

    Raises `InputError` for a method that does not fit the problem, and `ForeignRecords` for records of another one.
    """
    require_fit(problem)
    require_gradients(problem)
    ledger = Ledger(cancelled=cancelled, keep=keep, past=resume, identity=partial(identity_of, problem))
    evaluators = [Evaluator(problem, sheet, ledger, engine) for sheet in sheets(problem)]
    require_eliminated(problem, evaluators)
    run = Run(problem, 1, progress, ledger, stages=stages)
    if fronts is not None:

        def told(entry: Progress) -> None:
            fronts(run.front_so_far())
            if progress is not None:
                progress(entry)

        run.progress = told
    try:
        return _searched(problem, evaluators, run)
    except Cancelled:
        return so_far(problem, evaluators, run)


def _searched(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    method, finish = problem.settings.method, as_found
    if method == "auto":
        run.rounds, finish = 1 + len(WIDTHS) + planned(problem), deliver
        archive = explore(problem, evaluators, run)
    else:
        archive = search_of(method)(problem, evaluators, run)
    front = finish(problem, evaluators, archive, run) if len(archive) else None
    if front is not None:
        return front
    diagnosis = diagnose(problem, partial(_best, run=run, evaluators=evaluators), run.ledger, evaluators[0].engine)
    if len(diagnosis.feasible) and method != "auto":
        return empty(problem, evaluators, run, "infeasible", _MISSED.format(method))
    if len(diagnosis.feasible):
        archive = run.archive = Archive.empty(len(problem.objectives))
        _seed(archive, evaluators, diagnosis.feasible)
        zoom(problem, evaluators, archive, run)
        front = deliver(problem, evaluators, archive, run) if len(archive) else None
        if front is not None:
            return front
    message = diagnosis.message or _THIN
    if diagnosis.message and prove_infeasible(problem, poll=partial(run.stage("proving"), 0, 1)):
        message += "; proven: no design of the ranges meets them all"
    return empty(problem, evaluators, run, "infeasible", message)


_DIAGNOSING = "diagnosing"
_THIN = (
    "designs that meet all requirements to rounding exist, but none that meets the equalities exactly; "
    "widen the ranges a little"
)

_MISSED = (
    "{} found no design that meets all requirements, though such designs exist; allow it more evaluations, "
    "or use the method auto"
)


def _best(problem: Problem, *, run: Run, evaluators: list[Evaluator]) -> float | None:
    """Return the best value (SI) of a problem's only objective, None where nothing is feasible.

    run, evaluators: of the search that wants to know it.
    """
    own = [Evaluator(problem, sheet, run.ledger, evaluators[0].engine) for sheet in sheets(problem)]
    inner = Run(problem, 1, lambda at: run.stand(_DIAGNOSING, at.round, at.rounds), run.ledger)
    inner.stages = lambda at: run.stand(_DIAGNOSING, at.round, at.rounds)
    archive = explore(problem, own, inner)
    front = deliver(problem, own, archive, inner) if len(archive) else None
    run.tell(_DIAGNOSING, evaluators, Archive.empty(len(run.problem.objectives)))
    if front is None:
        return None
    quantity = problem.quantity(problem.objectives[0].quantity)
    return float(quantity.evaluate(front.part(0).mechanism, front.dimensions[:1]).values[0])


def _seed(archive: Archive, evaluators: list[Evaluator], dimensions: Array) -> None:
    """Put designs found by the feasibility search into the archive, in the coordinates of their sheet."""
    for index, evaluator in enumerate(evaluators):
        sheet = evaluator.sheet
        own = dimensions[np.sign(dimensions[:, 2]) != -sheet.sign]
        if len(own):
            archive.screen(index, evaluator, _coordinates(sheet, own))


def _coordinates(sheet: Sheet, dimensions: Array) -> Array:
    sizes = np.concatenate([np.abs(dimensions[:, :3]), dimensions[:, 3:]], axis=1)
    columns = [sizes[:, sheet.names.index(name)] for name in sheet.free]
    u = np.stack(columns, axis=1) if columns else np.zeros((len(dimensions), 0))
    return np.clip((u - sheet.lower) / np.where(sheet.upper > sheet.lower, sheet.upper - sheet.lower, 1.0), 0.0, 1.0)
