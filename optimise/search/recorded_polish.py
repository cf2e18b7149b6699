"""Polish and projection as recorded steps of a search, on its engine where worthwhile."""

from collections.abc import Callable

import numpy as np

from ...model.arrays import Array, IntArray
from ..engine.engine import Serial
from .candidates import Polished, object_array
from .checkpoints import Numbers
from .evaluation import Evaluator
from .polish import ITERATIONS, Evaluates
from .polish import polish_designs as polish_here

Lengths = IntArray
_PolishOptions = tuple[tuple[float, ...], tuple[int, ...] | None, int | None, bool]
"""Scale, chosen objectives and iterations of a polish, and whether the last column of its starts is `best_in`."""


def polish_recorded(
    evaluator: Evaluator,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    viewed_evaluator: Evaluates | None = None,
    best_in: IntArray | None = None,
) -> Polished:
    """Return the result of `polish_on_engine` as a recorded step.

    viewed_evaluator: a view of the evaluator that the polish uses instead.
    """
    inputs: tuple[Numbers, ...] = (start, scale, np.array([-1] if chosen is None else chosen, dtype=np.int64))
    inputs = inputs if best_in is None else (*inputs, best_in)

    def compute() -> Polished:
        return polish_on_engine(viewed_evaluator or evaluator, start, scale, chosen=chosen, best_in=best_in)

    return _recorded_polish(evaluator, "polish", inputs, compute)


def move_onto_constraints_recorded(evaluator: Evaluator, start: Array, scale: Array) -> Polished:
    """Return designs from `start` (n, k), only moved onto violated constraints by the shortest step."""
    return _recorded_polish(
        evaluator, "projection", (start, scale), lambda: polish_on_engine(evaluator, start, scale, iterations=None)
    )


def polish_on_engine(
    evaluator: Evaluates,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    iterations: int | None = ITERATIONS,
    best_in: IntArray | None = None,
) -> Polished:
    """Return the result of `polish.polish`, on the engine where worthwhile; no record is stored.

    Every design is polished independently, so that workers can share them.
    """
    if not isinstance(evaluator, Evaluator) or isinstance(evaluator.engine, Serial):
        return polish_here(evaluator, start, scale, chosen=chosen, iterations=iterations, best_in=best_in)
    before = evaluator.evaluations
    options = (tuple(scale.tolist()), chosen, iterations, best_in is not None)
    rows = start if best_in is None else np.column_stack([start, best_in])
    parts = evaluator.chunked(_polish_rows, options, rows, kind="polish", together=True)
    evaluator.evaluations = before + sum(count for _, count in parts)
    (first, _), *rest = parts
    return first.join(*(part for part, _ in rest))


def _polish_rows(evaluator: Evaluator, options: _PolishOptions, start: Array) -> tuple[Polished, int]:
    """Return polished designs and the number of evaluations for them."""
    before, (scale, chosen, iterations, ends) = evaluator.evaluations, options
    best_in = start[:, -1].astype(np.int64) if ends else None
    start = start[:, :-1] if ends else start
    designs = polish_here(evaluator, start, np.array(scale), chosen=chosen, iterations=iterations, best_in=best_in)
    return designs, evaluator.evaluations - before


def _recorded_polish(
    evaluator: Evaluator, kind: str, inputs: tuple[Numbers, ...], compute: Callable[[], Polished]
) -> Polished:
    """Return the result of a step; a record stores ragged rows end to end, with their lengths."""

    def arrays() -> tuple[Array, Array, Array, Array, Lengths, Array, Array, Lengths, Array]:
        result = compute()
        k, owners = result.u.shape[1], [owner for owner, _ in result.goals]
        return (
            result.u,
            result.values,
            result.violation,
            result.residual,
            np.array([len(owner) for owner in owners], dtype=np.int64),
            np.concatenate([np.zeros(0), *owners]),
            np.concatenate([np.zeros((0, k)), *(slopes for _, slopes in result.goals)]),
            np.array([len(edges) for edges in result.active], dtype=np.int64),
            np.concatenate([np.zeros((0, k)), *result.active]),
        )

    u, values, violation, residual, pieces, owners, slopes, edges, active = evaluator.recorded_step(
        kind, inputs, arrays
    )
    n, ends = len(pieces), np.cumsum(pieces)[:-1]
    goals = zip(np.split(owners, ends), np.split(slopes, ends), strict=True)
    active_rows = np.split(active, np.cumsum(edges)[:-1])
    return Polished(
        u, values, violation, residual, object_array(goals if n else ()), object_array(active_rows if n else ())
    )
