"""Force of the cylinder and of the three pins of a lever that a turning cylinder moves.

F is the force of the piston rod on the lever at B, P the push of the cylinder along its line, G gravity. Without
friction in the pins,

- lever, moments about O: OB x F = J alpha - S x G, with the first moment S of its mass and its inertia J about O;
- barrel and piston rod, moments about A: AB x F = sum of (p x m (G - a) - I gamma'') over both;
- piston rod, along the line: P = F u - m_rod (G - a_rod) u.

The first two are linear in F with the determinant AB x OB, zero at a dead point. The seal rubs with a constant force
against the motion, which adds to the push outward and to the pull inward.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import require_all_finite, require_numbers
from ..errors import InputError
from ..machine.lever_cylinder import Cylinder, euler_load_times_squared_length
from ..machine.lever_spring import LeverSpring
from ..machine.loads.load import require_word
from ..swing.swing_types import LeverLaw
from .lever_geometry import DimensionErrors, TurningCylinder, Vectors
from .lever_state import LeverNumbers, lever_state, work_against_gravity_and_spring


@dataclass(frozen=True, kw_only=True)
class LeverBody:
    """Lever with the mass that it carries.

    mass: kg. moment_along, moment_across: first moments about O in its own axes, kg m. inertia: about O, kg m^2.
    """

    mass: float = 0.0
    moment_along: float = 0.0
    moment_across: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "inertia", phrase="the {} of a lever", least=0.0)
        require_numbers(self, "moment_along", "moment_across", phrase="the {} of a lever")

    def with_point_mass(self, mass: float, along: float, across: float = 0.0) -> LeverBody:
        """Return the lever with a point mass, kg, at a place in its own axes, m."""
        return LeverBody(
            mass=self.mass + mass,
            moment_along=self.moment_along + mass * along,
            moment_across=self.moment_across + mass * across,
            inertia=self.inertia + mass * (along * along + across * across),
        )


@dataclass(frozen=True, kw_only=True)
class UniformBar:
    """Barrel or piston rod: a slender uniform bar along the cylinder's line, from A or from B. mass: kg. length: m."""

    mass: float = 0.0
    length: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "length", phrase="the {} of barrel and piston rod", least=0.0)

    @property
    def inertia(self) -> float:
        """Moment of inertia about its centre, kg m^2."""
        return self.mass * self.length**2 / 12.0


@dataclass(frozen=True, kw_only=True)
class LeverMachine:
    """Masses of a lever and its cylinder, gravity along x and y, m/s^2, and a spring on the lever.

    ram: distance of the pin in a ram from A along the line, m; 0 without one.
    """

    sizes: TurningCylinder
    lever: LeverBody = LeverBody()
    barrel: UniformBar = UniformBar()
    piston_rod: UniformBar = UniformBar()
    gravity: tuple[float, float] = (0.0, -9.81)
    spring: LeverSpring | None = None
    ram: float = 0.0

    def __post_init__(self) -> None:
        require_all_finite("gravity", self.gravity)

    def energy_to_lift(self, start: float, end: float) -> float:
        """Return the work, J, against gravity and spring from one lever angle to another, rad."""
        return float(work_against_gravity_and_spring(numbers_of_machine(self, LeverSwing(start, end))))


@dataclass(frozen=True)
class LeverSwing:
    """A swing of the lever from one angle, rad, to another, and back the same way. duration: of one way, s.

    The law is that of the cylinder's length over time; slow ignores inertia. of_full_turn: whether it is the fast
    stroke of a crank that rotates fully.
    """

    start: float
    end: float
    law: LeverLaw = "slow"
    duration: float | None = None
    of_full_turn: bool = False

    def __post_init__(self) -> None:
        require_word("law", self.law, LeverLaw)
        require_numbers(self, "duration", phrase="the duration of a swing", above=0.0, unit="s")
        if self.law == "slow" and self.duration is not None:
            raise InputError(
                f"a slow swing must not have a duration, as it ignores inertia; got {self.duration:g} s; name a "
                "motion law such as cycloidal, or leave out the duration"
            )
        if self.law != "slow" and self.duration is None:
            raise InputError(
                f"a swing with a motion law needs a duration; got the law {self.law} and no duration; give the "
                "time of one stroke, or leave out the law"
            )


@dataclass(frozen=True)
class LeverCurves:
    """Curves over the swing, each (n,), SI and radians; vectors are complex numbers x + i y.

    The return has the same forces at the same places, as every law is symmetric, and the opposite speeds. push: force
    P of the cylinder without friction, N, positive where it pushes. speed: dL/dt, m/s. pin, pivot, cylinder_pivot:
    forces on the lever at B and at O, and on the cylinder at A, N.
    """

    share: Array
    lever_angle: Array
    lever_speed: Array
    cylinder_angle: Array
    length: Array
    speed: Array
    transmission: Array
    push: Array
    pin: Vectors
    pivot: Vectors
    cylinder_pivot: Vectors


def numbers_of_machine(
    machine: LeverMachine, swing: LeverSwing, cylinder: Cylinder | None = None, errors: DimensionErrors | None = None
) -> LeverNumbers:
    """Return the numbers of one machine over a swing."""
    sizes, lever, barrel, rod = machine.sizes, machine.lever, machine.barrel, machine.piston_rod
    cylinder = cylinder or Cylinder()
    numbers = LeverNumbers(
        *(sizes.crank, sizes.frame, sizes.frame_angle, sizes.offset, sizes.pin_angle),
        *(swing.start, swing.end, 0.0 if swing.duration is None else 1.0 / swing.duration),
        *(lever.mass, lever.moment_along, lever.moment_across, lever.inertia),
        *machine.gravity,
        *(barrel.mass, barrel.length, rod.mass, rod.length),
        *(errors or DimensionErrors()),
        cylinder.seal_friction,
        *(cylinder.areas or (math.nan, math.nan)),
        math.nan if cylinder.supply_pressure is None else cylinder.supply_pressure,
        math.nan if cylinder.rod is None else euler_load_times_squared_length(cylinder.rod, cylinder.modulus),
        ram=machine.ram,
    )
    spring = machine.spring
    return numbers if spring is None else numbers._replace(**{f"spring_{name}": x for name, x in vars(spring).items()})


def lever_curves(machine: LeverMachine, swing: LeverSwing, share: Array) -> LeverCurves:
    """Return the curves at fractions (n,) of the duration from start to end."""
    state = lever_state(numbers_of_machine(machine, swing), swing.law, share, share)
    pin, pivot, cylinder_pivot = (part[0] + 1j * part[1] for part in (state.pin, state.pivot, state.cylinder_pivot))
    return LeverCurves(
        share=share,
        lever_angle=state.lever_angle,
        lever_speed=state.lever_speed,
        cylinder_angle=np.unwrap(np.arctan2(state.line[1], state.line[0])),
        length=state.length,
        speed=state.speed,
        transmission=machine.sizes.motion_at(state.lever_angle).transmission,
        push=state.push,
        pin=pin,
        pivot=pivot,
        cylinder_pivot=cylinder_pivot,
    )
