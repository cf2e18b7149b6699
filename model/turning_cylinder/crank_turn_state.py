"""A crank rotates fully about O and turns the line from A to B: shaper, Whitworth mechanism, oscillating cylinder.

The crank turns at constant speed w. With psi from OA to OB, the direction gamma of the line turns by gamma' per angle
of the crank and the length L along it changes by L'. Crank < frame: the line swings between two reversals, where it is
a tangent of the pin's circle. Frame < crank: it rotates fully too. Then a stroke lasts from one crossing of the normal
of OA to the other. Four angles, at which friction or loads change, divide the turn: psi = 0 and 180 deg, where L'
changes its sign, and both ends of the fast stroke around psi = 0.

The arm of the line carries an inertia, its weight, a torque against its motion, and a ram that its pin at the distance
R moves by y = R sin(gamma - direction of OA), normal to OA. With their moment N about A on the line, F of the line on
the crank at B follows from AB x F = N + (moment of the bodies) and from its part along the line, the friction of the
cylinder. The torque on the crank is T = J w' - S x G - OB x F; T w is the rate of all energies and works.
"""

from typing import Any, NamedTuple

import numpy as np

from ..kernel.arithmetic import analytic, arcsine, inverse
from .lever_geometry import Motion, motion_at
from .lever_state import LeverNumbers, Vector, bodies_at, cross, difference, dot, scaled, tip_acceleration

PIECES = 4
"""Pieces of a turn: the second half of the fast stroke begins piece 1, the slow stroke piece 2."""
_TURN = 2.0 * np.pi


class TurnState(NamedTuple):
    """State over a turn, SI and radians; primes are derivatives by the crank angle.

    stretch: d(crank angle) / d(place). line: direction of the line. turn_1, turn_2: gamma' and gamma''. length_1: L'.
    ram_1: y' of a ram, 0 without one. torque: on the crank, counter-clockwise. pin, pivot: forces on the crank at B
    and O. cylinder_pivot: on arm and cylinder at A.
    """

    crank_angle: Any
    stretch: Any
    line: Vector
    length: Any
    turn_1: Any
    turn_2: Any
    length_1: Any
    ram_1: Any
    torque: Any
    pin: Vector
    pivot: Vector
    cylinder_pivot: Vector


@analytic
def fast_stroke_ends(c: Any) -> tuple[Any, Any]:
    """Return the angles a and b, rad; the fast stroke is from psi = -a to psi = b.

    c: `LeverNumbers` or `TurningCylinder`.
    """
    r, f, e = c.crank, c.frame, c.offset
    swings = 1.0 * (r.real < f.real)
    lesser, per_greater = swings * r + (1.0 - swings) * f, inverse(swings * f + (1.0 - swings) * r)
    side = (2.0 * swings - 1.0) * e
    return 0.5 * np.pi - arcsine((lesser - side) * per_greater), 0.5 * np.pi - arcsine((lesser + side) * per_greater)


@analytic
def turn_state(c: LeverNumbers, place: Any, probe: Any) -> TurnState:
    """Return the state at places: piece of the turn plus the fraction of its angle.

    probe: places within the same piece. Place 0 and 4 are the start of the fast stroke.
    """
    before, after = fast_stroke_ends(c)
    piece = np.minimum(np.maximum(np.floor(probe), 0.0), PIECES - 1.0)
    fast, last = 1.0 * (piece < 2.0), 1.0 * (piece > 2.0)
    opening, middle = 1.0 * (piece < 1.0), 1.0 * (piece > 1.0) - last
    low = -opening * before + middle * after + last * np.pi
    high = (fast - opening) * after + middle * np.pi + last * (_TURN - before)
    psi = low + (place - piece) * (high - low)
    return _state_at_angle(c, psi + c.frame_angle - c.pin_angle, piece, high - low)


def place_in_turn(c: LeverNumbers, crank_angle: Any) -> Any:
    """Return the places of crank angles, rad, for one crank with real numbers."""
    before, after = fast_stroke_ends(c)
    cuts = [-before, 0.0, after, np.pi, _TURN - before]
    psi = np.mod(crank_angle + c.pin_angle - c.frame_angle + before, _TURN) - before
    return np.interp(psi, [float(cut) for cut in cuts], np.arange(PIECES + 1.0))


@analytic
def _state_at_angle(c: LeverNumbers, angle: Any, piece: Any, stretch: Any) -> TurnState:
    motion = motion_at(c, angle)
    way = 1.0 - 2.0 * (c.speed.real < 0.0)
    bodies = bodies_at(c, angle, motion, c.speed, 0.0 * c.speed)
    arm, ram, moment, ram_1 = _arm_and_ram_forces(c, motion, piece, way)
    extends = way * (1.0 - 2.0 * (piece < 1.0) - 2.0 * (piece > 2.0))
    along = dot(bodies.rod, motion.line) - c.rub * extends
    across = (bodies.about_a + moment + c.offset * along) * inverse(motion.length)
    x, y = motion.line
    force = along * x - across * y, along * y + across * x
    torque = bodies.about_o - cross(scaled(c.crank, motion.radial), force)
    on_cylinder = difference(difference(force, bodies.rod), bodies.barrel)
    pivot, cylinder_pivot = difference(bodies.carried, force), difference(difference(on_cylinder, arm), ram)
    place = (angle, stretch, motion.line, motion.length)
    turn = (motion.turn_1, motion.turn_2, motion.length_1, ram_1)
    return TurnState(*place, *turn, torque, force, pivot, cylinder_pivot)


@analytic
def _arm_and_ram_forces(c: LeverNumbers, motion: Motion, piece: Any, way: Any) -> tuple[Vector, Vector, Any, Any]:
    """Return the arm's weight less m a, the ram's force on the arm, their moment about A, and y'."""
    gravity = c.gravity_x, c.gravity_y
    line_1, line_2 = motion.turn_1 * c.speed, motion.turn_2 * c.speed * c.speed
    centre = scaled(c.arm_moment, motion.line)
    arm = difference(scaled(c.arm_mass, gravity), tip_acceleration(centre, line_1, line_2))
    slow = 1.0 * (piece > 1.0)
    rotates = 1.0 * (c.frame.real < c.crank.real)
    against = c.arm_torque * way * (2.0 * slow - 1.0 + 2.0 * rotates * (1.0 - slow))
    frame = np.cos(c.frame_angle), np.sin(c.frame_angle)
    normal = -frame[1], frame[0]
    pin = scaled(c.ram, motion.line)
    speed_1 = dot((-pin[1], pin[0]), normal)
    acceleration = dot(tip_acceleration(pin, line_1, line_2), normal)
    push = c.ram_mass * (acceleration - dot(gravity, normal)) - slow * way * c.ram_force
    moment = cross(centre, gravity) - c.arm_inertia * line_2 - against - push * speed_1
    return arm, scaled(-push, normal), moment, speed_1 * motion.turn_1
