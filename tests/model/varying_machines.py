"""Machines with one varying number of every kind, and designs of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from slidercrank.model.machine.links_and_joints import Bar, Counterweight, Friction, Pin, RigidLink
from slidercrank.model.machine.loads.added_mass import AddedMass
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Clearances, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from tests.model.cases import STRENGTH, TOLERANCES, Array, random_designs


def vary(path: str, lower: float, upper: float, factor: float = 1.0) -> Varying:
    """Return a number of the machine that varies under its own path."""
    return Varying(name=path, sets=((path, factor),), lower=lower, upper=upper)


_BARS = Mechanism(
    speed=21.0,
    acceleration=30.0,
    crank=Bar(width=0.03, depth=0.02, density=7800.0),
    rod=Bar(width=0.025, depth=0.015, density=2700.0),
    slider_mass=1.5,
    gravity=(2.0, -9.0),
    loads=(
        StrokeForce(outward=-150.0, inward=150.0),
        Spring(stiffness=700.0, free_position=0.04, datum="inner dead centre"),
        PositionTable(positions=(0.0, 0.02, 0.05), forces=(0.0, -90.0, -30.0), datum="outer dead centre"),
        Viscous(coefficient=20.0),
        AddedMass(mass=0.8),
    ),
    tolerances=replace(TOLERANCES, clearances=Clearances(crank_pin=2e-5, guide=3e-5)),
    strength=STRENGTH,
)
BARS = replace(
    _BARS,
    varying=(
        vary("speed", 10.0, 40.0),
        vary("acceleration", 10.0, 60.0),
        vary("slider_mass", 0.5, 3.0),
        vary("crank.width", 0.02, 0.05),
        vary("rod.depth", 0.01, 0.03),
        vary("rod.density", 2000.0, 8000.0),
        Varying(name="gravity", sets=(("gravity.0", 0.6), ("gravity.1", -0.8)), lower=5.0, upper=12.0),
        Varying(name="force", sets=(("loads.0.outward", -1.0), ("loads.0.inward", 1.0)), lower=50.0, upper=300.0),
        vary("loads.1.stiffness", 300.0, 1500.0),
        vary("loads.1.free_position", 0.01, 0.06),
        vary("loads.3.coefficient", 5.0, 40.0),
        vary("tolerances.crank.absolute", 1e-5, 1e-4),
        vary("tolerances.rod.fraction", 1e-5, 1e-3),
        vary("tolerances.crank_angle.absolute", 5e-4, 3e-3),
        vary("tolerances.clearances.crank_pin", 1e-5, 1e-4),
        vary("tolerances.clearances.guide", 1e-5, 1e-4),
        vary("strength.crank_pin", 0.01, 0.016),
        vary("strength.crank_pivot", 0.01, 0.016),
        vary("strength.slider_pin", 0.008, 0.014),
        vary("loads.4.mass", 0.3, 2.0),
    ),
)
"""Bars, loads of several kinds, tolerances and clearances."""

BODIES = Mechanism(
    speed=-16.0,
    acceleration=12.0,
    crank=RigidLink(mass=0.8, centre=0.02, centre_across=0.01, inertia=1e-3),
    rod=RigidLink(mass=1.3, centre=0.07, centre_across=-0.02, inertia=4e-3),
    counterweight=Counterweight(mass=0.9, radius=0.05, angle=2.8, inertia=1e-3),
    slider_mass=1.2,
    gravity=(0.0, -9.81),
    loads=(
        StrokeForce(outward=-120.0, inward=20.0),
        AngleTable(angles=(-0.3, 0.9, 2.0, 3.3, 4.6), forces=(0.0, 80.0, -90.0, 10.0, 60.0)),
    ),
    tolerances=TOLERANCES,
    varying=(
        vary("speed", 8.0, 30.0, -1.0),
        vary("crank.mass", 0.5, 2.0),
        vary("crank.centre", 0.01, 0.05),
        vary("rod.mass", 0.5, 2.0),
        vary("rod.centre_across", 0.005, 0.03, -1.0),
        vary("rod.inertia", 1e-3, 8e-3),
        vary("counterweight.mass", 0.2, 2.0),
        vary("counterweight.radius", 0.02, 0.08),
        vary("counterweight.angle", 2.0, 4.0),
        vary("counterweight.inertia", 1e-4, 2e-3),
        vary("loads.0.outward", 50.0, 200.0, -1.0),
        vary("loads.0.inward", 10.0, 40.0),
        vary("tolerances.offset.absolute", 1e-5, 1e-4),
    ),
)
"""Rigid bodies with a counterweight, whose mass centre is given by radius and angle."""

_PRESSURE_SPEEDS = replace(
    BODIES,
    varying=(),
    friction=Friction(
        guide=0.1,
        crank_pivot=Pin(radius=0.006, coefficient=0.1),
        crank_pin=Pin(radius=0.005, coefficient=0.08),
        slider_pin=Pin(radius=0.004, coefficient=0.12),
    ),
)
RUBBED = replace(
    _PRESSURE_SPEEDS,
    varying=(
        vary("slider_mass", 0.5, 3.0),
        vary("friction.guide", 0.02, 0.25),
        vary("friction.crank_pivot.radius", 0.002, 0.01),
        vary("friction.crank_pin.coefficient", 0.02, 0.2),
        vary("friction.slider_pin.radius", 0.002, 0.01),
        vary("friction.slider_pin.coefficient", 0.02, 0.2),
        vary("counterweight.angle", 2.0, 4.0),
    ),
)
"""Friction in all joints."""

VARIED = {"bars": BARS, "bodies": BODIES, "rubbed": RUBBED}


def varied_designs(machine: Mechanism, count: int, *, seed: int) -> Array:
    """Return designs (count, 3 + k) of a machine, none near locking, its numbers within the middle of their ranges."""
    random = np.random.default_rng(seed)
    lower = np.array([item.lower for item in machine.varying])
    upper = np.array([item.upper for item in machine.varying])
    values = lower + (upper - lower) * random.uniform(0.2, 0.8, (count, len(lower)))
    return np.column_stack([random_designs(count, seed=seed, least_margin=0.3), values])


def unit_steps(machine: Mechanism, designs: Array) -> Array:
    """Return steps of the numbers of designs (n, 3 + k). A fifth of the range, for a dimension a tenth of the crank."""
    spans = [0.2 * (item.upper - item.lower) for item in machine.varying]
    sizes = 0.1 * designs[:, :1] * np.ones((1, 3))
    return np.column_stack([sizes, np.tile(spans, (len(designs), 1))]) if spans else sizes
