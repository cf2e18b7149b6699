"""Work that has a moment: what is not done by then goes on aside, and the answer does without it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")

_ONE = threading.Lock()
"""Of the work aside: kernels that a machine sees for the first time compile for up to a minute, once."""


def within(seconds: float, work: Callable[[], T]) -> T | None:
    """Return the result of the work, or None if it takes longer, or while earlier work still goes on."""
    done: list[T] = []
    failed: list[Exception] = []

    def run() -> None:
        try:
            done.append(work())
        except Exception as error:  # noqa: BLE001 - raised again where it is waited for
            failed.append(error)
        finally:
            _ONE.release()

    if not _ONE.acquire(timeout=seconds):
        return None
    thread = threading.Thread(target=run, daemon=True, name="preview")
    thread.start()
    thread.join(seconds)
    if failed:
        raise failed[0]
    return done[0] if done else None
