"""Every number that a message of limits gives can be asked for, and 0.1 % more cannot."""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.kinematics import geometry
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise import solve as solving
from slidercrank.optimise.certificate.infeasibility_certificate import prove_infeasible
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from tests.case_count import case_count

pytestmark = pytest.mark.usefixtures("little")

Job = dict[str, Any]
CLOSED = ("stroke", "time_ratio", "transmission_angle", "rod_to_crank", "rod_to_offset")
TITLES = {QUANTITIES[name].title: name for name in QUANTITIES}


def random_job(random: np.random.Generator) -> Job:
    """Return a job whose requirements are those of one of its designs. One or two of them may be shifted beyond it."""
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
        value = sizes[name] * random.uniform(0.7, 1.5)
        value = max(value, 1.001) if name == "time_ratio" else min(value, 85.0) if "angle" in name else max(value, 1.01)
        word = random.choice(["min", "max", "equals"], p=[0.5, 0.3, 0.2])
        rules[str(name)] = {str(word): typed(name, f"{value:.4g}")}
    return {
        "name": "random",
        "mechanism": {"speed": "100 rpm", "slider": {"mass": "2 kg"}},
        "variables": variables,
        "constraints": rules,
        "objectives": {next(name for name in CLOSED if name not in rules): "minimise"},
        "optimiser": {"samples": 512, "designs": 2},
    }


def typed(name: str, number: str) -> str | float:
    """Return a number as a person types it into a job."""
    unit = QUANTITIES[name].unit.symbol
    return f"{number} {unit}" if unit else float(number)


NUMBER = r"(-?[\d.]+(?:e[+-]?\d+)?)"
POSSIBLE = re.compile(rf"constraints\.(\w+): .* at (?:most|least) {NUMBER}(?: deg| mm)? is possible; got")
ACTIVE = re.compile(r"(?:with|and) (\w+) (?:at least|at most|exactly) ")
RATIO = re.compile(rf"with a least transmission angle .* it is at most {NUMBER}; ")
ANGLE = re.compile(rf"lower constraints\.transmission_angle to {NUMBER} deg at most")
HAD = re.compile(
    rf"([A-Za-z -]+) (at least|at most|exactly) [^;]*?, at (?:most|least|the nearest) {NUMBER}[^;]* is possible with"
)
TOGETHER = re.compile(rf"([A-Za-z -]+) (at least|at most|exactly) {NUMBER}[^;]*? instead of")
KEYS = {"at least": "min", "at most": "max", "exactly": "equals"}


def said_of(job: Job) -> str:
    """Return the message on a job that cannot be met, nothing if it can."""
    try:
        front = solve(parse_job(job))
    except JobError as error:
        return str(error)
    return "" if front.status == "done" else front.message


def alternatives(job: Job, message: str) -> Iterator[Job]:
    """Yield the job, with the rules that a message speaks of, once for each number in it, asking for that."""
    rules = job["constraints"]
    ratio, angle, possible = RATIO.search(message), ANGLE.search(message), POSSIBLE.search(message)
    if ratio or angle:
        kept = (
            rules
            if "other requirements" in message
            else {name: rules[name] for name in ("time_ratio", "transmission_angle")}
        )
        for name, number in (("time_ratio", ratio), ("transmission_angle", angle)):
            if number:
                yield asking({**job, "constraints": kept}, name, next(iter(kept[name])), number[1])
    elif possible:
        name = possible[1]
        active = {other: rules[other] for other in ACTIVE.findall(message) if other in rules}
        kept = rules if "other requirements" in message else {name: rules[name], **active}
        yield asking({**job, "constraints": kept}, name, next(iter(kept[name])), possible[2])
    else:
        for title, relation, number in HAD.findall(message):
            yield asking(job, TITLES[title.strip()], KEYS[relation], number)
        together = copy.deepcopy(job)
        for title, relation, number in TOGETHER.findall(message):
            named = TITLES[title.rpartition("and ")[2].strip().removeprefix("ask for ")]
            together = asking(together, named, KEYS[relation], number)
        if together != job:
            yield together


def asking(job: Job, name: str, key: str, number: str) -> Job:
    """Return the job with another number in one of its rules."""
    changed = copy.deepcopy(job)
    changed["constraints"].setdefault(name, {})[key] = typed(name, number)
    return changed


def tightened(job: Job, asked: Job) -> Job:
    """Return a job of `alternatives` with 0.1 % more asked for, towards what was asked at first."""
    changed = copy.deepcopy(job)
    for name, rule in job["constraints"].items():
        for key, value in rule.items():
            first = asked["constraints"].get(name, {}).get(key)
            if value != first:
                size, wanted = number_of(value), FLOOR if first is None else number_of(first)
                more = size * (1.001 if wanted > size else 0.999)
                more = min(more, wanted, key=lambda end: abs(end - size)) if key == "equals" else more
                changed = asking(changed, name, key, f"{more:.12g}")
    return changed


FLOOR = 10.0
"""Degrees of the transmission angle that hold where a job sets none."""


def number_of(value: str | float) -> float:
    """Return the number of a value as it is typed."""
    return float(value.split()[0]) if isinstance(value, str) else value


def impossible(job: Job) -> bool:
    """Return whether a job is refused, proven to have no design, or has none that the search finds."""
    try:
        problem = parse_job(job)
    except JobError:
        return True
    return prove_infeasible(problem, seconds=0.5) or solve(problem).status == "infeasible"


def tried(job: Job) -> int:
    """Try every number that is told of a job; return how many there were."""
    message, count = said_of(job), 0
    for other in alternatives(job, message):
        assert said_of(other) == "", (job, message, other["constraints"])
        assert impossible(tightened(other, job)), (job, message, other["constraints"])
        count += 1
    assert bool(message) == bool(count), (job, message)
    return count


@pytest.mark.slow
def test_every_number_that_is_told_can_be_had_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of random jobs, refused by the parser or searched in vain; a proof would only add to the message."""
    monkeypatch.setattr(solving, "prove_infeasible", lambda *_, **__: False)
    random = np.random.default_rng(3)  # messages of every kind come with this seed
    counts = [tried(random_job(random)) for _ in range(case_count(25, 50))]
    assert sum(count > 0 for count in counts) >= case_count(6, 12)


@pytest.mark.parametrize(("seed", "number"), [(4, 24), (6, 7)])
def test_either_of_two_numbers_serves_with_the_rules_that_the_message_names(seed: int, number: int) -> None:
    """Jobs where lowering one of two helps beside all other rules, lowering the other only without them."""
    random = np.random.default_rng(seed)
    assert tried([random_job(random) for _ in range(number + 1)][-1])
