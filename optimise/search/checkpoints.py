"""Checkpoints of a search, step by step, from which an interrupted run resumes bit for bit.

A search is a function of its problem and of the results of its costly steps: screening or polishing a batch, running a
local solver from one start, breeding a population. Given these results, it repeats the same path without computing
them, and continues computing where they end. So every method can resume without code of its own, and little must be
stored: the result of a step, not the hundreds of evaluations behind it.

Each step is stored with a digest of its inputs. A search that requests a step with another digest is another search or
computes differently: another job, other versions, another kind of processor. This raises an error, and results are
never mixed.

The fingerprint of a search is a digest of its problem, the same in every process, and the software versions.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from platform import python_version
from typing import Any, Protocol, TypeVar, cast

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import ForeignRecords
from ..problem.problem import Problem

_COMPUTE = ("slidercrank", "numpy", "scipy", "numba", "moocore", "optuna", "cmaes")
_LEFT_OUT = ("folders",)  # folders of a custom function, because a job may be moved


@cache
def version_of(name: str) -> str:
    """Return the version of an installed package; "unknown" if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "unknown"


def software_versions() -> dict[str, str]:
    """Return the versions of this software and of its numerical libraries."""
    return {"python": python_version(), **{name: version_of(name) for name in (*_COMPUTE, "pandas")}}


def identity_of(problem: Problem) -> Identity:
    """Return the identity of a search of this problem.

    Its name may change and its budget may rise before it resumes.
    """
    settings = replace(problem.settings, evaluations=None)
    digest = hashlib.blake2b(digest_size=16)
    for part in _identifying_parts(replace(problem, settings=settings, name="")):
        digest.update(part)
    return Identity(digest.hexdigest(), json.dumps({name: version_of(name) for name in _COMPUTE}))


def _identifying_parts(value: Any) -> Iterator[bytes]:
    """Yield a value's type and content; for a composite value, the number of parts, then the parts."""
    yield f"{type(value).__qualname__}:".encode()
    if is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            if item.compare and item.name not in _LEFT_OUT:
                yield item.name.encode()
                yield from _identifying_parts(getattr(value, item.name))
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}".encode() + value.tobytes()
    elif isinstance(value, Mapping):
        yield from _identifying_parts(tuple(value.items()))
    elif isinstance(value, (tuple, list)):
        yield f"{len(value)};".encode()
        for item in value:
            yield from _identifying_parts(item)
    elif isinstance(value, float):
        yield value.hex().encode() + b";"
    elif value is None or isinstance(value, (str, int, bool, np.generic)):
        yield f"{value!r};".encode()
    elif callable(value) and hasattr(value, "__qualname__"):
        yield f"{value.__module__}.{value.__qualname__};".encode()
    else:
        yield from _identifying_parts(vars(value) if hasattr(value, "__dict__") else None)


PAUSE = 1.0
"""s between two records of a long round: a kill loses at most this and the current step."""

Numbers = Array | IntArray
Words = IntArray
Arrays = TypeVar("Arrays", bound=tuple[Numbers, ...])
"""Result of a step: the same number of arrays, floats and integers in the same places, every time."""


class Cancelled(Exception):
    """Raised to end a search with its front so far; see `Checkpoints.poll`."""


@dataclass(frozen=True)
class Identity:
    """Fingerprint of a problem and of the software versions that solved it. problem: a digest. versions: as JSON."""

    problem: str
    versions: str


@dataclass(frozen=True)
class Record:
    """Steps of a search that follow those of the previous record.

    identity: identity of the search. number: index from zero. told: number of rounds reported so far. seconds: duration
    of the search so far. words: the steps end to end, as 64-bit numbers in memory order; see `Checkpoints`.
    """

    identity: Identity
    number: int
    rounds: int
    seconds: float
    words: Words


class EvaluationCounter(Protocol):
    """Counter of evaluated designs in a step."""

    evaluations: int


class Checkpoints:
    """The steps of one search: first those of an earlier run, then those computed now, which are stored.

    told: number of rounds reported so far. before: number reported by the earlier run. repeated: number of records of
    the earlier run replayed so far, out of `resumed`. ended: time of the first request to end the search, by
    `time.perf_counter`; otherwise None. polled: called at every poll in a step that is computed.

    In `Record.words`, a step is two words of digest, its number of evaluations, and its number of arrays. For each
    array follow its kind (0 for floats, 1 for integers), the number and sizes of its dimensions, and its numbers.
    """

    def __init__(
        self,
        *,
        cancelled: Callable[[], bool] | None = None,
        keep: Callable[[Record], None] | None = None,
        past: Sequence[Record] = (),
        identity: Callable[[], Identity] | None = None,
    ) -> None:
        """Continue after `past`, all records of an earlier run of the same search, in order, any number.

        cancelled: called many times a second; returns whether the search must end. keep: called with every new record.
        identity: identity of this search; needed only to store records or to resume. Raises `ForeignRecords` for
        records of another search.
        """
        self._cancelled = cancelled
        self._keep = keep
        self._identity = identity() if identity is not None and (keep is not None or past) else None
        require_records_of(past, self._identity)
        self.repeated, self.resumed = 0, len(past)
        self.ended: float | None = None
        self._past = _decode_steps(self._count_replayed(past))
        self._next = next(self._past, None)
        self.earlier_rounds = past[-1].rounds if past else 0
        self._number = len(past)
        self._pending: list[Words] = []
        self.rounds = 0
        self.polled: Callable[[], None] | None = None
        now = time.perf_counter()
        self._start = now - (past[-1].seconds if past else 0.0)
        self._when = now

    @property
    def replaying(self) -> bool:
        """Whether steps of the earlier run remain."""
        return self._next is not None

    @property
    def elapsed_seconds(self) -> float:
        """Time since the search started, s, including the earlier run."""
        return time.perf_counter() - self._start

    def poll(self) -> None:
        """Raise `Cancelled` if the search must end. Call it in every computation, at least every second."""
        if self._next is None:
            self.interrupt()
            if self.polled is not None:
                self.polled()

    def interrupt(self) -> None:
        """Raise `Cancelled` if the search must end, even during replay; for code that may never end by itself."""
        if self._cancelled is not None and self._cancelled():
            self.ended = time.perf_counter() if self.ended is None else self.ended
            raise Cancelled

    def close(self) -> None:
        """Stop polling and storing, because later computations belong to no step."""
        self._cancelled = self._keep = self._next = None

    def recorded_step(
        self, kind: str, inputs: Sequence[Numbers], compute: Callable[[], Arrays], counts: EvaluationCounter
    ) -> Arrays:
        """Return the result of a step: from the earlier run, otherwise computed now.

        kind, inputs: identification of the step by everything it depends on besides the problem. counts: counter of
        evaluations. Raises `ForeignRecords` if the earlier run had another step here.
        """
        if self._next is None and self._keep is None:
            return compute()
        key = _step_key(kind, inputs)
        if self._next is not None:
            past, self._next = self._next, next(self._past, None)
            if past.key != key:
                raise ForeignRecords(_OTHERWISE.format(kind))
            counts.evaluations += past.evaluations
            return cast(Arrays, past.arrays)
        before = counts.evaluations
        arrays = compute()
        self._pending.append(_encode_step(_Step(key, counts.evaluations - before, arrays)))
        if time.perf_counter() - self._when >= PAUSE:
            self._store_record()
        return arrays

    def end_round(self) -> bool:
        """Store the steps of a finished round; return whether the earlier run had not reported it."""
        self.rounds += 1
        unreported = self.rounds > self.earlier_rounds
        self._store_record(ends=unreported)
        return unreported

    def _count_replayed(self, past: Sequence[Record]) -> Iterator[Record]:
        """Yield records, and count those whose steps have all been replayed."""
        for record in past:
            yield record
            self.repeated += 1

    def _store_record(self, *, ends: bool = False) -> None:
        """Pass on the pending steps as a record.

        ends: whether a round ends, which makes a record even without steps.
        """
        if self._keep is not None and (self._pending or ends) and self._identity is not None:
            words, self._pending = np.concatenate([np.zeros(0, np.int64), *self._pending]), []
            self._number += 1
            self._keep(Record(self._identity, self._number - 1, self.rounds, self.elapsed_seconds, words))
        self._when = time.perf_counter()


@dataclass(frozen=True)
class _Step:
    key: tuple[int, int]
    evaluations: int
    arrays: tuple[Numbers, ...]


def _step_key(kind: str, inputs: Sequence[Numbers]) -> tuple[int, int]:
    digest = hashlib.blake2b(kind.encode(), digest_size=16)
    for array in inputs:
        digest.update(str(array.shape).encode())
        digest.update(np.ascontiguousarray(array).view(np.uint8).data if array.size else b"")
    first, second = np.frombuffer(digest.digest(), np.int64).tolist()
    return first, second


def _encode_step(step: _Step) -> Words:
    parts = [np.array([*step.key, step.evaluations, len(step.arrays)], dtype=np.int64)]
    for array in step.arrays:
        integers = array.dtype == np.int64
        parts.append(np.array([integers, array.ndim, *array.shape], dtype=np.int64))
        parts.append(np.ascontiguousarray(array).reshape(-1).view(np.int64))
    return np.concatenate(parts)


def _decode_steps(past: Iterable[Record]) -> Iterator[_Step]:
    for record in past:
        words, at = record.words, 0
        try:
            while at < len(words):
                first, second, evaluations, count = words[at : at + 4].tolist()
                at += 4
                arrays = []
                for _ in range(count):
                    integers, dimensions = words[at : at + 2].tolist()
                    shape = words[at + 2 : at + 2 + dimensions].tolist()
                    at += 2 + dimensions
                    size = int(np.prod(shape, dtype=np.int64))
                    array = words[at : at + size].reshape(shape)
                    arrays.append(array.copy() if integers else array.view(np.float64).copy())
                    at += size
                yield _Step((first, second), evaluations, tuple(arrays))
        except ValueError as error:
            raise ForeignRecords(
                f"the records of a run must be complete; got a damaged one ({error}); {_ANEW}"
            ) from error


def require_records_of(past: Sequence[Record], identity: Identity | None) -> None:
    """Raise `ForeignRecords` unless these are all records of this search so far, in order."""
    for number, record in enumerate(past):
        if identity is None or record.identity.problem != identity.problem:
            raise ForeignRecords(f"a run can only continue with its original job, method and seed; {_ANEW}")
        if record.identity.versions != identity.versions:
            raise ForeignRecords(
                f"a run can only continue with its original versions; it has {record.identity.versions}, here "
                f"{identity.versions} are installed; install the original ones, or {_ANEW}"
            )
        if record.number != number:
            raise ForeignRecords(
                f"a run can only continue from all its records in order; got number {record.number} instead of "
                f"{number}; {_ANEW}"
            )


_ANEW = "start a new run"
_OTHERWISE = (
    "a run can only continue where it computes the same results; the search reached a different step ({}) from the "
    f"stored one, perhaps on another kind of processor; {_ANEW}"
)
