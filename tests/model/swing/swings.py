"""Random linkages that swing, many of which do not turn through, with a random machine each."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import get_args

import numpy as np

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.swing import Swing
from slidercrank.model.swing.swing_types import Driver, Law
from tests.model.cases import random_friction, random_machine


def crank_loads(random: np.random.Generator, *, spring: bool = True) -> tuple[Load, ...]:
    """Return a constant torque, a resistance, a spring and a table on the crank, some of them."""
    angles, torques = np.sort(random.uniform(-3.0, 3.0, 5)), random.normal(0.0, 15.0, 5)
    k, free = random.uniform(5.0, 60.0), random.uniform(-3.0, 3.0)
    loads: list[Load] = [
        CrankTorque(torque=random.normal(0.0, 20.0), resistance=random.uniform(0.0, 12.0)),
        CrankTorqueTable(angles=tuple(angles.tolist()), forces=tuple(torques.tolist())),
        *([CrankTorque(crank_stiffness=k, free_angle=free)] if spring else []),
    ]
    return tuple(load for load in loads if random.random() < 0.7)


def random_points(random: np.random.Generator) -> tuple[tuple[float, float], ...]:
    """Return points of a motion that rises and falls in speed, unlike forth and back."""
    times = np.linspace(0.0, 1.0, 6)
    bent = times + random.uniform(-0.06, 0.06) * np.sin(np.pi * times) ** 2
    ways = bent * bent * (3.0 - 2.0 * bent)
    ways[0], ways[-1] = 0.0, 1.0
    return tuple(zip(times.tolist(), ways.tolist(), strict=True))


Case = tuple[Mechanism, Linkage, Swing]


def random_swings(
    count: int, *, seed: int, driver: Driver | None = None, friction: bool = False, least: float = 0.35
) -> list[Case]:
    """Return linkages whose crank swings, the driven side's transmission angle at least `least` rad throughout."""
    random, found = np.random.default_rng(seed), list[Case]()
    while len(found) < count:
        r, l = random.uniform(0.05, 0.3, 2)
        e = random.uniform(-1.0, 1.0) * (r + l)
        start = random.uniform(-4.0, 4.0)
        end = start + float(random.choice([-1.0, 1.0])) * random.uniform(0.2, 2.5)
        drives: Driver = driver or ("crank" if random.random() < 0.5 else "slider")
        machine = random_machine(random)
        rubs = random_friction(random)
        law: Law = get_args(Law)[random.integers(len(get_args(Law)))]
        duration = None if law == "slow" else random.uniform(0.3, 2.0)
        points = random_points(random) if law == "table" else ()
        theta = np.linspace(start, end, 400)
        across = e - r * np.sin(theta)
        if np.abs(across).max() >= 0.94 * l:
            continue
        sign = 1.0 if machine.branch == "open" else -1.0
        phi = np.arctan2(across, sign * np.sqrt(l * l - across**2))
        bend = np.sin(theta - phi)
        if drives == "slider" and (np.abs(bend).min() < math.sin(least) or np.ptp(np.sign(bend))):
            continue
        if drives == "crank" and np.abs(across).max() > l * math.cos(least):
            continue
        linkage = Linkage(r, l, e, machine.branch)
        if not bool(linkage.rotates_fully):
            kept = [load for load in machine.loads if not getattr(load, "datum", "").endswith("dead centre")]
            machine = replace(machine, loads=tuple(kept))
        machine = replace(machine, friction=rubs) if friction else machine
        swing = Swing(start=start, end=end, driver=drives, law=law, duration=duration, points=points)
        if len(found) % 3 == 0:
            machine = replace(machine, loads=(*machine.loads, *crank_loads(np.random.default_rng(len(found)))))
        found.append((machine, linkage, swing))
    return found
