"""Verdict on the faults: figures, and everything that is not as it has to be."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from slidercrank.service.store import Event, Store

from .audit import Change, changes
from .jobs import Found
from .journal import Note, notes
from .stored_results import results_in_store

_ENDED = ("done", "infeasible", "cancelled", "failed")


@dataclass
class Verdict:
    """Verdict on jobs. violations: in words; empty if all is well. slowest: of all resumptions, in s."""

    jobs: int = 0
    wrong: Counter[str] = field(default_factory=Counter)
    repeated: int = 0
    most_repeated: int = 0
    refused: int = 0
    failed: int = 0
    resumptions: int = 0
    slowest: float = 0.0
    violations: list[str] = field(default_factory=list)

    def violate(self, kind: str, what: str) -> None:
        """Note what must not be."""
        self.wrong[kind] += 1
        self.violations.append(f"{kind}: {what}")

    def resumed(self, seconds: float) -> None:
        """Note how long it took until a job went on."""
        self.resumptions += 1
        self.slowest = max(self.slowest, seconds)

    def add(self, other: Verdict) -> None:
        """Take in what came of other jobs."""
        self.jobs += other.jobs
        self.wrong += other.wrong
        self.repeated += other.repeated
        self.most_repeated = max(self.most_repeated, other.most_repeated)
        self.refused += other.refused
        self.failed += other.failed
        self.resumptions += other.resumptions
        self.slowest = max(self.slowest, other.slowest)
        self.violations += other.violations

    def line(self) -> str:
        """Return the figures."""
        wrong = ", ".join(f"{self.wrong[kind]} {kind}" for kind in KINDS_OF_WRONG)
        return (
            f"{self.jobs} jobs: {wrong}; {self.repeated} rounds repeated, at most {self.most_repeated} a crash; "
            f"{self.refused} writes refused, {self.failed} failed; "
            f"{self.resumptions} resumptions, the slowest after {self.slowest:.2f} s"
        )


KINDS_OF_WRONG = (
    "lost",
    "ended twice",
    "designs differ",
    "results differ",
    "stale writes",
    "rounds amiss",
    "events missed",
    "late",
    "left",
    "printed",
)


def judge(
    address: str,
    numbers: Mapping[int, str],
    expected: Mapping[str, Found],
    journal: Path,
    deaths: Mapping[str, float] | None = None,
    *,
    within: float = math.inf,
) -> Verdict:
    """Return the verdict on jobs, compared with their undisturbed results.

    deaths: when workers were killed. within: how soon after that, in s, another one has to go on with their jobs.
    """
    verdict = Verdict(jobs=len(numbers))
    results, audit = results_in_store(address), changes(address)
    noted: dict[int, list[Note]] = {}
    for note in notes(journal):
        verdict.failed += note.what == "failed"
        noted.setdefault(note.job, []).append(note)
    with Store(address) as store:
        for number, kind in numbers.items():
            events = store.events(number, limit=1_000_000)
            _judge_end(verdict, number, store.job(number).state, events, audit[number])
            _judge_result(verdict, number, results.get(number), expected[kind])
            _judge_writes(verdict, number, audit[number], noted.get(number, []))
            _judge_rounds(verdict, number, events, noted.get(number, []))
            _time_resumptions(verdict, number, events, deaths or {}, within)
    return verdict


def _judge_end(verdict: Verdict, number: int, state: str, events: Sequence[Event], audit: Sequence[Change]) -> None:
    if state != "done":
        verdict.violate("lost", f"job {number} is {state}")
    told = [event.data["state"] for event in events if event.kind == "state" and event.data["state"] in _ENDED]
    ended = [change.state for change in audit if change.was != change.state and change.state in _ENDED]
    resumed = sum(event.data.get("reason") == "resumed" for event in events)
    if len(told) > 1 + resumed or len(ended) > 1 + resumed:
        verdict.violate("ended twice", f"job {number}: events {told}, changes {ended}")
    if [event.number for event in events] != list(range(1, len(events) + 1)):
        verdict.violate("rounds amiss", f"the events of job {number} have gaps")


def _judge_result(verdict: Verdict, number: int, result: Found | None, expected: Found) -> None:
    if result is None or result.designs != expected.designs:
        verdict.violate("designs differ", f"job {number}")
    if result is None or result.record != expected.record:
        verdict.violate("results differ", f"job {number}")


def _judge_writes(verdict: Verdict, number: int, audit: Sequence[Change], noted: Sequence[Note]) -> None:
    """Check that every write is of the latest claim and in order, and that no noted one is missing.

    A write after its lease would show as one of an earlier claim, or as one that its worker noted and the log has not.
    """
    fence, writes = 0, 0
    for change in audit:
        next_write = change.fence == fence and change.writes in (writes, writes + 1)
        next_claim = change.fence == fence + 1 and change.writes == 0
        if not (next_write or next_claim):
            verdict.violate("stale writes", f"job {number}: {change} after claim {fence}, write {writes}")
        fence, writes = change.fence, change.writes
    there = {(change.fence, change.writes) for change in audit}
    for note in noted:
        if note.what == "wrote" and (note.fence, note.number) not in there:
            verdict.violate("stale writes", f"job {number}: {note} is not in the log")
    verdict.refused += sum(note.what == "refused" for note in noted)


def _judge_rounds(verdict: Verdict, number: int, events: Sequence[Event], noted: Sequence[Note]) -> None:
    evaluated = [note for note in noted if note.what == "evaluated"]
    latest: dict[int, int] = {}
    for note in evaluated:
        if note.fence not in latest:
            before = max((last for fence, last in latest.items() if fence < note.fence), default=0)
            again = before + 1 - note.number
            verdict.repeated += max(0, again)
            verdict.most_repeated = max(verdict.most_repeated, again)
            if again > 1:
                verdict.violate("rounds amiss", f"job {number}: claim {note.fence} begins {again} rounds back")
        latest[note.fence] = note.number
    rounds = [event.data["round"] for event in events if event.kind == "progress" and not event.data["steps"]]
    if rounds != list(range(1, len(rounds) + 1)):
        verdict.violate("rounds amiss", f"job {number}: its events tell of rounds {rounds}")


def _time_resumptions(
    verdict: Verdict, number: int, events: Sequence[Event], deaths: Mapping[str, float], within: float
) -> None:
    for event in events:
        worker = event.data.get("text", "").removeprefix("the lease of ").removesuffix(" ended without a report")
        if event.kind == "message" and worker in deaths:
            taken = event.at - deaths[worker]
            verdict.resumed(taken)
            if taken > within:
                verdict.violate(
                    "late", f"job {number} of {worker}, killed at {deaths[worker]:.3f}, after {taken:.2f} s"
                )
