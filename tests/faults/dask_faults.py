"""Workers and scheduler of a Dask cluster, killed and suspended at random moments under a robust job."""

from __future__ import annotations

import random
import threading
import time
from dataclasses import dataclass, field
from functools import cache

from slidercrank.optimise.engine.cluster import Cluster
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.solve import solve

from .dask_cluster import DaskCluster

_AWAY = 2.0  # s that the scheduler is away
_SUSPENDED = 1.0, 12.0  # s that a worker or the scheduler is suspended
ROBUST = """
name = "robust"
[mechanism]
speed = "300 rpm"
slider = { mass = "2 kg" }
[tolerances]
crank = "0.2 mm"
rod = "0.2 mm"
[variables]
crank = ["20 mm", "80 mm"]
rod = ["100 mm", "300 mm"]
offset = ["20 mm", "60 mm"]
[constraints]
transmission_angle = { min = "40 deg" }
stroke = { min = "80 mm", max = "100 mm" }
[objectives]
time_ratio = "maximise"
peak_torque = "minimise"
[robust]
"""
"""A job file to which its samples and its search are added."""


@dataclass
class Struck:
    """Strikes on a cluster, and their effect on the jobs. lost, doubled: evaluations."""

    jobs: int = 0
    workers: int = 0
    schedulers: int = 0
    suspensions: int = 0
    evaluations: int = 0
    lost: int = 0
    doubled: int = 0
    violations: list[str] = field(default_factory=list)

    def line(self) -> str:
        """Return the figures."""
        return (
            f"{self.workers} workers and {self.schedulers} schedulers killed, {self.suspensions} suspended, in "
            f"{self.jobs} jobs of {self.evaluations} evaluations: {self.lost} lost, {self.doubled} counted twice, "
            f"{len(self.violations)} violations"
        )


@cache
def job(designs: int, samples: int) -> Problem:
    """Return a robust job."""
    import tomllib

    return parse_job(tomllib.loads(f"{ROBUST}[optimiser]\ndesigns = {designs}\nsamples = {samples}\n"))


def strike(
    workers: int,
    schedulers: int,
    seed: int,
    *,
    suspensions: int = 0,
    between: float = 5.0,
    designs: int = 3,
    samples: int = 200,
) -> Struck:
    """Solve a robust job again and again until so many workers and schedulers were killed or suspended under it.

    between: two blows, on average, s.
    """
    chance = random.Random(seed)
    problem = job(designs, samples)
    alone = solve(problem)
    struck, over = Struck(), threading.Event()
    with DaskCluster(2) as cluster:
        blows = ["worker"] * workers + ["scheduler"] * schedulers + ["suspend"] * suspensions
        chance.shuffle(blows)

        def blow() -> None:
            for kind in blows:
                if over.wait(chance.expovariate(1.0 / between)):
                    return
                if kind == "worker":
                    cluster.kill_worker()
                    struck.workers += 1
                elif kind == "suspend":
                    cluster.suspend(chance.uniform(*_SUSPENDED), scheduler=chance.random() < 0.5)
                    struck.suspensions += 1
                else:
                    cluster.kill_scheduler()
                    time.sleep(_AWAY)
                    cluster.start_scheduler()
                    cluster.revive_workers()
                    struck.schedulers += 1

        engine = Cluster(cluster.address, patience=120.0)
        engine.map(_nothing, range(2))  # connected: whatever is heavy goes there
        striker = threading.Thread(target=blow)
        striker.start()
        try:
            while striker.is_alive() or not struck.jobs:
                _compare(struck, alone, solve(problem, engine=engine))
        finally:
            over.set()
            striker.join()
            engine.close()
    return struck


def _compare(struck: Struck, alone: ParetoFront, found: ParetoFront) -> None:
    struck.jobs += 1
    struck.evaluations += found.evaluations
    struck.lost += max(0, alone.evaluations - found.evaluations)
    struck.doubled += max(0, found.evaluations - alone.evaluations)
    if found.evaluations != alone.evaluations:
        struck.violations.append(f"run {struck.jobs} has {found.evaluations} evaluations, not {alone.evaluations}")
    if found.dimensions.tobytes() != alone.dimensions.tobytes() or not found.designs.equals(alone.designs):
        struck.violations.append(f"the front of run {struck.jobs} differs")


def _nothing(item: int) -> int:
    return item
