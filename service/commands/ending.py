"""The end of a command: exit codes, and signals as a wish to stop without losing anything."""

from __future__ import annotations

import signal
import threading
from types import FrameType
from typing import Any, NoReturn

import typer

from ..text.screen import say

FAULT, WRONG_INPUT, NOTHING_FEASIBLE, NOT_PROVEN, INTERRUPTED = 1, 2, 3, 4, 130
EXIT_CODES = {"done": 0, "infeasible": NOTHING_FEASIBLE, "cancelled": INTERRUPTED, "failed": WRONG_INPUT}
"""By the state of a job."""


def end_without_design(message: str) -> NoReturn:
    """End a command that found no design, or none that meets the conditions."""
    say(f"slidercrank: {message}")
    raise typer.Exit(NOTHING_FEASIBLE)


class Interruption:
    """While entered, a first Ctrl-C asks to stop at the next good moment; a second one stops at once.

    service: SIGTERM asks, too, and nothing is said of it.
    """

    def __init__(self, *, service: bool = False) -> None:
        self._service = service
        self._asked = False
        self._before: dict[int, Any] = {}

    def asked(self) -> bool:
        """Whether to stop."""
        return self._asked

    def __enter__(self) -> Interruption:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGTERM, signal.SIGINT) if self._service else (signal.SIGINT,):
                self._before[number] = signal.signal(number, self._heard)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _heard(self, number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGINT and self._asked:
            raise KeyboardInterrupt
        self._asked = True
        if not self._service:
            say("stopping after this step; Ctrl-C again stops at once")
