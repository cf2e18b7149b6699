"""Result of a forward simulation: the motion over time, and the energy balance that checks it."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from ..arrays import Array
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.drive import Drive, speed_range
from ..machine.mechanism import Mechanism
from .crank_equation import TURN, Equation, Span

Verdict = Literal["time is up", "turns done", "steady", "stands still", "beyond the torque table", "cancelled"]

_SAID: dict[Verdict, str] = {
    "time is up": "the time limit was reached",
    "turns done": "all turns are complete",
    "steady": "it runs steadily: the speed repeats from turn to turn",
    "stands still": "it has stalled: the motor cannot overcome the load or friction here",
    "beyond the torque table": "the motor's torque is not known beyond its speed table",
    "cancelled": "cancelled",
}
assert set(_SAID) == set(get_args(Verdict))


@dataclass(frozen=True, kw_only=True)
class MotorRun:
    """Motion of a crank driven by a motor; arrays (n,) in time order, SI.

    motor_torque: motor torque on the crank, N m, counter-clockwise. torque: part that the mechanism absorbs; the
    flywheel and the rotor absorb the rest.
    """

    time: Array
    speed: Array
    acceleration: Array
    motor_torque: Array
    torque: Array


@dataclass(frozen=True, kw_only=True)
class Transient(MotorRun):
    """Motion of the crank over time, arrays (n,), SI and radians; points are denser where the crank turns fast.

    verdict: reason for the end. turned_back: times at which the crank reversed, s. angle: crank angle including full
    turns, rad. power: motor power, W. kinetic, potential: energies of
    mechanism and drive, and of gravity, J. motor_work, load_work: work since the start by the motor and on the loads,
    springs included, J. friction_work: heat from the joints since the start, J.
    """

    verdict: Verdict
    turned_back: tuple[float, ...]
    angle: Array
    power: Array
    slider_position: Array
    slider_velocity: Array
    slider_acceleration: Array
    kinetic: Array
    potential: Array
    motor_work: Array
    load_work: Array
    friction_work: Array

    @property
    def message(self) -> str:
        """The verdict in words, with its time."""
        return f"after {self.time[-1]:.4g} s and {self.turns:.4g} turns: {_SAID[self.verdict]}"

    @property
    def turns(self) -> float:
        """Turns made from start to end, negative clockwise."""
        return float(self.angle[-1] - self.angle[0]) / TURN

    @property
    def energy_balance_error(self) -> float:
        """Maximum energy balance error, as a fraction of the maximum energy or work; 0 if all are 0.

        Kinetic energy gained + potential energy gained - (work of the motor - work done on the loads - friction heat).
        """
        stored = self.kinetic - self.kinetic[0] + self.potential - self.potential[0]
        error = np.abs(stored - self.motor_work + self.load_work + self.friction_work).max()
        parts = (self.kinetic, self.potential - self.potential[0], self.motor_work, self.load_work, self.friction_work)
        size = max(float(np.abs(part).max()) for part in parts)
        return float(error) / size if size > 0.0 else 0.0

    def last_turn(self) -> slice | None:
        """Return which points belong to the last whole turn; None if the crank did not make one without reversing."""
        back = np.abs(self.angle - self.angle[-1]) >= TURN * (1.0 - 1e-12)
        if not back.any():
            return None
        first = int(np.flatnonzero(back)[-1])
        speeds = self.speed[first:]
        return slice(first, None) if np.all(speeds > 0.0) or np.all(speeds < 0.0) else None

    def fluctuation(self) -> float | None:
        """Return (maximum - minimum speed) / mean speed over the last whole turn; None if there is no such turn.

        The mean is over time, 2 pi / period. Extremes are those at the points; more samples are more accurate.
        """
        turn = self.last_turn()
        if turn is None:
            return None
        speeds, times = np.abs(self.speed[turn]), self.time[turn]
        mean = abs(float(self.angle[-1] - self.angle[turn][0])) / float(times[-1] - times[0])
        return float(speeds.max() - speeds.min()) / mean


class Recorder:
    """Collects the points of a simulation, stretch by stretch."""

    def __init__(self, equation: Equation, drive: Drive, linkage: Linkage, mechanism: Mechanism, samples: int) -> None:
        self._equation, self._drive, self._samples = equation, drive, samples
        self._linkage = require_single_rotating_linkage(mechanism, linkage)
        self._parts: list[Array] = []

    def add_solution(self, stretch: Span, turn: int, solution: Any) -> None:
        """Add the solution within a stretch; add its first point only if it is the very first."""
        count = np.ceil(np.abs(np.diff(solution.y[0])) * (self._samples / TURN)).astype(int)
        times = [
            np.linspace(start, end, max(1, inner), endpoint=False)
            for start, end, inner in zip(solution.t[:-1], solution.t[1:], count, strict=True)
        ]
        time = np.append(np.concatenate(times), solution.t[-1])[1 if self._parts else 0 :]
        self._append_points(stretch, turn, time, solution.sol(time))

    def add_single_state(self, stretch: Span, turn: int, time: float, y: Array) -> None:
        """Add a single state if there is no other."""
        if not self._parts:
            self._append_points(stretch, turn, np.array([time]), y[:, None], moving=0.0)

    def _append_points(self, stretch: Span, turn: int, time: Array, y: Array, *, moving: float = 1.0) -> None:
        local, speed, motor_work, load_work, *heat = y
        terms, added = stretch.terms_at(np.ascontiguousarray(local)), self._drive.inertia
        direction = self._equation.direction
        speed_in_range = np.clip(direction * speed, *speed_range(self._drive))
        motor = self._drive.torque_on_crank(direction * speed_in_range, direction)
        acceleration = moving * (motor - terms.required_torque(speed, 0.0)) / (terms.inertia + added)
        torque = terms.required_torque(speed, acceleration)
        if self._equation.rubs:
            if moving:
                motion = np.ascontiguousarray(local), np.ascontiguousarray(speed), motor, added
                acceleration, _ = stretch.solve_acceleration(*motion, acceleration)
            torque = motor - added * acceleration
        slider = self._linkage.at(local + self._equation.lead, speed=speed, acceleration=acceleration)
        self._parts.append(
            np.array(
                [
                    time,
                    speed,
                    acceleration,
                    motor,
                    torque,
                    local + self._equation.period * turn,
                    motor * speed,
                    slider.slider_position,
                    slider.slider_velocity,
                    slider.slider_acceleration,
                    0.5 * (self._equation.moving_inertia(local) + added) * speed**2,
                    self._equation.gravity_energy(local),
                    motor_work,
                    load_work,
                    heat[0] if heat else np.zeros(len(time)),
                ]
            )
        )

    def result(self, verdict: Verdict, turned_back: tuple[float, ...]) -> Transient:
        """Return all points."""
        names = [name for name in Transient.__dataclass_fields__ if name not in ("verdict", "turned_back")]
        columns = dict(zip(names, np.concatenate(self._parts, axis=1), strict=True))
        return Transient(verdict=verdict, turned_back=turned_back, **columns)
