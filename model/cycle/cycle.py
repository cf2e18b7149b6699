"""All curves of one design over the cycle, for figures, tables and tests.

The work balance has loads, friction in each joint, and kinetic energy. Per cycle, one turn or two, with dt = dtheta / w
at constant speed:

- input: integral of T over the cycle, in the direction of rotation;
- useful: work done against the loads, which is minus the integral of F dx (F, x positive outward) and, for torques M on
  the crank, of M dtheta;
- friction heat: mu |N| |dx| in the guide, rho |F| times the relative rotation in the pins: |phi'| in the slider pin, 1
  - phi' in the crank pin, 1 in the crank pivot;
- stored: kinetic energy from the crank's acceleration, if any. Springs and gravity return the energy that they store
  within a turn.

Loads that do net work on the machine drive it; the crank then delivers that work less friction.
"""

import math
from dataclasses import dataclass, fields
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.breakpoints import breakpoints_of
from ..dynamics.segments import (
    CycleWindow,
    Segment,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
    find_segment_pieces,
    load_on_slider,
)
from ..dynamics.torque_with_friction import (
    friction_signs_in_segment,
    joint_forces_with_optional_friction,
    needs_friction_kernel,
    rotation_sense,
    torque_without_crank_loads,
)
from ..errors import InputError
from ..kernel.kernel import Row, Table, kernel
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.cylinders_and_turns import TURN, cycle_turns, half_of_cycle_at, machines_of_turns, require_one_turn
from ..machine.derived_designs import derived_blocks
from ..machine.design import Design, design_at
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from ..machine.raw_machine_vector import Loads, load_structure, raw_vector
from ..signals.averages import signal_averages
from ..signals.panel_polynomials import resolve_curves
from ..signals.position_error import influences, root_sum_square, worst_case
from ..signals.signal_inputs import cycle_window
from ..signals.signals import Signal, design_motion
from .crank_speed import crank_speed_and_acceleration
from .self_locking import require_no_locking

_COLUMNS = 16
_SPEED, _ACCELERATION = Design._fields.index("speed"), Design._fields.index("acceleration")


@dataclass(frozen=True)
class MotionAndForces:
    """Curves of one design, each (n,), SI and radians; forces as components along x and y.

    load: load on the slider, N, positive outward. pivot: force from the frame on the crank; crank_pin: force from the
    crank on the rod; slider_pin: force from the rod on the slider; guide: force from the guide on the slider, along +y.
    """

    crank_angle: Array
    slider_position: Array
    slider_velocity: Array
    slider_acceleration: Array
    load: Array
    pivot_x: Array
    pivot_y: Array
    crank_pin_x: Array
    crank_pin_y: Array
    slider_pin_x: Array
    slider_pin_y: Array
    guide: Array


@dataclass(frozen=True)
class Cycle(MotionAndForces):
    """Curves of one design over crank angles.

    torque: drive torque, N m, counter-clockwise. crank_load: torque of the loads on the crank, N m, counter-clockwise.
    """

    transmission_angle: Array
    torque: Array
    position_error: Array
    position_error_rss: Array
    crank_load: Array


@kernel
def _fill_cycle_curves(
    block: Table,
    loads: Loads,
    watch: CycleWindow,
    angles: Row,
    speeds: Row,
    accelerations: Row,
    out: Table,
    rubbing: bool,
) -> None:
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    for i in range(angles.shape[0]):
        theta = angles[i]
        block[_SPEED, 0], block[_ACCELERATION, 0] = speeds[i], accelerations[i]
        d = design_at(block, 0)
        sine, cosine = math.sin(theta), math.cos(theta)
        _, outward = find_segment_pieces(d, block, 0, theta, loads, watch, piece, shift)
        segment = Segment(block, loads, outward, piece, shift)
        m = design_motion(sine, cosine, d)
        load = load_on_slider(m, d, theta, segment)
        sides = friction_signs_in_segment(theta, d, segment, rubbing)
        f = joint_forces_with_optional_friction(sine, cosine, m, d, load, sides)
        j = influences(sine, cosine, m, d.l)
        out[0, i] = m.x
        out[1, i] = m.x_1 * d.speed
        out[2, i] = m.x_2 * d.speed * d.speed + m.x_1 * d.acceleration
        out[3, i] = load
        out[4, i] = f.pivot_x
        out[5, i] = f.pivot_y
        out[6, i] = f.crank_pin_x
        out[7, i] = f.crank_pin_y
        out[8, i] = f.slider_pin_x
        out[9, i] = f.slider_pin_y
        out[10, i] = f.guide
        out[11, i] = math.atan2(abs(m.l_cos), abs(m.l_sin))
        way = rotation_sense(d)
        out[12, i] = torque_without_crank_loads(f.torque, theta, way, segment)
        out[13, i] = worst_case(j, d)
        out[14, i] = root_sum_square(j, d)
        out[15, i] = -torque_without_crank_loads(0.0, theta, way, segment)


def cycle(
    mechanism: Mechanism,
    linkage: Linkage,
    crank_angle: ArrayLike,
    *,
    speed: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
) -> Cycle:
    """Return all curves of one fully rotating linkage at crank angles (n,), rad.

    speed, acceleration: crank speed and acceleration at each angle, rad/s and rad/s^2, (n,) or one value; by default
    those of the mechanism, along its profile if it has one. For several cylinders, the curves are those of one
    cylinder; see `multi_cylinder`. Where a load or friction jumps (exactly at a dead centre, or where the rod
    reverses), the value is one-sided: that of the inward stroke at a dead centre, that of counter-clockwise motion at
    zero speed. Torque and forces are NaN where friction locks the linkage (see `rubbing` for where they are
    undetermined). Raises `InputError` for arrays of linkages and for a linkage on another branch than the mechanism's.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.require(np.atleast_1d(crank_angle), np.float64, ["C", "W"])  # one compiled kernel serves all
    mechanism_motion = crank_speed_and_acceleration(mechanism, angles)
    speeds, accelerations = (
        np.array(np.broadcast_to(np.asarray(default if argument is None else argument, dtype=np.float64), angles.shape))
        for argument, default in zip((speed, acceleration), mechanism_motion, strict=True)
    )
    if not (np.isfinite(angles).all() and np.isfinite(speeds).all() and np.isfinite(accelerations).all()):
        raise InputError("crank angles, speeds and accelerations must be finite")
    return cycle_at_speeds(mechanism, linkage, angles, speeds, accelerations)


def cycle_at_speeds(
    mechanism: Mechanism, linkage: Linkage, angles: Array, speeds: Array, accelerations: Array
) -> Cycle:
    """Return the curves of one linkage, which need not rotate fully but must close at all crank angles (n,)."""
    if cycle_turns(mechanism) > 1:
        return _cycle_of_two_turns(mechanism, linkage, angles, speeds, accelerations)
    out = np.empty((_COLUMNS, len(angles)))
    watch, loads = CycleWindow(0, 0.0, 1.0, False), load_structure(mechanism)
    at, w, a = (np.require(values, np.float64, ["C", "W"]) for values in (angles, speeds, accelerations))
    block = _derived_block(mechanism, linkage).copy()  # the kernel sets the speed at each angle
    _fill_cycle_curves(block, loads, watch, at, w, a, out, needs_friction_kernel(mechanism))
    return Cycle(angles, *out)


def _cycle_of_two_turns(
    mechanism: Mechanism, linkage: Linkage, angles: Array, speeds: Array, accelerations: Array
) -> Cycle:
    """Return the curves over a cycle of two turns, each angle from the machine of its own turn."""
    turn = half_of_cycle_at(mechanism, *linkage.dead_centre_angles, angles)
    parts = [cycle_at_speeds(half, linkage, angles, speeds, accelerations) for half in machines_of_turns(mechanism)]
    return Cycle(*(np.where(turn == 0, *(getattr(part, field.name) for part in parts)) for field in fields(Cycle)))


def derived_design(mechanism: Mechanism, linkage: Linkage) -> Design:
    """Return one linkage's numbers for the equations of motion; missing dead centres are NaN."""
    design: Design = design_at(_derived_block(mechanism, linkage), 0)
    return design


def kinks_of_loads(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the crank angles (k,) of one fully rotating linkage at which a load has kinks or jumps."""
    require_one_turn(mechanism, "a swing")
    loads = load_structure(mechanism)
    block = _derived_block(mechanism, linkage).copy()
    block[_SPEED] = 0.0  # valves open in both senses of rotation
    cuts = breakpoints_of(block[None], loads, cycle_window(mechanism, Signal.TORQUE), rubbing=False)
    return cuts.angle[0, : cuts.many[0]]


def _derived_block(mechanism: Mechanism, linkage: Linkage) -> Table:
    return _derived_blocks(mechanism, np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64))


@memoise_by_batch  # searches along one linkage's curves call this a thousand times
def _derived_blocks(mechanism: Mechanism, design: Array) -> Table:
    raw = raw_vector(mechanism)
    raw[:3] = design[0]
    block: Table = derived_blocks(raw, load_structure(mechanism))[0][0]
    block.flags.writeable = False
    return block


def breakpoints(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the crank angles (k,) in [0, 2 pi), rad, of possible jumps and kinks in torque and forces.

    There is at least one; in between, every curve is smooth. For a cycle of two turns, the angles are in [0, 4 pi).
    Raises `InputError` where friction locks the linkage.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    if cycle_turns(mechanism) > 1:
        angles = np.concatenate([breakpoints(half, linkage) for half in machines_of_turns(mechanism)])
        return np.unique(np.concatenate([angles, angles + TURN]))
    raw, loads = raw_vector(mechanism), load_structure(mechanism)
    raw[:3] = linkage.crank, linkage.rod, linkage.offset
    require_no_locking(mechanism.friction, linkage)
    watch = cycle_window(mechanism, Signal.TORQUE)
    cuts = breakpoints_of(derived_blocks(raw, loads)[0], loads, watch, rubbing=needs_friction_kernel(mechanism))
    return cuts.angle[0, : cuts.many[0]]


_PIECES = 8  # minimum number of panels between two breakpoints
_SAMPLES = 720
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Energies:
    """Energies over one cycle of one or two turns, J. useful: work done against the load, negative if the load drives.

    throughput: integral of |F dx|, used to judge whether the useful work exceeds rounding errors.
    """

    input: float
    useful: float
    stored: float
    guide_heat: float
    crank_pivot_heat: float
    crank_pin_heat: float
    slider_pin_heat: float
    throughput: float

    @property
    def heat(self) -> float:
        """Friction heat in all joints, J."""
        return self.guide_heat + self.crank_pivot_heat + self.crank_pin_heat + self.slider_pin_heat

    @property
    def efficiency(self) -> float | None:
        """Work output divided by work input; None if the load neither absorbs nor supplies net work.

        If the crank drives, the input is useful work plus friction heat. If the load drives, the input is the work of
        the load and the output is the work that the crank delivers after friction, at least 0.
        """
        if abs(self.useful) <= _ROUNDING * self.throughput:
            return None
        net = self.useful + self.heat
        return self.useful / net if self.useful > 0.0 else max(0.0, net / self.useful)


def cycle_energies(mechanism: Mechanism, linkage: Linkage) -> Energies:
    """Return the energies over one cycle for one linkage.

    Raises `InputError` where friction locks the linkage, `AssemblyError` where it does not rotate fully.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    cuts = breakpoints(mechanism, linkage)
    dimensions = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    kappa = crowding_parameter(*map(float, dimensions[0]))
    turn = 1.0 if mechanism.speed >= 0.0 else -1.0
    friction = mechanism.friction

    def energy_rates(tau: Array) -> Array:
        """Return all integrands (k, n) over the crowded angle."""
        theta = np.array([crank_angle_from_crowded(angle, kappa) for angle in tau])
        weight = kappa / (np.cos(tau) ** 2 + (kappa * np.sin(tau)) ** 2)
        curves = cycle(mechanism, linkage, theta)
        motion = linkage.at(theta, speed=1.0)
        work = -linkage.sign * curves.load * motion.slider_velocity - curves.crank_load
        swing = motion.rod_velocity
        integrands: Array = weight * np.stack(
            [
                turn * curves.torque,
                turn * work,
                friction.guide * np.abs(curves.guide * motion.slider_velocity),
                friction.crank_pivot.friction_circle_radius * np.hypot(curves.pivot_x, curves.pivot_y),
                friction.crank_pin.friction_circle_radius
                * np.hypot(curves.crank_pin_x, curves.crank_pin_y)
                * (1.0 - swing),
                friction.slider_pin.friction_circle_radius
                * np.hypot(curves.slider_pin_x, curves.slider_pin_y)
                * np.abs(swing),
                np.abs(work),
            ]
        )
        return integrands

    turns = cycle_turns(mechanism)
    edges = [crowded_from_crank_angle(float(angle), kappa) for angle in (*cuts, cuts[0] + turns * TURN)]
    ends = np.concatenate([edges[:1], *(np.linspace(a, b, 1 + _PIECES)[1:] for a, b in pairwise(edges))])
    sizes = np.abs(energy_rates(np.linspace(edges[0], edges[-1], _SAMPLES))).max(axis=1)
    panels = resolve_curves(energy_rates, ends, np.where(sizes > 0.0, sizes, 1.0))
    drive_work, useful, guide, pivot, crank_pin, slider_pin, throughput = map(panels.integral, range(len(sizes)))
    inertia = signal_averages(mechanism, Signal.REFLECTED_INERTIA, dimensions).mean[0]
    stored = turn * turns * TURN * mechanism.acceleration * float(inertia)
    return Energies(drive_work, useful, stored, guide, pivot, crank_pin, slider_pin, throughput)
