"""The motion law on the cells of a turn, as a cone programme.

The unknowns are K at the starts of the cells and the drive torque T there, linear in between:

    K_next = K + width (T + T_next) / 2 - integral of Q,

exactly. Limits on torque, speed and crank acceleration, peak and time are convex in K and T: the time per angle, sqrt(J
/ 2 K), is convex in K; T^2 sqrt(J / 2 K), whose integral is that of T^2 over time, is convex in both (the perspective
of a square over a concave function). A lower limit on the time is not convex. It is replaced by the tangent to the time
at another law, which lies below every law's time (the convex-concave procedure: A. L. Yuille and A. Rangarajan, Neural
Computation 15, 2003).
"""

import warnings
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ...model.arrays import Array
from ...model.motion_law.law_turn import LawTurn, cell_integral_weights
from ...model.optional_packages import import_extra
from ...model.transient.crank_equation import TURN
from .law_limits import LawLimits

Aim = Literal["peak torque", "rms torque", "cycle time", "long cycle", "acceleration"]
_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Requirement:
    """Requirements of a programme besides speeds and accelerations; None for nothing.

    torque_limit: N m. longest: upper limit on the time, s. least: lower limit on the time, s: by the tangent at a law
    with `energies`, K at starts and middles of cells, J, (2, n), which is stricter; otherwise by the chord between the
    limits of K, which is less strict.
    """

    torque_limit: float | None = None
    longest: float | None = None
    least: float | None = None
    energies: Array | None = None


@dataclass(frozen=True)
class Multipliers:
    """Multipliers of a programme in SI.

    momentum: multipliers of dK / d(phi) = T - Q in each cell, (n,). pace: multiplier of the time, positive for an upper
    limit, negative for a lower one. sides: multipliers of the acceleration limit at start and end of each cell, upper
    and lower side, (2, 2, n).
    """

    momentum: Array
    pace: float
    sides: Array


@dataclass(frozen=True)
class Solution:
    """T, N m, and K, J, at the starts of cells (n,); objective; K at starts and middles (2, n)."""

    torque: Array
    energy: Array
    value: float
    energies: Array
    multipliers: Multipliers


@dataclass(frozen=True)
class Margins:
    """Relative distances (n,) that a law keeps from limits in each cell: least and greatest K, crank acceleration."""

    least: Array
    greatest: Array
    acceleration: Array


class Programme:
    """Programmes on the cells of one turn, within limits."""

    def __init__(self, turn: LawTurn, limits: LawLimits, margins: Margins) -> None:
        """Store a turn, limits, and margins to these.

        Torques are scaled by `unit`, N m, energies by `energy_unit`, J, and times by the cycle time, so that all
        numbers are of order 1; `ratio` is the unit of energy over that of torque.
        """
        self.turn, self.limits = turn, limits
        self.unit = max(float(np.abs(turn.terms.load).max()), 1e-6 * float(turn.terms.inertia.max()))
        self.time_unit = limits.cycle_time
        self.energy_unit = 0.5 * float(turn.terms.inertia.mean()) * (TURN / limits.cycle_time) ** 2
        self.ratio = self.energy_unit / self.unit
        n = len(turn.width)
        half = np.repeat(cell_integral_weights(np.array([0.5])), n, axis=0)
        self.loads = np.sum(turn.angle_weights * turn.terms.load, axis=1) / self.unit
        self.half_loads = turn.width * np.einsum("ni,ni->n", half, turn.terms.load) / self.unit
        self.angles = np.stack([turn.cell_start_angles, turn.cell_start_angles + 0.5 * turn.way * turn.width])
        self.inertia = turn.inertia_at(self.angles)
        low, high = limits.energy_limits(self.angles, self.inertia, turn.slider_derivatives(self.angles)[0])
        lifted, lowered = (np.stack([np.maximum(by, np.roll(by, 1)), by]) for by in (margins.least, margins.greatest))
        self.low, self.high = low * (1.0 + lifted) / self.energy_unit, high * (1.0 - lowered) / self.energy_unit
        self.low = np.minimum(self.low, self.high)
        self.acceleration = 1.0 - margins.acceleration
        simpson = np.stack([(turn.width + np.roll(turn.width, 1)) / 6.0, 4.0 * turn.width / 6.0])
        self.slowness = (simpson * np.sqrt(0.5 * self.inertia / self.energy_unit) / self.time_unit).ravel()

    def turn_time(self, energies: Array) -> float:
        """Return the time of a turn, s, by Simpson's rule; K (2, n), J: at starts and middles."""
        return float(self.slowness @ np.sqrt(self.energy_unit / energies.ravel())) * self.time_unit

    def objective_unit(self, aim: Aim) -> float:
        """Return the objective in SI that equals 1 in the programme."""
        return {"peak torque": self.unit, "cycle time": self.time_unit, "rms torque": self.unit**2}.get(aim, 1.0)

    def solve(self, aim: Aim, needs: Requirement) -> Solution | None:
        """Return the solution; None if it has none, or the solver finds none."""
        cone = _Cone(self)
        if needs.torque_limit is not None:
            cone.rules.append(cone.cp.abs(cone.torque) <= needs.torque_limit / self.unit)
        pace = cone.limit_time(needs)
        sides = cone.limit_acceleration(aim == "acceleration")
        objective = cone.objective_with_rules(aim)
        problem = cone.cp.Problem(cone.cp.Minimize(objective), cone.rules)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # the bound shows the effect of an inaccurate answer
            try:
                problem.solve(
                    solver=cone.cp.CLARABEL, tol_gap_abs=_TOLERANCE, tol_gap_rel=_TOLERANCE, tol_feas=_TOLERANCE
                )
            except cone.cp.SolverError:
                return None
        if cone.torque.value is None or "infeasible" in problem.status:
            return None
        size = self.objective_unit(aim)
        n = len(self.turn.width)
        duals = np.array([side.dual_value for side in sides] or np.zeros((4, n))).reshape(2, 2, n) * size / self.unit
        multipliers = Multipliers(
            np.asarray(cone.momentum.dual_value) * size / self.unit,
            sum(sign * float(rule.dual_value) for sign, rule in pace) * size / self.time_unit,
            duals,
        )
        energies = np.asarray(cone.places.value).reshape(2, n) * self.energy_unit
        return Solution(cone.torque.value * self.unit, energies[0], float(problem.value) * size, energies, multipliers)


@dataclass
class _Cone:
    """Unknowns and rules of a programme.

    `places` and `torques` are K and T at the starts, then at the middles, of cells.
    """

    programme: Programme
    rules: list[Any] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.cp = cp = import_extra("cvxpy", "a motion law needs")
        of, turn, n = self.programme, self.programme.turn, len(self.programme.turn.width)
        self.energy, self.torque, self.size = cp.Variable(n), cp.Variable(n), cp.Variable()
        self.following = np.roll(np.arange(n), -1)
        after = self.torque[self.following]
        gain = cp.multiply(0.5 * turn.width, self.torque + after) - of.loads
        self.momentum = of.ratio * (self.energy[self.following] - self.energy) - gain == 0.0
        gain = cp.multiply(turn.width / 8.0, 3.0 * self.torque + after) - of.half_loads
        middle = self.energy + gain / of.ratio
        self.places = cp.hstack([self.energy, middle])
        self.torques = cp.hstack([self.torque, 0.5 * (self.torque + after)])
        high, self.ones = of.high.ravel(), np.ones(2 * n)
        bounded = np.flatnonzero(np.isfinite(high))
        self.rules += [self.momentum, self.places >= of.low.ravel(), self.places[bounded] <= high[bounded]]
        self._root: Any = None

    def _product_at_least_square(self, first: Any, second: Any, factor: Any) -> Any:
        """Return the rule first second >= factor^2, with first + second >= 0, element by element."""
        return self.cp.SOC(first + second, self.cp.vstack([2.0 * factor, first - second]), axis=0)

    @property
    def energy_root(self) -> Any:
        """An unknown that is at most the root of K."""
        if self._root is None:
            self._root = self.cp.Variable(len(self.ones))
            self.rules.append(self._product_at_least_square(self.places, self.ones, self._root))
        return self._root

    def turn_time_bound(self) -> Any:
        """Return an upper bound on the time of the turn."""
        inverse = self.cp.Variable(len(self.ones))
        self.rules.append(self._product_at_least_square(self.energy_root, inverse, self.ones))
        return self.programme.slowness @ inverse

    def limit_time(self, needs: Requirement) -> list[tuple[float, Any]]:
        """Add limits on the time; return each with the sign of its multiplier."""
        time_unit = self.programme.time_unit
        limits: list[tuple[float, Any]] = []
        if needs.longest is not None:
            limits.append((1.0, self.turn_time_bound() <= needs.longest / time_unit))
        if needs.least is not None:
            low, high, slowness = self.programme.low.ravel(), self.programme.high.ravel(), self.programme.slowness
            if needs.energies is None:  # the chord of 1 / sqrt(K) between the limits
                slope = -1.0 / (np.sqrt(low * high) * (np.sqrt(low) + np.sqrt(high)))
                time = slowness @ (low**-0.5 + self.cp.multiply(slope, self.places - low))
            else:
                at = np.maximum(needs.energies.ravel() / self.programme.energy_unit, low)
                time = (slowness / np.sqrt(at)) @ (1.5 - 0.5 * self.cp.multiply(1.0 / at, self.places))
            limits.append((-1.0, time >= needs.least / time_unit))
        self.rules += [rule for _, rule in limits]
        return limits

    def limit_acceleration(self, relaxed: bool) -> list[Any]:
        """Add the acceleration limit, multiplied by `size` if relaxed; return its sides: by end, upper one first."""
        turn, unit = self.programme.turn, self.programme.unit
        limit = self.programme.limits.acceleration_limit(turn.end_terms)
        sides: list[Any] = []
        if limit is None:
            return []
        for end, cells in enumerate((slice(None), self.following)):
            value = self.torque[cells] + self.cp.multiply(
                self.programme.ratio * limit.by_energy[end], self.energy[cells]
            )
            load, size = turn.end_terms.load[end] / unit, self.programme.acceleration * limit.greatest[end] / unit
            greatest = (self.size if relaxed else 1.0) * size
            sides += [value - load <= greatest, load - value <= greatest]
        self.rules += sides
        return sides

    def objective_with_rules(self, aim: Aim) -> Any:
        """Return the objective, and add its rules."""
        if aim == "peak torque":
            self.rules.append(self.cp.abs(self.torque) <= self.size)
        if aim in ("peak torque", "acceleration"):
            return self.size
        if aim == "cycle time":
            return self.turn_time_bound()
        slowness = self.programme.slowness
        if aim == "long cycle":
            return self.cp.sum(self.places) / len(self.ones)  # one law is slowest at every angle (`law_limits`)
        square = self.cp.Variable(len(self.ones))
        self.rules.append(self._product_at_least_square(square, self.energy_root, self.torques))
        return slowness @ square
