"""SIGTERM and Ctrl-C as a wish to stop in an orderly way, for commands that run until then."""

from __future__ import annotations

import signal
import threading
from types import FrameType
from typing import Any


class Termination:
    """While entered, a first SIGTERM or Ctrl-C asks to stop; a second Ctrl-C interrupts whatever goes on."""

    def __init__(self) -> None:
        self._asked = threading.Event()
        self._before: dict[int, Any] = {}

    def asked(self) -> bool:
        """Whether to stop."""
        return self._asked.is_set()

    def __enter__(self) -> Termination:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGTERM, signal.SIGINT):
                self._before[number] = signal.signal(number, self._heard)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _heard(self, number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGINT and self._asked.is_set():
            raise KeyboardInterrupt
        self._asked.set()
