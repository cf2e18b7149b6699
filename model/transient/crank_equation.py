"""The equation of motion of the crank, from the same forces as the inverse dynamics.

The drive torque is affine in the crank's acceleration, and quadratic in its speed:

    T = J(theta) a + (J'(theta) / 2 + E(theta)) w^2 + C(theta) + D(theta) w,

where J is the moving inertia, C gravity and all speed-independent loads, D the viscous loads, and E the loads that grow
with the square of the speed. Each term is the torque from `dynamics.forces` for a motion and a load that leave only
this term. Nothing is derived a second time, and no term is a difference of large numbers. With friction, these terms
are those of the frictionless machine; `Span.friction_state` then gives the torque that the motion requires.

C depends on the slider's direction, and hence on the direction of rotation. It is smooth only between *breakpoints*:
dead centres and knots of load tables. In a `Stretch` the crank turns in one direction between two breakpoints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..cycle.self_locking import require_no_locking
from ..dynamics.segments import (
    Cuts,
    CycleWindow,
    Segment,
    add_formula_loads,
    angle_identifying_segment,
    breakpoint_capacity,
    cut_cycle,
    find_segment_pieces,
    load_on_slider,
)
from ..dynamics.torque import forces_without_friction, load_without_pieces
from ..dynamics.torque_with_friction import torque_without_crank_loads
from ..errors import InputError
from ..kernel.kernel import Integers, Row, Table, kernel
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.arrangement import require_one_cylinder
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import LOAD_SLOTS, Loads, Raw, load_structure, raw_vector
from ..signals.signal_inputs import cycle_window
from ..signals.signals import Signal, design_motion
from .friction_torque import CylinderFriction, FrictionState, Senses, jamming_error, least_inertia_with_friction
from .mechanism_energies import gravity_potential_energy, moving_inertia

TURN = 2.0 * math.pi
NEAREST = 1e-12
"""rad; breakpoints closer together count as one."""
_STILL, _SPIN, _PUSH, _BARE, _SQUARE = range(5)
_SPEED_POWERS = {_SPIN: 1, _PUSH: 1, _BARE: 1, _SQUARE: 2}  # power of the speed in the loads that each column keeps


@dataclass(frozen=True)
class Terms:
    """The terms of the equation of motion at crank angles (n,).

    inertia: J, kg m^2. spin: J'/2, kg m^2. static: C, N m. drag: D, N m s.
    square: E, N m s^2. load: torque on the crank from speed-independent loads, N m; part of -C.
    """

    inertia: Array
    spin: Array
    static: Array
    drag: Array
    load: Array
    square: Array

    @property
    def depends_on_speed(self) -> bool:
        """Whether a load depends on the speed."""
        return bool(self.drag.any() or self.square.any())

    def required_torque(self, speed: Any, acceleration: Any) -> Any:
        """Return the torque, N m, that the motion needs."""
        return self.inertia * acceleration + (self.spin + self.square) * speed**2 + self.static + self.drag * speed


@kernel
def _cut_cycle(block: Table, loads: Loads, watch: CycleWindow, cuts: Cuts) -> int:
    return cut_cycle(design_at(block, 0), block, 0, loads, watch, cuts)


@kernel
def _find_segment_pieces(
    block: Table, loads: Loads, watch: CycleWindow, probe: float, piece: Integers, shift: Row
) -> bool:
    _, outward = find_segment_pieces(design_at(block, 0), block, 0, probe, loads, watch, piece, shift)
    return outward


@kernel
def _fill_equation_terms(
    block: Table, loads: Loads, outward: bool, way: float, piece: Integers, shift: Row, angles: Row, out: Table
) -> None:
    still, spin, push, bare = design_at(block, 0), design_at(block, 1), design_at(block, 2), design_at(block, 3)
    square = design_at(block, 4)
    segment = Segment(block, loads, outward, piece, shift)
    for i in range(angles.shape[0]):
        theta = angles[i]
        sine, cosine = math.sin(theta), math.cos(theta)
        m = design_motion(sine, cosine, still)
        load = load_on_slider(m, still, theta, segment)
        out[0, i] = forces_without_friction(sine, cosine, m, push, 0.0).torque
        out[1, i] = forces_without_friction(sine, cosine, m, spin, 0.0).torque
        static = forces_without_friction(sine, cosine, m, still, load).torque
        out[2, i] = torque_without_crank_loads(static, theta, way, segment)
        dragged = add_formula_loads(load_without_pieces(m, spin, 0.0), m, spin, block, 1, outward, loads)
        out[3, i] = forces_without_friction(sine, cosine, m, bare, dragged).torque
        load_torque = still.branch * load * m.x_1
        out[4, i] = load_torque - torque_without_crank_loads(0.0, theta, way, segment)
        squared = add_formula_loads(0.0, m, square, block, 4, outward, loads)
        out[5, i] = forces_without_friction(sine, cosine, m, bare, squared).torque


class Span:
    """A part of the cycle, from `low` to `high`, rad, in which every term is smooth.

    The crank passes through it in one direction, +1 or -1."""

    low: float
    high: float
    way: float

    def terms_at(self, crank_angle: Array) -> Terms:
        """Return the terms at crank angles (n,), rad."""
        raise NotImplementedError

    def friction_state(self, crank_angle: Array, speed: Array, acceleration: Array) -> FrictionState:
        """Return torque and heat with friction at crank angles, rad, speeds, rad/s, and accelerations (n,), rad/s^2."""
        raise NotImplementedError

    def solve_acceleration(
        self, crank_angle: Array, speed: Array, torque: Array, inertia: float, guess: Array, *, by_speed: bool = False
    ) -> tuple[Array, FrictionState]:
        """Return accelerations (n,), rad/s^2, with friction, and the torque and heat of that motion.

        torque: motor torque on the crank, N m. inertia: inertia of the drive, kg m^2. guess: start of the iteration.
        Raises `InputError` if friction may jam the crank, so that the acceleration is not unique.
        """
        raise NotImplementedError


class Equation:
    """An equation of motion over a cycle of the crank.

    direction: +1 or -1, direction in which the motor turns the crank. period: crank angle of the cycle, rad.
    dead_centres: (k,), rad. breakpoints: (n,), ascending, within a cycle from 0, rad. lead: lead of the first
    cylinder's crank over the angle, rad. crowds: whether its curves are steep at the same angles as those of one
    linkage (`segments.crowding_parameter`). rubs: whether there is friction.
    """

    direction: float
    period: float = TURN
    dead_centres: Array
    breakpoints: Array
    lead: float = 0.0
    crowds: bool = True
    rubs: bool = False

    def stretch_from_breakpoint(self, index: int, way: float) -> Span:
        """Return the stretch from breakpoint `index` to the next one; the last stretch extends beyond the cycle."""
        raise NotImplementedError

    def spans_in_passing_order(self, way: float) -> list[Span]:
        """Return the spans of the cycle in the order in which the crank passes them, counter-clockwise or clockwise."""
        order = range(len(self.breakpoints))
        return [self.stretch_from_breakpoint(index, way) for index in (order if way > 0.0 else reversed(order))]

    def gravity_energy(self, crank_angle: Array) -> Array:
        """Return the potential energy of gravity, J, counted from the crank pivot; same shape as the crank angle."""
        raise NotImplementedError

    def moving_inertia(self, crank_angle: Array) -> Array:
        """Return the moving inertia, kg m^2; same shape as the crank angle."""
        raise NotImplementedError

    def least_inertia_with_friction(self, crank_angle: Array) -> Array:
        """Return the minimum inertia that friction leaves, kg m^2 (`friction_state`); same shape as the crank angle."""
        raise NotImplementedError

    def require_inertia(self, added: float) -> None:
        """Raise `InputError` if nothing resists an acceleration of the crank somewhere.

        Also raises it if friction may cancel the resistance. added: inertia of the drive, kg m^2.
        """
        angles = np.concatenate([self.dead_centres, np.linspace(0.0, TURN, 720, endpoint=False)])
        inertia = self.moving_inertia(angles) + added
        if not inertia.min() > 1e-6 * inertia.max():
            raise InputError(
                "the crank needs inertia at every angle, also at the dead centres where the slider stops; got none "
                "there; give the crank a mass, or the drive a flywheel"
            )
        if self.rubs:
            inertia_left = self.least_inertia_with_friction(angles) + added
            if not inertia_left.min() > 1e-6 * inertia.max():
                raise jamming_error(angles, inertia_left)


class Stretch(Span):
    """The crank turning in one direction between two breakpoints, `low` and `high`, rad; way: +1 or -1."""

    def __init__(self, equation: CrankEquation, low: float, high: float, way: float) -> None:
        self.low, self.high, self.way = low, high, way
        count = len(equation.loads.kind)
        self._piece, self._shift = np.zeros(count, np.int64), np.zeros(count)
        self._block, self._loads = equation.block, equation.loads
        counter_clockwise = _find_segment_pieces(
            self._block, self._loads, equation.watch, angle_identifying_segment(low, high), self._piece, self._shift
        )
        self._outward = bool(counter_clockwise == (way > 0.0))
        if equation.rubs:
            d = design_at(self._block, _STILL)
            rod = design_motion(
                math.sin(angle_identifying_segment(low, high)), math.cos(angle_identifying_segment(low, high)), d
            ).rod_1
            slide = d.branch * (1.0 if self._outward else -1.0)
            senses = Senses(way, float(slide), math.copysign(1.0, rod * way))
            arguments = self._block, _PUSH, self._loads, self._outward, senses, self._piece, self._shift
            self._rubbing = CylinderFriction(*arguments)

    def terms_at(self, crank_angle: Array) -> Terms:
        """Return the terms at crank angles (n,), rad; beyond the ends the loads continue as inside."""
        out = np.empty((6, len(crank_angle)))
        _fill_equation_terms(
            self._block, self._loads, self._outward, self.way, self._piece, self._shift, crank_angle, out
        )
        return Terms(*out)

    def friction_state(self, crank_angle: Array, speed: Array, acceleration: Array) -> FrictionState:
        """Return torque and heat with friction, (n,)."""
        return self._rubbing.state_at(crank_angle, speed, acceleration)

    def solve_acceleration(
        self, crank_angle: Array, speed: Array, torque: Array, inertia: float, guess: Array, *, by_speed: bool = False
    ) -> tuple[Array, FrictionState]:
        """Return accelerations with friction, and the resulting torque and heat, (n,)."""
        return self._rubbing.solve_acceleration(crank_angle, speed, torque, inertia, guess, by_speed=by_speed)


class CrankEquation(Equation):
    """The equation of motion of one fully rotating linkage.

    marks: additional crank angles to use as breakpoints, rad. breakpoints: (n,), ascending in [0, 2 pi), rad.
    direction: +1 or -1, direction in which the motor turns the crank, given by the sign of the mechanism's speed.
    Raises AssemblyError if the linkage does not rotate fully, InputError if friction locks it.
    """

    def __init__(self, mechanism: Mechanism, linkage: Linkage, *, marks: tuple[float, ...] = ()) -> None:
        linkage = require_single_rotating_linkage(mechanism, linkage)
        self.rubs = mechanism.friction.acts
        if self.rubs:
            require_no_locking(mechanism.friction, linkage)
        require_one_cylinder(mechanism.arrangement, "motion under a motor")
        self.direction = -1.0 if mechanism.speed < 0.0 else 1.0
        self.loads, self.watch = load_structure(mechanism), cycle_window(mechanism, Signal.TORQUE)
        raw = np.repeat(raw_vector(mechanism)[:, None], 5, axis=1)
        raw[:3] = np.array([[float(linkage.crank)], [float(linkage.rod)], [float(linkage.offset)]])
        raw[Raw.SPEED] = raw[Raw.ACCELERATION] = 0.0
        raw[Raw.SPEED, [_SPIN, _SQUARE]] = raw[Raw.ACCELERATION, _PUSH] = 1.0
        raw[[Raw.GRAVITY_X, Raw.GRAVITY_Y], _SPIN:] = 0.0
        for index, load in enumerate(mechanism.loads):
            for column, power in _SPEED_POWERS.items():
                if not load.is_moving_mass and load.speed_power != power:
                    raw[Raw.END + LOAD_SLOTS * index :, column][:LOAD_SLOTS] = 0.0
        self.block = np.hstack([derived_blocks(np.ascontiguousarray(column), self.loads)[0][0] for column in raw.T])
        self.dead_centres = np.asarray(linkage.dead_centre_angles)
        self.breakpoints = self._breakpoints(marks)
        self._stretches: dict[tuple[int, float], Stretch] = {}

    def _breakpoints(self, marks: tuple[float, ...]) -> Array:
        capacity = breakpoint_capacity(self.loads)
        cuts = Cuts(
            np.empty(capacity),
            np.empty(capacity, np.int64),
            np.empty(capacity),
            np.empty(capacity, np.int64),
        )
        count = _cut_cycle(self.block, self.loads, self.watch, cuts)
        angles = np.sort(np.concatenate([np.mod(marks, TURN), cuts.angle[:count]]))
        is_distinct = np.diff(angles, prepend=angles[-1] - TURN) > NEAREST
        return np.asarray(angles[is_distinct] if len(angles) > 1 else angles)

    def stretch_from_breakpoint(self, index: int, way: float) -> Stretch:
        """Return the stretch from breakpoint `index` to the next one; the last stretch extends beyond 2 pi."""
        if (index, way) not in self._stretches:
            low = float(self.breakpoints[index])
            last = index + 1 == len(self.breakpoints)
            high = float(self.breakpoints[0]) + TURN if last else float(self.breakpoints[index + 1])
            self._stretches[index, way] = Stretch(self, low, high, way)
        return self._stretches[index, way]

    def moving_inertia(self, crank_angle: Array) -> Array:
        """Return the moving inertia, kg m^2, from the kinetic energy of the bodies; same shape as the crank angle."""
        d = design_at(self.block, _STILL)
        sine, cosine = np.sin(crank_angle), np.cos(crank_angle)
        return np.asarray(moving_inertia(sine, cosine, design_motion(sine, cosine, d), d))

    def least_inertia_with_friction(self, crank_angle: Array) -> Array:
        """Return the minimum inertia that friction leaves, kg m^2; same shape as the crank angle."""
        d = design_at(self.block, _PUSH)
        sine, cosine = np.sin(crank_angle), np.cos(crank_angle)
        m, mu = design_motion(sine, cosine, d), d.guide_friction
        inertia: Array = np.minimum(*(least_inertia_with_friction(sine, cosine, m, d, side) for side in (mu, -mu)))
        return inertia

    def gravity_energy(self, crank_angle: Array) -> Array:
        """Return the potential energy of gravity, J, counted from the crank pivot; same shape as the crank angle."""
        d = design_at(self.block, _STILL)
        sine, cosine = np.sin(crank_angle), np.cos(crank_angle)
        return np.asarray(gravity_potential_energy(sine, cosine, design_motion(sine, cosine, d), d))
