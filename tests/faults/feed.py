"""Jobs for the workers to do, never more at a time than there are workers free to take over."""

from __future__ import annotations

import random

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Job, Store

from .jobs import KINDS, tables


class Feed:
    """Submits jobs, a few at a time, and remembers them. jobs: number and kind of each."""

    def __init__(self, store: Store, chance: random.Random, *, at_once: int = 2, most_attempts: int = 1000) -> None:
        """Feed a store. at_once: how many jobs are under way. most_attempts: of each; here most kills are meant."""
        self.jobs: dict[int, str] = {}
        self._store = store
        self._chance = chance
        self._at_once = at_once
        self._most_attempts = most_attempts

    def fill(self) -> None:
        """Submit jobs until enough are under way."""
        for _ in range(self._at_once - len(self.under_way())):
            kind = self._chance.choice(KINDS)
            job = submit(self._store, tables(kind), most_attempts=self._most_attempts)
            self.jobs[job.id] = kind

    def under_way(self) -> list[Job]:
        """Return the jobs that have not ended."""
        return self._store.jobs(states=("queued", "running"))

    def busy(self) -> list[str]:
        """Return the workers that have a job."""
        return [job.worker for job in self.under_way() if job.worker is not None]
