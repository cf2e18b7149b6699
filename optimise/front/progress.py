"""Progress of a running search as numbers, text and a live bar; summary of a discrete search."""

import contextlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from threading import Event, Thread
from typing import Any


@dataclass(frozen=True, kw_only=True)
class DiscreteSearch:
    """How the front of a problem with discrete numbers was found.

    exact: whether every combination was judged; otherwise only those next to designs of the continuous front.
    combinations: number of combinations. judged: number of those judged. rules: rules for the discrete numbers by name,
    in words. continuous: best value of each objective on the continuous front, (m,), as minimised, SI; empty without
    one.
    """

    exact: bool
    combinations: int
    judged: int
    rules: Mapping[str, str]
    continuous: tuple[float, ...]

    @property
    def extent_text(self) -> str:
        """Extent of the search, in words."""
        return "exact" if self.exact else "neighbours of the continuous front"


LOADING = "loading"
"""Stage before a search: loading libraries, the job and the records of an earlier run."""
REPEATING = "repeating rounds"
"""Stage of a resumed search that repeats the recorded rounds without evaluating anything."""


@dataclass(frozen=True)
class Progress:
    """Progress of a search after a round, or during a long stage.

    round, rounds: number of this round and of planned rounds. feasible: number of feasible designs found so far.
    hypervolume: hypervolume of these designs; it never decreases. During the search, its unit is a box spanned by the
    first feasible designs, so it may exceed 1. In a front's history, it is a fraction of the front's box. It cannot be
    compared between runs. step, steps: progress within the stage, 0 of 0 at the end of a round.
    """

    stage: str
    round: int
    rounds: int
    evaluations: int
    feasible: int
    hypervolume: float
    seconds: float
    step: int = 0
    steps: int = 0

    @property
    def is_preparing(self) -> bool:
        """Whether the search is still loading, or repeating the rounds of an earlier run."""
        return self.stage in (LOADING, REPEATING)


def stage_text(progress: Mapping[str, Any]) -> str:
    """Return a search's stage and its progress: "polishing 12/66", "selecting designs 1,200/3,000".

    progress: fields of `Progress`; old stores lack the steps.
    """
    total = progress.get("steps", 0)
    count, total = (progress["step"], total) if total else (progress["round"], progress["rounds"])
    return f"{progress['stage']} {count:,}/{total:,}"


@contextlib.contextmanager
def progress_bar() -> Iterator[Callable[[Progress], None]]:
    """Show a live bar within the context, on standard error or in a notebook; yield the callback that updates it.

    Its clock keeps running between reports.
    """
    from tqdm.auto import tqdm

    form, ended, (columns, rows) = "{desc} {bar:24} {unit} {elapsed}", Event(), _terminal_size()
    with tqdm(desc="starting", unit="", bar_format=form, total=1, leave=False, ncols=columns, nrows=rows) as bar:

        def update_bar(at: Progress) -> None:
            bar.total, bar.n = at.steps or at.rounds, at.step if at.steps else at.round
            bar.unit = f"{at.feasible:,} feasible, hypervolume {at.hypervolume:.4f}"
            bar.set_description_str(stage_text(vars(at)))

        def tick() -> None:
            while not ended.wait(1.0):
                bar.refresh()

        clock = Thread(target=tick, daemon=True)
        clock.start()
        try:
            yield update_bar
        finally:
            ended.set()
            clock.join()


def _terminal_size() -> tuple[int | None, int | None]:
    """Return default columns and rows for a terminal that reports none, such as some remote ones; otherwise None."""
    try:
        columns, rows = os.get_terminal_size(sys.stderr.fileno())
    except (OSError, ValueError, AttributeError):
        return None, None
    return None if columns else 80, None if rows else 24
