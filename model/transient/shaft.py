"""The equation of motion of a crankshaft: of several cylinders, or of a cycle of two turns.

Each cylinder is a machine of its own at its crank angle, and a cycle of two turns two machines (`machine.two_turns`).
Moving inertia, and every term of the torque, add up.
"""

from __future__ import annotations

import math

import numpy as np

from ..arrays import Array
from ..linkage.linkage import Linkage
from ..linkage.single import single
from ..machine.mechanism import Mechanism
from ..machine.members import Member, members
from ..machine.two_turns import cycle_turns, half_at, halves
from .equation import NEAREST, TURN, CrankEquation, Equation, Span, Stretch, Terms
from .friction_torque import (
    ITERATIONS,
    FrictionState,
    has_converged,
    next_acceleration,
    require_inertia_left,
    sum_cylinders,
)


class ShaftStretch(Span):
    """The shaft turning one way between two breakpoints, `low` and `high`, rad: a stretch of each cylinder.

    parts: each with the angle of its crank over the shaft's, rad.
    """

    def __init__(self, low: float, high: float, way: float, parts: list[tuple[Stretch, float]]) -> None:
        self.low, self.high, self.way, self._parts = low, high, way, parts

    def at(self, crank_angle: Array) -> Terms:
        """Return the terms at crank angles (n,) of the shaft, rad."""
        found = [stretch.at(crank_angle + lead) for stretch, lead in self._parts]
        columns = zip(*((t.inertia, t.spin, t.static, t.drag, t.load, t.square) for t in found), strict=True)
        return Terms(*(np.sum(column, axis=0) for column in columns))

    def rubbed(self, crank_angle: Array, speed: Array, acceleration: Array) -> FrictionState:
        """Return torque and heat with friction of all cylinders, (n,)."""
        return sum_cylinders([stretch.rubbed(crank_angle + lead, speed, acceleration) for stretch, lead in self._parts])

    def accelerated(
        self, crank_angle: Array, speed: Array, torque: Array, inertia: float, guess: Array, *, by_speed: bool = False
    ) -> tuple[Array, FrictionState]:
        """Return accelerations with friction, and torque and heat of all cylinders with them, (n,)."""
        found, last = np.array(guess), math.inf
        low, high = np.full(found.shape, -np.inf), np.full(found.shape, np.inf)
        for _ in range(ITERATIONS):
            state = self.rubbed(crank_angle, speed, found)
            least = state.least + inertia
            require_inertia_left(crank_angle, least)
            excess = torque - inertia * found - state.torque
            new, low, high = next_acceleration(found, excess, state.by_acceleration + inertia, least, low, high)
            size = np.abs(new) + (np.abs(torque) + np.abs(state.torque)) / least
            step = float((np.abs(new - found) / np.where(size > 0.0, size, 1.0)).max())
            found = new
            if has_converged(step, last):
                break
            last = step
        return found, state


class ShaftEquation(Equation):
    """The equation of motion of all cylinders of one linkage each, over a turn or two.

    marks: further angles of the shaft, rad, that shall be breakpoints.
    Raises AssemblyError if the linkage does not turn fully, InputError where friction locks it.
    """

    def __init__(self, mechanism: Mechanism, linkage: Linkage, *, marks: tuple[float, ...] = ()) -> None:
        self._linkage = single(mechanism, linkage)
        turns = cycle_turns(mechanism)
        self.period = turns * TURN
        self.direction = -1.0 if mechanism.speed < 0.0 else 1.0
        self.rubs = mechanism.friction.acts
        alone = Member(mechanism, 0.0, 0.0, 0.0)
        self._members = (alone,) if mechanism.arrangement is None else members(mechanism)
        self._equations = [
            [CrankEquation(half, self._linkage) for half in (halves(own.mechanism) if turns > 1 else (own.mechanism,))]
            for own in self._members
        ]
        ends = np.asarray(self._linkage.dead_centre_angles)
        self.dead_centres = np.concatenate([ends - own.lead for own in self._members])
        self.lead = self._members[0].lead
        self.crowds = all(math.remainder(own.lead, math.pi) == 0.0 for own in self._members)
        parts = zip(self._members, self._equations, strict=True)
        once = np.concatenate([each.breakpoints - own.lead for own, equations in parts for each in equations])
        every = np.concatenate([*(once + turn * TURN for turn in range(turns)), marks])
        every = np.sort(np.mod(every, self.period))
        apart = np.diff(every, prepend=every[-1] - self.period) > NEAREST
        self.breakpoints = every[apart] if apart.any() else every[:1]

        self._stretches: dict[tuple[int, float], ShaftStretch] = {}

    def stretch(self, index: int, way: float) -> Span:
        """Return the stretch from breakpoint `index` to the next, the last one reaching beyond the cycle."""
        if (index, way) not in self._stretches:
            ends = [*self.breakpoints.tolist(), float(self.breakpoints[0]) + self.period]
            self._stretches[index, way] = self._stretch(ends[index], ends[index + 1], way)
        return self._stretches[index, way]

    def _stretch(self, low: float, high: float, way: float) -> ShaftStretch:
        middle, parts = 0.5 * (low + high), []
        for own, equations in zip(self._members, self._equations, strict=True):
            at, half = middle + own.lead, 0
            if len(equations) > 1:
                inner, outer = self._linkage.dead_centre_angles
                half = int(half_at(own.mechanism, inner, outer, np.array(at)))
            cuts = equations[half].breakpoints
            local = float(cuts[0]) + (at - float(cuts[0])) % TURN
            index = int(np.searchsorted(cuts, local, side="right")) - 1
            parts.append((equations[half].stretch(index, way), own.lead + local - at))
        return ShaftStretch(low, high, way, parts)

    def inertia(self, crank_angle: Array) -> Array:
        """Return the moving inertia of all cylinders, kg m^2; shape of the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(sum(equations[0].inertia(crank_angle + own.lead) for own, equations in parts))

    def least_inertia(self, crank_angle: Array) -> Array:
        """Return the least inertia that friction leaves of all cylinders, kg m^2; shape of the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(sum(equations[0].least_inertia(crank_angle + own.lead) for own, equations in parts))

    def height_energy(self, crank_angle: Array) -> Array:
        """Return the potential energy of gravity of all cylinders, J; shape of the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(sum(equations[0].height_energy(crank_angle + own.lead) for own, equations in parts))


def equation_of(mechanism: Mechanism, linkage: Linkage, *, marks: tuple[float, ...] = ()) -> Equation:
    """Return the equation of motion of a machine: of its crank, or of a shaft with cylinders or two turns.

    marks: further crank angles, rad, that shall be breakpoints.
    """
    cylinders = 1 if mechanism.arrangement is None else len(mechanism.arrangement.phases)
    several = cylinders > 1 or cycle_turns(mechanism) > 1
    return (ShaftEquation if several else CrankEquation)(mechanism, linkage, marks=marks)
