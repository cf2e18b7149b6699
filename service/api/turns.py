"""Work of which one request does some at a time, so that the service stays quick for all others."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

from fastapi import HTTPException

_PATIENCE = 10.0  # s

DRAWING = threading.Lock()
"""matplotlib is not made for threads."""
SIMULATING = threading.Lock()


@contextlib.contextmanager
def in_turn(lock: threading.Lock, what: str) -> Iterator[None]:
    """Wait for a turn; give up with a 503 that says so when it does not come soon."""
    if not lock.acquire(timeout=_PATIENCE):
        message = f"{what} is done for one request at a time; others were first for {_PATIENCE:g} s; try again"
        raise HTTPException(503, message, headers={"Retry-After": "5"})
    try:
        yield
    finally:
        lock.release()
