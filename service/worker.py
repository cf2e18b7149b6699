"""A worker: claims jobs of a store, solves them, and writes what it finds."""

from __future__ import annotations

import contextlib
import logging
import math
import os
import secrets
import socket
import threading
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import replace

from ..model.errors import InputError, LeaseLost, StoreError
from .result import json_text, result_of
from .store import LEASE, Artefact, Claim, Store

_log = logging.getLogger(__name__)
PULSE = 1.0
_DELAY = 2.0  # s before another attempt after the first error; doubled with every further one
Stop = Callable[[], bool]


class Stopped(Exception):
    """The worker is to stop, so its job goes back."""


def worker_name() -> str:
    """Return a name for a worker that no other one has: machine, process, and some letters."""
    return f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(3)}"


def work(
    store: Store, *, name: str | None = None, lease: float = LEASE, stop: Stop | None = None, drain: bool = False
) -> int:
    """Solve jobs of a store one after the other, and return how many were taken on.

    lease: for how long, in s, a job stays this worker's without a word of it; a third of it is how often it renews one.
    stop: asked between rounds and while nothing waits; when it says so, the job under way goes back into the queue and
    the work ends. drain: end as soon as no job waits.

    While the database cannot be reached, it is tried again every second.
    """
    name = name or worker_name()
    stop = stop or (lambda: False)
    taken, greeted = 0, -lease
    while not stop():
        try:
            if time.monotonic() - greeted > lease / 3.0:
                store.greet(name)
                greeted = time.monotonic()
            claim = store.claim(name, lease=lease)
        except StoreError as error:
            if drain:
                raise
            _log.warning("%s", error)
            claim = None
        if claim is not None:
            _log.info("job %d: claimed by %s", claim.job.id, name)
            solve_claimed(store, claim, stop)
            taken += 1
        elif drain:
            break
        else:
            time.sleep(PULSE)
    with contextlib.suppress(StoreError):  # where it cannot be reached, the worker is silent from now on
        store.part(name)
    return taken


def solve_claimed(store: Store, claim: Claim, stop: Stop) -> None:
    """Solve a claimed job and end it; or give it back, with the reason, when that does not succeed.

    What the job evaluated under earlier claims is not evaluated again. When the lease is lost, or the database out of
    reach for as long as it lasts, nothing is written: whoever claims the job next goes on from what is there.
    """
    try:
        with Pulse(claim) as pulse:
            try:
                _solve(store, claim, lambda: _ends(claim, pulse, stop))
            except Stopped:
                claim.hand_back("its worker stopped; another one goes on")
            except InputError as error:
                claim.fail(str(error), again=False)
            except (LeaseLost, StoreError):
                raise
            except Exception as error:  # noqa: BLE001 - whatever it is, the job and not the worker ends
                claim.put(Artefact(name="error.txt", media_type="text/plain", content=_trace(error)))
                reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
                claim.fail(reason, again=True, delay=_DELAY * 2.0 ** (claim.job.attempts - 1))
            except BaseException:
                with contextlib.suppress(LeaseLost, StoreError):  # what interrupts matters more
                    claim.hand_back("its worker was interrupted; another one goes on")
                raise
    except (LeaseLost, StoreError) as error:
        _log.warning("job %d: left as it is: %s", claim.job.id, error)


class Pulse:
    """While entered, a thread that keeps the lease of a claim and learns whether its job is to be cancelled.

    lost: whether the lease is another worker's by now.
    """

    def __init__(self, claim: Claim) -> None:
        """Care for a claim."""
        self.claim = claim
        self.lost = False
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._beat, name=f"pulse of job {claim.job.id}", daemon=True)

    def __enter__(self) -> Pulse:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join()

    def _beat(self) -> None:
        lease = self.claim.lease
        while not self._end.wait(min(PULSE, lease / 10.0)):
            try:
                if self.claim.age > lease / 3.0:
                    self.claim.renew()
                else:
                    self.claim.look()
            except LeaseLost:
                self.lost = not self._end.is_set()  # at the end of a job it is given up as it should be
                return
            except StoreError:
                continue  # the writes of the search find out whether it stays so


def _solve(store: Store, claim: Claim, ends: Callable[[], bool]) -> None:
    from ..optimise.job import parse_job
    from ..optimise.solve import solve

    problem = parse_job(store.tables(claim.job.id), allow_user_code=False)
    past = tuple(claim.generations())
    limit = claim.job.limits.seconds or math.inf
    end = time.monotonic() + limit

    def over() -> bool:
        return ends() or time.monotonic() >= end

    front = solve(problem, progress=claim.tell, cancelled=over, resume=past, keep=claim.keep)
    result = result_of(front, claim.job.run)
    if result.status == "cancelled" and not claim.cancel_asked:
        result = replace(result, message=f"{result.message}; its search took longer than its limit of {limit:g} s")
    claim.finish(result, [versions_file(front.versions)])


def versions_file(versions: Mapping[str, str]) -> Artefact:
    """Return the file of what computed a result."""
    return Artefact(name="versions.json", media_type="application/json", content=json_text(versions).encode())


def _ends(claim: Claim, pulse: Pulse, stop: Stop) -> bool:
    """Whether the search is to end with what it has; raises what ends it without."""
    if pulse.lost:
        raise LeaseLost(f"the lease of job {claim.job.id} has ended; another worker goes on from what was committed")
    if claim.cancel_asked:
        return True
    if stop():
        raise Stopped
    return False


def _trace(error: Exception) -> bytes:
    return "".join(traceback.format_exception(error)).encode(errors="replace")
