"""Polish and projection as recorded steps of a search: their results are kept, not the evaluations that they took."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..front.stationarity import Array
from .checkpoints import Numbers, floats, integers
from .evaluation import Evaluator
from .polish import ITERATIONS, Evaluates, Polished
from .spread import polish, project


def polished(
    evaluator: Evaluator,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    shown: Evaluates | None = None,
) -> Polished:
    """Return the result of `polish`. shown: the evaluator in another light, which it is to see instead."""
    given = (start, scale, np.array([-1] if chosen is None else chosen, dtype=np.int64))

    def compute() -> tuple[Numbers, ...]:
        return _arrays(polish(shown or evaluator, start, scale, chosen=chosen, iterations=ITERATIONS))

    return _polished(evaluator.ledger.step("polish", given, compute, evaluator))


def projected(evaluator: Evaluator, start: Array, scale: Array) -> Polished:
    """Return the result of `project`."""

    def compute() -> tuple[Numbers, ...]:
        return _arrays(project(evaluator, start, scale))

    return _polished(evaluator.ledger.step("projection", (start, scale), compute, evaluator))


def _arrays(found: Polished) -> tuple[Numbers, ...]:
    k = found.u.shape[1]
    return (
        found.u,
        found.values,
        found.violation,
        found.residual,
        _lengths([owner for owner, _ in found.goals]),
        np.concatenate([np.zeros(0), *(owner for owner, _ in found.goals)]),
        np.concatenate([np.zeros((0, k)), *(slopes for _, slopes in found.goals)]),
        _lengths(list(found.active)),
        np.concatenate([np.zeros((0, k)), *found.active]),
    )


def _polished(arrays: tuple[Numbers, ...]) -> Polished:
    u, values, violation, residual, pieces, owners, slopes, edges, active = arrays
    ends = np.cumsum(integers(pieces))[:-1]
    return Polished(
        floats(u),
        floats(values),
        floats(violation),
        floats(residual),
        tuple(zip(_split(owners, ends), _split(slopes, ends), strict=True)) if len(pieces) else (),
        tuple(_split(active, np.cumsum(integers(edges))[:-1])) if len(edges) else (),
    )


def _lengths(parts: list[Array]) -> NDArray[np.int64]:
    return np.array([len(part) for part in parts], dtype=np.int64)


def _split(array: Numbers, ends: NDArray[np.int64]) -> list[Array]:
    return np.split(floats(array), ends)
