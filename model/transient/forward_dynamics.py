"""Forward dynamics: how the crank moves under a motor and the loads, from rest or from a given state.

    J(theta) theta'' + J'(theta) theta'^2 / 2 + C(theta) + D(theta) theta' = T_motor(theta'),

J includes the drive's inertia; with friction in the joints, `solve_acceleration` gives the acceleration. The equation
is integrated over time by an explicit Runge-Kutta method of order 8 (DOP853; Hairer, Norsett and Wanner, Solving
Ordinary Differential Equations I, 2nd ed. 1993, II.5), stretch by stretch. No step crosses a dead centre at which a
load changes, a knot of a table, or a standstill. The work of motor and loads, and the friction heat, are integrated
with it. Where a guide force changes sides, the acceleration has a kink rather than a jump: the step-size control
resolves it, as the energy balance confirms.

At standstill the loads for both directions of rotation are evaluated. The crank starts in the direction in which motor
and loads leave an accelerating torque. Otherwise it stays at rest, because motor and loads depend only on angle and
speed.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.cylinders_and_turns import cycle_turns
from ..machine.drive import Drive, speed_range
from ..machine.mechanism import Mechanism
from .crank_equation import NEAREST, TURN, Span
from .crankshaft_equation import equation_of
from .simulated_motion import Recorder, Transient, Verdict

_EPS = 1e-12


@dataclass(frozen=True, kw_only=True)
class State:
    """Crank angle, rad, and crank speed, rad/s, counter-clockwise."""

    angle: float = 0.0
    speed: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.angle) and math.isfinite(self.speed)):
            raise InputError(f"a state must be finite; got angle {self.angle:g} rad, speed {self.speed:g} rad/s")


@dataclass(frozen=True)
class Progress:
    """Progress of a simulation: time, s, of at most `duration`; turns made, backward turns negative; speed, rad/s."""

    time: float
    duration: float
    turns: float
    speed: float


Stop = Literal["edge", "standstill", "table", "time"]


def drive_or_error(mechanism: Mechanism, drive: Drive | None) -> Drive:
    """Return the drive, by default the mechanism's own. Raises `InputError` if there is no drive at all."""
    chosen = mechanism.drive if drive is None else drive
    if chosen is None:
        raise InputError("simulating a start or a run needs a motor; got a mechanism without a drive; add a [drive]")
    return chosen


def simulate(
    mechanism: Mechanism,
    linkage: Linkage,
    drive: Drive | None = None,
    *,
    duration: float,
    turns: int | None = None,
    steady: float | None = None,
    start: State = State(),
    tolerance: float = 1e-12,
    samples: int = 90,
    progress: Callable[[Progress], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Transient:
    """Return the motion of one fully rotating linkage under a motor.

    drive: motor and flywheel, by default those of the mechanism. The motor turns the crank in the direction given by
    the sign of the mechanism's speed. Several cylinders move as one shaft. In a two-turn cycle, angles below 360 deg
    belong to the first turn. duration: time limit, s. turns: number of turns, in either direction, after which the
    motion ends. steady: relative change in speed over a cycle below which the motion ends. tolerance: relative
    tolerance of the integration. samples: minimum number of points per turn in the result. progress: function called
    after every stretch. cancelled: function called as often; if it returns true, the motion so far is returned.

    The result's `verdict` says why the motion ended. Raises `InputError` for values out of range and if nothing resists
    an acceleration, `AssemblyError` if the linkage does not rotate fully.
    """
    drive = drive_or_error(mechanism, drive)
    _require_options(duration, turns, steady, tolerance, samples)
    run = _Run(mechanism, linkage, drive, start, duration, tolerance, samples)
    before, passed = math.nan, 0
    while True:
        verdict = run.integrate_stretch()
        if progress is not None:
            progress(Progress(run.time, duration, (run.total_crank_angle - start.angle) / TURN, run.speed))
        if verdict is None and run.at_mark:
            full_turns = round((run.total_crank_angle - start.angle) / TURN)
            if turns is not None and abs(full_turns) >= turns:
                verdict = "turns done"
            if run.at_cycle:
                if verdict is None and steady is not None and full_turns != passed:
                    verdict = "steady" if abs(run.speed - before) <= steady * abs(run.speed) else None
                before, passed = run.speed, full_turns
        if verdict is None and cancelled is not None and cancelled():
            verdict = "cancelled"
        if verdict is not None:
            return run.result(verdict)


def _require_options(duration: float, turns: int | None, steady: float | None, tolerance: float, samples: int) -> None:
    if not 0.0 < duration < math.inf:
        raise InputError(f"the duration must be positive and finite; got {duration:g} s")
    if turns is not None and turns < 1:
        raise InputError(f"turns must be a whole number of at least 1; got {turns}")
    if steady is not None and not 0.0 < steady < 1.0:
        raise InputError(f"steady must be a fraction of the speed between 0 and 1, such as 1e-6; got {steady:g}")
    if not 1e-13 <= tolerance <= 1e-3:
        raise InputError(f"the tolerance must lie between 1e-13 and 1e-3; got {tolerance:g}")
    if samples < 8:
        raise InputError(f"samples must be at least 8 per turn; got {samples}")


class _Run:
    """A simulation in progress. The crank angle is kept within a cycle: `index` of the stretch, `local`, and `turn`.

    marks: breakpoints a whole number of turns from the start.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        linkage: Linkage,
        drive: Drive,
        start: State,
        duration: float,
        tolerance: float,
        samples: int,
    ) -> None:
        starts = tuple(start.angle + turn * TURN for turn in range(cycle_turns(mechanism)))
        self.equation = equation_of(mechanism, linkage, marks=starts)
        self.period = self.equation.period
        self.equation.require_inertia(drive.inertia)
        self.drive, self.duration, self.tolerance = drive, duration, tolerance
        self.slowest, self.fastest = sorted(self.equation.direction * end for end in speed_range(drive))
        breakpoints = self.equation.breakpoints
        first = float(breakpoints[0])
        self.local = first + (start.angle - first) % self.period
        self.turn = round((start.angle - self.local) / self.period)
        gaps = breakpoints - self.local - np.array([[0.0], [TURN]])
        marks = np.argmin(np.abs((gaps + math.pi) % self.period - math.pi), axis=1).tolist()
        self.index = self.mark = marks[0]  # the start is a breakpoint, or nearly one
        self.marks = {*marks}
        if self.local > first + self.period - 2.0 * NEAREST:
            self.turn, self.local = self.turn + 1, first
        self.time, self.speed, self.at_mark, self.at_cycle = 0.0, start.speed, True, True
        self.works = np.zeros(3 if self.equation.rubs else 2)
        self.turned_back: list[float] = []
        self.scale = self._speed_scale_for_errors(mechanism.speed)
        self.recorder = Recorder(self.equation, drive, linkage, mechanism, samples)
        self.way = math.copysign(1.0, start.speed) if start.speed else 0.0
        self.arrived = -self.equation.direction  # at rest, so that the motor's direction is tried first
        if not self.slowest <= self.speed <= self.fastest:
            raise InputError(
                f"the motor's torque must be known at the start; got a crank speed of {start.speed:g} rad/s; "
                "extend the torque table"
            )
        if self.way < 0.0:
            self.index = (self.index - 1) % len(breakpoints)
            self._count_from_previous_cycle(self.index == len(breakpoints) - 1)

    def result(self, verdict: Verdict) -> Transient:
        """Return the motion found so far, with a verdict."""
        self.recorder.add_single_state(
            self._stretch_in_direction(self.way or self.equation.direction), self.turn, self.time, self._state_vector()
        )
        return self.recorder.result(verdict, tuple(self.turned_back))

    @property
    def total_crank_angle(self) -> float:
        """The crank angle, rad, including full turns."""
        return self.local + self.period * self.turn

    def integrate_stretch(self) -> Verdict | None:
        """Integrate to the end of the stretch, to standstill or to the time limit, whichever comes first.

        Return why the motion ends, if it does.
        """
        if self.way == 0.0 and (ended := self._start_from_standstill()):
            return ended
        stretch = self._stretch_in_direction(self.way)
        solution, stop = self._integrate(stretch)
        self.recorder.add_solution(stretch, self.turn, solution)
        self.time = float(solution.t[-1])
        self.local, self.speed, *works = (float(value) for value in solution.y[:, -1])
        self.works = np.array(works)
        self.at_mark = False
        if stop == "edge":
            self._enter_next_stretch(stretch)
        elif stop == "standstill":
            self.speed, self.way, self.arrived = 0.0, 0.0, stretch.way
        else:
            return "beyond the torque table" if stop == "table" else "time is up"
        return None

    def _stretch_in_direction(self, way: float) -> Span:
        return self.equation.stretch_from_breakpoint(self.index, way)

    def _state_vector(self) -> Array:
        return np.array([self.local, self.speed, *self.works])

    def _count_from_previous_cycle(self, wrapped: bool) -> None:
        """Count the local angle from the previous cycle if the crank went back over the first breakpoint."""
        if wrapped:
            self.turn, self.local = self.turn - 1, self.local + self.period

    def _enter_next_stretch(self, stretch: Span) -> None:
        count, forward = len(self.equation.breakpoints), self.way > 0.0
        edge = (self.index + forward) % count
        self.at_mark, self.at_cycle = edge in self.marks, edge == self.mark
        self.local, self.index = (stretch.high, edge) if forward else (stretch.low, (edge - 1) % count)
        if not forward:
            self._count_from_previous_cycle(self.index == count - 1)
        elif edge == 0:
            self.turn, self.local = self.turn + 1, float(self.equation.breakpoints[0])

    def _speed_scale_for_errors(self, speed: float) -> float:
        """Return the reference speed for errors while the crank is slow, rad/s."""
        pull, resist = abs(float(self.drive.torque_on_crank(0.0, self.equation.direction))), 0.0
        for stretch in self.equation.spans_in_passing_order(self.equation.direction):
            terms = stretch.terms_at(np.linspace(stretch.low, stretch.high, 9))
            pull = max(pull, float(np.abs(terms.static).max()))
            resist = max(resist, float(terms.inertia.max()) + self.drive.inertia)
        return max(abs(speed), abs(self.speed), math.sqrt(TURN * pull / resist))

    def _integrate(self, stretch: Span) -> tuple[Any, Stop]:
        from scipy.integrate import solve_ivp

        motor, added, direction = self.drive.torque_on_crank, self.drive.inertia, self.equation.direction
        slowest, fastest, way, rubs = self.slowest, self.fastest, stretch.way, self.equation.rubs
        edge = stretch.high if way > 0.0 else stretch.low
        angle = np.empty(1)

        def rate(_time: float, y: Array) -> Array:
            angle[0], speed = y[0], float(y[1])
            terms = stretch.terms_at(angle)
            # Beyond its table the motor keeps its last value until the event below has found the end.
            torque = float(motor(min(max(speed, slowest), fastest), direction))
            drag = (terms.drag[0] + terms.square[0] * speed) * speed
            surplus = torque - terms.spin[0] * speed * speed - terms.static[0] - drag
            acceleration = surplus / (terms.inertia[0] + added)
            works = torque * speed, (drag - terms.load[0]) * speed
            if not rubs:
                return np.array([speed, acceleration, *works])
            pushed = np.array([torque]), added, np.array([acceleration])
            rubbing, state = stretch.solve_acceleration(angle, y[1:2].copy(), *pushed)
            return np.array([speed, rubbing[0], *works, state.heat[0]])

        events: list[Any] = [lambda _time, y: way * (y[0] - edge), lambda _time, y: way * y[1]]
        if math.isfinite(limit := fastest if way > 0.0 else -slowest):
            events.append(lambda _time, y: limit - way * y[1])
        for event, sense in zip(events, (1.0, -1.0, -1.0), strict=False):
            event.terminal, event.direction = True, sense
        energy = float(self.equation.moving_inertia(np.array(self.local)) + added) * self.scale**2
        solution = solve_ivp(
            rate,
            (self.time, self.duration),
            self._state_vector(),
            method="DOP853",
            rtol=self.tolerance,
            atol=self.tolerance * np.array([1e-2, 1e-2 * self.scale, *(1e-2 * energy for _ in self.works)]),
            events=events,
            dense_output=True,
        )
        if not solution.success:
            raise InputError(
                f"the motion cannot be followed beyond {solution.t[-1]:.6g} s at this tolerance; got "
                f"{self.tolerance:g}; check the masses and loads for values that differ by many orders of magnitude"
            )
        names: tuple[Stop, ...] = ("edge", "standstill", "table")
        event_times = solution.t_events or []
        ended = [name for name, times in zip(names, event_times, strict=False) if len(times)]
        return solution, ended[0] if ended else "time"

    def _breakaway_torque(self, stretch: Span, local: float) -> float:
        """Return the torque that resists a start from standstill in the span's direction, N m."""
        at = np.array([local])
        if self.equation.rubs:
            return float(stretch.friction_state(at, np.zeros(1), np.zeros(1)).torque[0])
        return float(stretch.terms_at(at).static[0])

    def _start_from_standstill(self) -> Verdict | None:
        """Find the direction in which the crank starts from standstill; if it does not start, return the reason."""
        count = len(self.equation.breakpoints)
        motor = float(self.drive.torque_on_crank(0.0, self.equation.direction))
        at_edge = abs(self.local - self._stretch_in_direction(1.0).low) <= NEAREST
        before = (self.index - 1) % count if at_edge else self.index
        push = {}
        for way, index in ((1.0, self.index), (-1.0, before)):
            stretch = self.equation.stretch_from_breakpoint(index, way)
            local = stretch.high if index != self.index else self.local
            static = self._breakaway_torque(stretch, local)
            push[way] = way * (motor - static) - _EPS * (abs(motor) + abs(static))
        arrived = self.arrived
        self.way = next((way for way in (-arrived, arrived) if push[way] > 0.0), 0.0)
        if self.way == 0.0:
            return "stands still"
        if (self.fastest if self.way > 0.0 else -self.slowest) <= 0.0:
            return "beyond the torque table"
        if self.time > 0.0 and self.way != arrived:
            self.turned_back.append(self.time)
        if self.way < 0.0 and at_edge:
            self.index = before
            self._count_from_previous_cycle(self.index == count - 1)
        return None
