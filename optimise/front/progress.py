"""Progress of a search, as it is told while it runs."""

from __future__ import annotations

from dataclasses import dataclass

LOADING = "loading"
"""Stage before a search: what it computes with, its job, and what is kept of an earlier run are read."""
REPEATING = "repeating rounds"
"""Stage of a search that goes on: its rounds are those of the earlier run, without evaluating anything."""


@dataclass(frozen=True)
class Progress:
    """Progress of a search after one of its rounds, or in a long stage between two.

    round, rounds: this one and how many are planned. feasible: designs found so far that meet every constraint.
    hypervolume: what those dominate; it never falls. While the search goes on it is told in boxes that the first
    feasible designs span, and may exceed 1; in the history of a front, as a share of the box of that front. Not
    comparable between runs. step, steps: how far the stage is, 0 of 0 at the end of a round.
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
    def prepares(self) -> bool:
        """Whether nothing new is searched yet: the search loads, or repeats what an earlier run of it did."""
        return self.stage in (LOADING, REPEATING)
