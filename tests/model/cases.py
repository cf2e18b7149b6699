"""Random linkages and machines that the tests share."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import fields, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Bar, Counterweight, Friction, Pin, RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Branch, Material, Mechanism, Strength, Tolerance, Tolerances, Window
from slidercrank.objectives.machine_needs import (
    A_BAR,
    COMPRESSOR,
    COUPLES,
    CRANK_BAR,
    CYLINDER,
    HEAT,
    LOSSES,
    REPEATS,
    ROD_BAR,
    WEARS,
    Need,
)
from slidercrank.objectives.machine_needs import CRANK_MASS as CRANK_WEIGHS
from slidercrank.objectives.machine_needs import ROD_MASS as ROD_WEIGHS
from slidercrank.objectives.machine_needs import STRENGTH as STRONG
from slidercrank.objectives.quantity import Quantity
from slidercrank.optimise.job import parse_job

Array = NDArray[np.float64]

TOLERANCES = Tolerances(
    crank=Tolerance(absolute=5e-5, fraction=2e-4),
    rod=Tolerance(absolute=1e-4, fraction=1e-4),
    offset=Tolerance(absolute=3e-5, fraction=5e-4),
    crank_angle=Tolerance(absolute=1.7e-3),
)
WINDOWED = Tolerances(
    crank=TOLERANCES.crank,
    rod=TOLERANCES.rod,
    offset=TOLERANCES.offset,
    crank_angle=TOLERANCES.crank_angle,
    window=Window(during="outward stroke", start=0.15, end=0.8),
)

SMOOTH = Mechanism(
    speed=31.0,
    acceleration=40.0,
    crank=Bar(width=0.03, depth=0.02, density=7800.0),
    rod=RigidLink(mass=1.3, centre=0.07, centre_across=-0.02, inertia=4e-3),
    counterweight=Counterweight(mass=0.9, radius=0.05, angle=2.8, inertia=1e-3),
    slider_mass=1.95,
    gravity=(3.0, -9.3),
    loads=(
        StrokeForce(outward=-60.0, inward=-60.0),
        Spring(stiffness=800.0, free_position=0.05, datum="inner dead centre"),
        Viscous(coefficient=25.0),
    ),
    tolerances=TOLERANCES,
)
"""Curves that are smooth all over the cycle."""

STROKES = Mechanism(
    speed=-12.0,
    acceleration=15.0,
    crank=RigidLink(mass=0.8),
    rod=Bar(width=0.03, depth=0.02, density=7800.0),
    slider_mass=2.5,
    gravity=(0.0, -9.81),
    loads=(
        StrokeForce(outward=-200.0, inward=30.0),
        Spring(stiffness=400.0, free_position=0.02, datum="outer dead centre"),
    ),
    tolerances=WINDOWED,
)
"""Loads that change at the dead centres; position error over a part of one stroke."""

TABLES = Mechanism(
    speed=9.0,
    acceleration=-6.0,
    crank=RigidLink(mass=0.8, centre=0.02, centre_across=0.01, inertia=1e-3),
    rod=Bar(width=0.03, depth=0.02, density=7800.0),
    slider_mass=1.2,
    gravity=(-4.0, 7.0),
    loads=(
        PositionTable(
            positions=(0.0, 0.01, 0.025, 0.06),
            forces=(0.0, -150.0, -40.0, -300.0),
            datum="inner dead centre",
            during="outward stroke",
        ),
        PositionTable(positions=(0.004, 0.03, 0.11), forces=(120.0, -20.0, 0.0), datum="outer dead centre"),
        AngleTable(angles=(-0.3, 0.9, 2.0, 3.3, 4.6), forces=(0.0, 80.0, -90.0, 10.0, 60.0)),
        Viscous(coefficient=15.0),
    ),
    tolerances=Tolerances(
        crank=TOLERANCES.crank,
        rod=TOLERANCES.rod,
        offset=TOLERANCES.offset,
        crank_angle=TOLERANCES.crank_angle,
        window=Window(start=0.3, end=1.0),
    ),
    branch="crossed",
)
"""Tables over position (two datums) and angle on the crossed branch; position error without a part of the cycle."""

AIR = Compressor(
    bore=0.05,
    low=1e5,
    high=6e5,
    compression_exponent=1.3,
    expansion_exponent=1.2,
    clearance_volume=2e-6,
)

MACHINES = {"smooth": SMOOTH, "strokes": STROKES, "tables": TABLES}


STRENGTH = Strength(
    material=Material(
        density=7850.0,
        elasticity=207e9,
        yield_strength=350e6,
        ultimate_strength=520e6,
        endurance=150e6,
        bearing_pressure=20e6,
    ),
    crank_pivot=0.008,
    crank_pin=0.007,
    slider_pin=0.006,
    eye_concentration=2.5,
    wear_coefficient=1e-15,
)
BARS_OF = {WEARS, STRONG, ROD_BAR, CRANK_BAR, A_BAR, CRANK_WEIGHS, ROD_WEIGHS}


RUBBING_PIVOT = Friction(crank_pivot=Pin(radius=0.01, coefficient=0.1))


def fitted(quantity: Quantity, machine: Mechanism) -> Mechanism:
    """Return a machine that has what a quantity is of.

    Two cylinders for a rocking couple, no crank acceleration for times of strokes, bars for their strength, for gas a
    compressor whose clearance follows the stroke; for losses a crank pivot that rubs, which locks no design, and a load
    that resists more than any other one drives; else what the message of a need gives as an example. Quantities of the
    same needs get the same one: what they have in common is computed once.
    """
    found = _fitted(set(quantity.needs), machine)
    for need in quantity.needs:
        if need.consequence == "undefined" and not need.is_met(found):
            found = _with_example(need, found)
    return _kept(found)


def with_example(job: dict[str, Any], need: Need) -> dict[str, Any]:
    """Return a job with the example tables from the message of a need, if it has any."""
    found = re.search(r"for example, add (\[+)(\w+)\]+ (\w+ = .*?)(?:, or .*| on the slider)?$", need.missing)
    if found is None:
        return job
    table: dict[str, Any] = tomllib.loads(f"table = {{ {found[3]} }}")["table"]
    return job | {found[2]: [table] if found[1] == "[[" else job.get(found[2], {}) | table}


def _with_example(need: Need, machine: Mechanism) -> Mechanism:
    """Return a machine with the example of a need that it does not meet."""
    lengths = {"crank": "50 mm", "rod": "200 mm", "offset": "0 mm"}
    job = {"name": "Small", "variables": lengths, "objectives": {"stroke": "maximise"}, "mechanism": {"speed": "9 rpm"}}
    before, after = parse_job(job).mechanism, parse_job(with_example(job, need)).mechanism
    changed = {item.name: getattr(after, item.name) for item in fields(Mechanism)}
    changed = {name: value for name, value in changed.items() if value != getattr(before, name)}
    return replace(machine, **changed | {"loads": (*machine.loads, *after.loads)})


@lru_cache(maxsize=64)
def _kept(machine: Mechanism) -> Mechanism:
    return machine


def _fitted(needs: set[Need], machine: Mechanism) -> Mechanism:
    if REPEATS in needs:
        return replace(machine, acceleration=0.0)
    if COUPLES in needs:
        return replace(machine, arrangement=Arrangement(phases=(0.0, 2.0), places=(-0.05, 0.06)))
    if {*LOSSES, *HEAT} & needs:
        resistance = StrokeForce(outward=-3000.0, inward=3000.0)
        return replace(machine, friction=RUBBING_PIVOT, loads=(*machine.loads, resistance))
    if BARS_OF & needs:
        bar = Bar(width=0.03, depth=0.02, density=7800.0)
        crank, rod = (link if isinstance(link, Bar) else bar for link in (machine.crank, machine.rod))
        return replace(machine, strength=STRENGTH, crank=crank, rod=rod)
    return replace(machine, loads=(*machine.loads, AIR)) if {CYLINDER, COMPRESSOR} & needs else machine


def random_designs(count: int, *, seed: int, least_margin: float = 1e-3, greatest_margin: float = 3.0) -> Array:
    """Return designs (count, 3) that turn fully: crank, rod, offset, m.

    The margin rod / (crank + |offset|) - 1 is log-uniform between its limits. Half the offsets are up to three cranks
    long, the other half are log-uniform down to a ten-thousandth of the crank; either sign.
    """
    random = np.random.default_rng(seed)
    crank = random.uniform(0.02, 0.15, count)
    wide = random.uniform(0.0, 3.0, count)
    near = 10.0 ** random.uniform(-4.0, 0.0, count)
    share = np.where(random.random(count) < 0.5, wide, near)
    offset = crank * share * random.choice([-1.0, 1.0], count)
    margin = 10.0 ** random.uniform(math.log10(least_margin), math.log10(greatest_margin), count)
    return np.stack([crank, (crank + np.abs(offset)) * (1.0 + margin), offset], axis=1)


def linkage_of(designs: Array, branch: Branch = "open") -> Linkage:
    """Return the linkage of one design (3,) or of many (..., 3)."""
    return Linkage(designs[..., 0], designs[..., 1], designs[..., 2], branch)


def random_machine(random: np.random.Generator, *, loads: bool = True) -> Mechanism:
    """Return a machine of random masses, gravity direction, loads, rotation, acceleration and branch."""

    def link() -> Bar | RigidLink:
        if random.random() < 0.5:
            width, depth = random.uniform(0.01, 0.05, 2)
            return Bar(width=width, depth=depth, density=random.uniform(2000.0, 9000.0))
        if random.random() < 0.3:
            return RigidLink(mass=random.uniform(0.1, 3.0))
        return RigidLink(
            mass=random.uniform(0.1, 3.0),
            centre=random.uniform(-0.05, 0.2),
            centre_across=random.uniform(-0.05, 0.05),
            inertia=random.uniform(1e-4, 1e-2),
        )

    signed = random.choice([-1.0, 1.0], 3)
    pull = random.uniform(0.0, 2.0 * math.pi)
    branch: Branch = "open" if random.random() < 0.5 else "crossed"
    return Mechanism(
        speed=signed[0] * random.uniform(1.0, 40.0),
        acceleration=signed[1] * random.uniform(0.5, 80.0),
        crank=link(),
        rod=link(),
        counterweight=Counterweight(
            mass=random.uniform(0.0, 2.0),
            radius=random.uniform(0.0, 0.1),
            angle=random.uniform(0.0, 2.0 * math.pi),
            inertia=random.uniform(0.0, 1e-3),
        ),
        slider_mass=random.uniform(0.1, 4.0),
        gravity=(9.81 * math.cos(pull), 9.81 * math.sin(pull)),
        loads=random_loads(random) if loads else (),
        branch=branch,
    )


def random_loads(
    random: np.random.Generator,
) -> tuple[Load, ...]:
    """Return one load of every kind, springs and tables at every datum."""
    size = random.uniform(-300.0, 300.0, 12)
    knots = np.sort(random.uniform(0.0, 0.1, 4))
    angles = np.sort(random.uniform(-1.0, 5.0, 4))
    return (
        StrokeForce(outward=size[0], inward=size[1]),
        Spring(stiffness=random.uniform(0.0, 2000.0), free_position=random.uniform(0.0, 0.3)),
        Spring(stiffness=random.uniform(0.0, 2000.0), datum="inner dead centre"),
        Spring(stiffness=random.uniform(0.0, 2000.0), free_position=0.03, datum="outer dead centre"),
        Viscous(coefficient=random.uniform(0.0, 50.0)),
        PositionTable(positions=tuple(knots), forces=tuple(size[2:6]), datum="inner dead centre"),
        PositionTable(positions=tuple(0.1 + knots), forces=tuple(size[4:8]), during="inward stroke"),
        PositionTable(
            positions=tuple(knots),
            forces=tuple(size[6:10]),
            datum="outer dead centre",
            during="outward stroke",
        ),
        AngleTable(angles=tuple(angles), forces=tuple(size[8:12]), during="outward stroke"),
        Drag(drag=random.uniform(0.0, 20.0)),
    )


def random_friction(random: np.random.Generator) -> Friction:
    """Return friction in all joints: guide coefficient of up to 0.3, friction circles of up to 2 mm."""

    def pin() -> Pin:
        return Pin(radius=random.uniform(0.002, 0.01), coefficient=random.uniform(0.0, 0.2))

    return Friction(guide=random.uniform(0.0, 0.3), crank_pivot=pin(), crank_pin=pin(), slider_pin=pin())
