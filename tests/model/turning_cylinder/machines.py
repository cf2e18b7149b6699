"""Random levers with turning cylinders, and swings that they can make."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.machine.lever_spring import LeverSpring
from slidercrank.model.turning_cylinder.cylinder_and_pin_forces import LeverBody, LeverMachine, LeverSwing, UniformBar
from slidercrank.model.turning_cylinder.lever_geometry import TurningCylinder


def some_sizes(random: np.random.Generator) -> TurningCylinder:
    """Return random dimensions; the offset is small enough for every lever angle off the dead points by 10 deg."""
    crank, frame = random.uniform(0.2, 1.5, 2).tolist()
    near = math.sqrt(crank**2 + frame**2 - 2.0 * crank * frame * math.cos(math.radians(10.0)))
    angles = random.uniform(-math.pi, math.pi, 2).tolist()
    return TurningCylinder(
        crank=crank,
        frame=frame,
        frame_angle=angles[0],
        offset=float(random.uniform(-0.6, 0.6)) * near,
        pin_angle=angles[1],
    )


def some_ends(sizes: TurningCylinder, random: np.random.Generator) -> tuple[float, float]:
    """Return two lever angles on one side of the dead points, in either order, some of them turns away."""
    low, high = sorted(random.uniform(math.radians(12.0), math.radians(168.0), 2).tolist())
    side = float(random.choice([-1.0, 1.0]))
    shift = 2.0 * math.pi * int(random.integers(-2, 3)) - float(sizes.angle_from_frame_to_crank(0.0))
    ends = [side * low + shift, side * (high + 0.02) + shift]
    random.shuffle(ends)
    return ends[0], ends[1]


def some_machine(random: np.random.Generator) -> tuple[LeverMachine, LeverSwing]:
    """Return a random machine with gravity in any direction, and a swing of it by any law."""
    sizes = some_sizes(random)
    mass, along, across, barrel, rod = random.uniform(0.5, 90.0, 5).tolist()
    lengths = random.uniform(0.1, 1.0, 2)
    lever = LeverBody(inertia=float(random.uniform(0.0, 5.0))).with_point_mass(mass, 0.01 * along, 0.01 * across - 0.4)
    gravity = random.normal(0.0, 7.0, 2).tolist()
    machine = LeverMachine(
        sizes=sizes,
        lever=lever,
        barrel=UniformBar(mass=0.3 * barrel, length=float(lengths[0])),
        piston_rod=UniformBar(mass=0.2 * rod, length=float(lengths[1])),
        gravity=(gravity[0], gravity[1]),
    )
    law = str(random.choice(["slow", "constant", "trapezoid", "harmonic", "cycloidal", "polynomial"]))
    duration = None if law == "slow" else float(random.uniform(0.3, 3.0))
    return machine, LeverSwing(*some_ends(sizes, random), law, duration)  # type: ignore[arg-type]


def some_spring(random: np.random.Generator) -> LeverSpring:
    """Return a random spring that pushes or pulls."""
    numbers = random.uniform((0.6, -3.0, 0.1, -3.0, -900.0, 0.3, 0.0), (1.0, 3.0, 0.5, 3.0, 900.0, 1.0, 2000.0))
    frame, frame_angle, lever, pin_angle, force, length, stiffness = numbers.tolist()
    places = {"frame": frame, "frame_angle": frame_angle, "lever": lever, "pin_angle": pin_angle}
    return LeverSpring(**places, force=force, length=length, stiffness=stiffness)
