"""Hooks that tell schemathesis how a job file is sent, and give it some solvable jobs."""

from __future__ import annotations

import copy
from typing import Any

import schemathesis

from slidercrank.service.api.job_requests import EXAMPLE


@schemathesis.serializer("application/toml")
def send_job_file_as_text(_context: schemathesis.SerializationContext, value: Any) -> bytes:
    """Send a job file as its text."""
    return value if isinstance(value, bytes) else str(value).encode(errors="replace")


@schemathesis.hook
def map_body(context: schemathesis.HookContext, body: Any) -> Any:
    """Put a job that can be solved in place of every other made-up one: those are mostly refused."""
    if isinstance(body, dict) and isinstance(body.get("job"), dict) and len(str(body)) % 2:
        return {**body, "job": copy.deepcopy(EXAMPLE)}
    return body
