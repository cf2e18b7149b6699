"""Random problems of one objective: a random machine, ranges around a random linkage, constraints that it meets."""

from __future__ import annotations

import numpy as np

from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.problem.problem import Problem
from tests.model.cases import random_designs, random_machine
from tests.optimise.problems import Bounds, problem


def random_problem(seed: int, objective: str = "peak_torque") -> Problem:
    """Return a feasible problem; the linkage that it is built around is not its optimum.

    Ranges reach from a third to three times the linkage. One to three of: stroke given or at least, time ratio given or
    at least, transmission angle at least, rod to crank at most, the rule rod to offset.
    """
    random = np.random.default_rng([seed, 4])
    machine = random_machine(random)
    while True:
        design = random_designs(1, seed=int(random.integers(2**31)), least_margin=0.1)[0]
        known = {
            name: float(QUANTITIES[name].evaluate(machine, design[None]).values[0])
            for name in ("stroke", "time_ratio", "transmission_angle", "rod_to_crank", "rod_to_offset")
        }
        if known["transmission_angle"] > 0.35 and known["rod_to_offset"] < 50.0:
            break
    r, l, e = (float(value) for value in design)
    held: dict[str, Bounds] = {"stroke": known["stroke"] if random.random() < 0.5 else (known["stroke"], None)}
    if random.random() < 0.5:
        held["transmission_angle"] = (0.9 * known["transmission_angle"], None)
    if random.random() < 0.4:
        held["time_ratio"] = (
            known["time_ratio"] if random.random() < 0.3 else (1.0 + 0.8 * (known["time_ratio"] - 1.0), None)
        )
    if random.random() < 0.3:
        held["rod_to_crank"] = (None, 1.5 * known["rod_to_crank"])
    if random.random() < 0.2 and "time_ratio" not in held:
        held["rod_to_offset"] = known["rod_to_offset"]
    ends = sorted([0.3 * e, 3.0 * e]) if random.random() < 0.7 else sorted([-1.5 * e, 3.0 * e])
    return problem(
        {objective: "minimise"},
        held,
        crank=(r / 3.0, 3.0 * r),
        rod=(l / 3.0, 3.0 * l),
        offset=(ends[0], ends[1]),
        mechanism=machine,
        samples=2048,
        seed=seed + 1,
    )
