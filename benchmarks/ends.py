"""Random jobs of several objectives, and how far the ends of their fronts are from what is best in one objective alone.

`python -m benchmarks.ends` in the project's folder solves 100 jobs and each of their objectives alone; two numbers
after it say how many jobs, and the first. Prints each end that is off by more than 1e-6 of its range, and a summary;
ends with 1 where one is worse than alone.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.same_fronts import random_machine
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.solve import solve

Table = dict[str, Any]

NEAR = 1e-6
"""Of the range of an objective over the front: ends as near as this are the best."""
_SENSES = {
    "peak_torque": "minimise",
    "rms_torque": "minimise",
    "peak_power": "minimise",
    "transmission_angle": "maximise",
    "time_ratio": "maximise",
    "footprint": "minimise",
    "position_error": "minimise",
    "peak_slider_acceleration": "minimise",
    "peak_guide_force": "minimise",
    "peak_shaking_force": "minimise",
    "peak_pivot_force": "minimise",
    "stroke": "maximise",
    "2 * crank + rod": "minimise",
    "peak_torque * peak_slider_acceleration": "minimise",
    "rms_torque / stroke": "minimise",
    "max(peak_torque, 0.5 * peak_torque + rms_torque)": "minimise",
}


def random_job(seed: int) -> Table:
    """Return a job around a random linkage, of three or four objectives, with rules that the linkage meets."""
    random = np.random.default_rng([15, seed])
    crank, rod = random.uniform(30.0, 80.0), random.uniform(160.0, 320.0)
    offset = random.uniform(5.0, 60.0)
    spans = 1.0 + random.uniform(0.1, 0.9, 3)
    variables: Table = {
        name: [f"{size / span:.4g} mm", f"{size * span:.4g} mm"]
        for name, size, span in zip(("crank", "rod", "offset"), (crank, rod, offset), spans, strict=True)
    }
    side = random.integers(0, 3)
    if side:
        variables["offset"] = [f"-{offset * spans[2]:.4g} mm", f"{-offset / spans[2] if side == 1 else offset:.4g} mm"]
    wanted = random.choice(list(_SENSES), size=random.integers(3, 5), replace=False)
    job: Table = {
        "name": f"ends {seed}",
        **random_machine(random, slowest=30.0),
        "variables": variables,
        "constraints": {"transmission_angle": {"min": f"{random.uniform(10.0, 30.0):.1f} deg"}},
        "objectives": {str(name): _SENSES[str(name)] for name in wanted},
        "optimiser": {"designs": int(random.choice([20, 60])), "seed": seed},
    }
    stroke = np.sqrt((rod + crank) ** 2 - offset**2) - np.sqrt((rod - crank) ** 2 - offset**2)
    rule = random.choice(["equals", "min", "max", "none"])
    if rule != "none" and not any("stroke" in name for name in wanted):
        job["constraints"]["stroke"] = {str(rule): f"{stroke:.4g} mm"}
    _more(random, job, crank, rod)
    return job


def _more(random: np.random.Generator, job: Table, crank: float, rod: float) -> None:
    """Give a job some of loads, friction, gravity, formulas as rules, other numbers that vary, steps and options."""
    variables, constraints = job["variables"], job["constraints"]
    if random.random() < 0.4:
        job["mechanism"]["gravity"] = "9.81 m/s^2"
    if random.random() < 0.3:
        job["load"].append({"viscous": f"{random.uniform(5.0, 60.0):.4g} N s/m"})
    if random.random() < 0.3:
        job["load"].append({"stiffness": f"{random.uniform(50.0, 500.0):.4g} N/m", "free_position": f"{rod:.4g} mm"})
    if random.random() < 0.4:
        job["friction"] = {"guide": round(float(random.uniform(0.02, 0.3)), 3)}
    if random.random() < 0.3:
        constraints["rod - 2 * crank"] = {"min": f"{0.7 * (rod - 2.0 * crank):.4g} mm"}
    if random.random() < 0.2 and "time_ratio" not in job["objectives"]:
        constraints["time_ratio + 0.1 * abs(offset) / crank"] = {"max": 1.3}
    kind = random.random()
    if kind < 0.2:
        variables["mechanism.slider.mass"] = ["0.5 kg", "5 kg"]
        job["mechanism"]["slider"]["mass"] = "1 kg"
    elif kind < 0.35:
        variables["rod"] = {"choices": [f"{rod * factor:.4g} mm" for factor in (0.9, 1.0, 1.15)]}
    elif kind < 0.45 and "equals" not in constraints.get("stroke", {}):
        for name, step in (("crank", 2.0), ("rod", 5.0), ("offset", 2.0)):
            low, high = variables[name]
            variables[name] = {"min": low, "max": high, "step": f"{step} mm"}


@dataclass(frozen=True)
class End:
    """An end of a front. missed: by how much it is worse than the best of the objective alone, as a share of its range.

    Less than zero where it is better.
    """

    seed: int
    objective: str
    missed: float


def alone(problem: Problem, place: int) -> ParetoFront:
    """Return the answer of a job with one of its objectives."""
    return solve(replace(problem, objectives=(problem.objectives[place],)))


def ends(problem: Problem, seed: int) -> list[End]:
    """Return how far the ends of a problem's front are from each objective alone; none of a job without designs."""
    front = solve(problem)
    found = []
    for place, objective in enumerate(problem.objectives if len(front) else ()):
        best, own = float(alone(problem, place).values[0, 0]), front.values[:, place]
        span = max(float(np.ptp(own)), 1e-6 * abs(best), 1e-300)
        found.append(End(seed, objective.quantity, (float(own.min()) - best) / span))
    return found


def main(count: int = 100, first: int = 0) -> int:
    """Print ends that are off by more than `NEAR` of the range, and a summary; return 1 where one is worse."""
    total, off, infeasible = 0, 0, 0
    for seed in range(first, first + count):
        found = ends(parse_job(random_job(seed)), seed)
        infeasible += not found
        total += len(found)
        for end in found:
            if abs(end.missed) > NEAR:
                off += end.missed > 0.0
                print(f"job {seed}: {end.objective} {end.missed:.3g}", flush=True)
    print(f"{count} jobs, {infeasible} infeasible, {total} ends, {off} worse than alone by more than {NEAR:g}")
    return 1 if off else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
