"""The polish on an engine: every design is polished by itself, so that many are shared out among workers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..engine.serial import Serial
from ..front.stationarity import Array
from .evaluation import Evaluator
from .polish import ITERATIONS, Evaluates, Polished
from .polish import polish as polish_here
from .polish import project as project_here


def polish(
    evaluator: Evaluates,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    iterations: int = ITERATIONS,
) -> Polished:
    """Return the result of `polish.polish`, on the evaluator's engine where that is worth it."""
    if not isinstance(evaluator, Evaluator) or isinstance(evaluator.engine, Serial):
        return polish_here(evaluator, start, scale, chosen=chosen, iterations=iterations)
    return _shared_out(evaluator, _Asked(tuple(scale.tolist()), chosen, iterations), start)


def project(evaluator: Evaluator, start: Array, scale: Array) -> Polished:
    """Return the result of `polish.project`, on the evaluator's engine where that is worth it."""
    if isinstance(evaluator.engine, Serial):
        return project_here(evaluator, start, scale)
    return _shared_out(evaluator, _Asked(tuple(scale.tolist()), None, None), start)


@dataclass(frozen=True)
class _Asked:
    """Settings of a polish; see `polish.polish`. iterations: None to project only."""

    scale: tuple[float, ...]
    chosen: tuple[int, ...] | None
    iterations: int | None


def _shared_out(evaluator: Evaluator, asked: _Asked, start: Array) -> Polished:
    before = evaluator.evaluations
    parts = evaluator.chunked(_polish, asked, start, kind="polish", together=True)
    evaluator.evaluations = before + sum(count for _, count in parts)
    found = [part for part, _ in parts]
    return Polished(
        u=np.concatenate([part.u for part in found]),
        values=np.concatenate([part.values for part in found]),
        violation=np.concatenate([part.violation for part in found]),
        residual=np.concatenate([part.residual for part in found]),
        goals=tuple(each for part in found for each in part.goals),
        active=tuple(each for part in found for each in part.active),
    )


def _polish(evaluator: Evaluator, asked: _Asked, start: Array) -> tuple[Polished, int]:
    """Return polished designs and how many were evaluated for them."""
    before, scale = evaluator.evaluations, np.array(asked.scale)
    if asked.iterations is None:
        found = project_here(evaluator, start, scale)
    else:
        found = polish_here(evaluator, start, scale, chosen=asked.chosen, iterations=asked.iterations)
    return found, evaluator.evaluations - before
