"""Case 2: the vibrating sieve, with the offset of the mirror image."""

import math

import numpy as np

from ...model.classical.loop_equations import solve_loop
from ...model.linkage.linkage import Linkage
from ...model.machine.links_and_joints import Bar, Clearance
from ...model.machine.mechanism import Mechanism
from .printed_values import Numbers

STEEL = Bar(width=0.03, depth=0.02, density=7800.0)
SLIDER = (0.100, 0.050, 0.050)
SPEED = 300.0 * 2.0 * math.pi / 60.0
SIEVE = Linkage(0.140, 0.310, -0.060)
LONGER_CRANK = Linkage(0.150, 0.310, -0.060)
LONGER_ROD = Linkage(0.140, 0.320, -0.060)
LOOSE = Mechanism(
    speed=SPEED,
    crank=STEEL,
    rod=STEEL,
    slider_mass=STEEL.density * math.prod(SLIDER),
    gravity=(0.0, -9.81),
    clearance=Clearance(joint="crank pin", radius=1e-3, journal_radius=0.01),
)
"""Includes the 1 mm of clearance that the report simulates, taken as radial; the report states neither pin nor
restitution."""
_KG_MM2 = 1e6


def computed_values() -> Numbers:
    """Return the exact values by key."""
    exact: dict[str, float] = {}
    for name, length in (("crank", 0.140), ("rod", 0.310)):
        exact[f"{name}_mass"] = STEEL.mass(length)
        exact |= _moments_of_inertia(name, STEEL.principal_inertias(length))
    mass = STEEL.density * math.prod(SLIDER)
    a, b, c = SLIDER
    exact["slider_mass"] = mass
    exact |= _moments_of_inertia(
        "slider", (mass * (a**2 + b**2) / 12, mass * (a**2 + c**2) / 12, mass * (b**2 + c**2) / 12)
    )
    theta = np.linspace(0.0, 2.0 * math.pi, 200)
    # The report starts at a rod angle of 180 deg; its rod points from slider to crank.
    iterated = solve_loop(SIEVE, theta, start=(0.040, 0.0))
    positions = np.degrees(np.linspace(0.0, 2.0 * math.pi, 4))
    return Numbers(
        exact
        | {
            "speed": SPEED,
            "cycle_time": 2.0 * math.pi / SPEED,
            "second_position": float(positions[1]),
            "third_position": float(positions[2]),
            "stroke": 1e3 * float(SIEVE.stroke),
            "stroke_crank_150": 1e3 * float(LONGER_CRANK.stroke),
            "stroke_rod_320": 1e3 * float(LONGER_ROD.stroke),
            "time_ratio": float(SIEVE.time_ratio),
            "newton_raphson_difference": 1e3
            * float(np.abs(iterated.slider_position - SIEVE.at(theta).slider_position).max()),
        }
    )


def _moments_of_inertia(name: str, values: tuple[float, float, float]) -> dict[str, float]:
    return {f"{name}_{axis}": _KG_MM2 * value for axis, value in zip(("Mxx", "Myy", "Mzz"), values, strict=True)}
