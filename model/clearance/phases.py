"""Integration through flight and contact: each phase is smooth and ends at an exactly located event.

scipy's DOP853 takes the steps. Within a phase the right-hand side keeps its form: in flight there is no contact force;
in contact the initial impact speed is fixed. After every step the interpolant is checked at intermediate points, so
that no short contact is missed. The phase ends where the interpolant crosses the clearance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array, Mask
from ..errors import SlidercrankError
from .equations import STATES, System, state_rates

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

    system, block, loads: results of `system.build_system`. hysteresis, slow_impact: parameters of the clearance.
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
