"""Heartbeat and budget of a claimed job: a thread renews the lease and notices events that the search cannot."""

from __future__ import annotations

import contextlib
import contextvars
import logging
import os
import signal
import threading
import time
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import NoReturn

from ...model.errors import LeaseLost, StoreError
from ...objectives.kinds import count_with_noun
from ...objectives.own.function_process_client import is_guard_command
from ..resources.memory import Memory, size_text
from ..runs.result import Result
from ..store import NO_LIMITS, NOT_DONE, Claim, Limits

_log = logging.getLogger(__name__)
PULSE = 0.25
"""Time between two heartbeats, s: a cancelled job must end within 2 s, of which its search may take one to notice."""
EXHAUSTED = 75
"""Exit code of a process whose job exceeded its memory limit; another process is to take its place."""
DEAF = 76
"""Exit code of a process whose search did not stop on request; another process is to take its place."""
_STOP_PATIENCE = 60.0  # s for a search to end on request: a compiling kernel cannot respond
Stop = Callable[[], bool]


@dataclass
class Budget:
    """Remaining time and evaluations of a search, from now on.

    A search ends at the next check after either is exhausted.

    limits: the memory limit is ignored here. waited: time that the search has waited for disk space, s.
    """

    limits: Limits
    waited: Callable[[], float] = lambda: 0.0
    _began: float = field(default_factory=time.monotonic, init=False)
    _evaluations: int = field(default=0, init=False)

    def count_evaluations(self, evaluations: int) -> None:
        """Record the number of designs evaluated so far."""
        self._evaluations = evaluations

    def is_spent(self) -> bool:
        """Whether the search must end with its result so far."""
        return bool(self.exhausted_limit_text())

    def with_limit_named(self, result: Result) -> Result:
        """Return a result whose message names the limit that ended its search, if any."""
        reason = self.exhausted_limit_text() if result.status == "cancelled" else ""
        return replace(result, message=f"{result.message}; {reason}") if reason else result

    def exhausted_limit_text(self) -> str:
        """Return the exhausted limit in words; empty if there is none."""
        seconds, evaluations = self.limits.seconds, self.limits.evaluations
        if seconds is not None and time.monotonic() - self._began - self.waited() >= seconds:
            return f"its search reached its time limit of {seconds:g} s"
        if evaluations is not None and self._evaluations >= evaluations:
            return f"its search reached its limit of {count_with_noun(evaluations, 'evaluation')}"
        return ""


@dataclass(eq=False)
class Heartbeat:
    """While this context is active, a thread renews a claim's lease and checks its job for a cancellation.

    budget: budget of the job. If the job exceeds its memory, as measured by `memory`, it is set aside as failed and the
    process ends with exit code `EXHAUSTED`. Nothing else frees the memory reliably. If the search does not end within a
    minute after another limit or a cancellation, and only if there is a grace, the job ends without it and the process
    exits with `DEAF`. grace: time that a search may continue after `stop` is true, s; unlimited if None. The job is
    then returned to the queue and the process exits with 0. patience: time that a cancelled job waits for a search that
    has not started, s; unlimited if None. The job then ends without the search. So does a job whose worker must stop:
    nothing is lost. A search that loads or compiles its functions notices nothing. lost: reason why this worker no
    longer has the job; empty while it has.
    """

    claim: Claim
    _: KW_ONLY
    budget: Budget = field(default_factory=lambda: Budget(NO_LIMITS))
    memory: Memory = field(default_factory=Memory)
    stop: Stop = lambda: False
    grace: float | None = None
    patience: float | None = None
    lost: str = field(default="", init=False)

    def __post_init__(self) -> None:
        self._since: dict[str, float] = {}
        self._end = threading.Event()
        beat = contextvars.copy_context().run  # so that its log lines name the same job
        self._thread = threading.Thread(
            target=beat, args=(self._beat_until_end,), name=f"heartbeat of job {self.claim.job.id}", daemon=True
        )

    def __enter__(self) -> Heartbeat:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()

    def _beat_until_end(self) -> None:
        lease = self.claim.lease
        while not self.lost and not self._end.wait(min(PULSE, lease / 10.0)):
            self._check_memory()
            self._check_stop()
            self._check_unresponsive_search()
            try:
                if self.claim.seconds_since_renewal > lease / 3.0 or self.claim.astray:
                    self.claim.renew()
                else:
                    self.claim.refresh_cancellation()
                self._check_cancellation()
            except LeaseLost:
                if not self._end.is_set():  # at the end of a job the claim is released on purpose
                    self.lost = "its lease has expired; another worker continues from the last committed round"
            except StoreError:
                pass  # the writes of the search will show whether it is still valid

    def _seconds_since_first(self, condition: str) -> float:
        """Return the time that a condition has held, s, since the first call."""
        now = time.monotonic()
        return now - self._since.setdefault(condition, now)

    def _check_cancellation(self) -> None:
        if self.patience is None or not self.claim.cancel_asked or self.claim.has_started or self._end.is_set():
            return
        if self._seconds_since_first("cancelled") >= self.patience:
            self.claim.end_as_cancelled()
            self.lost = "it was cancelled before its search began"

    def _check_memory(self) -> None:
        allowed = self.budget.limits.memory
        if allowed is None or (used := self.memory.used_by_job()) <= allowed or self._end.is_set():
            return
        reason = (
            f"it may use {size_text(allowed)} of memory; its worker used {size_text(used)}; give it a higher "
            "limit, or ask for less"
        )
        _log.error("set aside: %s", reason)
        with contextlib.suppress(LeaseLost, StoreError):  # otherwise its lease expires, and the attempt counts
            self.claim.fail(reason, again=False)
        end_process_tree(EXHAUSTED)

    def _check_unresponsive_search(self) -> None:
        reason = NOT_DONE if self.claim.cancel_asked else self.budget.exhausted_limit_text()
        if self.claim.waits:  # while it waits for disk space, it cannot end
            self._since.pop("told to end", None)
            return
        if self.grace is None or not reason:
            return
        if self._seconds_since_first("told to end") < _STOP_PATIENCE or self._end.is_set():
            return
        _log.error("ended: its search did not stop within %g s of being asked to", _STOP_PATIENCE)
        try:
            self.claim.end_as_cancelled(f"{reason}; its search did not stop when asked to")
        except (LeaseLost, StoreError):
            return  # it has ended after all, or its writes will show
        end_process_tree(DEAF)

    def _check_stop(self) -> None:
        if self.grace is None or not self.stop():
            return
        waited = self._seconds_since_first("worker stops")
        has_started = self.claim.has_started or self.patience is None
        grace = self.grace if has_started else min(self.grace, self.patience or 0.0)
        if waited < grace or self._end.is_set():
            return
        moment = "in the middle of a round" if has_started else "before its search began"
        _log.warning("handed back: its worker stopped %s", moment)
        with contextlib.suppress(LeaseLost, StoreError):
            self.claim.hand_back(f"its worker stopped {moment}; another one continues")
        end_process_tree(0)


def end_process_tree(code: int) -> NoReturn:
    """End the children with their process groups, then this process, immediately, regardless of its other threads."""
    end_children()
    os._exit(code)


def end_children() -> None:
    """Kill the children of this process, their children, and their process groups."""
    import psutil

    waiting = psutil.Process().children()
    while waiting:
        child = waiting.pop()
        with contextlib.suppress(psutil.Error, OSError):
            if is_guard_command(child.cmdline()):
                continue  # it kills what its function has started, once the requesting process has ended
            waiting += child.children()
            if hasattr(os, "killpg") and os.getpgid(child.pid) == child.pid:
                os.killpg(child.pid, signal.SIGKILL)
            child.kill()
