"""Time of a wish on the fronts of the shipped jobs: random values for some objectives, within and around the front."""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter

import numpy as np

from slidercrank.optimise.decisions.wish import Wishes
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import load_job
from slidercrank.optimise.solve import solve

from .report import Row

JOBS = ("feeder", "sieve", "support", "compressor", "press", "servo_press", "tipper")
COUNT = 100
AT_MOST = 300.0
"""ms, of a wish in a process that is warm."""


def wishes() -> Iterator[Row]:
    """Yield for each job the time of 100 wishes, and the greatest residual of the designs that they led to."""
    for job in JOBS:
        front = solve(load_job(f"runs/{job}.toml"))
        asked, random = Wishes(front), np.random.default_rng(1)
        times, residuals = [], []
        for given in [_random(front, random) for _ in range(1 + COUNT)]:
            begin = perf_counter()
            found = asked.design_nearest_to_wishes(given).found
            times.append(1e3 * (perf_counter() - begin))
            residuals.append(float(found.columns["residual"][0]))
        yield Row(f"{job}: a wish, ms", times[1:], at_most=AT_MOST)  # the first one makes things ready
        yield Row(f"{job}: stationarity residual of the designs", residuals, at_most=1e-6, worst=True)


def _random(front: ParetoFront, random: np.random.Generator) -> dict[str, float]:
    """Return values for some objectives, SI."""
    found = {}
    for objective in front.objectives:
        quantity = front.problem.quantity(objective.quantity)
        values = front.columns[quantity.field] / quantity.unit.factor
        if random.random() < 0.7 or not found:
            found[objective.quantity] = float(values.min() + random.uniform(-0.2, 1.2) * np.ptp(values))
    return found
