"""Evaluation in several processes on this machine; if one ends abruptly, it is replaced and its chunks are repeated."""

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from typing import Any, cast

from ...model.errors import EngineError, InputError
from ...model.kernel.batches import interruption_grace_time, poll_interruption, record_killed_call
from .engine import Found, Item, Poll

MOST_BREAKS = 3
"""Number of abrupt ends, each with only this item running, after which the item is given up."""
_STARTS = 8  # consecutive starts that may fail
_START = 3.0  # s, typical time to start processes and load compiled code
_TICK = 0.1  # s, between two checks for interruption


class Processes:
    """Processes that start on first use and stay alive.

    They are spawned, so they inherit only the environment. They end with this process, whatever the reason. Do not use
    them from several threads at once.
    """

    def __init__(self, workers: int | None = None) -> None:
        """Store the number of processes, by default one per processor. Raises `InputError` for fewer than one."""
        if workers is not None and workers < 1:
            raise InputError(
                f"the number of processes must be at least one; got {workers}; leave it out for one per processor"
            )
        self.workers = workers or os.cpu_count() or 1
        self._pool: ProcessPoolExecutor | None = None
        self._refused = 0.0

    def should_map(self, seconds: float) -> bool:
        """Whether this amount of work is worth mapping; see `Engine`."""
        if self._pool is None:
            self._refused += seconds
        return self._pool is not None or self._refused >= _START

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item; see `Engine`.

        Raises `EngineError` for an item whose processes ended three times.
        """
        results: dict[int, Found] = {}
        suspects, breaks = set[int](), [0] * len(items)
        while len(results) < len(items):
            left = [index for index in range(len(items)) if index not in results]
            # Items running when processes ended are repeated one at a time: an item that ends a process alone is to
            # blame, not the items beside it.
            alone = next((index for index in left if index in suspects), None)
            broken = self._collect_results(function, items, left if alone is None else [alone], results, poll)
            suspects.update(broken)
            for index in broken:
                breaks[index] += len(broken) == 1
                if breaks[index] >= MOST_BREAKS:
                    raise EngineError(
                        f"an evaluation process must not exit by itself; {MOST_BREAKS} did at the same designs (chunk "
                        f"{index + 1} of {len(items)}); check for too little memory or a crash in a custom function, "
                        "or evaluate without processes"
                    )
        return [results[index] for index in range(len(items))]

    def close(self) -> None:
        """Stop the processes after their current work."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None

    def _collect_results(
        self,
        function: Callable[[Item], Found],
        items: Sequence[Item],
        chosen: list[int],
        results: dict[int, Found],
        poll: Poll | None,
    ) -> list[int]:
        """Add the selected items' results to `results` until a process dies.

        Return the items that were running then.
        """
        running: dict[Future[Found], int] = {}
        waiting = iter(chosen)
        try:
            while True:
                for index in islice(waiting, self.workers - len(running)):
                    pool = self._started_pool()
                    with block_interrupts():
                        running[pool.submit(function, items[index])] = index
                if not running:
                    return []
                for future in wait(running, timeout=_TICK, return_when=FIRST_COMPLETED).done:
                    results[running[future]] = future.result()
                    del running[future]
                if poll is not None:
                    poll()
                poll_interruption()
        except BrokenProcessPool:
            self.close()
            for future, index in running.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    results[index] = future.result()
            return [index for index in running.values() if index not in results]
        except BaseException:
            for future in running:
                future.cancel()
            if wait([future for future in running if future.running()], timeout=interruption_grace_time()).not_done:
                record_killed_call()
                self._kill_processes()
            raise

    def _kill_processes(self) -> None:
        """Kill processes whose work is no longer needed and may never end."""
        pool, self._pool = self._pool, None
        if pool is not None:
            for process in list((cast(Any, pool)._processes or {}).values()):
                process.kill()
            pool.shutdown(cancel_futures=True)

    def _started_pool(self) -> ProcessPoolExecutor:
        """Return the pool once its first process is ready: a failed start is not the fault of an item."""
        for _ in range(_STARTS):
            if self._pool is not None:
                return self._pool
            import multiprocessing

            pool = ProcessPoolExecutor(
                self.workers, mp_context=multiprocessing.get_context("spawn"), initializer=end_with_parent
            )
            try:
                with block_interrupts():
                    ready = pool.submit(_report_ready)
                ready.result()
                self._pool = pool
            except BrokenProcessPool:
                pool.shutdown()
        raise EngineError(
            f"evaluation processes must be able to start; {_STARTS} exited immediately; put the work of the calling "
            'script under if __name__ == "__main__", or check for too little memory'
        )


@contextlib.contextmanager
def block_interrupts() -> Iterator[None]:
    """Shield processes that start meanwhile from Ctrl-C; this process receives it afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _report_ready() -> None:
    """Do nothing; returning shows that the process has started."""


def end_with_parent() -> None:
    """Prepare a process to ignore Ctrl-C, which its parent handles, and to end with its parent, even if killed."""
    import multiprocessing
    from multiprocessing.connection import wait as wait_for

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def exit_with_parent() -> None:
        wait_for([cast(Any, parent).sentinel])
        os._exit(1)

    threading.Thread(target=exit_with_parent, name="end with the parent", daemon=True).start()
