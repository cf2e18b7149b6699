"""Evaluation on a Dask cluster; work lost with a worker or the scheduler is repeated."""

import contextlib
import logging
import time
import uuid
from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from platform import python_version_tuple
from typing import Any

from ...model.errors import EngineError, InputError, SlidercrankError
from ...model.optional_packages import import_extra
from .engine import Found, Item, Poll

_log = logging.getLogger(__name__)
PATIENCE = 300.0
"""s, time without a scheduler or any worker after which a search gives up."""
MOST_KILLED = 3
"""Number of times that Dask may give up an item because its workers died; each time, four workers have died."""
_START = 1.0  # s, typical time to connect
_CONNECT = 5.0  # s, timeout for one attempt
_TICK = 0.1
_LOOK = 2.0  # s, between two checks for workers while no results arrive
_DELAYS = 0.25, 8.0  # s, before reconnecting: the initial delay, doubled up to the maximum
_SAME = ("slidercrank", "numpy", "numba", "scipy")  # packages whose versions affect the last bit


@dataclass(frozen=True)
class Tls:
    """Files for an encrypted connection: the authority's certificate, the client's certificate and its key."""

    authority: Path
    certificate: Path
    key: Path


class _Lost(Exception):
    """The scheduler is lost, or no longer knows this client."""


class Cluster:
    """A running Dask cluster with the same software versions as this process.

    It connects on first use. Do not use it from several threads at once.
    """

    def __init__(self, address: str, *, tls: Tls | None = None, patience: float = PATIENCE) -> None:
        """Store the scheduler's address, "tcp://host:8786" or "tls://host:8786", and how long to wait for it, s.

        Raises `InputError` for any other kind of address, and for an encrypted one without the necessary files.
        """
        scheme, _, rest = address.partition("://")
        if scheme not in ("tcp", "tls") or "@" in rest or not rest.rpartition(":")[2].isdigit():
            # The part before @ may be a password.
            printable_address = f"***@{address.rpartition('@')[2]}" if "@" in address else address
            raise InputError(
                "a scheduler's address must look like tcp://host:8786 or tls://host:8786, without a user; got "
                f"{printable_address!r}; correct it"
            )
        if (scheme == "tls") != (tls is not None):
            raise InputError(
                f"an address with tls:// needs certificates, and no other may have them; got {address} "
                f"{'with' if tls else 'without'}; give authority, certificate and key with tls:// only"
            )
        if not patience >= 0.0:
            raise InputError(f"the patience with a lost scheduler must be zero or more; got {patience:g} s")
        self.address, self.tls, self.patience = address, tls, patience
        self.workers = 4  # until the real number is known
        self._client: Any = None
        self._refused = 0.0
        self._reached = 0.0  # last time the scheduler answered

    def should_map(self, seconds: float) -> bool:
        """Whether this amount of work is worth sending; see `Engine`."""
        if self._client is None:
            self._refused += seconds
        return self._client is not None or self._refused >= _START

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item; see `Engine`.

        Raises `EngineError` if the scheduler or all workers are missing for longer than the patience, if workers have
        other versions, or if an item repeatedly kills its workers.
        """
        results: dict[int, Found] = {}
        killed = [0] * len(items)
        delay, self._reached = _DELAYS[0], time.monotonic()
        while len(results) < len(items):
            try:
                self._run_round(self._connected_client(), function, items, results, killed, poll)
            except (_Lost, OSError, CancelledError, TimeoutError) as error:
                lost = self._client is not None
                self.close()
                if time.monotonic() - self._reached >= self.patience:
                    raise EngineError(
                        f"the scheduler must answer within {self.patience:g} s; {self.address} did not "
                        f"({_error_text(error)}); start it, or correct the address"
                    ) from None
                _log.warning("connection to scheduler %s lost (%s); reconnecting", self.address, _error_text(error))
                delay = _DELAYS[0] if lost else min(2.0 * delay, _DELAYS[1])
                _sleep_until(delay, poll)
        return [results[index] for index in range(len(items))]

    def close(self) -> None:
        """Close the connection; the cluster continues to run."""
        client, self._client = self._client, None
        if client is not None:
            with contextlib.suppress(Exception):  # the connection may already be lost
                client.close(timeout=_CONNECT)

    def _run_round(
        self,
        client: Any,
        function: Callable[[Item], Found],
        items: Sequence[Item],
        results: dict[int, Found],
        killed: list[int],
        poll: Poll | None,
    ) -> None:
        """Add missing results to `results`.

        Raise `_Lost` or a similar error when the connection to the scheduler fails.
        """
        dask: Any = import_module("distributed")
        self.workers = max(1, sum(client.nthreads().values()))
        pending: dict[Any, int] = {}

        def submit(indices: list[int]) -> None:
            name = uuid.uuid4().hex
            keys = [f"slidercrank-{name}-{index}" for index in indices]
            futures = client.map(
                _run_with_equal_versions, [(_library_versions(), function, items[index]) for index in indices], key=keys
            )
            pending.update(zip(futures, indices, strict=True))

        submit([index for index in range(len(items)) if index not in results])
        last_report = looked = time.monotonic()
        waits = False
        try:
            while pending:
                with contextlib.suppress(TimeoutError), client.as_current():
                    dask.wait(list(pending), timeout=_TICK, return_when="FIRST_COMPLETED")
                completed = [future for future in pending if future.done()]
                states = {future.status for future in completed}
                if client.status != "running" or states & {"cancelled", "lost"}:
                    raise _Lost("it no longer knows this client")
                self._reached = time.monotonic()
                good = [future for future in completed if future.status == "finished"]
                for future, result in zip(good, client.gather(good), strict=True):
                    results[pending.pop(future)] = result
                again = []
                for future in completed:
                    if future.status == "error":
                        index, error = pending.pop(future), future.exception()
                        if not isinstance(error, dask.KilledWorker):
                            raise _explain_error(error)
                        killed[index] += 1
                        if killed[index] >= MOST_KILLED:
                            raise EngineError(
                                f"workers must survive an evaluation; {4 * MOST_KILLED} of them died at the same "
                                f"designs (chunk {index + 1} of {len(items)}); check for too little memory or a crash "
                                "in a custom function"
                            )
                        again.append(index)
                if again:
                    submit(again)
                if poll is not None:
                    poll()
                now = time.monotonic()
                last_report = now if completed else last_report
                if now - max(last_report, looked) > _LOOK:
                    looked = now
                    self.workers = max(1, sum(threads := client.nthreads().values()))
                    last_report = now if threads else last_report
                    if not threads and not waits:
                        _log.warning(
                            "waiting for a worker: the scheduler at %s has none; giving up after %g s; start some: "
                            "dask worker %s",
                            *(self.address, self.patience, self.address),
                        )
                    waits = not threads
                    if not threads and now - last_report > self.patience:
                        raise EngineError(
                            f"a cluster needs workers; the scheduler at {self.address} had none for "
                            f"{self.patience:g} s; start some"
                        )
        except BaseException:
            with contextlib.suppress(Exception):
                client.cancel(list(pending), force=True)
            raise

    def _connected_client(self) -> Any:
        if self._client is None:
            dask = import_extra("distributed", "a Dask cluster needs")
            for name in [name for name in logging.root.manager.loggerDict if name.startswith("distributed")]:
                logging.getLogger(name).setLevel(logging.CRITICAL)  # errors are raised, and logged, here
            security = None
            if self.tls is not None:
                security = dask.Security(
                    require_encryption=True,
                    tls_ca_file=str(self.tls.authority),
                    tls_client_cert=str(self.tls.certificate),
                    tls_client_key=str(self.tls.key),
                )
            self._client = dask.Client(self.address, timeout=_CONNECT, set_as_default=False, security=security)
        return self._client


def _run_with_equal_versions(task: tuple[tuple[str, ...], Callable[[Any], Any], Any]) -> Any:
    versions, function, item = task
    if versions != _library_versions():
        raise EngineError(
            f"workers must have the same versions as the client; got {', '.join(_library_versions())} for "
            f"{', '.join(versions)}; install the same"
        )
    return function(item)


@lru_cache(maxsize=1)
def _library_versions() -> tuple[str, ...]:
    return (f"python {'.'.join(python_version_tuple()[:2])}", *(f"{name} {version(name)}" for name in _SAME))


def _explain_error(error: BaseException) -> BaseException:
    """Return the exception of a task, with an explanation if the cluster is at fault."""
    if isinstance(error, SlidercrankError) or not isinstance(error, ImportError | AttributeError | RuntimeError):
        return error
    return EngineError(
        f"scheduler and workers must have the same software as this machine; got {_error_text(error)}; install it there"
    )


def _error_text(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}".splitlines()[0][:200].rstrip(": ")


def _sleep_until(seconds: float, poll: Poll | None) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if poll is not None:
            poll()
        time.sleep(min(_TICK, max(0.0, end - time.monotonic())))
