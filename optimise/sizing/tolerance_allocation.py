"""Tolerances with the least manufacturing cost that keep the position error within a limit.

    minimise  sum_i c_i(t_i)   with   error(theta; t) <= limit at every crank angle of the working stroke,
                                      least_i <= t_i <= greatest_i,

c_i(t) = a_i + b_i / t^k_i (`costs`), with the first-order influences s_i(theta) of `model.signals.position_error`. Let
y_i = t_i^p with p = 1 for the worst case and p = 2 for the root-sum-square. Both limits are then linear,

    sum_i |s_i(theta)|^p y_i <= limit^p - F(theta),

where F contains the fixed contributions (clearances, tolerances without a cost), the bounds remain bounds, and the
costs b_i y_i^(-k_i / p) are strictly convex: one convex programme for both, with a unique solution. It has one
constraint for each crank angle of a continuum. An exchange method handles them: the programme is solved with a few
angles, and the exact local peaks of the resulting error (`model.signals.peaks`, no grid) are added, until none exceeds
the limit (R. Hettich and K. O. Kortanek, "Semi-infinite programming", SIAM Review 35(3), 1993, on exchange methods).
The cone solver finds the active angles and bounds, but tolerances with little weight in the cost only to 1e-4. The
optimality conditions

    k_i b_i t_i^(-k_i-1) = sum_j lambda_j p |s_i(theta_j)|^p t_i^(p-1)  for tolerances within their bounds,
    error(theta_j; t) = limit at the active peaks theta_j, which move with t,

are then solved for t and lambda to rounding. In a convex programme they are sufficient: a point that meets them, with
lambda >= 0 and no peak above the limit, is the optimum.
"""

import math
import warnings
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...model.arrays import Array
from ...model.errors import InfeasibleError, InputError
from ...model.linkage.linkage import Linkage
from ...model.linkage.require_single_linkage import require_single_rotating_linkage
from ...model.machine.loads.load import require_word
from ...model.machine.mechanism import Mechanism, Window
from ...model.optional_packages import import_extra
from ..problem.tolerance_costs import Costs
from .input_words import Kind
from .position_error_rows import ErrorRows

ROUNDS = 60
_NEAR = 1e-3  # relative excess below which the optimality conditions are tried
_EXCESS = 1e-10  # relative excess that the last round may leave
_SOLVED = 1e-11  # relative residual of the optimality conditions ...
_MET = 1e-6  # ... and that of a point that counts as optimal although they could not be solved
_AT_BOUND = 1e-6  # relative tolerance in the cone solver's answer
_CARRIES = 1e-6  # fraction of the multipliers that makes an angle active
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class Part:
    """One chosen tolerance.

    tolerance: tolerance, m, or rad for the crank angle. cost: cost of holding it. bound: end of its range on which it
    lies, if any. saving: decrease of the total cost per m (rad) by which that end is loosened; zero within the range.
    """

    name: str
    tolerance: float
    cost: float
    bound: Literal["least", "greatest"] | None
    saving: float


@dataclass(frozen=True)
class Allocation:
    """Least-cost tolerances.

    parts: the chosen tolerances. cost: their total cost. mechanism: the given mechanism with these tolerances. error:
    its greatest first-order position error, m. saving: decrease of the cost per m by which the limit is raised. angles:
    crank angles, rad, at which the limit is active, ascending; savings: contribution of each to `saving`. residual:
    relative residual of the optimality conditions. rounds: rounds of the exchange. converged: whether the error is
    within the limit to 1e-10 and the residual below 1e-6; otherwise this is the best point found.
    """

    kind: Kind
    limit: float
    parts: tuple[Part, ...]
    cost: float
    mechanism: Mechanism
    error: float
    saving: float
    angles: Array
    savings: Array
    residual: float
    rounds: int
    converged: bool


def allocate_tolerances(
    linkage: Linkage,
    costs: Costs,
    limit: float,
    kind: Kind = "worst case",
    window: Window | None = None,
    *,
    mechanism: Mechanism | None = None,
) -> Allocation:
    """Return the least-cost tolerances that keep the first-order position error of one linkage within a limit, m.

    kind: how errors add up. window: part of the cycle in which the error counts; by default that of the mechanism.
    mechanism: its clearances and its tolerances without a cost use part of the limit; its speed gives the direction of
    rotation. Raises `InfeasibleError` if even the smallest tolerances exceed the limit.
    """
    require_word("kind", kind, Kind)
    if not (math.isfinite(limit) and limit > 0.0):
        raise InputError(f"the limit of the position error must be positive and finite; got {limit:g} m")
    given = Mechanism(branch=linkage.branch) if mechanism is None else mechanism
    if window is not None:
        given = replace(given, tolerances=replace(given.tolerances, window=window))
    return _Programme(
        ErrorRows(given, require_single_rotating_linkage(given, linkage), costs, limit, kind), costs
    ).solve()


@dataclass(frozen=True)
class _Point:
    """Scaled tolerances x, active peaks and their multipliers, the Lagrangian's slope (n,), and its residual."""

    x: Array
    angles: Array
    multipliers: Array
    slope: Array
    residual: float


class _Programme:
    """The programme in x, with the limit as 1."""

    def __init__(self, rows: ErrorRows, costs: Costs) -> None:
        self.error, self.costs = rows, list(costs.costs_by_name.values())
        self.least, self.greatest, at = (
            rows.scale_tolerances(np.array([getattr(cost, name) for cost in self.costs]))
            for name in ("least", "greatest", "at")
        )
        self.q = np.array([cost.exponent for cost in self.costs]) / rows.power
        self.beta = np.array([cost.cost for cost in self.costs]) * at**self.q
        floor, limit = rows.error_peaks(self.least)[0].max(), 1e3 * rows.limit
        if not floor < 1.0:
            raise InfeasibleError(
                "the limit must exceed the position error with the smallest tolerances; got "
                f"{limit:g} mm, below {limit * floor ** (1.0 / rows.power):.6g} mm; raise the limit, "
                "or reduce clearances and the smallest tolerances"
            )

    def solve(self) -> Allocation:
        angles = self.error.start
        for count in range(1, ROUNDS + 1):
            x, carried = self._solve_cone_programme(angles)
            values, at = self.error.error_peaks(x)
            rough = self._collect_multipliers_at_peaks(x, angles, carried, at[values > 1.0 - _NEAR])
            point = self._solve_optimality_conditions(rough) if values.max() <= 1.0 + _NEAR else None
            if point is not None or values.max() <= 1.0 + _EXCESS or count == ROUNDS:
                # Without an exact point, the case is degenerate: as exact as the cone solver, which the residual shows.
                return self._allocation(point or rough, count)
            angles = np.concatenate([angles, at[values > 1.0]])
        raise AssertionError("the last round returns")

    def _solve_cone_programme(self, angles: Array) -> tuple[Array, Array]:
        """Return x and the multipliers of the limit at crank angles (m,), by cvxpy."""
        cp = import_extra("cvxpy", "tolerance allocation needs")
        rows, margin = self.error.rows_at_angles(angles)
        size = float(self.beta.sum())
        x = cp.Variable(len(self.beta))
        terms = zip(self.beta / size, x, -self.q, strict=True)
        cost = sum(share * cp.power(each, exponent, approx=False) for share, each, exponent in terms)
        within = rows @ x <= margin
        rules = [within, x >= self.least]
        ends = np.flatnonzero(np.isfinite(self.greatest))
        if len(ends):
            rules.append(x[ends] <= self.greatest[ends])
        problem = cp.Problem(cp.Minimize(cost), rules)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # an inaccurate answer is a start for the exact conditions
            problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-10, tol_gap_rel=1e-10, tol_feas=1e-10)
        if x.value is None:
            raise InputError(
                f"the cone solver found no tolerances ({problem.status}); costs and bounds must be of comparable size: "
                f"got costs of {self.beta.min():.3g} to {self.beta.max():.3g} for equal shares of the limit"
            )
        return np.clip(x.value, self.least, self.greatest), size * np.maximum(within.dual_value, 0.0)

    def _collect_multipliers_at_peaks(self, x: Array, angles: Array, carried: Array, at: Array) -> _Point:
        """Return the multipliers of sampled angles, collected at the nearest peaks."""
        multipliers = np.zeros(len(at))
        if len(at):
            np.add.at(multipliers, _nearest_angles(angles, at), carried)
        active = multipliers > _CARRIES * multipliers.sum()
        return self._evaluate_point(x, at[active], multipliers[active])

    def _evaluate_point(self, x: Array, angles: Array, multipliers: Array) -> _Point:
        pull = multipliers @ self.error.rows_at_angles(angles)[0] if len(angles) else np.zeros(len(x))
        push = self.q * self.beta * x ** (-self.q - 1.0)
        inside = (x > self.least * (1.0 + _AT_BOUND)) & (x < self.greatest * (1.0 - _AT_BOUND))
        residual = np.abs(pull / push - 1.0)[inside].max(initial=0.0)
        return _Point(x, angles, multipliers, np.where(inside, 0.0, pull - push), float(residual))

    def _solve_optimality_conditions(self, start: _Point) -> _Point | None:
        """Return the point near another that meets the optimality conditions; None if there is none."""
        from scipy.optimize import least_squares

        x = start.x
        low, high = x <= self.least * (1.0 + _AT_BOUND), x >= self.greatest * (1.0 - _AT_BOUND)
        pinned = np.where(low, self.least, np.where(high, self.greatest, x))
        free = np.flatnonzero(~(low | high))
        count, weight = len(free), start.multipliers

        def unpack(z: Array) -> tuple[Array, Array]:
            here = pinned.copy()
            here[free] *= np.exp(z[:count])
            found = self.error.error_peaks(here)[1]
            return here, found[_nearest_angles(start.angles, found)]

        def conditions(z: Array) -> Array:
            here, where = unpack(z)
            rows, margin = self.error.rows_at_angles(where)
            pull = (weight * (1.0 + z[count:])) @ rows
            push = self.q * self.beta * here ** (-self.q - 1.0)
            return np.concatenate([(pull / push - 1.0)[free], rows @ here - margin])

        z = np.zeros(count + len(weight))
        if len(z):
            z = least_squares(conditions, z, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=40).x
            if not np.abs(conditions(z)).max() <= _SOLVED:
                return None
        here, where = unpack(z)
        point = self._evaluate_point(here, where, weight * (1.0 + z[count:]))
        met = (
            np.all(point.multipliers >= 0.0)
            and np.all((here >= self.least) & (here <= self.greatest))
            and np.all(point.slope[low] >= 0.0)
            and np.all(point.slope[high] <= 0.0)
            and self.error.error_peaks(here)[0].max() <= 1.0 + _SOLVED
        )
        return point if met else None

    def _allocation(self, point: _Point, rounds: int) -> Allocation:
        greatest = float(self.error.error_peaks(point.x)[0].max())
        tolerances = self.error.tolerances(point.x)
        parts = []
        for name, cost, t, x, slope in zip(self.error.names, self.costs, tolerances, point.x, point.slope, strict=True):
            bound: Literal["least", "greatest"] | None = None
            if slope != 0.0:
                bound = "least" if slope > 0.0 else "greatest"
            saving = abs(slope) * self.error.power * x / t  # dx = p x dt / t
            parts.append(Part(name, float(t), cost.cost_at(float(t)), bound, float(saving)))
        order = np.argsort(point.angles)
        # d(limit^p) = p limit^p dlimit / limit
        savings = point.multipliers[order] * self.error.power / self.error.limit
        return Allocation(
            "worst case" if self.error.power == 1 else "rss",
            self.error.limit,
            tuple(parts),
            math.fsum(part.cost for part in parts),
            self.error.mechanism_with_tolerances(point.x),
            self.error.limit * greatest ** (1.0 / self.error.power),
            float(savings.sum()),
            point.angles[order],
            savings,
            point.residual,
            rounds,
            greatest <= 1.0 + _EXCESS and point.residual <= _MET,
        )


def _nearest_angles(angles: Array, among: Array) -> NDArray[np.intp]:
    """Return the crank angle nearest to each angle, rad, as an index."""
    distance: Array = np.abs(np.mod(angles[:, None] - among + math.pi, _TURN) - math.pi)
    return np.asarray(distance.argmin(axis=1))
