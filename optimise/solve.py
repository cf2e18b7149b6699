"""From a problem to its front: eliminate, search by the selected method, assemble the front."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..model.arrays import Array
from ..model.errors import InputError
from ..model.kernel.batches import interrupted_by
from .certificate.infeasibility_certificate import prove_infeasible
from .engine.engine import Engine
from .feasibility.best_value import Best, find_best_design
from .feasibility.infeasibility import diagnose_infeasibility, require_finite, valueless_quantity_text_of_variants
from .front.front import ParetoFront, Status
from .front.progress import REPEATING, Progress, progress_bar
from .methods.auto.auto import deliver_front, search_front_by_method
from .methods.auto.partial_front import partial_front
from .methods.registry import (
    method_of_problem,
    require_gradients,
    require_supported_equalities,
    require_supported_settings,
)
from .problem.contradictory_problems import require_nonzero_quantities, require_possible_problem
from .problem.problem import Problem, require_problem
from .search.assemble_front import empty_front
from .search.checkpoints import Cancelled, Checkpoints, Record, identity_of, require_records_of
from .search.elimination import elimination_branches
from .search.evaluation import Evaluator
from .search.mirrored_branches import drop_mirrored_branches
from .search.sample_and_zoom import Archive, Callback, Run, searched_evaluators, zoom_into_sparse_parts


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

    The same problem with the same seed gives the same designs, bit for bit.

    progress: called after every round; True shows a live bar, also in a notebook. stages: called about twice a second
    in a long stage between two rounds, or after the last. fronts: called just before `progress` with the objectives of
    the front so far, see `Run.latest_front`. cancelled: called many times a second; once it returns True, `solve`
    returns the front so far with status "cancelled". keep: called with records from which a later run can resume: after
    every round, before its progress is reported, and about every second in a long one. resume: all records of an
    earlier run of this problem, in order, any number; the run continues and returns the same front, bit for bit.
    engine: engine for the expensive evaluations, by default this process; it does not change the front. The caller
    closes it.

    Raises `InputError` for a method that does not fit the problem, and `ForeignRecords` for records of another search.
    """
    require_problem(problem, "solve")
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise InputError(f"progress must be True, for a bar, or a function; got {progress!r}")
    require_supported_settings(problem)
    require_gradients(problem)
    require_nonzero_quantities(problem)
    require_possible_problem(problem)
    checkpoints = Checkpoints(cancelled=cancelled, keep=keep, past=resume, identity=partial(identity_of, problem))
    with ExitStack() as stack:
        if progress is True:
            progress = stack.enter_context(progress_bar())
            stages = stages or progress
        listener = progress or None
        solver = _ContinuousSolver(checkpoints, engine, listener, stages, fronts, bool(resume))
        return _solve_discrete(problem, solver) if problem.discrete else solver.solve(problem)


def require_resumable(problem: Problem, records: Sequence[Record]) -> None:
    """Raise `ForeignRecords` unless a search of the problem can resume from the records."""
    if records:
        require_records_of(records, identity_of(problem))


@dataclass(frozen=True)
class _ContinuousSolver:
    """Solver for problems without discrete numbers; a problem with some is solved as a series of these."""

    checkpoints: Checkpoints
    engine: Engine | None
    listener: Callback | None
    stages: Callback | None
    fronts: Callable[[Array], None] | None
    resumes: bool
    runs: list[Run] = field(default_factory=list)

    def start_run(self, problem: Problem) -> Run:
        """Return a new run for a problem, with nothing computed yet."""
        # The second run of a problem with discrete numbers ignores them: its designs are not delivered.
        fronts = None if len(self.runs) == 1 else self.fronts
        has_listener = fronts is not None or self.listener is not None

        def report_with_front(entry: Progress) -> None:
            if fronts is not None:
                fronts(run.latest_front())
            if self.listener is not None:
                self.listener(entry)

        last = self.runs[-1] if self.runs else None
        run = Run(
            problem, 1, report_with_front if has_listener else None, self.checkpoints, stages=self.stages, previous=last
        )
        self.runs.append(run)
        return run

    def evaluators(self, problem: Problem) -> list[Evaluator]:
        """Return the evaluators of a problem. Raises `InputError` if its quantities have no values."""
        evaluators = [
            Evaluator(problem, branch, self.checkpoints, self.engine)
            for branch in drop_mirrored_branches(problem, elimination_branches(problem))
        ]
        require_supported_equalities(problem, searched_evaluators(evaluators))
        if len(self.runs) == 1:
            require_finite(problem, searched_evaluators(evaluators))
        return evaluators

    def solve(self, problem: Problem) -> ParetoFront:
        """Return the front; after cancellation, the front so far."""
        run = self.start_run(problem)
        evaluators: list[Evaluator] = []
        try:
            with interrupted_by(self.checkpoints.interrupt, between_parts=self.checkpoints.poll) as interruption:
                evaluators = self.evaluators(problem)
                if self.resumes:
                    run.report_stage(REPEATING, 0, 1, now=True)
                return _search_and_deliver(problem, evaluators, run)
        except Cancelled:
            return partial_front(problem, evaluators, run, silent=interruption.killed)


def _solve_discrete(problem: Problem, solver: _ContinuousSolver) -> ParetoFront:
    """Return the front of a problem with discrete numbers."""
    from .discrete.discrete_front import discrete_front

    run = solver.start_run(problem)
    evaluators: list[Evaluator] = []

    def empty(status: Status, message: str) -> ParetoFront:
        return empty_front(problem, evaluators, run, status, message)

    try:
        with interrupted_by(solver.checkpoints.interrupt):
            evaluators = solver.evaluators(problem)
        return discrete_front(problem, solver.solve, empty, run.stage_reporter("judging combinations"))
    except Cancelled:
        return empty("cancelled", "cancelled while evaluating combinations of discrete values")


def _search_and_deliver(problem: Problem, evaluators: list[Evaluator], run: Run) -> ParetoFront:
    method, free = method_of_problem(problem), searched_evaluators(evaluators)
    front = search_front_by_method(method, problem, evaluators, run)
    if front is not None:
        return front
    if problem.without_gradient():
        return empty_front(problem, evaluators, run, "infeasible", _NOT_KNOWN.format(method.name))
    diagnosis = diagnose_infeasibility(
        problem, partial(_best_value, run=run, evaluators=evaluators), run.checkpoints, evaluators[0].engine
    )
    if len(diagnosis.feasible) and not method.polishes and free:
        return empty_front(problem, evaluators, run, "infeasible", _MISSED.format(method.name))
    if len(diagnosis.feasible) and free:
        archive = run.archive = Archive.empty(len(problem.objectives))
        _seed_archive(archive, free, diagnosis.feasible)
        zoom_into_sparse_parts(problem, free, archive, run)
        front = deliver_front(problem, evaluators, archive, run)
        if front is not None:
            return front
    message = diagnosis.message or valueless_quantity_text_of_variants(problem, diagnosis.feasible) or _NARROW_RANGES
    if diagnosis.message and prove_infeasible(problem, poll=partial(run.stage_reporter("proving"), 0, 1)):
        message += "; proven: no design within the ranges meets them all"
    return empty_front(problem, evaluators, run, "infeasible", message)


_DIAGNOSING = "diagnosing"
_NARROW_RANGES = (
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


def _best_value(problem: Problem, *, run: Run, evaluators: list[Evaluator]) -> Best | None:
    """Return the best value of a problem's only objective, for the diagnosis of an infeasible problem."""

    def report(at: Progress) -> None:
        run.report_stage(_DIAGNOSING, at.round, at.rounds)

    best = find_best_design(problem, run.checkpoints, evaluators[0].engine, report)
    run.report_round(_DIAGNOSING, searched_evaluators(evaluators), Archive.empty(len(run.problem.objectives)))
    return best


def _seed_archive(archive: Archive, evaluators: list[Evaluator], dimensions: Array) -> None:
    """Add designs from the feasibility search to the archive, in the coordinates of their branch."""
    for index, evaluator in enumerate(evaluators):
        branch = evaluator.branch
        on_side = dimensions[np.sign(dimensions[:, 2]) != -branch.sign]
        if len(on_side):
            archive.screen(index, evaluator, branch.points_of_designs(on_side))
