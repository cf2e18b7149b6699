"""Random cranks that rotate fully and turn an arm with a ram and a cylinder."""

from __future__ import annotations

import numpy as np

from slidercrank.model.arrays import Array
from slidercrank.model.machine.arm import Arm
from slidercrank.model.machine.lever import Lever
from slidercrank.model.machine.lever_cylinder import Cylinder
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.swing import CRANK_TURN
from slidercrank.model.turning_cylinder.lever_state import LeverNumbers
from slidercrank.model.turning_cylinder.levers_of_designs import lever_batch


def some_turn(random: np.random.Generator, *, rotates: bool | None = None) -> tuple[Mechanism, Array]:
    """Return a random machine and its design (1, 3). rotates: whether the arm rotates fully too; either if None."""
    lesser, greater = sorted(random.uniform(0.1, 1.0, 2).tolist())
    lesser = min(lesser, 0.9 * greater)
    rotates = bool(random.integers(2)) if rotates is None else rotates
    crank, frame = (greater, lesser) if rotates else (lesser, greater)
    offset = float(random.uniform(-0.8, 0.8)) * (greater - lesser)
    mass, across, inertia, centre, ram = random.uniform((5.0, -0.2, 0.1, -0.3, 0.2), (40.0, 0.2, 3.0, 0.5, 1.0))
    arm = Arm(mass=0.7 * mass, centre=centre, inertia=inertia, torque=30.0, ram=ram, ram_mass=mass, ram_force=400.0)
    cylinder = Cylinder(closed_length=1.0, stroke=0.9, barrel_mass=3.0, piston_rod_mass=2.0, seal_friction=50.0)
    frame_angle, pin_angle, speed = random.uniform((-3.0, -3.0, 2.0), (3.0, 3.0, 9.0)).tolist()
    gravity = random.normal(0.0, 7.0, 2).tolist()
    mechanism = Mechanism(
        speed=speed * float(random.choice([-1.0, 1.0])),
        crank=RigidLink(mass=mass, centre=0.3, centre_across=across, inertia=inertia),
        gravity=(gravity[0], gravity[1]),
        lever=Lever(frame_angle=frame_angle, pin_angle=pin_angle, cylinder=cylinder, arm=arm),
    )
    return mechanism, np.array([[crank, frame, offset]])


def numbers_of(mechanism: Mechanism, design: Array) -> LeverNumbers:
    """Return the numbers of a machine and a design (1, 3) as floats."""
    batch, _ = lever_batch(mechanism, design, CRANK_TURN, gradients=False)
    return LeverNumbers(*(float(number[0]) for number in batch.plain))
