"""Case 4 and random machines with tolerances and clearances."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Clearances, Mechanism, Tolerance, Tolerances
from tests.model.cases import linkage_of, random_designs

SUPPORT = Linkage(1.4, 1.8, -0.05)
"""Chetana and Vineeth Kumar, fitted: crank 1400, rod 1800, offset 50 mm of the other sign."""
PUBLISHED = Mechanism(
    tolerances=Tolerances(
        crank=Tolerance(fraction=1e-3),
        rod=Tolerance(fraction=1e-3),
        offset=Tolerance(fraction=1e-3),
        crank_angle=Tolerance(absolute=math.radians(0.1)),
    )
)
"""The errors of its Table 1: 0.1 % of each length, 0.1 deg."""


def random_cases(count: int, *, seed: int, coarse: float = 1.0) -> list[tuple[Mechanism, Linkage]]:
    """Return machines on both branches whose limits are up to `coarse` times a tenth of their margin to locking."""
    random = np.random.default_rng(seed)
    cases = []
    for n, design in enumerate(random_designs(count, seed=seed, least_margin=0.1)):
        branch: Branch = "open" if n % 2 else "crossed"
        room = coarse * 0.1 * (design[1] - design[0] - abs(design[2])) * random.random(7)
        mechanism = Mechanism(
            tolerances=Tolerances(
                crank=Tolerance(absolute=min(room[0], 0.2 * design[0])),
                rod=Tolerance(absolute=room[1]),
                offset=Tolerance(absolute=room[2]),
                crank_angle=Tolerance(absolute=coarse * random.uniform(0.0, 0.2)),
                clearances=Clearances(
                    crank_pivot=0.3 * room[3], crank_pin=0.3 * room[4], slider_pin=0.3 * room[5], guide=0.3 * room[6]
                ),
            ),
            branch=branch,
        )
        cases.append((mechanism, linkage_of(design, branch)))
    return cases
