"""A motion law by direct collocation in time (casadi, IPOPT), from its own equations of motion.

The cycle is two strokes of free duration, so that loads that change with the stroke are smooth in each. A stroke has
equal intervals with Radau points of degree 3; at each the torque is free. Kinetic energy and heights of the bodies are
written here again, for links that are point masses and inertias, and differentiated by casadi.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

casadi: Any = pytest.importorskip("casadi")

DEGREE = 3


@dataclass(frozen=True)
class Plain:
    """A slider-crank in plain SI numbers: point-mass rod, forces by stroke, a spring."""

    crank: float
    rod: float
    offset: float
    speed: float
    inertia: float
    rod_mass: float
    rod_centre: float
    rod_inertia: float
    slider: float
    gravity: float
    outward: float
    inward: float
    stiffness: float
    free: float

    def functions(self) -> Any:
        """Return J, J', the torque against gravity and spring, and x' as functions of the crank angle."""
        theta = casadi.SX.sym("theta")
        along = casadi.sqrt(self.rod**2 - (self.offset - self.crank * casadi.sin(theta)) ** 2)
        pin = casadi.vertcat(self.crank * casadi.cos(theta), self.crank * casadi.sin(theta))
        slider = casadi.vertcat(pin[0] + along, self.offset)
        centre = pin + self.rod_centre * (slider - pin)
        turn = casadi.jacobian(casadi.atan2(slider[1] - pin[1], along), theta)
        travel = casadi.jacobian(slider[0], theta)
        moved = casadi.jacobian(centre, theta)
        inertia = (
            self.inertia
            + self.rod_mass * casadi.dot(moved, moved)
            + self.rod_inertia * turn**2
            + self.slider * travel**2
        )
        height = self.gravity * self.rod_mass * centre[1] + 0.5 * self.stiffness * (slider[0] - self.free) ** 2
        pair = [casadi.jacobian(inertia, theta), casadi.jacobian(height, theta)]
        return tuple(casadi.Function("f", [theta], [value]) for value in (inertia, *pair, travel))


def best_by_collocation(
    machine: Plain,
    dead_centres: tuple[float, float],
    *,
    objective: str,
    cycle_time: float,
    least: float,
    greatest: float,
    torque_limit: float | None = None,
    intervals: int = 24,
) -> float:
    """Return peak torque, RMS torque or cycle time of the best law that IPOPT finds, started at constant speed.

    dead_centres: inner and outer one, rad. least, greatest: crank speed, rad/s. intervals: of a stroke.
    """
    count = DEGREE * intervals
    inertia, slope, held, travel = (function.map(count) for function in machine.functions())
    way = 1.0 if machine.speed > 0.0 else -1.0
    points = casadi.collocation_points(DEGREE, "radau")
    derivative, _, weights = casadi.collocation_coeff(points)
    each = casadi.DM.eye(intervals)
    by_start, by_inside = casadi.kron(each, derivative[0, :]), casadi.kron(each, derivative[1:, :])
    places = (np.arange(intervals)[:, None] + np.array(points)).ravel() / intervals
    opti = casadi.Opti()
    mean = 2.0 * np.pi / cycle_time
    size = max(1.0, abs(machine.outward) * machine.crank)
    inner, outer = dead_centres
    first = (outer - inner) * way % (2.0 * np.pi)  # passed in the outward stroke
    peak, squares, total = opti.variable(), 0.0, 0.0
    begin = opti.variable()
    speed_at_start, phi = begin, 0.0
    opti.set_initial(begin, 1.0)
    for passed, force in ((first, machine.outward), (2.0 * np.pi - first, machine.inward)):
        duration = opti.variable()
        opti.set_initial(duration, passed / (2.0 * np.pi))
        opti.subject_to(duration >= 0.02)
        step = duration * cycle_time / intervals
        inside, torque = opti.variable(2, count), opti.variable(1, count)
        opti.set_initial(inside[0, :], phi + passed * places)
        opti.set_initial(inside[1, :], 1.0)
        starts = casadi.horzcat(casadi.vertcat(phi, speed_at_start), inside[:, DEGREE - 1 : -1 : DEGREE])
        rates = starts @ by_start + inside @ by_inside
        theta, speed = inner + way * inside[0, :], inside[1, :] * mean
        load = way * held(theta) - way * force * travel(theta)
        gain = (torque * size - load - 0.5 * way * slope(theta) * speed**2) / inertia(theta)
        opti.subject_to(step * speed.T == rates[0, :].T)
        opti.subject_to(step * gain.T == rates[1, :].T * mean)
        squares += step * ((torque**2) @ casadi.repmat(weights, intervals, 1))
        opti.subject_to(opti.bounded(least / mean, inside[1, :].T, greatest / mean))
        bound = peak if torque_limit is None else torque_limit / size
        opti.subject_to(bound >= torque.T)
        opti.subject_to(-bound <= torque.T)
        state = inside[:, -1]
        phi += passed
        opti.subject_to(state[0] == phi)
        speed_at_start = state[1]
        total += duration
    opti.subject_to(speed_at_start == begin)
    if objective != "cycle time":
        opti.subject_to(total == 1.0)
    opti.set_initial(peak, 1.0)
    opti.subject_to(peak >= 0.0)
    goals = {"peak torque": peak, "rms torque": squares / cycle_time + 1e-9 * peak, "cycle time": total + 1e-9 * peak}
    opti.minimize(goals[objective])
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "tol": 1e-8, "max_iter": 1000})
    solved = opti.solve()
    if objective == "peak torque":
        return float(solved.value(peak)) * size
    if objective == "rms torque":
        return float(np.sqrt(solved.value(squares / cycle_time))) * size
    return float(solved.value(total)) * cycle_time
