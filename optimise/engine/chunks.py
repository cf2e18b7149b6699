"""Batches of rows on an engine, in chunks that are worth the way; light batches stay where they are."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from itertools import pairwise
from statistics import median
from time import perf_counter
from typing import Any, Generic, TypeVar

import numpy as np

from ...model.arrays import Array
from .engine import LONGEST, Engine, Poll, Serial

Value = TypeVar("Value")
Subject = TypeVar("Subject")
Question = TypeVar("Question", bound=Hashable)
Part = TypeVar("Part")
Work = Callable[[Subject, Question, Array], Part]
"""Work on rows: a function of a module, of the subject, the question and rows (n, k). Each row is judged independently
of the others, to the last bit, so that chunks do not affect the result."""

CHUNK = 0.05
"""Minimum time of a chunk, s: sending one costs about 1 ms here, and a few on a cluster."""
_EACH = 4  # chunks for every worker, so that none waits long for the last one
_FIRST = 4  # rows, of the first chunk of a kind: kernels are loaded and samples drawn with it
_SURE = 0.5 * CHUNK  # s, after which a pace is reliable


class Shared(Generic[Value]):
    """A value that is sent with every chunk but created only once in each process that works on them.

    A problem pickles into some kB, negligible next to a chunk of 50 ms. Creating it is costly: custom functions start a
    process, and samples are drawn.
    """

    def __init__(self, value: Value) -> None:
        """Take the value; it is pickled when it first leaves this process."""
        self.value = value

    @cached_property
    def pickled(self) -> bytes:
        """The value as bytes. Raises the error of pickle if it cannot leave this process."""
        return pickle.dumps(self.value, protocol=pickle.HIGHEST_PROTOCOL)

    @property
    def portable(self) -> bool:
        """Whether the value can leave this process: functions given from Python may not."""
        try:
            return bool(self.pickled)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False

    def __reduce__(self) -> tuple[Any, tuple[bytes]]:
        return _shared_value, (self.pickled,)


@lru_cache(maxsize=16)
def _shared_value(pickled: bytes) -> Shared[Any]:
    """Return the value of these bytes, the same one for the same bytes."""
    shared = Shared(pickle.loads(pickled))
    shared.__dict__["pickled"] = pickled
    return shared


@dataclass
class _Pace:
    """Time a row takes, s, and the seconds over which it was measured; negative before the first."""

    row: float = 0.0
    seconds: float = -1.0

    def measured(self, seconds: float, rows: int) -> None:
        if self.seconds < 0.0:  # the first time counts for nothing: something may have been compiled
            self.row, self.seconds = seconds / rows, 0.0
        elif seconds >= _SURE or self.seconds < _SURE:
            self.row, self.seconds = seconds / rows, seconds


@dataclass(frozen=True)
class Chunked(Generic[Subject]):
    """Does work on rows of one subject, on an engine if it is expensive.

    That is measured: a batch leaves this process when at least two chunks of 50 ms remain and the engine considers it
    worthwhile. Where the work is done does not affect the results. poll: called between chunks.
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
        """Return the parts of the work on rows (n, k), in order; a single part if it is cheap.

        kind: kind of work that takes the same time for a row; the question if None. together: whether rows are much
        quicker together than one by one. They are then not divided here, and elsewhere into at most one chunk for each
        worker. Raises the errors of the work, the engine and `poll`.
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
                    return parts + self._mapped(work, question, rows[begin:], pace, 1 if together else _EACH)
                light = True
            if self.poll is not None:
                self.poll()
            if pace.seconds >= 0.0 and not together:
                count = left if light else max(2 * count if pace.seconds > 0.0 else 1, int(CHUNK / pace.row))
            start = perf_counter()
            parts.append(work(self.shared.value, question, rows[begin : begin + count]))
            pace.measured(perf_counter() - start, min(count, left))
            begin += count
        return parts

    def _mapped(
        self, work: Work[Subject, Question, Part], question: Question, rows: Array, pace: _Pace, per_worker: int
    ) -> list[Part]:
        engine = self.engine
        if not isinstance(engine, Serial) and not self.shared.portable:
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
