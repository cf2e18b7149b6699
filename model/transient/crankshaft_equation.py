"""Equation of motion of a crankshaft, for several cylinders or a two-turn cycle.

Each cylinder is a separate machine at its crank angle, and a two-turn cycle is two machines (`machine.two_turns`). The
moving inertias, and every term of the torque, add up.
"""

import math

import numpy as np

from ..arrays import Array
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.cylinders_and_turns import (
    Member,
    cycle_turns,
    half_of_cycle_at,
    machines_of_arrangement,
    machines_of_turns,
)
from ..machine.mechanism import Mechanism
from .crank_equation import NEAREST, TURN, CrankEquation, Equation, Span, Stretch, Terms
from .friction_torque import (
    ITERATIONS,
    FrictionState,
    has_converged,
    next_acceleration,
    require_inertia_left,
    sum_cylinders,
)


class ShaftStretch(Span):
    """The shaft turning in one direction between two breakpoints, `low` and `high`, rad: a stretch of each cylinder.

    parts: stretches, each with the lead of its crank angle over the shaft angle, rad.
    """

    def __init__(self, low: float, high: float, way: float, parts: list[tuple[Stretch, float]]) -> None:
        self.low, self.high, self.way, self._parts = low, high, way, parts

    def terms_at(self, crank_angle: Array) -> Terms:
        """Return the terms at crank angles (n,) of the shaft, rad."""
        terms = [stretch.terms_at(crank_angle + lead) for stretch, lead in self._parts]
        columns = zip(*((t.inertia, t.spin, t.static, t.drag, t.load, t.square) for t in terms), strict=True)
        return Terms(*(np.sum(column, axis=0) for column in columns))

    def friction_state(self, crank_angle: Array, speed: Array, acceleration: Array) -> FrictionState:
        """Return torque and heat with friction for all cylinders, (n,)."""
        return sum_cylinders(
            [stretch.friction_state(crank_angle + lead, speed, acceleration) for stretch, lead in self._parts]
        )

    def solve_acceleration(
        self, crank_angle: Array, speed: Array, torque: Array, inertia: float, guess: Array, *, by_speed: bool = False
    ) -> tuple[Array, FrictionState]:
        """Return accelerations with friction, and the resulting torque and heat for all cylinders, (n,)."""
        accelerations, last = np.array(guess), math.inf
        low, high = np.full(accelerations.shape, -np.inf), np.full(accelerations.shape, np.inf)
        for _ in range(ITERATIONS):
            state = self.friction_state(crank_angle, speed, accelerations)
            least = state.least + inertia
            require_inertia_left(crank_angle, least)
            excess = torque - inertia * accelerations - state.torque
            new, low, high = next_acceleration(accelerations, excess, state.by_acceleration + inertia, least, low, high)
            size = np.abs(new) + (np.abs(torque) + np.abs(state.torque)) / least
            step = float((np.abs(new - accelerations) / np.where(size > 0.0, size, 1.0)).max())
            accelerations = new
            if has_converged(step, last):
                break
            last = step
        return accelerations, state


class ShaftEquation(Equation):
    """The equation of motion of all cylinders with the same linkage, over one or two turns.

    marks: additional shaft angles to use as breakpoints, rad. Raises AssemblyError if the linkage does not rotate
    fully, InputError if friction locks it.
    """

    def __init__(self, mechanism: Mechanism, linkage: Linkage, *, marks: tuple[float, ...] = ()) -> None:
        self._linkage = require_single_rotating_linkage(mechanism, linkage)
        turns = cycle_turns(mechanism)
        self.period = turns * TURN
        self.direction = -1.0 if mechanism.speed < 0.0 else 1.0
        self.rubs = mechanism.friction.acts
        only_member = Member(mechanism, 0.0, 0.0, 0.0)
        self._members = (only_member,) if mechanism.arrangement is None else machines_of_arrangement(mechanism)
        self._equations = [
            [CrankEquation(half, self._linkage) for half in machines_of_turns(member.mechanism)]
            for member in self._members
        ]
        ends = np.asarray(self._linkage.dead_centre_angles)
        self.dead_centres = np.concatenate([ends - member.lead for member in self._members])
        self.lead = self._members[0].lead
        self.crowds = all(math.remainder(member.lead, math.pi) == 0.0 for member in self._members)
        parts = zip(self._members, self._equations, strict=True)
        first_turn = np.concatenate(
            [equation.breakpoints - member.lead for member, equations in parts for equation in equations]
        )
        cuts = np.concatenate([*(first_turn + turn * TURN for turn in range(turns)), marks])
        cuts = np.sort(np.mod(cuts, self.period))
        is_distinct = np.diff(cuts, prepend=cuts[-1] - self.period) > NEAREST
        self.breakpoints = cuts[is_distinct] if is_distinct.any() else cuts[:1]

        self._stretches: dict[tuple[int, float], ShaftStretch] = {}

    def stretch_from_breakpoint(self, index: int, way: float) -> Span:
        """Return the stretch from breakpoint `index` to the next one; the last stretch extends beyond the cycle."""
        if (index, way) not in self._stretches:
            ends = [*self.breakpoints.tolist(), float(self.breakpoints[0]) + self.period]
            self._stretches[index, way] = self._stretch(ends[index], ends[index + 1], way)
        return self._stretches[index, way]

    def _stretch(self, low: float, high: float, way: float) -> ShaftStretch:
        middle, parts = 0.5 * (low + high), []
        for member, equations in zip(self._members, self._equations, strict=True):
            at, half = middle + member.lead, 0
            if len(equations) > 1:
                inner, outer = self._linkage.dead_centre_angles
                half = int(half_of_cycle_at(member.mechanism, inner, outer, np.array(at)))
            cuts = equations[half].breakpoints
            local = float(cuts[0]) + (at - float(cuts[0])) % TURN
            index = int(np.searchsorted(cuts, local, side="right")) - 1
            parts.append((equations[half].stretch_from_breakpoint(index, way), member.lead + local - at))
        return ShaftStretch(low, high, way, parts)

    def moving_inertia(self, crank_angle: Array) -> Array:
        """Return the moving inertia of all cylinders, kg m^2; same shape as the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(sum(equations[0].moving_inertia(crank_angle + member.lead) for member, equations in parts))

    def least_inertia_with_friction(self, crank_angle: Array) -> Array:
        """Return the minimum inertia that friction leaves for all cylinders, kg m^2; same shape as the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(
            sum(equations[0].least_inertia_with_friction(crank_angle + member.lead) for member, equations in parts)
        )

    def gravity_energy(self, crank_angle: Array) -> Array:
        """Return the potential energy of gravity of all cylinders, J; same shape as the crank angle."""
        parts = zip(self._members, self._equations, strict=True)
        return np.asarray(sum(equations[0].gravity_energy(crank_angle + member.lead) for member, equations in parts))


def equation_of(mechanism: Mechanism, linkage: Linkage, *, marks: tuple[float, ...] = ()) -> Equation:
    """Return the equation of motion for a machine's crank, or for its shaft with several cylinders or two turns.

    marks: additional crank angles to use as breakpoints, rad.
    """
    cylinders = 1 if mechanism.arrangement is None else len(mechanism.arrangement.phases)
    several = cylinders > 1 or cycle_turns(mechanism) > 1
    return (ShaftEquation if several else CrankEquation)(mechanism, linkage, marks=marks)
