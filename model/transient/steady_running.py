"""Steady running: the speed repeats after a turn. It is solved directly rather than by simulating until it settles."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.drive import Drive, speed_range
from ..machine.mechanism import Mechanism
from ..machine.work_absorption import may_do_work_over_a_turn
from ..quadrature import WEIGHTS
from .constant_torque_motion import (
    balanced_speed,
    cut_at_energy_minima,
    periodic_motion_by_energy_integral,
    refine_at_energy_minima,
)
from .crank_equation import TURN
from .crankshaft_equation import equation_of
from .forward_dynamics import drive_or_error
from .simulated_motion import MotorRun
from .steady_cycle import Guess, PeriodicTurn, Profile, Torque

_ROUNDING = 1e-13  # fraction of maximum torque times cycle angle: a smaller change in energy is a rounding error


@dataclass(frozen=True, kw_only=True)
class SteadyRunning(MotorRun):
    """One cycle of steady running, arrays (n,) in time order, SI and radians; extremes of the speed included.

    crank_angle: from the first breakpoint on, decreasing if the crank turns clockwise. mean_speed: 2 pi / period, with
    its sign. work: work of the motor per turn, J. inertia: inertia of flywheel and motor at the crank, kg m^2. memory:
    fraction of a small change in w^2 that remains after a turn (below 1: stable; 1: any speed persists, because nothing
    depends on it). turns: turns per cycle.
    """

    crank_angle: Array
    mean_speed: float
    work: float
    inertia: float
    memory: float
    turns: int = 1

    @property
    def period(self) -> float:
        """Time of a turn, s."""
        return TURN / abs(self.mean_speed)

    @property
    def fluctuation(self) -> float:
        """Coefficient of speed fluctuation: (maximum - minimum speed) / mean speed."""
        return float(self.speed.max() - self.speed.min()) / abs(self.mean_speed)


class Runner:
    """Steady running of one linkage, or of several cylinders, for any flywheel and motor."""

    def __init__(self, mechanism: Mechanism, linkage: Linkage) -> None:
        self.equation = equation_of(mechanism, linkage)
        dimensions = (float(linkage.crank), float(linkage.rod), float(linkage.offset))
        self.turn = PeriodicTurn(self.equation, dimensions)
        self.speed = abs(mechanism.speed)
        self.viscous = self.turn.depends_on_speed
        self.works = may_do_work_over_a_turn(replace(mechanism, acceleration=0.0))

    def run_under_drive(self, drive: Drive) -> SteadyRunning:
        """Return the steady running under a motor: see `steady_running`."""
        self.equation.require_inertia(drive.inertia)
        motor, guess = self._motor_torque(drive), self.balanced_speed(drive)
        solved = self.turn.solve_on_fine_panels(motor, drive.inertia, lambda turn: turn.constant_speed_guess(guess))
        if solved is None or not solved[1].memory < 1.0:
            raise InputError(
                f"steady running needs a crank that completes every turn; got none near {guess:.6g} rad/s, where "
                "motor and loads balance; add a flywheel or a stronger motor"
            )
        running = _steady_result(*solved, motor, drive.inertia)
        fastest = float(np.abs(running.speed).max())
        if not fastest <= speed_range(drive)[1]:
            raise InputError(
                "steady running needs a motor torque at every speed of the turn; got a crank speed of "
                f"{fastest:.6g} rad/s, beyond the torque table; extend the table"
            )
        return running

    def run_under_constant_torque(self, inertia: float) -> SteadyRunning:
        """Return the steady running under the constant torque that maintains the mechanism's speed as the mean.

        inertia: inertia of flywheel and motor at the crank, kg m^2. The torque is `motor_torque[0]` of the result.
        Raises `InputError` if the mechanism has no speed, or the crank nearly stops (see `least_and_greatest_speed`).
        """
        if not self.speed:
            raise InputError("finding a constant torque needs the mean speed; got none; add it")
        self.equation.require_inertia(inertia)

        def guess(turn: PeriodicTurn) -> Guess | None:
            coast = periodic_motion_by_energy_integral(turn, inertia, self.speed)
            if coast.guess is None or coast.stops:
                return turn.constant_speed_guess(self.speed) if self.viscous else None
            return coast.guess

        turn, solved = self.turn, None
        for finer in (cut_at_energy_minima, refine_at_energy_minima):
            turn = finer(turn, periodic_motion_by_energy_integral(turn, inertia, self.speed).load)
            solved = turn.solve_on_fine_panels(_zero_motor_torque, inertia, guess, mean_speed=self.speed)
            if solved is not None:
                break
        else:
            raise InputError(
                f"no constant torque was found that turns the crank at a mean speed of {self.speed:.6g} rad/s with "
                f"{inertia:.6g} kg m^2 in addition to the mechanism; add a flywheel or raise the speed"
            )
        turn, profile = solved
        if not self.works:  # cancelling terms leave rounding errors
            profile = replace(profile, added=0.0)
        return _steady_result(turn, profile, _zero_motor_torque, inertia)

    def least_and_greatest_speed(self, inertia: float) -> tuple[float, float]:
        """Return the minimum and maximum speed, rad/s, under the constant torque that maintains the mean speed.

        The minimum speed is 0 if the crank nearly stops: below a millionth of the maximum. inertia: see
        `run_under_constant_torque`. Raises `InputError` if the inertia is zero at some crank angle, so that speeds are
        undefined, or if no steady running is found with viscous loads or friction.
        """
        self.equation.require_inertia(inertia)
        try:
            running = self.run_under_constant_torque(inertia)
        except InputError:
            turn = cut_at_energy_minima(
                self.turn, periodic_motion_by_energy_integral(self.turn, inertia, self.speed).load
            )
            coast = periodic_motion_by_energy_integral(turn, inertia, self.speed)
            if self.viscous or coast.guess is None or not coast.stops:
                raise
            energy, start, added = coast.guess
            rate = turn.energy_slope_and_derivative(energy, _zero_motor_torque, inertia)[0] + added / (
                turn.terms.inertia + inertia
            )
            stopping = _steady_result(turn, Profile(energy, start, rate, added, 1.0), _zero_motor_torque, inertia)
            return 0.0, float(np.abs(stopping.speed).max())
        return float(np.abs(running.speed).min()), float(np.abs(running.speed).max())

    def balanced_speed(self, drive: Drive) -> float:
        """Return the magnitude of the constant speed, rad/s, at which motor and loads balance over a turn.

        Only a stable speed counts: at a higher speed the loads exceed the motor. Among several, the one closest to the
        mechanism's speed counts, or the lowest if that speed is 0. Raises `InputError` if there is none.
        """
        return balanced_speed(self.turn, drive, self._motor_torque(drive), self.speed)

    def energy_range_at_constant_speed(self, speed: float) -> float:
        """Return the range over a turn of the integral of mean T - T at constant speed, J. speed: magnitude, rad/s."""
        turn, pace = self.turn.with_panels_at_contact_changes(speed), np.array(self.turn.way * speed)
        torque = turn.terms.required_torque(pace, 0.0) + turn.friction_torque(pace, 0.0)
        starts, nodes = turn.running_integral(turn.mean(torque) - torque)
        change = float(max(starts.max(), nodes.max()) - min(starts.min(), nodes.min()))
        rounding = _ROUNDING * turn.equation.period * float(np.abs(torque).max())
        return change if change > rounding else 0.0

    def _motor_torque(self, drive: Drive) -> Torque:
        """Return the drive's torque; beyond a table it keeps the last value, so that an iteration may go there."""
        way, (slowest, fastest) = self.turn.way, speed_range(drive)

        def motor(speed: Array) -> tuple[Array, Array]:
            speed_in_range = way * np.clip(way * speed, slowest, fastest)
            slope = drive.gear_ratio**2 * drive.motor_torque_law.torque_slope(drive.gear_ratio * way * speed_in_range)
            return drive.torque_on_crank(speed_in_range, way), np.where(speed_in_range == speed, slope, 0.0)

        return motor


def _zero_motor_torque(speed: Array) -> tuple[Array, Array]:
    return np.zeros(np.shape(speed)), np.zeros(np.shape(speed))


def _steady_result(turn: PeriodicTurn, profile: Profile, motor: Torque, inertia: float) -> SteadyRunning:
    cycle_angle = turn.equation.period
    time_per_angle = turn.way / np.sqrt(2.0 * profile.energy)
    period = float(turn.width @ (time_per_angle @ WEIGHTS))
    angle, time, energy, acceleration = _curves_at_panel_points(turn, profile, time_per_angle, period)
    speed = turn.way * np.sqrt(2.0 * energy)
    torque = motor(speed)[0] + profile.added
    at_nodes = motor(turn.way * np.sqrt(2.0 * profile.energy))[0] + profile.added
    return SteadyRunning(
        crank_angle=angle,
        time=time,
        speed=speed,
        acceleration=acceleration,
        motor_torque=torque,
        torque=torque - inertia * acceleration,
        mean_speed=turn.way * cycle_angle / period,
        work=float(turn.width @ (at_nodes @ WEIGHTS)) * (TURN / cycle_angle),
        inertia=inertia,
        memory=profile.memory,
        turns=round(cycle_angle / TURN),
    )


def _curves_at_panel_points(turn: PeriodicTurn, profile: Profile, pace: Array, period: float) -> Array:
    """Return angle, time, E and its derivative at starts, nodes and extremes of all panels, (4, count), in order.

    The first point is repeated at the end, a cycle later.
    """
    times, node_times = turn.running_integral(pace)
    first_rates = turn.panel_edge_values(profile.rate)[:, 0]
    starts = np.stack([turn.low, times, profile.start, first_rates])
    nodes = np.stack([part.ravel() for part in (turn.angle, node_times, profile.energy, profile.rate)])
    extremes = np.array(
        [
            (
                turn.low[p] + place * turn.width[p],
                times[p] + turn.value_and_integral(pace, p, place)[1],
                profile.start[p] + turn.value_and_integral(profile.rate, p, place)[1],
                0.0,
            )
            for p, place, _ in turn.zero_crossings(profile.rate)
        ]
    ).reshape(-1, 4)
    points = np.concatenate([starts, nodes, extremes.T], axis=1)
    points = points[:, np.argsort(points[1], kind="stable")]
    end = points[:, :1] + np.array([[turn.way * turn.equation.period], [period], [0.0], [0.0]])
    return np.concatenate([points, end], axis=1)


def steady_running(mechanism: Mechanism, linkage: Linkage, drive: Drive | None = None) -> SteadyRunning:
    """Return the steady running under a motor, by default the mechanism's own drive.

    Among several (for a motor whose torque rises and falls with speed), the stable one closest to the mechanism's
    speed. Raises `InputError` if there is none: the motor is too weak, nothing limits the speed, or the torque table
    ends too soon.
    """
    return Runner(mechanism, linkage).run_under_drive(drive_or_error(mechanism, drive))
