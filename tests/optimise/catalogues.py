"""Random jobs whose every design comes from a catalogue, and their fronts by enumeration that shares no search code."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Objective

Array = NDArray[np.float64]
Table = dict[str, Any]

_FLOORS = {"transmission_angle": math.radians(10.0), "self_locking_margin": math.radians(5.0)}
_SENSES = {
    "peak_torque": "minimise",
    "rms_torque": "minimise",
    "peak_power": "minimise",
    "transmission_angle": "maximise",
    "time_ratio": "maximise",
    "footprint": "minimise",
    "position_error": "minimise",
    "peak_slider_acceleration": "minimise",
    "stroke": "maximise",
}
_MET = 1e-9  # relative: a requirement that holds to rounding holds


def random_job(*seed: int) -> Table:
    """Return a job whose lengths and other numbers are lists, so that nothing is left free.

    The lists are narrow, so that combinations just miss what is required. Some jobs leave a length to the stroke or to
    the transmission angle that is asked, some have friction, some a spring.
    """
    random = np.random.default_rng([12, *seed])
    crank = float(random.uniform(40.0, 75.0))
    rod = crank * float(random.uniform(2.0, 3.2))
    offset = float(random.uniform(0.1, 0.7)) * (rod - crank)
    lists = {name: _around(random, length) for name, length in (("crank", crank), ("rod", rod), ("offset", offset))}
    if random.random() < 0.3:  # either side
        lists["offset"][0] *= -1.0
    variables: Table = {name: {"choices": [f"{x:.1f} mm" for x in lengths]} for name, lengths in lists.items()}
    r, l, e = (float(random.choice(lengths)) for lengths in lists.values())
    stroke = math.sqrt((l + r) ** 2 - e * e) - math.sqrt((l - r) ** 2 - e * e)
    angle = math.degrees(math.acos((r + abs(e)) / l))
    excess = math.asin(abs(e) / (l - r)) - math.asin(abs(e) / (l + r))
    constraints: Table = {}
    rule = int(random.integers(0, 7))
    if rule == 0:
        variables["offset"] = ["-120 mm", "120 mm"]
    elif rule == 1:
        variables["crank"] = ["20 mm", "100 mm"]
    elif rule == 2:
        variables["rod"] = ["60 mm", "300 mm"]
        constraints["transmission_angle"] = {"equals": f"{angle:.2f} deg"}
    elif rule == 3:
        constraints["time_ratio"] = {"max": round((math.pi + excess) / (math.pi - excess) + 0.02, 3)}
    elif rule == 4:
        constraints["transmission_angle"] = {"min": f"{angle - 0.5:.2f} deg"}
    if rule in (0, 1):
        constraints["stroke"] = {"equals": f"{stroke:.3f} mm"}
    elif rule != 2:
        constraints["stroke"] = {"min": f"{stroke * 0.99:.3f} mm", "max": f"{stroke * 1.02:.3f} mm"}
    job: Table = {
        "name": f"catalogue {seed}",
        "mechanism": {
            "speed": "240 rpm",
            "crank": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
            "rod": {"width": "25 mm", "depth": "15 mm", "density": "7800 kg/m^3"},
            "slider": {"mass": "2 kg"},
        },
        "load": [{"force": "150 N", "opposes": str(random.choice(["motion", "outward stroke", "inward stroke"]))}],
        "tolerances": {"crank": "0.05 mm", "rod": "0.1 mm", "offset": "0.05 mm", "crank_angle": "0.1 deg"},
        "variables": variables,
        "constraints": constraints,
        "optimiser": {"designs": 1000, "seed": int(random.integers(1, 100))},
    }
    more: list[tuple[str, list[Any]]] = [
        ("mechanism.speed", [f"{speed:.0f} rpm" for speed in random.uniform([60.0, 240.0], [230.0, 400.0])]),
        ("mechanism.slider.mass", [f"{mass:.2f} kg" for mass in random.uniform([0.5, 2.5], [2.4, 5.0])]),
        ("load.1.force", [f"{force:.0f} N" for force in random.uniform([20.0, 200.0], [190.0, 400.0])]),
    ]
    if random.random() < 1.0 / 3.0:
        job["friction"] = {"guide": 0.1}
        more.append(("friction.guide", [0.05, 0.15]))
    if random.random() < 1.0 / 3.0:
        job["load"].append({"stiffness": "1 N/mm", "free_position": "100 mm"})
        more.append(("load.2.stiffness", ["0.5 N/mm", "2 N/mm"]))
    if random.random() < 0.5:
        job["mechanism"]["gravity"] = "9.81 m/s^2"
    for place in random.permutation(len(more))[: random.integers(0, 3)]:
        path, values = more[place]
        variables[path] = {"choices": values}
    free = [name for name in _SENSES if "equals" not in constraints.get(name, {})]
    wanted = random.choice(free, int(random.choice([1, 2, 2, 3, 3])), replace=False)
    job["objectives"] = {str(name): _SENSES[str(name)] for name in wanted}
    return job


def _around(random: np.random.Generator, length: float) -> list[float]:
    """Return three lengths some percent apart."""
    step = float(random.uniform(0.02, 0.1))
    return [round(length * (1.0 + step * place), 1) for place in (-1, 0, 1)]


def brute_force(problem: Problem) -> Array:
    """Return the objectives (n, m) of the front, as minimised, by evaluation of every combination."""
    alike: dict[Any, tuple[Problem, list[Array]]] = {}
    for part in problem.parts():
        alike.setdefault((part.mechanism, part.constraints), (part, []))[1].extend(_designs(part))
    return front_of(np.concatenate([_values(part, np.reshape(designs, (-1, 3))) for part, designs in alike.values()]))


def front_of(values: Array) -> Array:
    """Return the non-dominated rows; of those equal to 1e-9 of the range, the one that is better elsewhere."""
    alone = [row for row in values if not ((values <= row).all(axis=1) & (values < row).any(axis=1)).any()]
    front = np.unique(np.array(alone).reshape(-1, values.shape[1]), axis=0)
    if not len(front):
        return front
    near = np.maximum(1e-9 * np.ptp(front, axis=0), 1e-11 * np.abs(front).max(axis=0))
    kept: list[Array] = []
    for row in front[np.argsort(((front - front.min(axis=0)) / np.maximum(near, 1e-300)).sum(axis=1), kind="stable")]:
        if not any((other <= row + near).all() for other in kept):
            kept.append(row)
    return np.array(kept)


def _designs(part: Problem) -> list[Array]:
    """Return the designs (3,) that ranges of one value and closed forms of equalities give."""
    wanted = {c.quantity: float(c.lower) for c in part.constraints if c.equality and c.lower is not None}
    ranges = {"crank": part.crank, "rod": part.rod, "offset": part.offset}
    known = {name: ends.lower for name, ends in ranges.items() if ends.fixed}
    if len(known) == 3:
        return [np.array([known["crank"], known["rod"], known["offset"]])]
    (free,) = set(ranges) - set(known)
    r, l, e = (known.get(name, math.nan) for name in ("crank", "rod", "offset"))
    found: list[float] = []
    if "stroke" in wanted:
        s = wanted["stroke"]
        if free == "offset":
            square = (s * s / 4.0 - r * r) * (4.0 * l * l / (s * s) - 1.0)
            found = [math.sqrt(square), -math.sqrt(square)] if square > 1e-15 else [0.0] if square > -1e-15 else []
        elif free == "crank":
            square = s * s * (l * l - e * e - s * s / 4.0) / (4.0 * l * l - s * s)
            found = [math.sqrt(square)] if square > 0.0 else []
    elif free == "rod":
        found = [(r + abs(e)) / math.cos(wanted["transmission_angle"])]
    places = [np.array([{**known, free: value}[name] for name in ("crank", "rod", "offset")]) for value in found]
    ends = ranges[free]
    return [d for d, value in zip(places, found, strict=True) if ends.lower - 1e-12 <= value <= ends.upper + 1e-12]


def _values(part: Problem, designs: Array) -> Array:
    """Return the objectives (k, m), as minimised, of those of the designs (n, 3) that meet the requirements."""
    r, l, e = designs.T
    designs = designs[l > r + np.abs(e)]
    bounds = {c.quantity: (c.lower, c.upper) for c in part.constraints}
    floors = {"transmission_angle"} | ({"self_locking_margin"} if part.mechanism.friction.acts else set())
    for name in floors:
        lower, upper = bounds.get(name, (None, None))
        bounds[name] = (_FLOORS[name] if lower is None else lower, upper)
    for name, (lower, upper) in bounds.items():
        values = _of(part, name, designs)
        met = ~np.isnan(values)
        if lower is not None:
            met &= values >= lower - _MET * abs(lower)
        if upper is not None:
            met &= values <= upper + _MET * abs(upper)
        designs = designs[met]
    found = [_minimised(objective, _of(part, objective.quantity, designs)) for objective in part.objectives]
    return np.stack(found, axis=1)


def _minimised(objective: Objective, values: Array) -> Array:
    return -values if objective.sense == "maximise" else values


def _of(part: Problem, name: str, designs: Array) -> Array:
    return part.quantity(name).evaluate(part.mechanism, designs).values


def distance(found: Array, expected: Array) -> float:
    """Return how far two fronts are from each other, of the range: the greatest distance to the nearest design."""
    if not len(found) or not len(expected):
        return math.inf if len(found) != len(expected) else 0.0
    span = np.maximum(np.ptp(expected, axis=0), 1e-3 * np.abs(expected).max(axis=0))
    apart = np.abs(found[:, None] - expected[None]) / np.where(span > 0.0, span, 1.0)
    worst = apart.max(axis=2)
    return float(max(worst.min(axis=0).max(), worst.min(axis=1).max()))


def pairs(front: Array) -> list[tuple[int, int]]:
    """Return pairs of a front: one as good as the other to 1e-9 of the range, better by more somewhere."""
    near = 1e-9 * np.ptp(front, axis=0) if len(front) else np.zeros(0)
    return [
        (one, other)
        for one, other in itertools.permutations(range(len(front)), 2)
        if (front[one] <= front[other] + near).all() and (front[one] < front[other] - near).any()
    ]
