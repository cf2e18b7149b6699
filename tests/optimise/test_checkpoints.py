"""Resumption of a run stopped anywhere, by any method: it ends as if it had not been stopped."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from slidercrank.model.errors import ForeignRecords
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.methods import local
from slidercrank.optimise.methods.registry import methods_by_name
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.robust_problem import Robust, robust_problem
from slidercrank.optimise.search import checkpoints
from slidercrank.optimise.search import checkpoints as identity
from slidercrank.optimise.search.checkpoints import Cancelled, Checkpoints, Identity, Numbers, Record, identity_of
from slidercrank.optimise.solve import solve
from tests.optimise.problems import Bounds, degrees, problem, search_little, shipped

# Both signs of the offset, so that there are two branches; a peak among the objectives and one among the constraints.
HELD: dict[str, Bounds] = {"stroke": (0.16, 0.22), "transmission_angle": (degrees(30.0), None)}
LIMITED: dict[str, Bounds] = HELD | {"peak_slider_speed": (None, 4.0)}
SETTINGS: dict[str, dict[str, int]] = {
    "auto": {"samples": 128},
    "slsqp": {},
    "trust_constr": {},
    "differential_evolution": {"evaluations": 1_000},
    "shgo": {"evaluations": 64},
    "minimax": {"evaluations": 2_000},
    "epsilon_constraint": {"evaluations": 400},
    "chebyshev": {"evaluations": 400},
    "nbi": {"evaluations": 400},
    "tpe": {"samples": 8, "evaluations": 40},
    "cmaes": {"samples": 6, "evaluations": 60},
}


SLOW = ("trust_constr", "shgo", "minimax")


@pytest.fixture(autouse=True)
def every_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep every step at once, so that runs can be cut within their rounds; search little."""
    monkeypatch.setattr(checkpoints, "PAUSE", 0.0)
    monkeypatch.setattr(local, "SAMPLES", 512)
    search_little(monkeypatch)


def asked(method: str) -> Problem:
    """Return a small problem for a method."""
    alone = methods_by_name()[method].objectives == "one"
    given = problem(
        {"peak_torque": "minimise"} if alone else {"peak_torque": "minimise", "time_ratio": "maximise"},
        LIMITED,
        crank=(0.05, 0.15),
        rod=0.4 if method in SLOW else (0.2, 0.6),
        offset=(0.01, 0.15) if method in SLOW else (-0.1, 0.15),
        designs=6,
    )
    settings = SETTINGS.get(method, {"samples": 16, "evaluations": 80})
    return replace(given, settings=replace(given.settings, method=method, seed=5, **settings))


def content(front: ParetoFront) -> tuple[object, ...]:
    """Return all that a front is but the time that it took, exactly."""
    return (
        front.status,
        front.message,
        front.evaluations,
        front.hypervolume,
        front.dimensions.tobytes(),
        front.values.tobytes(),
        front.designs.to_csv(),
        [(owner.tobytes(), slopes.tobytes()) for owner, slopes in front.goals],
        [edges.tobytes() for edges in front.active],
        [replace(entry, seconds=0.0) for entry in front.history],
    )


def steps(records: list[Record]) -> bytes:
    return b"".join(record.words.tobytes() for record in records)


@cache
def whole(method: str) -> tuple[tuple[object, ...], tuple[Record, ...], tuple[Progress, ...], int]:
    """Return the content, records, progress and number of questions whether to end of an uninterrupted run."""
    kept: list[Record] = []
    told: list[Progress] = []
    questions = itertools.count()
    front = solve(asked(method), keep=kept.append, progress=told.append, cancelled=lambda: next(questions) < 0)
    assert front.status == "done"
    return content(front), tuple(kept), tuple(told), next(questions)


def after(questions: int) -> Callable[[], bool]:
    """Return a callback that ends a search after so many questions."""
    left = iter(range(questions))
    return lambda: next(left, None) is None


@pytest.mark.parametrize("method", methods_by_name())
def test_a_run_goes_on_from_any_record_bit_for_bit(method: str) -> None:
    found, records, told, _ = whole(method)
    assert len(records) >= 6
    for cut in (2, len(records) - 1) if method in SLOW else (1, len(records) - 1, len(records)):
        kept, again = list(records[:cut]), list[Progress]()
        front = solve(asked(method), resume=records[:cut], keep=kept.append, progress=again.append)
        assert content(front) == found
        assert steps(kept) == steps(list(records))
        # Rounds that were told are not told again.
        assert [entry.round for entry in again] == [entry.round for entry in told[records[cut - 1].rounds :]]


@pytest.mark.parametrize("method", [name for name in methods_by_name() if name not in SLOW])
def test_a_run_that_is_cancelled_again_and_again_ends_as_if_it_had_not_been(method: str) -> None:
    """Each time within a round: after some of the questions that a whole run is asked."""
    found, records, _, questions = whole(method)
    kept: list[Record] = []
    part, stops = questions // 3, 0
    assert part >= 3
    while True:
        before = len(kept)
        front = solve(asked(method), resume=tuple(kept), keep=kept.append, cancelled=after(part))
        if front.status != "cancelled":
            break
        stops += 1
        if len(kept) == before:  # the same step took all of it
            part *= 2
    assert stops >= 2
    assert content(front) == found
    assert steps(kept) == steps(list(records))


@pytest.mark.parametrize("method", ["auto", "slsqp", "differential_evolution", "shgo", "nbi", "nsga2"])
def test_what_was_found_by_half_time_is_delivered_on_cancel(method: str) -> None:
    front = solve(asked(method), cancelled=after(whole(method)[3] // 2))
    assert front.status == "cancelled"
    assert len(front) > 0
    for name in front.designs.columns[front.designs.columns.str.startswith("slack_")]:
        assert (front.designs[name] >= -1e-9 * np.abs(front.designs[name.removeprefix("slack_")])).all(), name


def test_a_kill_in_a_round_loses_no_more_than_the_step_under_way(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _, _, _ = whole("auto")

    class Killed(BaseException):
        pass

    kept: list[Record] = []

    def keep(record: Record) -> None:
        kept.append(record)
        if len(kept) == 7:
            raise Killed

    with pytest.raises(Killed):
        solve(asked("auto"), keep=keep)
    assert content(solve(asked("auto"), resume=kept)) == found


def test_a_job_without_a_feasible_design_goes_on_bit_for_bit() -> None:
    held: dict[str, Bounds] = {"stroke": (0.18, 0.2), "time_ratio": (1.5, None), "transmission_angle": (1.0, None)}
    given = problem({"peak_torque": "minimise"}, held, designs=4, samples=64)
    kept: list[Record] = []
    front = solve(given, keep=kept.append)
    assert front.status == "infeasible"
    for cut in (len(kept) // 2, len(kept) - 1):
        assert content(solve(given, resume=kept[:cut])) == content(front)


def test_what_is_kept_is_small() -> None:
    """A job of 50,000 evaluations keeps less than 4 MB."""
    kept: list[Record] = []
    solve(shipped("sieve"), keep=kept.append)
    assert sum(record.words.nbytes for record in kept) < 2**22


def test_records_of_another_job_method_or_seed_are_refused() -> None:
    _, records, _, _ = whole("nsga2")
    given = asked("nsga2")
    for other in (
        replace(given, settings=replace(given.settings, seed=6)),
        replace(given, settings=replace(given.settings, samples=12)),
        replace(given, settings=replace(given.settings, method="random")),
        replace(given, mechanism=replace(given.mechanism, slider_mass=2.5)),
        replace(given, offset=given.rod),
        replace(given, constraints=given.constraints[1:]),
        robust_problem(given, Robust(kind="worst case")),
    ):
        with pytest.raises(ForeignRecords, match=r"can only continue with its original job, .*; start a new run"):
            solve(other, resume=records)


def test_records_of_other_versions_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    _, records, _, _ = whole("random")
    monkeypatch.setattr(identity, "version_of", lambda name: "0.0.1" if name == "numpy" else "9")
    with pytest.raises(
        ForeignRecords,
        match=r"only continue with its original versions; it has .* install the original ones, or start a new run",
    ):
        solve(asked("random"), resume=records)


def test_records_that_are_not_whole_or_not_in_order_are_refused() -> None:
    _, records, _, _ = whole("sobol")
    for broken, words in (
        (records[1:], "got number 1 instead of 0"),
        ((*records[:2], records[1]), "got number 1 instead of 2"),
        ((replace(records[0], words=records[0].words[:-1]),), "must be complete"),
        ((replace(records[0], words=records[0].words[:3]),), "must be complete"),
        ((replace(records[0], words=np.roll(records[0].words, 1)),), r"must be complete|computes the same"),
    ):
        with pytest.raises(ForeignRecords, match=words):
            solve(asked("sobol"), resume=broken)


def test_a_search_that_comes_to_another_step_is_refused() -> None:
    """Records of a job that gives the same identity, but other designs: of another processor, say."""
    _, records, _, _ = whole("sobol")
    given = asked("sobol")
    other: list[Record] = []
    solve(replace(given, settings=replace(given.settings, seed=6)), keep=other.append)
    foreign = tuple(replace(record, identity=records[0].identity) for record in other)
    with pytest.raises(ForeignRecords, match="reached a different step"):
        solve(given, resume=(records[0], *foreign[1:]))


def test_a_raised_budget_only_adds_generations() -> None:
    _, records, told, _ = whole("nsga3")
    given = asked("nsga3")
    more: list[Progress] = []
    rounds = [record for record in records if record.rounds < len(told)]
    solve(replace(given, settings=replace(given.settings, evaluations=112)), resume=rounds, progress=more.append)
    assert [entry.round for entry in more] == [5, 6, 7]


def test_the_identity_of_a_problem_is_the_same_in_every_process_and_of_every_copy() -> None:
    assert identity_of(shipped("feeder")) == identity_of(replace(shipped("feeder")))
    assert identity_of(shipped("feeder")).problem != identity_of(shipped("sieve")).problem


class Counter:
    evaluations = 0


def test_steps_come_back_with_every_bit_and_their_evaluations() -> None:
    kept: list[Record] = []
    mine = Identity("a", "b")
    first, again = Counter(), Counter()
    given: tuple[Numbers, ...] = (
        np.array([[np.nan, -0.0, np.inf]]),
        np.zeros((0, 3)),
        np.array(3.5),
        np.arange(6).reshape(2, 3)[:, ::-1],
    )

    def compute() -> Iterator[tuple[Numbers, ...]]:
        first.evaluations += 7
        yield given

    one = Checkpoints(keep=kept.append, identity=lambda: mine)
    one.recorded_step("x", (np.ones(2),), lambda: next(compute()), first)
    one.end_round()
    two = Checkpoints(past=kept, identity=lambda: mine)
    assert two.replaying
    found = two.recorded_step("x", (np.ones(2),), lambda: (np.zeros(0),), again)
    assert not two.replaying
    assert again.evaluations == first.evaluations == 7
    for here, there in zip(found, given, strict=True):
        assert (here.dtype, here.shape, here.tobytes()) == (there.dtype, there.shape, there.tobytes())


def test_a_round_whose_last_step_was_kept_before_it_ended_is_not_reported_again() -> None:
    kept: list[Record] = []
    one = Checkpoints(keep=kept.append, identity=lambda: Identity("a", "b"))
    for number in range(2):
        one.recorded_step("x", (np.array([float(number)]),), lambda: (np.ones(1),), Counter())  # longer than the pause
        assert one.end_round()
    two = Checkpoints(past=kept, keep=kept.append, identity=lambda: Identity("a", "b"))
    for number in range(2):
        two.recorded_step("x", (np.array([float(number)]),), lambda: (np.zeros(1),), Counter())
        assert not two.end_round()
    assert [record.rounds for record in kept] == [0, 1, 1, 2]


def test_closed_checkpoints_neither_ask_nor_keep() -> None:
    kept: list[Record] = []
    one = Checkpoints(cancelled=lambda: True, keep=kept.append, identity=lambda: Identity("a", "b"))
    with pytest.raises(Cancelled):
        one.poll()
    one.close()
    one.poll()
    one.recorded_step("x", (), lambda: (np.ones(1),), Counter())
    one.end_round()
    assert kept == []


@dataclass
class Clock:
    now: float = 0.0

    def perf_counter(self) -> float:
        return self.now


def test_the_time_of_a_run_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    clock, kept = Clock(), list[Record]()
    monkeypatch.setattr(checkpoints, "time", clock)
    one = Checkpoints(keep=kept.append, identity=lambda: Identity("a", "b"))
    clock.now = 5.0
    one.recorded_step("x", (), lambda: (np.ones(1),), Counter())
    clock.now = 100.0
    two = Checkpoints(past=kept, identity=lambda: Identity("a", "b"))
    clock.now = 101.0
    assert two.elapsed_seconds == 6.0
