"""Share of random machines that keep what a robust front promises: drawn apart from the sample it was found with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import binomtest

from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.tolerance.error_distributions import error_distribution
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.robust.quantity import RobustQuantity
from slidercrank.objectives.robust.worst_points import tolerance_limits
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.robust_problem import robust_quantities

Array = NDArray[np.float64]


def realised(front: ParetoFront, *, samples: int, seed: int = 1_000_000_007) -> pd.DataFrame:
    """Return a row for each design and robust quantity: share of fresh machines that keep the promise.

    Every machine is evaluated exactly. low, high: the binomial interval (Clopper and Pearson 1934) that holds the true
    share with 99.9 % confidence. Dimensions of a worst case lie uniformly in the box.
    """
    rows = []
    for row in range(len(front)):
        problem, design = front.part(row), front.dimensions[row : row + 1]
        for quantity in robust_quantities(problem):
            promised = float(quantity.evaluate(problem.mechanism, design).values[0])
            machines = np.repeat(design, samples, axis=0)
            deviations = error_distribution(quantity.shape if quantity.case == "percentile" else "uniform").rvs(
                (samples, 3), random_state=np.random.default_rng([seed, row])
            )
            machines[:, :3] += deviations * tolerance_limits(problem.mechanism, design)
            values, rounding = _evaluated(quantity.inner, problem.mechanism, machines), 1e-12 * abs(promised)
            good = values <= promised + rounding if quantity.side == "high" else values >= promised - rounding
            interval = binomtest(int(good.sum()), samples).proportion_ci(0.999, method="exact")
            share = quantity.share if quantity.case == "percentile" else 1.0
            rows.append((share, good.mean(), float(interval.low), float(interval.high)))
    return pd.DataFrame(rows, columns=["share", "realised", "low", "high"])


def sampling_error(quantity: RobustQuantity, front: ParetoFront, *, scrambles: int) -> Array:
    """Return the standard error (n,), SI, of the percentiles of a front's designs: from independent scramblings."""
    others = [replace(quantity, seed=quantity.seed + 7919 * (index + 1)) for index in range(scrambles)]
    designs = [(front.part(row).mechanism, front.dimensions[row : row + 1]) for row in range(len(front))]
    found = [[other.evaluate(*design).values[0] for design in designs] for other in others]
    return np.asarray(np.std(np.array(found), axis=0, ddof=1))


def _evaluated(quantity: Quantity, mechanism: Mechanism, machines: Array) -> Array:
    turns = (machines[:, 0] > 0.0) & (machines[:, 1] > machines[:, 0] + np.abs(machines[:, 2]))
    values = np.full(len(machines), np.nan)  # keeps nothing
    values[turns] = quantity.evaluate(mechanism, machines[turns]).values
    return values
