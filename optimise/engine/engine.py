"""Interface of engines that evaluate chunks (this process, several processes or a cluster), and the serial engine.

Chunks of a batch are large enough to send; light batches stay in this process.
"""

import pickle
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from statistics import median
from time import perf_counter
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from ...model.arrays import Array

Item = TypeVar("Item")
Found = TypeVar("Found")
Poll = Callable[[], None]


class Engine(Protocol):
    """Applies a function to items on some computer, and returns the results in the order of the items.

    On processors of the same kind, every engine returns the same bits for an item.
    """

    @property
    def workers(self) -> int:
        """Number of items that are processed concurrently, at least one."""
        ...

    def should_map(self, seconds: float) -> bool:
        """Whether to map work that takes this long, s, in this process.

        Called for all expensive work: an engine that is slow to start declines work until the work declined so far
        outweighs its start.
        """
        ...

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item, in order.

        function: at module level, so that another process can import it. poll: called between items and while waiting;
        any error that it raises ends the map. Raises that error, the errors of the function, and `EngineError` if the
        engine is lost. Work lost with a worker is repeated silently.
        """
        ...

    def close(self) -> None:
        """Stop everything that the engine has started. It starts again with the next map."""
        ...


LONGEST = 0.5
"""s, maximum duration of a chunk if rows are short enough: nothing is polled meanwhile."""


class Serial:
    """Engine that runs work directly: it pickles nothing and starts nothing."""

    workers = 1

    def should_map(self, seconds: float) -> bool:
        """Return whether the work is long enough to need polling; see `Engine`."""
        return seconds > LONGEST

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item; see `Engine`."""
        results = []
        for item in items:
            if poll is not None:
                poll()
            results.append(function(item))
        return results

    def close(self) -> None:
        """Do nothing."""


Value = TypeVar("Value")
Subject = TypeVar("Subject")
Question = TypeVar("Question", bound=Hashable)
Part = TypeVar("Part")
Work = Callable[[Subject, Question, Array], Part]
"""Work on rows: a module-level function of the subject, the question and rows (n, k). The result for a row does not
depend on the other rows, to the last bit, so chunks do not affect it."""

CHUNK = 0.05
"""Minimum duration of a chunk, s; sending one costs about 1 ms on this machine, and a few ms on a cluster."""
_EACH = 4  # chunks per worker, so that no worker waits long for the last one
_FIRST = 4  # rows in the first chunk of each kind, which also loads kernels and draws samples
_SURE = 0.5 * CHUNK  # s, measured time after which a pace is reliable


class Shared(Generic[Value]):
    """A value that is sent with every chunk but created only once in each worker process.

    A pickled problem takes a few kB, negligible next to a chunk of 50 ms. Creating it is costly: custom functions start
    a process, and samples are drawn.
    """

    def __init__(self, value: Value) -> None:
        """Store the value; it is pickled when it first leaves this process."""
        self.value = value

    @cached_property
    def pickled(self) -> bytes:
        """The pickled value. Raises pickle's error if it cannot leave this process."""
        return pickle.dumps(self.value, protocol=pickle.HIGHEST_PROTOCOL)

    @property
    def can_be_pickled(self) -> bool:
        """Whether the value can leave this process; functions defined in Python code may not."""
        try:
            return bool(self.pickled)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False

    def __reduce__(self) -> tuple[Any, tuple[bytes]]:
        return _shared_value, (self.pickled,)


@lru_cache(maxsize=16)
def _shared_value(pickled: bytes) -> Shared[Any]:
    """Return the value for these bytes; the same bytes give the same object."""
    shared = Shared(pickle.loads(pickled))
    shared.__dict__["pickled"] = pickled
    return shared


@dataclass
class _Pace:
    """Time per row, s, and the duration of its measurement, s; negative before the first one."""

    row: float = 0.0
    seconds: float = -1.0

    def add_measurement(self, seconds: float, rows: int) -> None:
        if self.seconds < 0.0:  # ignore the first time, which may include compilation
            self.row, self.seconds = seconds / rows, 0.0
        elif seconds >= _SURE or self.seconds < _SURE:
            self.row, self.seconds = seconds / rows, seconds


@dataclass(frozen=True)
class Chunked(Generic[Subject]):
    """Runs work on rows of one subject, on an engine if the work is expensive.

    Cost is measured: a batch leaves this process if at least two chunks of 50 ms remain and the engine finds it
    worthwhile. The place of the work does not affect the results. poll: called between chunks.
    """

    shared: Shared[Subject]
    engine: Engine
    poll: Poll | None = None
    _paces: dict[Hashable, _Pace] = field(default_factory=dict, init=False)

    def __call__(
        self,
        work: Work[Subject, Question, Part],
        question: Question,
        rows: Array,
        *,
        kind: Hashable = None,
        together: bool = False,
    ) -> list[Part]:
        """Return the results of the work on rows (n, k), in order; a single result if it is cheap.

        kind: key for work with the same time per row; by default, the question. together: whether rows are much faster
        together than one by one. Such rows are not divided in this process; elsewhere they are divided into at most one
        chunk per worker. Passes on errors from the work, the engine and `poll`.
        """
        n = len(rows)
        if n == 0 or (isinstance(self.engine, Serial) and self.poll is None):
            return [work(self.shared.value, question, rows)]
        pace = self._paces.setdefault((work, question if kind is None else kind), _Pace())
        parts: list[Part] = []
        begin, count = 0, n if together else _FIRST
        while begin < n:
            left = n - begin
            light = pace.row * left < 2.0 * CHUNK
            if pace.seconds >= _SURE and not light:
                if self.engine.should_map(pace.row * left):
                    return parts + self._map_chunks(work, question, rows[begin:], pace, 1 if together else _EACH)
                light = True
            if self.poll is not None:
                self.poll()
            if pace.seconds >= 0.0 and not together:
                count = left if light else max(2 * count if pace.seconds > 0.0 else 1, int(CHUNK / pace.row))
            start = perf_counter()
            parts.append(work(self.shared.value, question, rows[begin : begin + count]))
            pace.add_measurement(perf_counter() - start, min(count, left))
            begin += count
        return parts

    def _map_chunks(
        self, work: Work[Subject, Question, Part], question: Question, rows: Array, pace: _Pace, per_worker: int
    ) -> list[Part]:
        engine = self.engine
        if not isinstance(engine, Serial) and not self.shared.can_be_pickled:
            engine = Serial()
        seconds = pace.row * len(rows)
        limit = (
            per_worker * engine.workers if per_worker == 1 else max(per_worker * engine.workers, int(seconds / LONGEST))
        )
        count = max(1, min(int(seconds / CHUNK), limit, len(rows)))
        edges = np.linspace(0, len(rows), count + 1).astype(int)
        chunks = [rows[a:b] for a, b in pairwise(edges.tolist())]
        timed_parts = engine.map(partial(_run_timed, work, self.shared, question), chunks, poll=self.poll)
        pace.row = median(seconds / len(chunk) for chunk, (seconds, _) in zip(chunks, timed_parts, strict=True))
        return [part for _, part in timed_parts]


def _run_timed(
    work: Work[Subject, Question, Part], shared: Shared[Subject], question: Question, rows: Array
) -> tuple[float, Part]:
    start = perf_counter()
    part = work(shared.value, question, rows)
    return perf_counter() - start, part
