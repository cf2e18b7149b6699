"""Motion of a linkage with a loose joint over many crank turns, in time."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..arrays import Array, Mask
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.cylinders_and_turns import require_single_cylinder_at_constant_speed
from ..machine.links_and_joints import Clearance, require_frictionless
from ..machine.mechanism import Mechanism
from .equations import reported_quantities
from .phases import FLIGHT, Integrator, Trace, build_system

Status = Literal["done", "cancelled"]


@dataclass(frozen=True)
class ClearanceProgress:
    """Progress after a crank turn. cycle, cycles: number of this turn, and of all turns. impacts, seconds: so far."""

    cycle: int
    cycles: int
    impacts: int
    seconds: float


@dataclass(frozen=True)
class ClearanceRun:
    """Motion of a linkage with a loose joint at the samples of the integration, (n,) each, SI and radians.

    times: times from zero, s, not equidistant; repeated where contact begins or ends. crank_angle: angle from the
    start, not wrapped. ideal_*: the same linkage without clearance. contact_force: normal force in the joint, N.
    friction_force: tangential force on the journal, counter-clockwise positive. penetration: m, negative in flight.
    journal_x, journal_y: centre of the journal relative to that of the bearing, m. in_contact: whether they touch.
    torque: torque on the crank, N m. input_work, load_work, dissipated: energy since the start, J, from the drive, from
    the loads on the slider, and lost in the contact. stored: kinetic, potential and elastic energy, J. impact_times,
    impact_speeds: at every start of a contact, (k,). cycles: completed turns; status says whether these are all.
    discard: initial turns that the statistics exclude.
    """

    mechanism: Mechanism
    linkage: Linkage
    clearance: Clearance
    status: Status
    cycles: int
    discard: int
    times: Array
    crank_angle: Array
    slider_position: Array
    slider_velocity: Array
    slider_acceleration: Array
    ideal_position: Array
    ideal_velocity: Array
    ideal_acceleration: Array
    contact_force: Array
    friction_force: Array
    penetration: Array
    journal_x: Array
    journal_y: Array
    in_contact: Mask
    torque: Array
    input_work: Array
    load_work: Array
    dissipated: Array
    stored: Array
    impact_times: Array
    impact_speeds: Array

    @property
    def turn_time(self) -> float:
        """Time for one crank turn, s."""
        return 2.0 * math.pi / abs(self.mechanism.speed)

    @property
    def energy_residual(self) -> Array:
        """Energy stored since the start, less the work of drive and loads, plus dissipated energy, J: zero if exact."""
        residual: Array = (self.stored - self.stored[0]) - self.input_work - self.load_work + self.dissipated
        return residual


def simulate(
    mechanism: Mechanism,
    linkage: Linkage,
    clearance: Clearance,
    *,
    cycles: int = 12,
    discard: int = 4,
    tolerance: float = 1e-7,
    progress: Callable[[ClearanceProgress], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ClearanceRun:
    """Return the motion over a number of crank turns at the mechanism's constant speed.

    It starts at crank angle zero with the motion of the ideal linkage and the journal centred in its bearing. This
    start is in free flight, so the first turns (`discard`) contain the initial transient. If the crank pivot is loose,
    the crank is turned by a coupling that yields only sideways. Loads act at the slider's actual position and velocity.
    The crank angle determines the stroke, so a load that opposes the motion is a prescribed force rather than friction.
    The counterweight belongs to the mechanism.

    tolerance: relative tolerance of an integration step (see `Integrator`). progress: function called after every turn.
    cancelled: function called every few steps; if it returns true, the motion so far is returned with status
    "cancelled". Raises the errors of `phases.build_system`, `InputError` for a crank at rest or if no turns remain, and
    `SlidercrankError` for a contact that is too soft to contain the journal.
    """
    _require_simulable(mechanism, cycles, discard, tolerance)
    began = time.perf_counter()
    linkage = require_single_rotating_linkage(mechanism, linkage)
    # With the motion of the ideal linkage: zero gap and zero gap velocity.
    integrator = Integrator(
        *build_system(mechanism, linkage, clearance),
        hysteresis=clearance.hysteresis,
        slow_impact=clearance.slow_impact,
        tolerance=tolerance,
        state=np.zeros(7),
    )
    period = 2.0 * math.pi / abs(mechanism.speed)
    # Fractions of a turn at which the crank passes the dead centres.
    turn, way = 2.0 * math.pi, math.copysign(1.0, mechanism.speed)
    dead_centres = sorted(float(angle * way % turn) / turn for angle in linkage.dead_centre_angles)
    turns_made = 0
    while turns_made < cycles:
        ends = [(turns_made + share) * period for share in (*dead_centres, 1.0)]
        reached = all(
            integrator.integrate_until(
                end, outward=_moves_outward(linkage, mechanism.speed, before, end), cancelled=cancelled
            )
            for before, end in zip([turns_made * period, *ends], ends, strict=False)
        )
        if not reached:
            break
        turns_made += 1
        if progress is not None:
            impacts = len(integrator.trace.impact_times)
            progress(ClearanceProgress(turns_made, cycles, impacts, time.perf_counter() - began))
        if turns_made < cycles and cancelled is not None and cancelled():
            break
    return _collect_run(mechanism, linkage, clearance, integrator, turns_made, cycles, discard)


def _require_simulable(mechanism: Mechanism, cycles: int, discard: int, tolerance: float) -> None:
    if not mechanism.speed:
        raise InputError("simulating a joint with clearance needs a crank speed; got none; add one")
    require_single_cylinder_at_constant_speed(mechanism, "the simulation of a joint with clearance")
    require_frictionless(mechanism.friction, "the simulation of a joint with clearance (with its own friction)")
    if not 0 <= discard < cycles:
        raise InputError(
            f"cycles must exceed discard, and discard must not be negative; got {cycles} and {discard}; add cycles"
        )
    if not 1e-13 <= tolerance <= 1e-3:
        raise InputError(f"tolerance must be from 1e-13 to 1e-3; got {tolerance:g}; 1e-7 is usual")


def _moves_outward(linkage: Linkage, speed: float, before: float, after: float) -> bool:
    """Whether the ideal slider moves outward between them."""
    middle = linkage.at(0.5 * (before + after) * speed, speed=speed)
    return bool(linkage.sign * middle.slider_velocity > 0.0)


def _collect_run(
    mechanism: Mechanism,
    linkage: Linkage,
    clearance: Clearance,
    integrator: Integrator,
    turns_made: int,
    cycles: int,
    discard: int,
) -> ClearanceRun:
    trace = integrator.trace if integrator.trace.times else _trace_at_start(integrator)
    times = np.concatenate(trace.times)
    states = np.ascontiguousarray(np.concatenate(trace.states, axis=1))
    rate, outward = np.concatenate(trace.rates), np.concatenate(trace.outward)
    observed = reported_quantities(times, states, rate, outward, integrator.system, integrator.block, integrator.loads)
    angle = mechanism.speed * times
    ideal = linkage.at(angle, speed=mechanism.speed)
    # With a loose crank pin, the gap points from the journal to the bearing (on the rod), else the reverse.
    side = -1.0 if clearance.joint == "crank pin" else 1.0
    return ClearanceRun(
        mechanism=mechanism,
        linkage=linkage,
        clearance=clearance,
        status="done" if turns_made == cycles else "cancelled",
        cycles=turns_made,
        discard=discard,
        times=times,
        crank_angle=angle,
        slider_position=observed[0],
        slider_velocity=observed[1],
        slider_acceleration=observed[2],
        ideal_position=ideal.slider_position,
        ideal_velocity=ideal.slider_velocity,
        ideal_acceleration=ideal.slider_acceleration,
        contact_force=observed[3],
        friction_force=observed[4],
        penetration=observed[5],
        journal_x=side * states[0],
        journal_y=side * states[1],
        in_contact=rate != FLIGHT,
        torque=observed[6],
        input_work=states[4],
        load_work=states[5],
        dissipated=states[6],
        stored=observed[7] + observed[8] + observed[9],
        impact_times=np.array(trace.impact_times),
        impact_speeds=np.array(trace.impact_speeds),
    )


def _trace_at_start(integrator: Integrator) -> Trace:
    """Return only the start, for a run cancelled immediately."""
    trace = Trace()
    trace.add_phase(np.zeros(1), integrator.state.reshape(-1, 1), FLIGHT, False)
    return trace
