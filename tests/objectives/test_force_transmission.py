"""Force transmission, against the transmission angle and dense sweeps of the joint forces."""

import dataclasses
import math

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import quantity
from tests.model.cases import random_designs, random_friction, random_machine

SHARE = quantity("force_transmission")
DESIGNS = random_designs(12, seed=14, least_margin=0.05)


def machines(*, rubbing: bool) -> list[Mechanism]:
    random = np.random.default_rng(40)
    found = []
    for k in range(8):
        machine = random_machine(random, loads=False)
        # Every other one pulls so hard that its masses hardly matter.
        size = random.choice([-1.0, 1.0]) * (1e5 if k % 2 else 50.0)
        pull = StrokeForce(outward=size, inward=size)
        friction = random_friction(random) if rubbing else machine.friction
        found.append(dataclasses.replace(machine, loads=(pull,), friction=friction))
    return found


def greatest(machine: Mechanism, linkage: Linkage, *, along: bool) -> float:
    """Return the peak of |B_x| or |B| by three ever finer sweeps; NaN where friction locks."""
    angles = np.linspace(0.0, 2.0 * np.pi, 4_001)
    for _ in range(3):
        forces = cycle(machine, linkage, angles)
        force = np.hypot(forces.slider_pin_x, 0.0 if along else forces.slider_pin_y)
        highest, step = angles[force.argmax()], angles[1] - angles[0]
        angles = np.linspace(highest - step, highest + step, 4_001)
    return float(force.max())


@pytest.mark.parametrize("rubbing", [False, True])
def test_it_is_the_ratio_of_the_peaks_of_dense_sweeps_of_joint_forces(rubbing: bool) -> None:
    drives = 0
    for machine in machines(rubbing=rubbing):
        found = SHARE.evaluate(machine, DESIGNS).values
        for row, (r, l, e) in zip(found, DESIGNS.tolist(), strict=True):
            linkage = Linkage(r, l, e, machine.branch)
            ratio = greatest(machine, linkage, along=True) / greatest(machine, linkage, along=False)
            assert row == -math.inf if math.isnan(ratio) else row == pytest.approx(ratio, rel=1e-7)
            drives += not math.isnan(ratio)
    assert drives > 40


def test_a_rod_without_mass_under_a_constant_force_transmits_as_its_transmission_angle_says() -> None:
    nothing = RigidLink(mass=0.0, inertia=0.0)
    machine = Mechanism(speed=3.0, rod=nothing, loads=(StrokeForce(outward=-70.0, inward=-70.0),))
    angles = [float(Linkage(*row).least_transmission_angle) for row in DESIGNS.tolist()]
    found = SHARE.evaluate(machine, DESIGNS, gradients=True)
    assert found.values == pytest.approx(np.sin(angles), rel=1e-12)
    cosine = np.cos(angles)  # (r + |e|) / l, so the sine falls with r and |e|
    _, l, e = DESIGNS.T
    rate = -cosine / np.sin(angles)
    assert found.gradients is not None
    by_dimension = (rate / l, -rate * cosine / l, rate * np.sign(e) / l)
    assert found.gradients == pytest.approx(np.stack(by_dimension, axis=1), rel=1e-9)


@pytest.mark.parametrize("machine", [Mechanism(), Mechanism(slider_mass=2.0, gravity=(0.0, -9.81))])
def test_a_machine_without_forces_along_the_line_has_none(machine: Mechanism) -> None:
    assert "got none; for example, add" in (SHARE.unmet_need(machine, "undefined") or "")
