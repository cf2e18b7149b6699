"""Numbers of many levers with their turning cylinders, and their state over a swing.

The formulas take real numbers, or complex ones whose imaginary part is a step. Vectors have two components.
"""

from typing import Any, NamedTuple

import numpy as np

from ..kernel.arithmetic import analytic, inverse, root
from ..swing.law import NO_TABLE, law_code, travel_and_derivatives_at
from ..swing.swing_types import LeverLaw
from .lever_geometry import Motion, angle_error_at, closing_length, cylinder_length, lever_angle_at, motion_at

Vector = tuple[Any, Any]


class LeverNumbers(NamedTuple):
    """Numbers of one lever or of many, SI and radians; see `lever`, `forces` and `machine.lever_cylinder`.

    rate: 1 / duration of one way, 0 for a slow swing. along, across: first moments of the lever. areas: full and
    annular area; NaN if there is no bore. buckling: push times length^2 that buckles the piston rod, N m^2; NaN if
    there is none. supply: pressure; NaN if there is none, as for closed_length and stroke. speed: of the crank, rad/s,
    if it rotates fully. arm_moment: first moment of the arm. arm_inertia: about its pivot; ram: 0 without one; see
    `machine.arm`. spring: see `machine.lever_spring`; without force and stiffness if there is none.
    """

    crank: Any
    frame: Any
    frame_angle: Any
    offset: Any
    pin_angle: Any
    start: Any
    end: Any
    rate: Any
    lever_mass: Any
    moment_along: Any
    moment_across: Any
    inertia: Any
    gravity_x: Any
    gravity_y: Any
    barrel_mass: Any
    barrel_length: Any
    rod_mass: Any
    rod_length: Any
    crank_error: Any
    frame_error: Any
    offset_error: Any
    length_error: Any
    rub: Any
    full_area: Any
    annular_area: Any
    supply: Any
    buckling: Any
    closed_length: Any = np.nan
    stroke: Any = np.nan
    speed: Any = 0.0
    arm_mass: Any = 0.0
    arm_moment: Any = 0.0
    arm_inertia: Any = 0.0
    arm_torque: Any = 0.0
    ram: Any = 0.0
    ram_mass: Any = 0.0
    ram_force: Any = 0.0
    spring_frame: Any = 1.0
    spring_frame_angle: Any = 0.0
    spring_lever: Any = 0.0
    spring_pin_angle: Any = 0.0
    spring_force: Any = 0.0
    spring_length: Any = 0.0
    spring_stiffness: Any = 0.0

    def cylinder_length(self, lever_angle: Any) -> Any:
        """Return the length of the cylinder, m, at lever angles, rad."""
        return cylinder_length(self.crank, self.frame, self.offset, lever_angle + self.pin_angle - self.frame_angle)

    @property
    def cylinder_end_lengths(self) -> tuple[Any, Any]:
        """Length of the cylinder at start and end, m."""
        return self.cylinder_length(self.start), self.cylinder_length(self.end)


class Errors(NamedTuple):
    """Tolerances as `angle_error_at` takes them."""

    crank: Any
    frame: Any
    offset: Any
    length: Any


class LeverState(NamedTuple):
    """State of a lever and its cylinder; see `forces.LeverCurves`. line: direction of the cylinder."""

    lever_angle: Any
    lever_speed: Any
    length: Any
    speed: Any
    line: Vector
    push: Any
    pin: Vector
    pivot: Vector
    cylinder_pivot: Vector
    angle_error: Any


def lever_state(c: LeverNumbers, law: LeverLaw, share: Any, probe: Any) -> LeverState:
    """Return the state at fractions of the duration from start to end.

    probe: fractions on the same side of the law's corners.
    """
    return state_in_swing(c, law_code(law), NO_TABLE, share, probe)


@analytic
def state_in_swing(c: LeverNumbers, law: int, table: Any, share: Any, probe: Any) -> LeverState:
    """Return the state as `lever_state` does. law, table: as for `travel_and_derivatives_at`."""
    shift = c.pin_angle - c.frame_angle
    first = closing_length(c.crank, c.frame, c.offset, c.start + shift)
    travel = closing_length(c.crank, c.frame, c.offset, c.end + shift) - first
    s, s_1, s_2, _ = travel_and_derivatives_at(law, table, share, probe)
    angle = lever_angle_at(c, first + travel * s, 0.5 * (c.start + c.end))
    motion = motion_at(c, angle)
    speed, acceleration = travel * s_1 * c.rate, travel * s_2 * c.rate * c.rate
    per_length_1 = inverse(motion.length_1)
    turn = speed * per_length_1
    rise = (acceleration - motion.length_2 * turn * turn) * per_length_1
    push, pin, pivot, cylinder_pivot = _forces(c, angle, motion, turn, rise)
    errors = Errors(c.crank_error, c.frame_error, c.offset_error, c.length_error)
    error = angle_error_at(c, angle + shift, motion.length, errors)
    return LeverState(angle, turn, motion.length, speed, motion.line, push, pin, pivot, cylinder_pivot, error)


@analytic
def _forces(c: LeverNumbers, angle: Any, motion: Motion, turn: Any, rise: Any) -> tuple[Any, Vector, Vector, Vector]:
    """Return push and the forces on the lever at B and O and on the cylinder at A. turn, rise: of the lever."""
    bodies = bodies_at(c, angle, motion, turn, rise)
    pin = scaled(c.crank, motion.radial)
    force = difference(scaled(bodies.about_a, pin), scaled(bodies.about_o, motion.span))
    force = scaled(inverse(cross(motion.span, pin)), force)
    on_rod = difference(force, bodies.rod)
    return dot(on_rod, motion.line), force, difference(bodies.carried, force), difference(on_rod, bodies.barrel)


class Bodies(NamedTuple):
    """Forces and moments that accelerate the bodies.

    carried: force on the lever. rod, barrel: weight less m a of both parts of the cylinder.
    about_o: moment of the lever about O. about_a: moment of `rod` and `barrel` about A less their I gamma''.
    """

    carried: Vector
    rod: Vector
    barrel: Vector
    about_o: Any
    about_a: Any


@analytic
def bodies_at(c: LeverNumbers, angle: Any, motion: Motion, turn: Any, rise: Any) -> Bodies:
    """Return the forces and moments that accelerate the bodies at a lever angle.

    turn, rise: speed and acceleration of the lever.
    """
    gravity = c.gravity_x, c.gravity_y
    line_1, line_2 = motion.turn_1 * turn, motion.turn_2 * turn * turn + motion.turn_1 * rise
    cosine, sine = np.cos(angle), np.sin(angle)
    moment = c.moment_along * cosine - c.moment_across * sine, c.moment_along * sine + c.moment_across * cosine
    x, y = motion.line
    half = 0.5 * c.barrel_length
    barrel = half * x - c.offset * y, half * y + c.offset * x
    barrel_force = scaled(c.barrel_mass, difference(gravity, tip_acceleration(barrel, line_1, line_2)))
    arm = scaled(0.5 * c.rod_length, motion.line)
    rod_acceleration = difference(
        tip_acceleration(scaled(c.crank, motion.radial), turn, rise), tip_acceleration(arm, line_1, line_2)
    )
    rod_force = scaled(c.rod_mass, difference(gravity, rod_acceleration))
    inertia = (c.barrel_mass * c.barrel_length * c.barrel_length + c.rod_mass * c.rod_length * c.rod_length) / 12.0
    spring_pin, spring, _ = spring_at(c, angle)
    return Bodies(
        carried=difference(difference(tip_acceleration(moment, turn, rise), scaled(c.lever_mass, gravity)), spring),
        rod=rod_force,
        barrel=barrel_force,
        about_o=c.inertia * rise - cross(moment, gravity) - cross(spring_pin, spring),
        about_a=cross(barrel, barrel_force) + cross(difference(motion.span, arm), rod_force) - inertia * line_2,
    )


@analytic
def spring_at(c: LeverNumbers, angle: Any) -> tuple[Vector, Vector, Any]:
    """Return the pin of the spring on the lever, its force there, and its energy, J, at a lever angle."""
    pin = (
        c.spring_lever * np.cos(angle + c.spring_pin_angle),
        c.spring_lever * np.sin(angle + c.spring_pin_angle),
    )
    frame = c.spring_frame * np.cos(c.spring_frame_angle), c.spring_frame * np.sin(c.spring_frame_angle)
    span = difference(pin, frame)
    length = vector_length(span)
    extension = length - c.spring_length
    push = c.spring_force - c.spring_stiffness * extension
    energy = (0.5 * c.spring_stiffness * extension - c.spring_force) * extension
    return pin, scaled(push * inverse(length), span), energy


def work_against_gravity_and_spring(c: LeverNumbers) -> Any:
    """Return the work against gravity and spring from start to end, J."""
    first, last = (_potential_energy(c, angle) for angle in (c.start, c.end))
    return last - first


def _potential_energy(c: LeverNumbers, angle: Any) -> Any:
    motion = motion_at(c, angle)
    cosine, sine = np.cos(angle), np.sin(angle)
    (x, y), (rx, ry) = motion.line, motion.radial
    half, back = 0.5 * c.barrel_length, 0.5 * c.rod_length
    moment_x = c.moment_along * cosine - c.moment_across * sine
    moment_x = moment_x + c.barrel_mass * (half * x - c.offset * y) + c.rod_mass * (c.crank * rx - back * x)
    moment_y = c.moment_along * sine + c.moment_across * cosine
    moment_y = moment_y + c.barrel_mass * (half * y + c.offset * x) + c.rod_mass * (c.crank * ry - back * y)
    return spring_at(c, angle)[2] - (c.gravity_x * moment_x + c.gravity_y * moment_y)


@analytic
def tip_acceleration(vector: Vector, speed: Any, rate: Any) -> Vector:
    """Return the acceleration of the tip of a vector that turns with a body."""
    square = speed * speed
    return -vector[0] * square - vector[1] * rate, vector[0] * rate - vector[1] * square


@analytic
def scaled(factor: Any, vector: Vector) -> Vector:
    """Return a vector times a number."""
    return factor * vector[0], factor * vector[1]


@analytic
def difference(first: Vector, second: Vector) -> Vector:
    """Return the first vector less the second."""
    return first[0] - second[0], first[1] - second[1]


@analytic
def cross(first: Vector, second: Vector) -> Any:
    """Return the component of the cross product normal to the plane."""
    return first[0] * second[1] - first[1] * second[0]


@analytic
def dot(first: Vector, second: Vector) -> Any:
    """Return the scalar product."""
    return first[0] * second[0] + first[1] * second[1]


@analytic
def vector_length(vector: Vector) -> Any:
    """Return the magnitude of a vector."""
    return root(dot(vector, vector))
