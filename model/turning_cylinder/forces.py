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

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import require_all_finite, require_numbers
from ..errors import InputError
from ..machine.loads.load import require_word
from ..swing.law import way
from ..swing.swing_types import LeverLaw
from .lever import TurningCylinder, Vectors


@dataclass(frozen=True, kw_only=True)
class LeverBody:
    """Lever with what it carries.

    mass: kg. moment_along, moment_across: first moments about O in its own axes, kg m. inertia: about O, kg m^2.
    """

    mass: float = 0.0
    moment_along: float = 0.0
    moment_across: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "inertia", phrase="the {} of a lever", least=0.0)
        require_numbers(self, "moment_along", "moment_across", phrase="the {} of a lever")

    def carrying(self, mass: float, along: float, across: float = 0.0) -> LeverBody:
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
    """Masses of a lever and its cylinder, and gravity along x and y, m/s^2."""

    sizes: TurningCylinder
    lever: LeverBody = LeverBody()
    barrel: UniformBar = UniformBar()
    piston_rod: UniformBar = UniformBar()
    gravity: tuple[float, float] = (0.0, -9.81)

    def __post_init__(self) -> None:
        require_all_finite("gravity", self.gravity)

    def energy_to_lift(self, start: float, end: float) -> float:
        """Return the work, J, against gravity from one lever angle to another, rad."""
        angles = np.array([start, end])
        motion, gravity = self.sizes.at(angles), complex(*self.gravity)
        centres = (
            complex(self.lever.moment_along, self.lever.moment_across) * np.exp(1j * angles)
            + self.barrel.mass * (1j * self.sizes.offset + 0.5 * self.barrel.length) * motion.line
            + self.piston_rod.mass * (self.sizes.crank * motion.radial - 0.5 * self.piston_rod.length * motion.line)
        )
        heights = -_dot(centres, gravity)
        return float(heights[1] - heights[0])


@dataclass(frozen=True)
class LeverSwing:
    """A swing of the lever from one angle, rad, to another, and back the same way. duration: of one way, s.

    The law is that of the cylinder's length over time; slow ignores inertia.
    """

    start: float
    end: float
    law: LeverLaw = "slow"
    duration: float | None = None

    def __post_init__(self) -> None:
        require_word("law", self.law, LeverLaw)
        require_numbers(self, "duration", phrase="the duration of a swing", above=0.0, unit="s")
        if self.law == "slow" and self.duration is not None:
            raise InputError(
                f"a slow swing has no duration, as it ignores inertia; got {self.duration:g} s; name a law such as "
                "cycloidal, or leave out the duration"
            )
        if self.law != "slow" and self.duration is None:
            raise InputError(
                f"a swing by a law needs its duration; got the law {self.law} and no duration; give the time of one "
                "way, or leave out the law"
            )


@dataclass(frozen=True)
class LeverCurves:
    """Curves over the way out, each (n,), SI and radians; vectors as complex numbers x + i y.

    The way back has the same forces at the same places, as every law is symmetric, and the opposite speeds. push: force
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


def lever_curves(machine: LeverMachine, swing: LeverSwing, share: Array) -> LeverCurves:
    """Return the curves at fractions (n,) of the time of the way out."""
    sizes = machine.sizes
    first, last = (float(sizes.length(angle)) for angle in (swing.start, swing.end))
    s, s_1, s_2 = way(swing.law, share)
    rate = 0.0 if swing.duration is None else 1.0 / swing.duration
    travel = last - first
    angle = sizes.lever_angle(first + travel * s, near=0.5 * (swing.start + swing.end))
    motion = sizes.at(angle)
    speed, acceleration = travel * s_1 * rate, travel * s_2 * rate * rate
    turn = speed / motion.length_1
    turn_rate = (acceleration - motion.length_2 * turn**2) / motion.length_1
    lever, gravity = machine.lever, complex(*machine.gravity)
    line, line_1, line_2 = motion.line, motion.turn_1 * turn, motion.turn_2 * turn**2 + motion.turn_1 * turn_rate
    moment = complex(lever.moment_along, lever.moment_across) * np.exp(1j * angle)
    barrel = (1j * sizes.offset + 0.5 * machine.barrel.length) * line
    barrel_force = machine.barrel.mass * (gravity - _turning(barrel, line_1, line_2))
    arm = 0.5 * machine.piston_rod.length * line
    pin = sizes.crank * motion.radial
    rod_force = machine.piston_rod.mass * (gravity - _turning(pin, turn, turn_rate) + _turning(arm, line_1, line_2))
    inertia = machine.barrel.inertia + machine.piston_rod.inertia
    about_a = _cross(barrel, barrel_force) + _cross(motion.span - arm, rod_force) - inertia * line_2
    about_o = lever.inertia * turn_rate - _cross(moment, gravity)
    force = (about_a * pin - about_o * motion.span) / _cross(motion.span, pin)
    return LeverCurves(
        share=share,
        lever_angle=angle,
        lever_speed=turn,
        cylinder_angle=np.unwrap(np.angle(line)),
        length=motion.length,
        speed=speed,
        transmission=motion.transmission,
        push=_dot(force - rod_force, line),
        pin=force,
        pivot=_turning(moment, turn, turn_rate) - lever.mass * gravity - force,
        cylinder_pivot=force - barrel_force - rod_force,
    )


def _turning(vector: Vectors, speed: Array, rate: Array) -> Vectors:
    """Return the acceleration of the tip of a vector that turns with a body."""
    return np.asarray(vector * (1j * rate - speed**2))


def _cross(first: Vectors, second: Vectors | complex) -> Array:
    return np.asarray((first.conj() * second).imag)


def _dot(first: Vectors, second: Vectors | complex) -> Array:
    return np.asarray((first.conj() * second).real)
