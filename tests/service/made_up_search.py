"""A made-up search in the place of `solve`, for workers in the process of the test."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.problem import Problem
from tests.service.store.contents import search_record

ROUNDS = 3
Search = Callable[..., ParetoFront]


def made_up_front(problem: Problem, status: str) -> ParetoFront:
    """Return a front of one design, as a search finds it."""
    return ParetoFront(
        problem=problem,
        status=status,  # type: ignore[arg-type]
        message="1 design",
        columns={
            "crank_mm": np.array([140.0]),
            "time_ratio": np.array([1.5]),
            "slow_stroke": np.array(["outward"]),
            "loaded_stroke": np.array(["equal"]),
            "least_transmission_angle_deg": np.array([45.0]),
        },
        dimensions=np.array([[0.14, 0.4, 0.05]]),
        values=np.array([[-1.5, -0.8]]),
        goals=((np.array([0.0, 1.0]), np.array([[1.0], [-1.0]])),),
        active=(np.zeros((0, 1)),),
        hypervolume=0.5,
        history=(),
        evaluations=48,
        seconds=0.1,
        seed=1,
        versions={"slidercrank": "0"},
    )


def search(problem: Problem, *, progress: Any, cancelled: Any, resume: Any, keep: Any, **_: Any) -> ParetoFront:
    """Keep `ROUNDS` records, beginning after those given."""
    from tests.service.store.contents import progress as at

    for number in range(len(resume), ROUNDS):
        if cancelled():
            return made_up_front(problem, "cancelled")
        keep(search_record(number))
        progress(at(number + 1))
    return made_up_front(problem, "done")


def until(condition: Callable[[], bool]) -> None:
    """Wait until something is so."""
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end, "it did not come about within 30 s"
        time.sleep(0.005)
