"""Integration through flight and contact: each phase is smooth and ends at an exactly located event.

scipy's DOP853 takes the steps. Within a phase the right-hand side keeps its form: in flight there is no contact force;
in contact the initial impact speed is fixed. After every step the interpolant is checked at intermediate points, so
that no short contact is missed. The phase ends where the interpolant crosses the clearance.

`build_system` takes the parameters from the mechanism and rejects machines that cannot be simulated.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array, Mask
from ..errors import InputError, SlidercrankError
from ..linkage.linkage import Linkage
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.links_and_joints import Clearance
from ..machine.loads.crank_torque import require_no_crank_load
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads, Raw, load_structure, raw_vector
from .equations import STATES, System, state_rates


def build_system(
    mechanism: Mechanism, linkage: Linkage, clearance: Clearance, *, start: float = 0.0
) -> tuple[System, Array, Loads]:
    """Return the system, its derived block and the structure of its loads. start: crank angle at time zero, rad.

    Raises `InputError` for an accelerating crank, for masses that leave the motion undetermined, and for a clearance
    that would let the linkage fold over to its other branch; `AssemblyError` unless the linkage rotates fully.
    """
    _require_simulable(mechanism, linkage, clearance)
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    raw = raw_vector(mechanism)
    raw[:3] = r, l, e
    # Loads take the slider velocity as velocity per radian times speed; with unit speed they can use it directly.
    raw[Raw.SPEED] = 1.0
    loads = load_structure(mechanism)
    block = derived_blocks(raw, loads)[0][0]
    d = design_at(block, 0)
    crank_first = complex(d.crank_along, d.crank_across)
    rod_first = l * complex(d.rod_along, d.rod_across)
    # Mass centres; zero for a massless link, which has no mass centre and needs none.
    c = crank_first / d.crank_mass if d.crank_mass else 0.0j
    s = rod_first / d.rod_mass if d.rod_mass else 0.0j
    spin_crank = d.crank_inertia - d.crank_mass * abs(c) ** 2
    spin_rod = d.rod_inertia - d.rod_mass * abs(s) ** 2
    pivot, slider = clearance.joint == "crank pivot", clearance.joint == "slider pin"
    k = np.array([1.0 if pivot else 0.0, 0.0 if slider else 1.0, 1.0])
    a = np.array([-l if pivot else 0.0, s if slider else s - l, 0.0], dtype=complex)
    b = np.array([c - r if pivot else c, r if slider else 0.0, 0.0], dtype=complex)
    m = np.array([d.crank_mass, d.rod_mass, d.slider_mass])
    system = System(
        r=r,
        l=l,
        e=e,
        branch=float(d.branch),
        speed=float(mechanism.speed),
        start=start,
        gravity=complex(*mechanism.gravity),
        clearance=clearance.radius,
        bearing_radius=clearance.bearing_radius,
        stiffness=clearance.contact_stiffness,
        friction=clearance.friction,
        slip_speed=clearance.slip_speed,
        journal_turns=0.0 if slider else 1.0,
        bearing_turns=0.0 if pivot else 1.0,
        m_xx=float(k @ m),
        m_x_rod=complex((k * m) @ a),
        m_x_crank=complex((k * m) @ b),
        m_rod=float(m @ np.abs(a) ** 2 + spin_rod),
        m_crank=float(m @ np.abs(b) ** 2 + spin_crank),
        m_rod_crank=complex((m * a) @ b.conj()),
        first_rod=complex(m @ a),
        first_crank=complex(m @ b),
    )
    # Effective inertia of the rod once the slider yields, at the rod angle with the strongest coupling.
    if system.m_xx * system.m_rod <= (1.0 + 1e-9) * abs(system.m_x_rod) ** 2:
        raise InputError(
            f"rod and slider need masses to simulate clearance in the {clearance.joint}; got a rod of "
            f"{d.rod_mass:g} kg and a slider of {d.slider_mass:g} kg; give both a mass"
        )
    return system, block, loads


def _require_simulable(mechanism: Mechanism, linkage: Linkage, clearance: Clearance) -> None:
    """Raise the errors of `build_system`, except those about masses."""
    linkage.require_full_rotation()
    if mechanism.acceleration:
        raise InputError(
            "a joint with clearance needs a crank at constant speed; got an acceleration of "
            f"{mechanism.acceleration:g} rad/s^2; set it to zero"
        )
    require_no_crank_load(mechanism, "a simulation of clearance")
    for load in mechanism.loads:
        if load.is_moving_mass:
            raise InputError(
                f"a simulation of clearance accepts only forces on the slider; got {load.magnitude_text}; "
                "add that mass to the slider's, or leave that load out"
            )
    rod_margin = float(linkage.rod - linkage.crank - abs(linkage.offset))
    if clearance.radius >= 0.5 * rod_margin:
        raise InputError(
            "a clearance must be less than half of rod - crank - |offset|, or the rod could fold over; "
            f"got {1e3 * clearance.radius:g} mm and {1e3 * rod_margin:g} mm; lengthen the rod or reduce the clearance"
        )


BETWEEN = 4
"""Samples per integrator step; a vibration of the contact takes at least six steps."""
FLIGHT = -1.0
"""Value that marks flight in place of a contact's damping rate."""
_STEPS_PER_TURN = 180
_ASK = 64


@dataclass
class Trace:
    """Results of an integration in pieces: times, states (7, n), damping rates, strokes; times and speeds of impacts.

    A time appears twice where one phase ends and the next begins.
    """

    times: list[Array] = field(default_factory=list)
    states: list[Array] = field(default_factory=list)
    rates: list[Array] = field(default_factory=list)
    outward: list[Mask] = field(default_factory=list)
    impact_times: list[float] = field(default_factory=list)
    impact_speeds: list[float] = field(default_factory=list)

    def add_phase(self, times: Array, states: Array, rate: float, outward: bool) -> None:
        """Append the samples of one phase."""
        self.times.append(times)
        self.states.append(states)
        self.rates.append(np.full(len(times), rate))
        self.outward.append(np.full(len(times), outward))


@dataclass
class Integrator:
    """Time integration of one linkage.

    system, block, loads: results of `build_system`. hysteresis, slow_impact: parameters of the clearance.
    tolerance: relative error of a step in gap and gap velocity; the absolute tolerance relates to the clearance and to
    the speed of a slow impact. time, state (7,), rate: current values. trace: past values.
    """

    system: System
    block: Array
    loads: Any
    hysteresis: float
    slow_impact: float
    tolerance: float
    state: Array
    time: float = 0.0
    rate: float = FLIGHT
    trace: Trace = field(default_factory=Trace)

    def integrate_until(self, end: float, *, outward: bool, cancelled: Callable[[], bool] | None = None) -> bool:
        """Integrate up to a time; return whether it was reached: False if cancelled before.

        outward: whether it is the outward stroke, which determines the loads. Raises `SlidercrankError` if the
        integrator finds no sufficiently small step, or if the contact is too soft to contain the journal.
        """
        while self.time < end:
            if not self._integrate_phase(end, outward, cancelled):
                return False
        return True

    def _integrate_phase(self, end: float, outward: bool, cancelled: Callable[[], bool] | None) -> bool:
        from scipy.integrate import DOP853

        fixed = (self.system, self.block, self.loads)
        rate, sign = self.rate, 1.0 if self.rate == FLIGHT else -1.0
        turn = 2.0 * math.pi / abs(self.system.speed) if self.system.speed else math.inf
        # The integrals follow the motion; they do not control the step size.
        allowed = np.full(STATES, math.inf)
        allowed[:2] = self.tolerance * self.system.clearance
        allowed[2:4] = self.tolerance * self.slow_impact
        solver = DOP853(
            lambda t, y: state_rates(t, y, rate, outward, *fixed),
            self.time,
            self.state,
            end,
            rtol=max(self.tolerance, 3e-14),
            atol=allowed,  # type: ignore[arg-type]  # scipy takes one for each state; its stubs do not know
            max_step=min(turn / _STEPS_PER_TURN, end - self.time),
        )
        steps = 0
        while solver.status == "running":
            steps += 1
            if cancelled is not None and steps % _ASK == 0 and cancelled():
                return False
            if solver.step() is not None:
                raise SlidercrankError(
                    f"the time steps must not fall below rounding error; they did at {solver.t:g} s; loosen the "
                    "tolerance or soften the contact"
                )
            interpolate = solver.dense_output()
            times = np.linspace(solver.t_old, solver.t, BETWEEN + 1)
            states = interpolate(times)
            depth = self._penetration(states[:, 1:])
            if not depth.max() < self.system.bearing_radius:
                raise SlidercrankError(
                    "the contact must hold the journal in its bearing; got a penetration beyond the bearing radius "
                    f"of {1e3 * self.system.bearing_radius:g} mm, with a stiffness of {self.system.stiffness:g} "
                    "N/m^1.5; stiffen the contact"
                )
            crossed = np.flatnonzero(sign * depth > 0.0)
            if len(crossed):
                self._switch_phase(interpolate, times[crossed[0]], times[crossed[0] + 1], sign)
                count = crossed[0] + 1
                times = np.append(times[:count], self.time)
                states = np.column_stack([states[:, :count], self.state])
                self.trace.add_phase(times, states, rate, outward)
                return True
            self.time, self.state = float(solver.t), states[:, -1]
            self.trace.add_phase(times, states, rate, outward)
        return True

    def _penetration(self, states: Array) -> Array:
        depth: Array = np.hypot(states[0], states[1]) - self.system.clearance
        return depth

    def _switch_phase(self, interpolate: Callable[[float], Array], before: float, after: float, sign: float) -> None:
        """Integrate to where the gap crosses the clearance between two times, then switch to the other phase."""
        from scipy.optimize import brentq

        def excess_depth(time: float) -> float:
            return sign * float(self._penetration(interpolate(time)))

        time = (
            float(brentq(excess_depth, before, after, xtol=1e-300, rtol=1e-15))
            if excess_depth(before) < 0.0
            else before
        )
        # At least a rounding error beyond it, so that the next phase begins on its own side.
        step = float(np.spacing(time))
        while time < after and excess_depth(time) <= 0.0:
            time = min(time + step, after)
            step *= 2.0
        self.time, self.state = time, interpolate(time)
        if self.rate != FLIGHT:
            self.rate = FLIGHT
            return
        x, y, x_t, y_t = self.state[:4]
        speed = (x * x_t + y * y_t) / math.hypot(x, y)
        self.rate = self.hysteresis / max(speed, self.slow_impact)
        self.trace.impact_times.append(time)
        self.trace.impact_speeds.append(speed)
