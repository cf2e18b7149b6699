"""Supervision of worker processes: starts them, restarts them when they end, and stops them together."""

from __future__ import annotations

import contextlib
import logging
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

from .heartbeat import DEAF, EXHAUSTED
from .worker_process import MARGIN, REFUSED, STALE, WorkerSettings

_log = logging.getLogger(__name__)
WORKER = (sys.executable, "-m", "slidercrank.service.workers.worker_process")
_LOOK = 0.1  # s between two checks of the processes
_FIRST, _LONGEST = 0.5, 30.0  # s until a process that ended early is restarted: doubled each time up to the maximum
_REASONS = {
    0: "it left",
    EXHAUSTED: "its job used more memory than allowed",
    DEAF: "its job did not stop when asked to",
    STALE: "earlier jobs left it too little memory",
    REFUSED: "it could not start; see above",
}
"""Why a process ended, by exit code."""
_SOON = 60.0  # s; after a longer run, a process is restarted without delay


@dataclass
class _Place:
    """State of one worker: its process and start, the number of early ends, and the next start."""

    number: int
    process: subprocess.Popen[bytes] | None = None
    started: float = 0.0
    ended_soon: int = 0
    due: float = field(default_factory=time.monotonic)
    is_drained: bool = False


class Supervisor:
    """While this context is active, a thread keeps a number of worker processes running.

    A worker that ends is replaced: immediately if it had run for a minute or ended because of its jobs. Otherwise it is
    replaced after half a second, doubled each time up to 30 s. On exit, all are asked to stop; those that do not stop
    within their grace are killed. A worker whose supervisor has ended, for whatever reason, stops in the same way.
    """

    def __init__(self, settings: WorkerSettings, processes: int, *, program: Sequence[str] = WORKER) -> None:
        """Prepare the supervisor; nothing is started yet.

        program: worker program; it reads the settings from standard input.
        """
        self.settings = settings
        self._program = program
        self._places = [_Place(number) for number in range(1, processes + 1)]
        self._leaving = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="supervisor", daemon=True)

    def __enter__(self) -> Supervisor:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.request_stop()
        self._thread.join()

    def request_stop(self) -> None:
        """Ask the workers to stop, without waiting for them."""
        self._leaving.set()

    def processes(self) -> list[int]:
        """Return the process numbers of the running workers."""
        running = [place.process for place in self._places]
        return [process.pid for process in running if process is not None and process.poll() is None]

    def is_finished(self) -> bool:
        """Whether all workers have drained the queue and ended."""
        return all(place.is_drained for place in self._places)

    def _watch(self) -> None:
        try:
            while not self._leaving.wait(_LOOK):
                for place in self._places:
                    try:
                        self._supervise_worker(place)
                    except Exception:  # noqa: BLE001 - whatever it is, the other workers are looked after
                        _log.exception("worker %d could not be supervised; trying again", place.number)
        finally:
            self._stop()

    def _supervise_worker(self, place: _Place) -> None:
        if place.process is None:
            if not place.is_drained and time.monotonic() >= place.due:
                self._start(place)
            return
        code = place.process.poll()
        if code is not None:
            _close_input(place.process)
            place.process = None
            self._plan_next(place, code)

    def _start(self, place: _Place) -> None:
        place.started = time.monotonic()
        try:
            # In a separate process group: Ctrl-C reaches only the supervisor, which then asks its workers to stop.
            process = subprocess.Popen(self._program, stdin=subprocess.PIPE, process_group=0)
        except OSError as error:
            self._plan(place, f"could not be started: {error.strerror or error}", soon=True)
            return
        place.process = process
        _log.info("worker %d of %d started as process %d", place.number, len(self._places), process.pid)
        assert process.stdin is not None
        with contextlib.suppress(OSError):  # it has already ended, as the next check will show
            process.stdin.write(self.settings.to_line())
            process.stdin.flush()

    def _plan_next(self, place: _Place, code: int) -> None:
        if code == 0 and self.settings.drain:
            place.is_drained = True
            _log.info("worker %d ended: no job is waiting", place.number)
            return
        soon = code not in (EXHAUSTED, DEAF, STALE) and time.monotonic() - place.started < _SOON
        self._plan(place, f"ended: {exit_reason(code)}", soon=soon)

    def _plan(self, place: _Place, event: str, *, soon: bool) -> None:
        place.ended_soon = place.ended_soon + 1 if soon else 0
        pause = min(_LONGEST, _FIRST * 2.0 ** (place.ended_soon - 1)) if soon else 0.0
        place.due = time.monotonic() + pause
        _log.warning("worker %d %s; another one starts in %g s", place.number, event, pause)

    def _stop(self) -> None:
        running = [place.process for place in self._places if place.process is not None]
        for process in running:
            _close_input(process)
        end = time.monotonic() + (self.settings.terms.grace or 0.0) + MARGIN
        for process in running:
            try:
                process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                _log.warning("worker process %d did not stop in time and is killed", process.pid)
                process.kill()
                process.wait()


def _close_input(process: subprocess.Popen[bytes]) -> None:
    """Close the standard input of a worker, which tells it to stop."""
    if process.stdin is not None:
        with contextlib.suppress(OSError):  # buffered data that could not be written to an ended worker
            process.stdin.close()


def exit_reason(code: int) -> str:
    """Return why a process ended, from its exit code."""
    if code < 0:
        try:
            return f"killed by {signal.Signals(-code).name}"
        except ValueError:
            return f"killed by signal {-code}"
    return _REASONS.get(code, f"exit code {code}")
