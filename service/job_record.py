"""A job as JSON: the same from the command line, the API and the client."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from .store import Job


def job_record(job: Job) -> dict[str, Any]:
    """Return the fields of a job as JSON has them: times in seconds since 1970, memory in bytes."""
    record = asdict(job)
    del record["fence"]
    limits = record.pop("limits")
    record["limits"] = {
        "seconds": limits["seconds"],
        "evaluations": limits["evaluations"],
        "memory_bytes": limits["memory"],
    }
    return record
