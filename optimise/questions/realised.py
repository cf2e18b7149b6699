"""Share of random machines that keep what a robust front promises."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from ...model.machine.mechanism import Mechanism
from ...model.tolerance.spreads import Shape, spread
from ...objectives.quantity import Array, Quantity
from ...objectives.robust.points import limits_of
from ...objectives.robust.quantity import RobustQuantity
from ..engine.chunks import Shared
from ..engine.engine import Engine, Serial
from ..front.front import ParetoFront
from ..problem.problem import Problem
from ..problem.robust import robust_quantities

_CONFIDENCE = 0.999
_CHUNK = 1 << 17  # designs evaluated at once


def realised(
    front: ParetoFront, *, samples: int = 100_000, seed: int = 1_000_000_007, engine: Engine | None = None
) -> pd.DataFrame:
    """Return which share of fresh machines keeps what each design of a robust front promises.

    Drawn at random, independent of the sample that the front was found with, every machine evaluated exactly. One row
    for each design and robust quantity: design (row of the front), quantity, promised (SI), share asked (1 for a worst
    case), realised, and low and high: the exact binomial interval (Clopper and Pearson 1934) that holds the true share
    with 99.9 % confidence. Dimensions of a worst case lie uniformly in the box. engine: where the machines of a design
    are evaluated, in this process by default.
    """
    shared = Shared(front.problem)
    wanted = [
        _Fresh(shared, front.variants[row] if front.variants else 0, row, front.dimensions[row], samples, seed)
        for row in range(len(front))
    ]
    heavy = engine if engine is not None and shared.portable else Serial()
    return pd.DataFrame([line for lines in heavy.map(_realised, wanted) for line in lines])


@dataclass(frozen=True)
class _Fresh:
    """Fresh machines of one design."""

    shared: Shared[Problem]
    variant: int
    row: int
    design: Array
    samples: int
    seed: int


def _realised(of: _Fresh) -> list[dict[str, Any]]:
    from scipy.stats import binomtest

    rows = []
    problem, design, samples = of.shared.value.part(of.variant), of.design[None], of.samples
    for quantity in robust_quantities(problem):
        promised = float(quantity.evaluate(problem.mechanism, design).values[0])
        shape: Shape = quantity.shape if quantity.case == "percentile" else "uniform"
        random = np.random.default_rng([of.seed, of.row])
        deviations = spread(shape).rvs((samples, 3), random_state=random)
        machines = np.repeat(design, samples, axis=0)
        machines[:, :3] += deviations * limits_of(problem.mechanism, design)
        values = _evaluated(quantity.inner, problem.mechanism, machines)
        rounding = 1e-12 * abs(promised)
        high = quantity.side == "high"
        kept = int((values <= promised + rounding if high else values >= promised - rounding).sum())
        interval = binomtest(kept, samples).proportion_ci(_CONFIDENCE, method="exact")
        rows.append(
            {
                "design": of.row,
                "quantity": quantity.name,
                "promised": promised,
                "share": quantity.share if quantity.case == "percentile" else 1.0,
                "realised": kept / samples,
                "low": float(interval.low),
                "high": float(interval.high),
            }
        )
    return rows


def sampling_error(quantity: RobustQuantity, front: ParetoFront, *, scrambles: int = 8) -> Array:
    """Return the standard error (n,), SI, of the percentiles of a front's designs: from independent scramblings."""
    found = []
    for index in range(scrambles):
        other = replace(quantity, seed=quantity.seed + 7919 * (index + 1))
        parts = [
            other.evaluate(front.part(row).mechanism, front.dimensions[row : row + 1]).values[0]
            for row in range(len(front))
        ]
        found.append(parts)
    return np.asarray(np.std(np.array(found), axis=0, ddof=1))


def _evaluated(quantity: Quantity, mechanism: Mechanism, machines: Array) -> Array:
    turns = (machines[:, 0] > 0.0) & (machines[:, 1] > machines[:, 0] + np.abs(machines[:, 2]))
    values = np.full(len(machines), np.nan)  # keeps nothing
    rows = np.flatnonzero(turns)
    for begin in range(0, len(rows), _CHUNK):
        some = rows[begin : begin + _CHUNK]
        values[some] = quantity.evaluate(mechanism, machines[some]).values
    return values
