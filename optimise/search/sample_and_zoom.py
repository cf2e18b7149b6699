"""First half of the search: many screened designs, first everywhere, then around sparse parts of the front."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ...objectives.robust.quantity import RobustQuantity
from ..front.dominance import nondominated
from ..front.hypervolume import ReportProgress
from ..front.progress import REPEATING, Progress
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from .candidates import Candidates, FrontCandidates, FrontVolume
from .checkpoints import Checkpoints
from .evaluation import Evaluator
from .least_violation import least_violation
from .recorded_polish import polish_recorded
from .sampling import first_samples, random_generator, sample_near_parents

FIRST = 16384
"""Number of designs in the first round, everywhere."""
SAMPLES = 4096
"""Number of designs in each later round."""
WIDTHS = (0.1, 0.05, 0.02, 0.01)
"""Spread of the zoom rounds in the unit box."""
BANDS = (0.0, 0.01, 0.04, 0.16)
"""Relative violation that samples may have, raised until enough are found; the polish removes it. The first is omitted
if equalities remain, because no sample meets them."""
ENOUGH = 32
"""Number of samples that is enough to zoom."""
LEAST = 1024
"""Minimum number of designs per round on each of many branches."""
_ROUND = 100  # branches without free unknowns per batch
_CROWD = 2000  # parents per round
_RANKED, _LEAST_RANKED = 256, 64  # samples whose best ones start a descent, over all branches and at least on each
_STARTS = 8  # descents, over all branches
_BEST = 1000  # designs to keep for a single objective
_FRONT_SAMPLE = 400  # designs to keep from the front so far, and from each round's front in the history
REPORT_INTERVAL = 0.5
"""Minimum time between two progress reports in a long stage, s."""

Callback = Callable[[Progress], None]


@dataclass
class Archive(Candidates):
    """Non-dominated designs found so far; a feasible design is displaced only by another feasible one.

    band: relative violation allowed for infeasible designs. feasible: number of feasible designs seen.
    """

    band: float = field(default=0.0, kw_only=True)
    feasible: int = field(default=0, kw_only=True)

    def screen(self, index: int, evaluator: Evaluator, u: Array) -> int:
        """Evaluate points (n, k) of a branch, add those that are feasible within the band, and return their number."""
        return self.screen_all([(index, evaluator, u)])

    def screen_all(self, points: Iterable[tuple[int, Evaluator, Array]]) -> int:
        """Screen points of several branches, then compare them with the archive once, which takes most of the time."""
        fresh: list[Candidates] = []
        for index, evaluator, u in points:
            _, values, violation = evaluator.screen_designs_objectives_violation(u, band=self.band)
            good = violation <= self.band + FEASIBLE
            is_feasible = violation <= FEASIBLE
            self.feasible += int(is_feasible.sum())
            fresh.append(Candidates(np.full(int(good.sum()), index), u[good], values[good], is_feasible[good]))
        self.add_designs(*fresh)
        return sum(map(len, fresh))

    def add_points(self, index: int, u: Array, values: Array, is_feasible: Mask | None = None) -> None:
        """Add points (n, k) of a branch with their objectives (n, m) as minimised.

        is_feasible: (n,), which points meet every constraint, by default all; the others are close enough to move
        there.
        """
        self.add_designs(
            Candidates(
                np.full(len(u), index), u, values, np.ones(len(u), np.bool_) if is_feasible is None else is_feasible
            )
        )

    def add_designs(self, *tables: Candidates) -> None:
        """Add designs from any branch."""
        together = self.join(*tables)
        rows = _candidate_rows_to_keep(together)
        as_they_are = len(rows) == len(together) and bool((np.diff(rows) > 0).all())
        self.replace_content(together if as_they_are else together[rows])


def _evenly_spread_values(values: Array) -> Array:
    return values[:: 1 + len(values) // _FRONT_SAMPLE]


def _candidate_rows_to_keep(candidates: Candidates) -> IntArray:
    """Return the rows of candidates to keep; feasible ones are displaced only by feasible ones."""
    rows = _nondominated_or_best_rows(candidates.values)
    if candidates.is_feasible.all():
        return rows
    feasible = np.flatnonzero(candidates.is_feasible)
    return np.concatenate(
        [feasible[_nondominated_or_best_rows(candidates.values[feasible])], rows[~candidates.is_feasible[rows]]]
    )


def _nondominated_or_best_rows(values: Array) -> IntArray:
    """Return the rows to keep: the non-dominated ones or, for a single objective, the `_BEST` best ones, best first."""
    alone = values.shape[1] == 1
    return np.argsort(values[:, 0], kind="stable")[:_BEST] if alone else nondominated(values)


def samples_per_branch(samples: int, evaluators: list[Evaluator]) -> int:
    """Return the number of samples per branch in a round; with many branches, a sensible minimum."""
    if len(evaluators) <= 2:
        return -(-samples // len(evaluators))
    return max(-(-samples // len(evaluators)), min(samples, LEAST))


@dataclass
class Run:
    """State of a running search: its rounds, the front at the end of each, and the result so far.

    checkpoints: checkpoints of its steps, shared with its evaluators. enumerated: evaluators of the branches without
    free unknowns. archive: designs found on the other branches. candidates: designs on the enumerated branches, and
    polished ones from the archive. fronts: objectives of feasible designs in each round, at most a few hundred.
    progress: called after every round. stages: called in long stages between two rounds. Without either, a round's
    hypervolume is reported as 0, not computed. previous: an earlier run for the same answer, which this one continues.
    """

    problem: Problem
    rounds: int
    progress: Callback | None = None
    checkpoints: Checkpoints = field(default_factory=Checkpoints)
    round_reports: list[Progress] = field(default_factory=list)
    fronts: list[Array] = field(default_factory=list)
    enumerated: list[Evaluator] = field(default_factory=list)
    stages: Callback | None = None
    previous: Run | None = None

    def __post_init__(self) -> None:
        count = len(self.problem.objectives)
        self.archive, self.candidates = Archive.empty(count), FrontCandidates.without_designs(np.ones(count))
        self._targets = np.array([objective.target or 0.0 for objective in self.problem.objectives])
        self._growth: FrontVolume = FrontVolume(self._targets) if self.previous is None else self.previous._growth
        self._last_report = time.monotonic()
        self._earlier_rounds: int = (
            0 if self.previous is None else self.previous._earlier_rounds + len(self.previous.round_reports)
        )

    def expect_rounds(self, count: int) -> None:
        """Expect this many further rounds."""
        self.rounds = len(self.round_reports) + count

    def begin_round(self, stage: str) -> None:
        """Report a stage at every poll until the round ends, so that a long step is not silent."""
        self.checkpoints.polled = partial(self.report_stage, stage, 0, 1)

    def report_round(self, stage: str, evaluators: list[Evaluator], archive: Archive) -> None:
        """Record the end of a round; evaluators: the evaluators of the archive's designs.

        A cancelled search builds its front from the last archive with designs. Rounds reported before an interruption
        are not reported again; only their replay is.
        """
        self.archive = archive if len(archive) else self.archive
        feasible_values = archive.values if archive.is_feasible.all() else archive.values[archive.is_feasible]
        feasible = (
            np.concatenate([feasible_values, self.candidates.values]) if len(self.candidates) else feasible_values
        )
        entry = Progress(
            stage,
            self._earlier_rounds + len(self.round_reports) + 1,
            self._planned_rounds(len(self.round_reports) + 1),
            sum(evaluator.evaluations for evaluator in (*evaluators, *self.enumerated)),
            archive.feasible + int((~self.candidates.has_free_unknowns).sum()),
            self._growth.add(feasible) if self.progress or self.stages else 0.0,
            self.checkpoints.elapsed_seconds,
        )
        self.round_reports.append(entry)
        self.checkpoints.polled = None
        self.fronts.append(
            _evenly_spread_values(feasible).copy()
        )  # a copy, because a view would keep all of them in memory
        if self.checkpoints.end_round():
            self._call_listener(entry, self.progress)
        else:
            self.report_stage(stage, 0, 1)

    def latest_front(self) -> Array:
        """Return the objectives (n, m) of the front after the last round, SI, as minimised.

        At most a few hundred designs. Those that violate a constraint appear only until a design meets all of them;
        the reported hypervolume is zero so far.
        """
        archive = self.archive
        if len(self.candidates) or archive.is_feasible.any():
            archive = archive[archive.is_feasible]
        if not len(self.candidates):
            return _evenly_spread_values(archive.values)
        values = np.concatenate([archive.values, self.candidates.values])
        return _evenly_spread_values(values[nondominated(values)])

    def stage_reporter(self, name: str) -> ReportProgress:
        """Return the callback for a long stage, which ends a cancelled search and reports progress."""

        def report(done: int, total: int) -> None:
            self.checkpoints.poll()
            self.report_stage(name, done, total)

        return report

    def report_stage(self, stage: str, done: int, total: int, *, now: bool = False) -> None:
        """Report progress within a stage, at most once in `REPORT_INTERVAL`. now: report in any case."""
        if self.stages is None or (time.monotonic() - self._last_report < REPORT_INTERVAL and not now):
            return
        if self.checkpoints.rounds < self.checkpoints.earlier_rounds or self.checkpoints.replaying:
            stage, done, total = REPEATING, self.checkpoints.repeated, self.checkpoints.resumed
        last = self.round_reports[-1] if self.round_reports else Progress(stage, 0, 0, 0, 0, 0.0, 0.0)
        rounds, seconds = self._planned_rounds(len(self.round_reports)), self.checkpoints.elapsed_seconds
        self._call_listener(
            replace(last, stage=stage, rounds=rounds, seconds=seconds, step=done, steps=max(done, total)), self.stages
        )

    def _planned_rounds(self, at_least: int) -> int:
        """Number of planned rounds, with those of earlier runs."""
        return self._earlier_rounds + max(self.rounds, at_least)

    def _call_listener(self, entry: Progress, listener: Callback | None) -> None:
        if listener is not None:
            listener(entry)
        self._last_report = time.monotonic()

    def history(
        self, ideal: Array, span: Array, max_designs: int | None = None, poll: Callable[[], None] = lambda: None
    ) -> tuple[Progress, ...]:
        """Return the rounds with hypervolumes in one scaling, so that they are comparable and never decrease.

        max_designs: number of designs per round that count; the others would add little. poll: called for each round.
        """
        growth = FrontVolume(self._targets, box=(ideal, span), max_designs=max_designs)
        rounds: list[Progress] = []
        for entry, front in zip(self.round_reports, self.fronts, strict=True):
            poll()
            rounds.append(replace(entry, hypervolume=growth.add(front)))
        return tuple(rounds)


def searched_evaluators(evaluators: list[Evaluator]) -> list[Evaluator]:
    """Return the evaluators of branches with free unknowns; they come first, so that indices stay valid."""
    return [evaluator for evaluator in evaluators if evaluator.dimension]


def enumerate_branches(problem: Problem, evaluators: list[Evaluator], run: Run) -> FrontCandidates:
    """Return the feasible designs of all branches without free unknowns, and add them to the run.

    Each of these branches has one design, which is evaluated exactly instead of sampled.
    """
    free, candidates = searched_evaluators(evaluators), run.candidates
    run.enumerated = evaluators[len(free) :]
    point = np.zeros((1, 0))
    for place, evaluator in enumerate(run.enumerated):
        run.checkpoints.poll()
        if evaluator.can_evaluate(point)[0]:
            candidates.add_feasible(len(free) + place, polish_recorded(evaluator, point, candidates.span))
        if (place + 1) % _ROUND == 0 or place + 1 == len(run.enumerated):
            run.report_round("enumerating", free, Archive.empty(len(problem.objectives)))
    return candidates


def sample_and_zoom(problem: Problem, evaluators: list[Evaluator], run: Run | None = None) -> Archive:
    """Return the archive of non-dominated screened designs: first samples, then zooms."""
    run = run or Run(problem, 1 + len(WIDTHS))
    archive = run.archive = Archive.empty(len(problem.objectives))
    samples = problem.settings.samples or FIRST
    loose = any(evaluator.loose for evaluator in evaluators)
    bands = BANDS[1:] if loose else BANDS[:-1]
    run.begin_round("sampling")
    for attempt, band in enumerate(bands):
        archive.band = band
        # A small feasible region needs more points before the search gives up.
        count = samples_per_branch(samples * 4**attempt, evaluators)
        hits = archive.screen_all(
            (index, evaluator, first_samples(count, evaluator.dimension, problem.settings.seed, index))
            for index, evaluator in enumerate(evaluators)
        )
        if hits >= min(ENOUGH, samples) or (
            not attempt and not hits and descents_stay_infeasible(problem, evaluators, bands[-1])
        ):
            break
    run.report_round("sampling", evaluators, archive)
    if len(archive):
        zoom_into_sparse_parts(problem, evaluators, archive, run)
    return archive


def zoom_into_sparse_parts(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> None:
    """Sample around sparse parts of the front, more closely in every round."""
    samples = problem.settings.samples or SAMPLES
    for step in range(len(WIDTHS)):
        run.begin_round("zooming")
        random = random_generator(problem.settings.seed, 1000, step)
        rows = random.choice(len(archive), _CROWD, replace=False) if len(archive) > _CROWD else slice(None)
        parents = archive[rows]
        archive.screen_all(
            (index, evaluator, _samples_around(parents, index, evaluator.dimension, samples, WIDTHS[step], random))
            for index, evaluator in enumerate(evaluators)
            if (parents.branch == index).any()
        )
        run.report_round("zooming", evaluators, archive)


def _samples_around(
    parents: Candidates, index: int, dimension: int, samples: int, width: float, random: np.random.Generator
) -> Array:
    """Return points around the parents on a branch, in proportion to its fraction of all parents."""
    on_branch = parents.branch == index
    count = max(1, int(samples * on_branch.mean()))
    return sample_near_parents(parents.u[on_branch][:, :dimension], parents.values[on_branch], count, width, random)


def descents_stay_infeasible(problem: Problem, evaluators: list[Evaluator], band: float) -> bool:
    """Whether descent from the best samples stays outside the band of the last samples.

    Sixteen times as many samples in that band would cost more and prove less, because their best are not local optima.
    False for robust quantities, because samples estimate them at a fraction of a descent's cost.
    """
    robust = any(isinstance(quantity, RobustQuantity) for quantity in problem.own)
    if robust or problem.without_gradient():
        return False
    k = len(evaluators)
    for index, evaluator in enumerate(evaluators):
        u = first_samples(FIRST // k, evaluator.dimension, problem.settings.seed, index)
        least = least_violation(evaluator, u, ranked=max(_LEAST_RANKED, _RANKED // k), starts=max(2, _STARTS // k))
        if (least.values <= band).any():
            return False
    return True
