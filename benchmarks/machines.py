"""The machine that benchmarks run on a linkage of, and the designs that they evaluate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances

Array = NDArray[np.float64]

BAR = Bar(width=0.03, depth=0.02, density=7800.0)
SPEED = 31.4
SLIDER = 1.95
GRAVITY = -9.81
LOAD = -20.0
CRANK, ROD, OFFSET_SHARE, ANGLE = 1e-4, 1e-4, 1e-3, 1e-3

MECHANISM = Mechanism(
    speed=SPEED,
    crank=BAR,
    rod=BAR,
    slider_mass=SLIDER,
    gravity=(0.0, GRAVITY),
    loads=(StrokeForce(outward=LOAD, inward=LOAD),),
    tolerances=Tolerances(
        crank=Tolerance(absolute=CRANK),
        rod=Tolerance(absolute=ROD),
        offset=Tolerance(fraction=OFFSET_SHARE),
        crank_angle=Tolerance(absolute=ANGLE),
    ),
)


def random_designs(count: int, *, seed: int = 1) -> Array:
    """Return fully turning designs (count, 3), m, with rods 0.1 % to three times longer than crank + |offset|."""
    random = np.random.default_rng(seed)
    crank = random.uniform(0.02, 0.1, count)
    offset = random.uniform(-0.1, 0.1, count)
    margin = 10.0 ** random.uniform(-3.0, np.log10(3.0), count)
    return np.stack([crank, (crank + np.abs(offset)) * (1.0 + margin), offset], axis=1)
