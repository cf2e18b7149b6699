"""End of a command: exit codes, and signals that request a stop without data loss."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from functools import wraps
from types import FrameType
from typing import Any, NoReturn

import typer

from ...model.errors import InfeasibleError
from ..runs.result import Result, infeasible_result, json_text
from ..text.screen import print_message, print_output

FAULT, WRONG_INPUT, NOTHING_FEASIBLE, NOT_PROVEN, INTERRUPTED = 1, 2, 3, 4, 130
EXIT_CODES = {"done": 0, "infeasible": NOTHING_FEASIBLE, "cancelled": INTERRUPTED, "failed": WRONG_INPUT}
"""Exit codes by job state."""


class NoDesigns(InfeasibleError):
    """Error for a run without designs where one is needed."""

    def __init__(self, result: Result) -> None:
        super().__init__(result.message)
        self.result = result


def print_infeasible_as_json(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command that, with --json, prints infeasible input as the JSON of a run without designs."""

    @wraps(command)
    def run(**given: Any) -> None:
        try:
            command(**given)
        except InfeasibleError as error:
            if given.get("json") is True:
                result = error.result if isinstance(error, NoDesigns) else infeasible_result(error)
                print_output(json_text(result.record()))
            raise

    return run


def exit_without_design(message: str) -> NoReturn:
    """End a command if its search found no design, or no design meets the conditions."""
    print_message(f"slidercrank: {message}")
    raise typer.Exit(NOTHING_FEASIBLE)


class Interruption:
    """Within this context, the first Ctrl-C requests a stop at the next safe point; the second stops immediately.

    service: whether SIGTERM also requests a stop, and no message is printed.
    """

    def __init__(self, *, service: bool = False) -> None:
        self._service = service
        self._requested = False
        self._before: dict[int, Any] = {}

    def is_requested(self) -> bool:
        """Whether to stop."""
        return self._requested

    def __enter__(self) -> Interruption:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGTERM, signal.SIGINT) if self._service else (signal.SIGINT,):
                self._before[number] = signal.signal(number, self._on_signal)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _on_signal(self, number: int, _frame: FrameType | None) -> None:
        if number == signal.SIGINT and self._requested:
            raise KeyboardInterrupt
        self._requested = True
        if not self._service:
            print_message("stopping after this step; press Ctrl-C again to stop immediately")
