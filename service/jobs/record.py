"""A job as JSON: the same from the command line, the API and the client."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from ..store import Job


def job_record(job: Job) -> dict[str, Any]:
    """Return the fields of a job as JSON has them: times in seconds since 1970, memory in bytes."""
    # Not `asdict`: it copies what is within, which takes most of the time of a list.
    record = {field.name: getattr(job, field.name) for field in fields(Job) if field.name not in ("fence", "limits")}
    record["limits"] = {
        "seconds": job.limits.seconds,
        "evaluations": job.limits.evaluations,
        "memory_bytes": job.limits.memory,
    }
    if job.progress is not None:
        record["progress"] = {"step": 0, "steps": 0, **job.progress, "front": job.progress.get("front")}
    return record
