"""The search's first half: many screened designs, first everywhere, then around sparse parts of the front."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from ...model.arrays import Array, Mask, Whole
from ...objectives.robust.quantity import RobustQuantity
from ..front.dominance import nondominated
from ..front.hypervolume import Stand
from ..front.progress import REPEATING, Progress
from ..problem.problem import Problem
from ..problem.violation import FEASIBLE
from .candidates import Candidates, Finished
from .checkpoints import Checkpoints
from .evaluation import Evaluator
from .growth import Growth
from .recorded import polished
from .sampling import around, first_samples, generator
from .violation import least_violation

FIRST = 16384
"""Designs of the first round, everywhere."""
SAMPLES = 4096
"""Designs of each later round."""
WIDTHS = (0.1, 0.05, 0.02, 0.01)
"""Spread of the zoom rounds, in the unit box."""
BANDS = (0.0, 0.01, 0.04, 0.16)
"""Relative violation that samples may have, in turn, until enough are found; the polish removes it. The first is left
out where equalities remain: no sample meets them."""
ENOUGH = 32
"""Samples that are enough to zoom on."""
LEAST = 1024
"""Designs of a round on each of many sheets."""
_ROUND = 100  # of sheets that leave nothing free
_CROWD = 2000  # parents of a round
_RANKED, _LEAST_RANKED = 256, 64  # samples of which the best lead down, of all sheets and at least of each
_STARTS = 8  # the same of those that do
_BEST = 1000  # designs kept of a single objective
_SHOWN = 400  # designs of a front so far, and of that of a round in the history
TELL = 0.5
"""s between two words of a long stage: somebody watches."""

Callback = Callable[[Progress], None]


@dataclass
class Archive(Candidates):
    """Non-dominated designs found so far; those that meet every constraint only each other displaces.

    band: by how much the others may violate constraints, relative. feasible: designs seen that meet every constraint.
    """

    band: float = field(default=0.0, kw_only=True)
    feasible: int = field(default=0, kw_only=True)

    def screen(self, index: int, evaluator: Evaluator, u: Array) -> int:
        """Evaluate points (n, k) of a sheet, take in those that are feasible within the band, return how many."""
        return self.screen_all([(index, evaluator, u)])

    def screen_all(self, points: Iterable[tuple[int, Evaluator, Array]]) -> int:
        """Screen points of several sheets, then compare them with the archive once: that is what takes time."""
        fresh: list[Candidates] = []
        for index, evaluator, u in points:
            _, values, violation = evaluator.screen(u, band=self.band)
            good = violation <= self.band + FEASIBLE
            met = violation <= FEASIBLE
            self.feasible += int(met.sum())
            fresh.append(Candidates(np.full(int(good.sum()), index), u[good], values[good], met[good]))
        self.put(*fresh)
        return sum(map(len, fresh))

    def take(self, index: int, u: Array, values: Array, met: Mask | None = None) -> None:
        """Take in points (n, k) of a sheet with their objectives (n, m) as minimised.

        met: (n,), which meet every constraint, all by default; the others are near enough to be moved there.
        """
        self.put(Candidates(np.full(len(u), index), u, values, np.ones(len(u), np.bool_) if met is None else met))

    def put(self, *others: Candidates) -> None:
        """Take in designs of any sheets."""
        together = self.join(*others)
        rows = _worth(together)
        as_they_are = len(rows) == len(together) and bool((np.diff(rows) > 0).all())
        self.become(together if as_they_are else together[rows])


def _some(values: Array) -> Array:
    return values[:: 1 + len(values) // _SHOWN]


def _worth(candidates: Candidates) -> Whole:
    """Return the rows of candidates worth keeping; others that meet every constraint displace these alone."""
    rows = _best(candidates.values)
    if candidates.met.all():
        return rows
    own = np.flatnonzero(candidates.met)
    return np.concatenate([own[_best(candidates.values[own])], rows[~candidates.met[rows]]])


def _best(values: Array) -> Whole:
    """Return the rows worth keeping: the non-dominated ones, or many of a single objective, best first."""
    alone = values.shape[1] == 1
    return np.argsort(values[:, 0], kind="stable")[:_BEST] if alone else nondominated(values)


def share(samples: int, evaluators: list[Evaluator]) -> int:
    """Return how many samples each sheet gets of those of a round; many sheets get a sensible number each."""
    if len(evaluators) <= 2:
        return -(-samples // len(evaluators))
    return max(-(-samples // len(evaluators)), min(samples, LEAST))


@dataclass
class Run:
    """State of a running search: its rounds, the front at the end of each, and the result so far.

    checkpoints: of its steps, which its evaluators have too. settled: evaluators of the sheets that leave nothing free.
    archive: what the search has found on the others. finished: the designs of the settled ones, and what the polish
    has made of the archive. fronts: objectives of feasible designs of each round, of many some hundreds. progress:
    called after every round. stages: called in long stages between two. Where neither is given, a round's hypervolume
    is not computed, and told as 0. after: an earlier run for the same answer, whose rounds and hypervolume go on.
    """

    problem: Problem
    rounds: int
    progress: Callback | None = None
    checkpoints: Checkpoints = field(default_factory=Checkpoints)
    told: list[Progress] = field(default_factory=list)
    fronts: list[Array] = field(default_factory=list)
    settled: list[Evaluator] = field(default_factory=list)
    stages: Callback | None = None
    after: Run | None = None

    def __post_init__(self) -> None:
        count = len(self.problem.objectives)
        self.archive, self.finished = Archive.empty(count), Finished.none(np.ones(count))
        self._targets = np.array([objective.target or 0.0 for objective in self.problem.objectives])
        self._growth: Growth = Growth(self._targets) if self.after is None else self.after._growth
        self._heard = time.monotonic()
        self._passed: int = 0 if self.after is None else self.after._passed + len(self.after.told)

    def tell(self, stage: str, evaluators: list[Evaluator], archive: Archive) -> None:
        """Record the end of a round; evaluators: those that the archive's designs are from.

        Of the last archive with designs the front is made if the search is told to end. A round that an earlier run has
        told is not told again, only that it is repeated.
        """
        self.archive = archive if len(archive) else self.archive
        own = archive.values if archive.met.all() else archive.values[archive.met]
        feasible = np.concatenate([own, self.finished.values]) if len(self.finished) else own
        entry = Progress(
            stage,
            self._passed + len(self.told) + 1,
            self._passed + max(self.rounds, len(self.told) + 1),
            sum(evaluator.evaluations for evaluator in (*evaluators, *self.settled)),
            archive.feasible + int((~self.finished.free).sum()),
            self._growth.take(feasible) if self.progress or self.stages else 0.0,
            self.checkpoints.seconds,
        )
        self.told.append(entry)
        self.fronts.append(_some(feasible).copy())  # not a view, which would keep all of them
        if self.checkpoints.turn():
            self._say(entry, self.progress)
        else:
            self.stand(stage, 0, 1)

    def latest(self) -> Array:
        """Return the objectives (n, m) of the front after the last round, SI, as minimised; of many some hundreds."""
        if self.archive.met.all() and not len(self.finished):
            return _some(self.archive.values)
        values = np.concatenate([self.archive.values, self.finished.values])
        return _some(values[nondominated(values)])

    def stage(self, name: str) -> Stand:
        """Return the callback of a long stage, many times a second: it ends a cancelled search and tells progress."""

        def stand(done: int, of: int) -> None:
            self.checkpoints.poll()
            self.stand(name, done, of)

        return stand

    def stand(self, stage: str, done: int, of: int, *, now: bool = False) -> None:
        """Tell how far a stage between two rounds is, where `TELL` has passed since anything was told, or now."""
        if self.stages is None or (time.monotonic() - self._heard < TELL and not now):
            return
        if self.checkpoints.told < self.checkpoints.before or self.checkpoints.replaying:
            stage, done, of = REPEATING, self.checkpoints.repeated, self.checkpoints.resumed
        last = self.told[-1] if self.told else Progress(stage, 0, self.rounds, 0, 0, 0.0, 0.0)
        self._say(
            replace(last, stage=stage, seconds=self.checkpoints.seconds, step=done, steps=max(done, of)), self.stages
        )

    def _say(self, entry: Progress, hearing: Callback | None) -> None:
        if hearing is not None:
            hearing(entry)
        self._heard = time.monotonic()

    def history(
        self, ideal: Array, span: Array, most: int | None = None, poll: Callable[[], None] = lambda: None
    ) -> tuple[Progress, ...]:
        """Return the rounds with hypervolumes of one scaling, so that they compare; they do not fall either.

        most: designs of each round that count; the others would add little. poll: called for each round.
        """
        growth = Growth(self._targets, box=(ideal, span), most=most)
        rounds: list[Progress] = []
        for entry, front in zip(self.told, self.fronts, strict=True):
            poll()
            rounds.append(replace(entry, hypervolume=growth.take(front)))
        return tuple(rounds)


def searched(evaluators: list[Evaluator]) -> list[Evaluator]:
    """Return the evaluators of sheets that leave something free; they come first, so that indices stay the same."""
    return [evaluator for evaluator in evaluators if evaluator.dimension]


def enumerate_settled(problem: Problem, evaluators: list[Evaluator], run: Run) -> Finished:
    """Return the feasible designs of all sheets that leave nothing free, and give them to the run.

    Each such sheet has one design, which is evaluated exactly: no sampling decides about these.
    """
    free, finished = searched(evaluators), run.finished
    run.settled = evaluators[len(free) :]
    point = np.zeros((1, 0))
    for place, evaluator in enumerate(run.settled):
        run.checkpoints.poll()
        if evaluator.valid(point)[0]:
            finished.add(len(free) + place, polished(evaluator, point, finished.span))
        if (place + 1) % _ROUND == 0 or place + 1 == len(run.settled):
            run.tell("enumerating", free, Archive.empty(len(problem.objectives)))
    return finished


def explore(problem: Problem, evaluators: list[Evaluator], run: Run | None = None) -> Archive:
    """Return the archive of non-dominated screened designs: first samples, then zooms."""
    run = run or Run(problem, 1 + len(WIDTHS))
    archive = run.archive = Archive.empty(len(problem.objectives))
    samples = problem.settings.samples or FIRST
    loose = any(evaluator.loose for evaluator in evaluators)
    bands = BANDS[1:] if loose else BANDS[:-1]
    for attempt, band in enumerate(bands):
        archive.band = band
        # A small feasible region wants more points before it is given up.
        count = share(samples * 4**attempt, evaluators)
        found = archive.screen_all(
            (index, evaluator, first_samples(count, evaluator.dimension, problem.settings.seed, index))
            for index, evaluator in enumerate(evaluators)
        )
        if found >= min(ENOUGH, samples) or (
            not attempt and not found and out_of_reach(problem, evaluators, bands[-1])
        ):
            break
    run.tell("sampling", evaluators, archive)
    if len(archive):
        zoom(problem, evaluators, archive, run)
    return archive


def zoom(problem: Problem, evaluators: list[Evaluator], archive: Archive, run: Run) -> None:
    """Sample around sparse parts of the front, closer in every round."""
    samples = problem.settings.samples or SAMPLES
    for step in range(len(WIDTHS)):
        random = generator(problem.settings.seed, 1000, step)
        some = random.choice(len(archive), _CROWD, replace=False) if len(archive) > _CROWD else slice(None)
        parents = archive[some]
        archive.screen_all(
            (index, evaluator, _near(parents, index, evaluator.dimension, samples, WIDTHS[step], random))
            for index, evaluator in enumerate(evaluators)
            if (parents.sheet == index).any()
        )
        run.tell("zooming", evaluators, archive)


def _near(
    parents: Candidates, index: int, dimension: int, samples: int, width: float, random: np.random.Generator
) -> Array:
    """Return points around the parents of a sheet, as many as is their share of the samples of all."""
    own = parents.sheet == index
    count = max(1, int(samples * own.mean()))
    return around(parents.u[own][:, :dimension], parents.values[own], count, width, random)


def out_of_reach(problem: Problem, evaluators: list[Evaluator], band: float) -> bool:
    """Whether descent from the best samples stays farther from the requirements than the band of the last samples.

    Sixteen times as many samples in that band would cost more, and say less: their best are no local optima. Not told
    of robust quantities, which are estimated for samples at a small part of what descent takes.
    """
    robust = any(isinstance(own, RobustQuantity) for own in problem.own)
    if robust or problem.without_gradient():
        return False
    k = len(evaluators)
    for index, evaluator in enumerate(evaluators):
        u = first_samples(FIRST // k, evaluator.dimension, problem.settings.seed, index)
        found = least_violation(evaluator, u, ranked=max(_LEAST_RANKED, _RANKED // k), starts=max(2, _STARTS // k))
        if (found.values <= band).any():
            return False
    return True
