"""Request for a motion law, and the resulting limits for one machine.

`EnergyBounds` has the least and greatest kinetic energy of any law within a torque. With |T| <= tau, the energy changes
by at most tau -+ Q per angle. So among all laws within the speed limits K_low and K_high, one is the slowest at every
angle simultaneously, and one the fastest:

    K_slowest(phi) = greatest over psi of K_low(psi) less the energy that tau can remove or add between psi and phi,

and likewise from K_high. The smaller of two such laws is also such a law, which proves it. So no law within tau has a
shorter turn than the fastest one, or a longer turn than the slowest one. Acceleration limits are ignored: the bounds
hold, but may be loose.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np

from ...model.arrays import Array, Mask
from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.motion_law.law_turn import LawTerms, LawTurn
from ...model.quadrature import NODES
from ...model.transient.crank_equation import TURN
from ...objectives.dead_centre import angle_and_travel_rate_before_dead_centre
from .input_words import RANGE, LawObjective, Timing

_DOUBLINGS, _BISECTIONS = 40, 40
_ROUNDING = 1e-12


@dataclass(frozen=True)
class ReachableLaws:
    """Slowest and fastest law within a torque: K at the nodes (n, 16), J, and times of a turn, s.

    exists: whether there is any law.
    """

    slowest: Array
    fastest: Array
    longest: float
    shortest: float
    exists: bool


class Reachable:
    """Laws that a turn allows within the speed limits."""

    def __init__(self, turn: LawTurn, limits: LawLimits) -> None:
        self.turn = turn
        self.low, self.high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
        cell, node = np.divmod(np.arange(turn.angle.size), turn.angle.shape[1])
        place = NODES[node]
        before = np.concatenate([[0.0], np.cumsum(np.sum(turn.angle_weights * turn.terms.load, axis=1))[:-1]])
        self.taken = before[cell] + turn.integral_from_cell_start(turn.terms.load, cell, place)
        self.passed = turn.passed[cell] + place * turn.width[cell]

    def laws_within(self, torque: float) -> ReachableLaws:
        """Return the slowest and fastest law within a torque, N m."""
        loss = self._continue_over_three_turns(
            torque * self.passed + self.taken, torque * TURN + self.turn.work_absorbed_by_loads
        )
        gain = self._continue_over_three_turns(
            torque * self.passed - self.taken, torque * TURN - self.turn.work_absorbed_by_loads
        )
        slowest, fastest = self._least_energies(self.low, loss, gain), -self._least_energies(-self.high, gain, loss)
        within = bool(np.all(slowest <= self.high * (1.0 + _ROUNDING)))
        fastest = np.maximum(fastest, slowest)  # it may be lower if no law exists
        closes = abs(self.turn.work_absorbed_by_loads) <= torque * TURN * (1.0 + _ROUNDING)
        return ReachableLaws(slowest, fastest, self._turn_time(slowest), self._turn_time(fastest), within and closes)

    def least_torque(self, torque: float, longest: float, least: float) -> float:
        """Return the torque, N m, below which no law takes between `least` and `longest`, s.

        torque: a positive initial guess. Infinite if no reasonable torque is enough.
        """

        def suffices(torque: float) -> bool:
            reach = self.laws_within(torque)
            return reach.exists and reach.shortest <= longest and reach.longest >= least

        low, high = 0.0, torque
        for _ in range(_DOUBLINGS):
            if suffices(high):
                break
            low, high = high, 2.0 * high
        else:
            return math.inf
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if suffices(middle) else (middle, high)
        return low

    def _turn_time(self, energy: Array) -> float:
        return float(np.sum(self.turn.angle_weights * np.sqrt(0.5 * self.turn.terms.inertia / energy)))

    def _least_energies(self, limit: Array, loss: Array, gain: Array) -> Array:
        """Return the least K above a limit that loses at most `loss` and gains at most `gain`.

        It loses after an angle at which it is on the limit, and gains before it.
        """
        three = np.tile(limit.ravel(), 3)
        after = np.maximum.accumulate(three + loss) - loss
        before = np.maximum.accumulate((three - gain)[::-1])[::-1] + gain
        middle = slice(len(self.passed), 2 * len(self.passed))
        return np.asarray(np.maximum(after, before)[middle].reshape(limit.shape))

    @staticmethod
    def _continue_over_three_turns(integral: Array, turn: float) -> Array:
        return np.concatenate([integral, integral + turn, integral + 2.0 * turn])


_EDGE = 1e-9  # rad
_ONLY_CONSTANT = 1e-5  # relative distance of a limit from the mean speed below which only constant speed remains
_NARROWS = {"narrows": True}  # a limit that may leave almost no law


@dataclass(frozen=True, kw_only=True)
class LawRequest:
    """A request for a motion law; SI, magnitudes.

    objective: quantity to minimise. cycle_time: s, by default that of the machine's speed, from which default speeds
    follow if it is the objective. timing: whether the cycle may be shorter. torque_limit: greatest drive torque.
    window: distance before the slider's dead centre within which window_speed limits the slider.
    """

    objective: LawObjective = "peak torque"
    cycle_time: float | None = None
    timing: Timing = "equal"
    torque_limit: float | None = field(default=None, metadata=_NARROWS)
    least_speed: float | None = field(default=None, metadata=_NARROWS)
    greatest_speed: float | None = field(default=None, metadata=_NARROWS)
    slider_speed: float | None = field(default=None, metadata=_NARROWS)
    window: float | None = None
    window_speed: float | None = field(default=None, metadata=_NARROWS)
    crank_acceleration: float | None = field(default=None, metadata=_NARROWS)

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, int | float) and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{item.name} of a motion law must be positive and finite; got {value:g}")

    @property
    def narrowing_fields(self) -> list[str]:
        """Fields with a limit that may leave almost no law."""
        return [
            item.name for item in fields(self) if item.metadata == _NARROWS and getattr(self, item.name) is not None
        ]


class AccelerationLimit(NamedTuple):
    """|T - Q + by_energy K| <= greatest, N m."""

    by_energy: Array
    greatest: Array


@dataclass(frozen=True)
class LawLimits:
    """Limits of a law for one machine; SI, infinite if unlimited.

    cycle_time: s. least_speed, greatest_speed: limits on the crank speed. window: crank angle at the start of the
    window, and the angle that it covers, rad. names: the interface's names for the request's fields.
    """

    request: LawRequest
    cycle_time: float
    least_speed: float
    greatest_speed: float
    window: tuple[float, float] | None
    way: float
    names: Mapping[str, str]

    @property
    def window_ends(self) -> tuple[float, ...]:
        """Crank angles at the start and the end of the window, rad."""
        return () if self.window is None else (self.window[0], self.window[0] + self.way * self.window[1])

    def name_of_field(self, field: str) -> str:
        """Return the interface's name for a field."""
        return self.names.get(field, field)

    def window_cells(self, turn: LawTurn) -> list[tuple[int, int]]:
        """Return the cells that start at the start and the end of the window, each with the adjacent cell outside."""
        if self.window is None:
            return []
        begin, end = (int(turn.locate_in_cells(np.array([mark + self.way * 1e-7]))[0][0]) for mark in self.window_ends)
        return [(begin, (begin - 1) % len(turn.width)), (end, end)]

    def greatest_slider_speed(self, crank_angle: Array) -> Array:
        """Return the greatest allowed slider speed, m/s, at crank angles."""
        speed = np.full(crank_angle.shape, self.request.slider_speed or math.inf)
        if self.request.window_speed is not None:
            speed[self._in_window(crank_angle)] = min(self.request.window_speed, self.request.slider_speed or math.inf)
        return speed

    def energy_limits(self, crank_angle: Array, inertia: Array, travel: Array) -> tuple[Array, Array]:
        """Return the least and the greatest allowed K, J, at crank angles. inertia: J, kg m^2. travel: x', m."""
        with np.errstate(divide="ignore"):
            fastest = np.minimum(self.greatest_speed, self.greatest_slider_speed(crank_angle) / np.abs(travel))
        return 0.5 * inertia * self.least_speed**2, 0.5 * inertia * fastest**2

    def acceleration_limit(self, terms: LawTerms) -> AccelerationLimit | None:
        """Return the limit on crank acceleration as one on J alpha, at crank angles with terms of any shape."""
        greatest = self.request.crank_acceleration
        if greatest is None:
            return None
        return AccelerationLimit(-terms.inertia_slope / terms.inertia, greatest * terms.inertia)

    def _in_window(self, crank_angle: Array) -> Mask:
        if self.window is None:
            return np.zeros(crank_angle.shape, np.bool_)
        passed = np.mod(self.way * (crank_angle - self.window[0]) + _EDGE, TURN)
        return np.asarray(passed <= self.window[1] + 2.0 * _EDGE)


def resolve_limits(
    mechanism: Mechanism, linkage: Linkage, request: LawRequest, names: Mapping[str, str] | None = None
) -> LawLimits:
    """Return the limits for a machine. names: the interface's names for the fields.

    The greatest speed is at most that of the motor. Raises `InputError` if the cycle time is missing, if a window is
    incomplete or outside the stroke, if speeds exclude each other or the cycle time, or if an objective lacks what it
    needs.
    """
    labels = dict(names or {})

    def name(field: str) -> str:
        return labels.get(field, field)

    speed = abs(mechanism.speed)
    if request.cycle_time is None and not speed:
        raise InputError(f"a motion law needs a cycle time; got a machine without speed; give {name('cycle_time')}")
    if request.objective == "cycle time" and request.torque_limit is None:
        raise InputError(f"the shortest cycle needs a torque limit; got none; give {name('torque_limit')}")
    if request.objective == "cycle time" and request.cycle_time is not None and speed:
        raise InputError(
            f"the shortest cycle must not have a given cycle time; got {name('cycle_time')} "
            f"{request.cycle_time:.6g} s; leave it out, or limit {name('greatest_speed')}"
        )
    if request.objective == "rms torque" and request.timing == "at most":
        raise InputError(
            f"the RMS torque needs an exact cycle time; got {name('timing')} at most; ask for the equal cycle time"
        )
    cycle_time = TURN / speed if request.cycle_time is None else request.cycle_time
    mean = TURN / cycle_time
    greatest = RANGE * max(mean, request.least_speed or 0.0)
    greatest = greatest if request.greatest_speed is None else request.greatest_speed
    drive = mechanism.drive
    if drive is not None and drive.greatest_speed is not None and drive.greatest_speed / drive.gear_ratio < greatest:
        greatest = drive.greatest_speed / drive.gear_ratio
        labels["greatest_speed"] = "the motor's greatest speed over the gear ratio"
    least = min(mean, greatest) / RANGE if request.least_speed is None else request.least_speed
    if least > greatest:
        raise InputError(
            f"{name('least_speed')} must not exceed {name('greatest_speed')}; got {rpm_text(least)} and "
            f"{rpm_text(greatest)}; change one"
        )
    if request.objective != "cycle time":
        if mean > greatest * (1.0 + 1e-12):
            raise InputError(
                f"a cycle of {cycle_time:.6g} s needs a mean crank speed of {rpm_text(mean)}; "
                f"{name('greatest_speed')} is {rpm_text(greatest)}; raise it, or allow {TURN / greatest:.6g} s"
            )
        if request.timing == "equal" and mean < least * (1.0 - 1e-12):
            raise InputError(
                f"a cycle of {cycle_time:.6g} s needs a mean crank speed of {rpm_text(mean)}; {name('least_speed')} is "
                f"{rpm_text(least)}; reduce it, or ask for {TURN / least:.6g} s"
            )
        for field, limit in (("least_speed", least), ("greatest_speed", greatest)):
            if abs(mean / limit - 1.0) < _ONLY_CONSTANT and (field == "greatest_speed" or request.timing == "equal"):
                raise InputError(
                    f"a cycle of {cycle_time:.6g} s has a mean crank speed of {rpm_text(mean)}; {name(field)} is "
                    f"{rpm_text(limit)}, which only allows constant speed; change one of them"
                )
    window = _crank_angle_window(mechanism, linkage, request, name("window"), name("window_speed"))
    return LawLimits(request, cycle_time, least, greatest, window, mechanism.direction, labels)


def _crank_angle_window(
    mechanism: Mechanism, linkage: Linkage, request: LawRequest, distance_name: str, speed_name: str
) -> tuple[float, float] | None:
    if request.window is None and request.window_speed is None:
        return None
    if request.window is None or request.window_speed is None:
        missing = distance_name if request.window is None else speed_name
        raise InputError(f"a working window needs its distance and its slider speed; got only one; give {missing}")
    stroke = float(linkage.stroke)
    if not request.window < stroke:
        raise InputError(
            f"{distance_name} must be less than the stroke, {1e3 * stroke:.6g} mm; got {1e3 * request.window:.6g} mm; "
            "reduce it"
        )
    design = np.array([float(linkage.crank), float(linkage.rod), float(linkage.offset)])
    angles, _ = angle_and_travel_rate_before_dead_centre(mechanism, design, np.array([request.window]))
    dead = float(linkage.dead_centre_angles[("inner", "outer").index(mechanism.slider.dead_centre)])
    return dead - mechanism.direction * float(angles[0]), float(angles[0])


def rpm_text(speed: float) -> str:
    """Return a speed, rad/s, as text in rpm."""
    return f"{30.0 / math.pi * speed:.6g} rpm"
