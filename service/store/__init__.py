"""The store of jobs: one database, SQLite or PostgreSQL, shared by all that submit, watch and solve them."""

from __future__ import annotations

from .claim import Claim
from .records import Artefact, Event, Job, State, Worker
from .store import LEASE, MOST_ATTEMPTS, MOST_QUEUED, Store

__all__ = [
    "LEASE",
    "MOST_ATTEMPTS",
    "MOST_QUEUED",
    "Artefact",
    "Claim",
    "Event",
    "Job",
    "State",
    "Store",
    "Worker",
]
