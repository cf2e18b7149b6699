"""Store of jobs: one database, SQLite or PostgreSQL, shared by all processes that submit, watch and solve jobs."""

from .claim import Claim
from .records import NO_LIMITS, NOT_DONE, RESUMABLE, Artefact, Event, Job, Limits, News, Queueing, State, Worker
from .store import LEASE, MOST_QUEUED, Store

__all__ = [
    "LEASE",
    "MOST_QUEUED",
    "NOT_DONE",
    "NO_LIMITS",
    "RESUMABLE",
    "Artefact",
    "Claim",
    "Event",
    "Job",
    "Limits",
    "News",
    "Queueing",
    "State",
    "Store",
    "Worker",
]
