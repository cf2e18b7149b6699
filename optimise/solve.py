"""From a problem to its front: eliminate, search by the method asked for, deliver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..model.arrays import Array
from ..model.errors import InputError
from ..model.kernel.interruption import interrupted_by
from .certificate.infeasible import prove_infeasible
from .engine.engine import Engine
from .feasibility.best import Best, best_of
from .feasibility.infeasibility import diagnose
from .feasibility.valueless import require_finite, valueless_in_all
from .front.front import ParetoFront, Status
from .front.progress import REPEATING, Progress, progress_bar
from .methods.auto.auto import deliver, searched_by
from .methods.auto.so_far import so_far
from .methods.registry import method_of, require_eliminated, require_fit, require_gradients
from .problem.impossible import require_possible
from .problem.problem import Problem, require_problem
from .problem.zero_objectives import require_ranking
from .search.assemble import empty
from .search.checkpoints import Cancelled, Checkpoints, Record, require_own
from .search.elimination import sheets
from .search.evaluation import Evaluator
from .search.fingerprint import identity_of
from .search.mirror import once
from .search.search import Archive, Callback, Run, searched, zoom


def solve(
    problem: Problem,
    *,
    progress: Callback | bool | None = None,
    stages: Callback | None = None,
    fronts: Callable[[Array], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    resume: Sequence[Record] = (),
    keep: Callable[[Record], None] | None = None,
    engine: Engine | None = None,
) -> ParetoFront:
    """Return the Pareto front of a problem.

    progress: called after every round; True shows a live bar, in a notebook too. stages: called about twice a second in
    a long stage between two rounds, or after the last. fronts: called just before `progress` with the objectives of the
    front so far, see `Run.latest`. cancelled: asked many times a second; when it says so, what was found so far
    is returned with status "cancelled". The same problem with the same seed gives the same designs, bit for bit.
    keep: called with what a later run needs to go on from here: after every round, before its progress is told, and
    about every second of a long one. resume: all records that an earlier run of this problem kept, in order, however
    many; the run goes on from them and gives what it would have given without a stop, bit for bit.
    engine: where heavy work is done, in this process by default; it does not show in the front. Who gives it closes it.

    Raises `InputError` for a method that does not fit the problem, and `ForeignRecords` for records of another one.
    """
    require_problem(problem, "solve")
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise InputError(f"progress must be True, for a bar, or a function; got {progress!r}")
    require_fit(problem)
    require_gradients(problem)
    require_ranking(problem)
    require_possible(problem)
    checkpoints = Checkpoints(cancelled=cancelled, keep=keep, past=resume, identity=partial(identity_of, problem))
    with ExitStack() as shown:
        if progress is True:
            progress = shown.enter_context(progress_bar())
            stages = stages or progress
        told = progress or None
        one = _One(checkpoints, engine, told, stages, fronts, bool(resume))
        return _with_values(problem, one) if problem.discrete else one.solve(problem)


def require_own_records(problem: Problem, records: Sequence[Record]) -> None:
    """Raise `ForeignRecords` unless a search of the problem can resume from the records, before it begins."""
    if records:
        require_own(records, identity_of(problem))


@dataclass(frozen=True)
class _One:
    """How problems without discrete numbers are solved, one after the other for one with some."""

    checkpoints: Checkpoints
    engine: Engine | None
    told: Callback | None
    stages: Callback | None
    fronts: Callable[[Array], None] | None
    resumes: bool
    runs: list[Run] = field(default_factory=list)

    def begun(self, problem: Problem) -> Run:
        """Return the run of a problem, before anything is computed."""
        heard = self.fronts is not None or self.told is not None

        def with_front(entry: Progress) -> None:
            if self.fronts is not None:
                self.fronts(run.latest())
            if self.told is not None:
                self.told(entry)

        last = self.runs[-1] if self.runs else None
        run = Run(problem, 1, with_front if heard else None, self.checkpoints, stages=self.stages, after=last)
        self.runs.append(run)
        return run

    def evaluators(self, problem: Problem) -> list[Evaluator]:
        """Return the evaluators of a problem, which is found to have values."""
        evaluators = [
            Evaluator(problem, sheet, self.checkpoints, self.engine) for sheet in once(problem, sheets(problem))
        ]
        require_eliminated(problem, searched(evaluators))
        if len(self.runs) == 1:
            require_finite(problem, searched(evaluators))
        return evaluators

    def solve(self, problem: Problem) -> ParetoFront:
        """Return the front, or what was found of it."""
        run = self.begun(problem)
        evaluators: list[Evaluator] = []
        try:
            with interrupted_by(self.checkpoints.interrupt, between=self.checkpoints.poll) as interruption:
                evaluators = self.evaluators(problem)
                if self.resumes:
                    run.stand(REPEATING, 0, 1, now=True)
                return _searched(problem, evaluators, run)
        except Cancelled:
            return so_far(problem, evaluators, run, silent=interruption.killed)


def _with_values(problem: Problem, one: _One) -> ParetoFront:
    """Return the front of a problem with discrete numbers."""
    from .discrete.front import discrete_front

    run = one.begun(problem)
    evaluators: list[Evaluator] = []

    def nothing(status: Status, message: str) -> ParetoFront:
        return empty(problem, evaluators, run, status, message)

    try:
        with interrupted_by(one.checkpoints.interrupt):
            evaluators = one.evaluators(problem)
        return discrete_front(problem, one.solve, nothing, run.stage("judging combinations"))
    except Cancelled:
        return nothing("cancelled", "cancelled while evaluating combinations of discrete values")


def _searched(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    method, free = method_of(problem), searched(evaluators)
    front = searched_by(method, problem, evaluators, run)
    if front is not None:
        return front
    if problem.without_gradient():
        return empty(problem, evaluators, run, "infeasible", _NOT_KNOWN.format(method.name))
    diagnosis = diagnose(problem, partial(_best, run=run, evaluators=evaluators), run.checkpoints, evaluators[0].engine)
    if len(diagnosis.feasible) and not method.polishes and free:
        return empty(problem, evaluators, run, "infeasible", _MISSED.format(method.name))
    if len(diagnosis.feasible) and free:
        archive = run.archive = Archive.empty(len(problem.objectives))
        _seed(archive, free, diagnosis.feasible)
        zoom(problem, free, archive, run)
        front = deliver(problem, evaluators, archive, run)
        if front is not None:
            return front
    message = diagnosis.message or valueless_in_all(problem, diagnosis.feasible) or _THIN
    if diagnosis.message and prove_infeasible(problem, poll=partial(run.stage("proving"), 0, 1)):
        message += "; proven: no design within the ranges meets them all"
    return empty(problem, evaluators, run, "infeasible", message)


_DIAGNOSING = "diagnosing"
_THIN = (
    "some designs meet all requirements within rounding, but none meets the equalities exactly; widen the ranges "
    "a little"
)

_NOT_KNOWN = (
    "{} found no design that meets all requirements; whether one exists is unknown, because a quantity has "
    "no gradient; allow more evaluations, or relax a requirement"
)

_MISSED = (
    "{} found no design that meets all requirements, although such designs exist; allow more evaluations, or "
    "use the method auto"
)


def _best(problem: Problem, *, run: Run, evaluators: list[Evaluator]) -> Best | None:
    """Return the best of a problem's only objective for the search that wants to know it."""

    def stand(at: Progress) -> None:
        run.stand(_DIAGNOSING, at.round, at.rounds)

    found = best_of(problem, run.checkpoints, evaluators[0].engine, stand)
    run.tell(_DIAGNOSING, searched(evaluators), Archive.empty(len(run.problem.objectives)))
    return found


def _seed(archive: Archive, evaluators: list[Evaluator], dimensions: Array) -> None:
    """Put designs found by the feasibility search into the archive, in the coordinates of their sheet."""
    for index, evaluator in enumerate(evaluators):
        sheet = evaluator.sheet
        own = dimensions[np.sign(dimensions[:, 2]) != -sheet.sign]
        if len(own):
            archive.screen(index, evaluator, sheet.coordinates(own))
