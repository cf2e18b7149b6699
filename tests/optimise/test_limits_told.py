"""Every number that a message of limits gives can be asked for, and 0.1 % more cannot."""

from __future__ import annotations

import copy
import math
import re
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from slidercrank.model import geometry
from slidercrank.model.errors import JobError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise import solve as solving
from slidercrank.optimise.certificate.infeasible import prove_infeasible
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve

Job = dict[str, Any]
CLOSED = ("stroke", "time_ratio", "transmission_angle", "rod_to_crank", "rod_to_offset")
TITLES = {QUANTITIES[name].title: name for name in QUANTITIES}


def random_job(random: np.random.Generator) -> Job:
    """Return a job whose rules are those of one of its designs, one or two of them shifted beyond it or not."""
    crank, rod, offset = random.uniform(20.0, 80.0), random.uniform(150.0, 300.0), random.uniform(5.0, 60.0)
    spans = 1.0 + random.uniform(0.05, 0.8, 3)
    variables: Job = {
        name: [f"{size / span:.4g} mm", f"{size * span:.4g} mm"]
        for name, size, span in zip(("crank", "rod", "offset"), (crank, rod, offset), spans, strict=True)
    }
    kind = random.choice(["free", "free", "listed", "given", "around zero"])
    if kind == "listed":
        variables["crank"] = {"choices": [f"{crank * factor:.4g} mm" for factor in (0.9, 1.0, 1.15)]}
    if kind == "given":
        variables["offset"] = f"{offset:.4g} mm"
    if kind == "around zero":
        variables["offset"] = [f"-{offset:.4g} mm", f"{offset:.4g} mm"]
    sizes = {
        "stroke": float(geometry.stroke(crank, rod, offset)),
        "time_ratio": float(geometry.time_ratio(crank, rod, offset)),
        "transmission_angle": math.degrees(float(geometry.least_transmission_angle(crank, rod, offset))),
        "rod_to_crank": rod / crank,
        "rod_to_offset": rod / offset,
    }
    rules: Job = {}
    for name in random.choice(CLOSED, size=random.integers(1, 4), replace=False):
        value = sizes[name] * random.choice([1.0, random.uniform(0.7, 1.5)])
        value = max(value, 1.001) if name == "time_ratio" else min(value, 85.0) if "angle" in name else max(value, 1.01)
        word = random.choice(["min", "max", "equals"], p=[0.5, 0.3, 0.2])
        rules[str(name)] = {str(word): typed(name, f"{value:.4g}")}
    if random.random() < 0.1:
        rules[str(random.choice(["peak_torque", "rms_torque"]))] = {"max": f"{10.0 ** random.uniform(-1.0, 1.0):.3g} N m"}
    job: Job = {
        "name": "random",
        "mechanism": {"speed": "100 rpm", "slider": {"mass": "2 kg"}},
        "variables": variables,
        "constraints": rules,
        "objectives": {next(name for name in CLOSED if name not in rules): "minimise"},
        "optimiser": {"samples": 2048, "designs": 2},
    }
    if random.random() < 0.1:
        job["friction"] = {"guide": 0.1}
        rules["self_locking_margin"] = {"min": f"{random.uniform(20.0, 80.0):.3g} deg"}
    return job


def typed(name: str, number: str) -> str | float:
    """Return a number as a person types it into a job."""
    unit = QUANTITIES[name].unit.symbol
    return f"{number} {unit}" if unit else float(number)


NUMBER = r"(-?[\d.]+(?:e[+-]?\d+)?)"
REFUSED = re.compile(rf"constraints\.(\w+): .*(at most|at least) {NUMBER}(?: deg| mm)? is possible; got")
BOTH = re.compile(rf"it is at most {NUMBER}; .* constraints\.transmission_angle to {NUMBER} deg at most")
HAD = re.compile(rf"([A-Za-z -]+) (at least|at most|exactly) [^;]*?, at (most|least|the nearest) {NUMBER}[^;]* can be had")
TOGETHER = re.compile(rf"([A-Za-z -]+) (at least|at most|exactly) {NUMBER}[^;]*? instead of")
WORDS = {"at least": "min", "at most": "max", "exactly": "equals"}


def outcome(job: Job) -> str:
    """Return what is said of a job that cannot be met, an empty text if it can."""
    try:
        front = solve(parse_job(job))
    except JobError as error:
        return str(error)
    return "" if front.status == "done" else front.message


def told(job: Job, message: str) -> Iterator[tuple[Job, str, str, str]]:
    """Yield each number of a message: the job with the rules that it speaks of, the quantity, the key, the number."""
    of_dimensions = {name: rule for name, rule in job["constraints"].items() if name in CLOSED}
    both, refused = BOTH.search(message), REFUSED.search(message)
    if both:
        for name, number in (("time_ratio", both[1]), ("transmission_angle", both[2])):
            rules = of_dimensions if "other rules" in message else {k: of_dimensions[k] for k in ("time_ratio", "transmission_angle")}
            yield {**job, "constraints": rules}, name, next(iter(rules[name])), number
    elif refused:
        name = refused[1]
        rules = of_dimensions if "other rules" in message else {name: of_dimensions[name]}
        key = next(iter(rules[name]))
        yield {**job, "constraints": rules}, name, key, refused[3]
    else:
        for title, relation, _, number in HAD.findall(message):
            yield job, TITLES[title.strip().removeprefix("and ")], WORDS[relation], number


def asking(job: Job, name: str, key: str, number: str) -> Job:
    changed = copy.deepcopy(job)
    changed["constraints"].setdefault(name, {}).pop(key, None)
    changed["constraints"][name][key] = typed(name, number)
    return changed
