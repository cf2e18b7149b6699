"""The best motion laws of random machines against direct collocation in time, which shares no code with them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.motion_law.input_words import LawObjective
from slidercrank.optimise.motion_law.law_limits import LawRequest
from slidercrank.optimise.motion_law.optimal_law import optimal_law

pytest.importorskip("casadi")

from tests.case_count import case_count
from tests.optimise.motion_law.collocation import Plain, best_by_collocation

OBJECTIVES: tuple[LawObjective, ...] = ("peak torque", "rms torque", "cycle time")
BETTER = 1e-3
"""Share by which collocation may find a better law."""


def random_plain(seed: int) -> Plain:
    random = np.random.default_rng([410, seed])
    crank = random.uniform(0.02, 0.1)
    offset = crank * random.uniform(-1.0, 1.0)
    rod = (crank + abs(offset)) * random.uniform(1.3, 3.0)
    speed = float(random.choice([-1.0, 1.0])) * random.uniform(5.0, 60.0)
    outward, inward = random.uniform(-500.0, 500.0, 2)
    size = crank * max(abs(outward), abs(inward))
    return Plain(
        crank=crank,
        rod=rod,
        offset=offset,
        speed=speed,
        inertia=random.uniform(0.3, 2.0) * size / speed**2,
        rod_mass=random.uniform(0.1, 1.0) * size / (crank * speed) ** 2,
        rod_centre=random.uniform(0.2, 0.8),
        rod_inertia=random.uniform(0.0, 0.2) * size / speed**2,
        slider=random.uniform(0.1, 1.0) * size / (crank * speed) ** 2,
        gravity=9.81,
        outward=outward,
        inward=inward,
        stiffness=random.uniform(0.0, 2.0) * size / crank**2,
        free=rod,
    )


def as_mechanism(plain: Plain) -> Mechanism:
    return Mechanism(
        speed=plain.speed,
        crank=RigidLink(mass=0.0),
        rod=RigidLink(mass=plain.rod_mass, centre=plain.rod_centre * plain.rod, inertia=plain.rod_inertia),
        slider_mass=plain.slider,
        gravity=(0.0, -plain.gravity),
        loads=(
            StrokeForce(outward=plain.outward, inward=plain.inward),
            Spring(stiffness=plain.stiffness, free_position=plain.free),
        ),
        drive=Drive(motor=ConstantTorque(torque=0.0), flywheel=plain.inertia),
    )


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(case_count(3, 30)))
def test_collocation_finds_no_better_law_and_none_below_the_bound(seed: int) -> None:
    plain = random_plain(seed)
    mechanism, linkage = as_mechanism(plain), Linkage(plain.crank, plain.rod, plain.offset)
    random = np.random.default_rng([411, seed])
    objective = OBJECTIVES[seed % 3]
    mean = abs(plain.speed)
    least, greatest = mean * (1.0 - random.uniform(0.1, 0.4)), mean * (1.0 + random.uniform(0.1, 0.6))
    limits: dict[str, Any] = {"least_speed": least, "greatest_speed": greatest}
    torque = None
    if objective == "cycle time":
        torque = 1.2 * optimal_law(mechanism, linkage, LawRequest(**limits)).value
    found = optimal_law(
        mechanism,
        linkage,
        LawRequest(objective=objective, torque_limit=torque, **limits),
    )
    inner, outer = (float(angle) for angle in linkage.dead_centre_angles)
    coarse, fine = (
        best_by_collocation(
            plain,
            (inner, outer),
            objective=objective,
            cycle_time=2.0 * math.pi / mean,
            least=least,
            greatest=greatest,
            torque_limit=torque,
            intervals=intervals,
        )
        for intervals in (24, 48)
    )
    # Between its points collocation exceeds limits; halving the intervals shows by how much that helps it.
    helped = max(0.0, fine - coarse)
    assert found.proven or found.relaxed
    assert found.value <= (fine + helped) * (1.0 + BETTER)
    assert found.bound <= (fine + helped) * (1.0 + BETTER)
    assert helped < 5e-3 * fine
