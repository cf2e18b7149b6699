"""From a problem to its front: eliminate, search by the method asked for, deliver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .certificate.infeasible import prove_infeasible
from .deliver import as_found, deliver, empty, planned
from .elimination import Sheet, sheets
from .engine.engine import Engine
from .evaluation import Evaluator
from .front import ParetoFront
from .gradients import require_gradients
from .infeasibility import diagnose
from .methods.registry import require_eliminated, require_fit, require_resumable, search_of
from .problem import Problem
from .search import WIDTHS, Archive, Callback, Run, explore, zoom
from .stationarity import Array

if TYPE_CHECKING:
    from .methods.generation import Generation


def solve(
    problem: Problem,
    *,
    progress: Callback | None = None,
    cancelled: Callable[[], bool] | None = None,
    resume: Sequence[Generation] = (),
    keep: Callable[[Generation], None] | None = None,
    engine: Engine | None = None,
) -> ParetoFront:
    """Return the Pareto front of a problem.

    progress: called after every round. cancelled: asked between rounds; when it says so, what was found so far is
    returned with status "cancelled". The same problem with the same seed gives the same designs, bit for bit.
    keep: called with each generation as soon as it is evaluated, by the methods that go generation by generation.
    resume: all generations that an earlier run of this problem kept, in order, however many; the run goes on from them
    and gives what it would have given without a stop, bit for bit.
    engine: where heavy work is done, in this process by default; it does not show in the front. Who gives it closes it.
    """
    require_fit(problem)
    if resume:
        require_resumable(problem)
    method = problem.settings.method
    require_gradients(problem)
    evaluators = [Evaluator(problem, sheet, engine) for sheet in sheets(problem)]
    if method == "auto":
        run = Run(problem, progress, cancelled, 1 + len(WIDTHS) + planned(problem))
        archive = explore(problem, evaluators, run)
        front = deliver(problem, evaluators, archive, run) if len(archive) else None
    else:
        require_eliminated(problem, evaluators)
        run = Run(problem, progress, cancelled, 1, resume, keep)
        archive = search_of(method)(problem, evaluators, run)
        front = as_found(problem, evaluators, archive, run) if len(archive) else None
    if front is not None:
        return front
    if run.stop():
        return empty(problem, evaluators, run, "cancelled", "cancelled before any feasible design was found")
    diagnosis = diagnose(problem, _best)
    if len(diagnosis.feasible) and method != "auto":
        return empty(problem, evaluators, run, "infeasible", _MISSED.format(method))
    if len(diagnosis.feasible):
        archive = Archive.empty(len(problem.objectives))
        _seed(archive, evaluators, diagnosis.feasible)
        zoom(problem, evaluators, archive, run)
        front = deliver(problem, evaluators, archive, run) if len(archive) else None
        if front is not None:
            return front
    message = diagnosis.message or _THIN
    if diagnosis.message and prove_infeasible(problem, cancelled=cancelled):
        message += "; proven: no design of the ranges meets them all"
    return empty(problem, evaluators, run, "infeasible", message)


_THIN = (
    "designs that meet all requirements to rounding exist, but none that meets the equalities exactly; "
    "widen the ranges a little"
)

_MISSED = (
    "{} found no design that meets all requirements, though such designs exist; allow it more evaluations, "
    "or use the method auto"
)


def _best(problem: Problem) -> float | None:
    """Return the best value (SI) of a problem's only objective, None where nothing is feasible."""
    evaluators = [Evaluator(problem, sheet) for sheet in sheets(problem)]
    run = Run(problem, None, None, 1)
    archive = explore(problem, evaluators, run)
    front = deliver(problem, evaluators, archive, run) if len(archive) else None
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
