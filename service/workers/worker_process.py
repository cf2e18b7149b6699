"""Worker in a separate process: `python -m slidercrank.service.workers.worker_process`, started by a supervisor.

It reads its settings from standard input, one line of JSON, so that no password appears in the process list. It stops
cleanly on SIGTERM, or when standard input ends because its supervisor requests it or has ended.
"""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
import threading
import time
from dataclasses import dataclass

from pydantic import TypeAdapter

from ...model.errors import SlidercrankError
from ..store import LEASE, Store
from ..store.database import Unavailable
from .heartbeat import end_process_tree
from .logs import Format, set_up_logs
from .worker import Stale, Terms, work

GRACE = 10.0
"""Time for a worker to stop, s; then its job returns to the queue, whatever the state of its search."""
MARGIN = 5.0
"""Time beyond its grace after which a worker that has not stopped is killed, s."""
NICENESS = 10
"""Niceness of a worker, so that the API answers even while all workers are busy."""
REFUSED = 2
"""Exit code of a worker that cannot work with its settings."""
STALE = 77
"""Exit code of a worker in which earlier jobs left so much memory that a fresh one takes its place."""
_log = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class WorkerSettings:
    """Settings of a worker process. address: address of the store. Times in s; other fields as in `worker.work`."""

    address: str
    lease: float = LEASE
    drain: bool = False
    most_running: int | None = None
    terms: Terms = Terms(grace=GRACE)
    log_format: Format = "text"

    def to_line(self) -> bytes:
        """Return the settings in the form that the process reads."""
        settings = TypeAdapter(WorkerSettings).dump_python(self)
        return json.dumps(settings, default=str).encode() + b"\n"  # escapes path bytes that no encoding can represent

    @classmethod
    def from_line(cls, line: bytes) -> WorkerSettings:
        """Return the settings from a line."""
        return TypeAdapter(WorkerSettings).validate_python(json.loads(line))


def main() -> int:
    """Work until asked to stop; return the exit code."""
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    line = _first_line()
    if not line:
        return 0
    settings = WorkerSettings.from_line(line)
    set_up_logs(settings.log_format)
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    threading.Thread(target=_exit_with_supervisor, args=(stop, settings.terms.grace), daemon=True).start()
    try:
        store = _open_store(settings, stop)
        if store is None:
            return 0
        with store:
            work(
                store,
                lease=settings.lease,
                stop=stop.is_set,
                drain=settings.drain,
                most_running=settings.most_running,
                terms=settings.terms,
            )
    except Stale:
        return STALE
    except SlidercrankError as error:
        _log.error("%s", error)
        return REFUSED
    return 0


def _open_store(settings: WorkerSettings, stop: threading.Event) -> Store | None:
    """Return the store as soon as it can be reached; None if the worker must stop first."""
    away = False
    while not stop.is_set():
        try:
            return Store(settings.address)
        except Unavailable as error:
            if settings.drain:
                raise
            if not away:
                _log.warning("%s; trying again until it is available", error)
            away = True
            stop.wait(1.0)
    return None


def _first_line() -> bytes:
    """Return the first line of standard input, or nothing. Unbuffered: no thread may hold its lock at the end."""
    line = b""
    while not line.endswith(b"\n"):
        part = os.read(0, 1)
        if not part:
            return b""
        line += part
    return line


def _exit_with_supervisor(stop: threading.Event, grace: float | None) -> None:
    """Stop when standard input ends, and exit after the grace time: the supervisor may have ended.

    This ends even hangs that the heartbeat cannot end, for example if a database does not answer.
    """
    while os.read(0, 64):
        pass
    stop.set()
    time.sleep((grace or 0.0) + MARGIN)
    end_process_tree(1)


if __name__ == "__main__":
    code = main()
    logging.shutdown()
    sys.exit(code)
