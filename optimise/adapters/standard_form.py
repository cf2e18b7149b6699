"""Standard form of a problem for other optimisers: bounds, minimised objectives, G <= 0 and H = 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...model.errors import InputError
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.quantity import Array
from ...objectives.tables.design_input import designs_as_array
from ..problem.constraint_violation import FEASIBLE, constraints_with_floors, minimised_values
from ..problem.problem import Problem, require_problem
from ..problem.requirements import Constraint, Objective
from ..search.elimination import EliminationBranch, elimination_branches

if TYPE_CHECKING:
    from scipy.optimize import Bounds, LinearConstraint, NonlinearConstraint

Row = tuple[Array, Array]
_MARGIN = 0.02
"""Minimum excess of the rod over crank + |offset|, as a fraction of the rod, if no transmission angle is required;
equals 11.5 deg."""


class Arrays(NamedTuple):
    """Objectives and requirements of n designs, and their Jacobians.

    F (n, m) is minimised; G (n, g) <= 0; H (n, h) = 0. The Jacobians (n, ., 3 + k) have shape (n, ., 0) unless
    requested.
    """

    F: Array
    G: Array
    H: Array
    dF: Array
    dG: Array
    dH: Array


class ScipyForm(NamedTuple):
    """Arguments for `scipy.optimize.minimize` and similar functions: bounds, constraints, a start near the middle."""

    fun: Callable[[Array], float]
    jac: Callable[[Array], Array]
    x0: Array
    bounds: Bounds
    constraints: list[LinearConstraint | NonlinearConstraint]


@dataclass(frozen=True, eq=False)
class StandardForm:
    """A problem in standard form, with x = (crank, rod, offset, extra variables), SI.

    names: names of the variables. lower, upper: their bounds (3 + k,). objectives, inequalities, equalities: labels of
    the columns of F, G and H. Objectives have the order of `Problem.objectives`, which may differ from the job's: see
    `objectives`. Maximised objectives are negated; an objective with a target becomes the distance from it. Each
    requirement is divided by the magnitude of its bound. The first two inequalities keep the crank rotating fully:
    crank + offset and crank - offset below the rod. A swing omits both, because its crank need not rotate fully. With
    eliminated equalities, x holds the remaining free unknowns, each from 0 to 1; `designs` converts x to designs. The
    bounds on computed dimensions are then the last inequalities.
    """

    problem: Problem
    names: tuple[str, ...]
    lower: Array
    upper: Array
    objectives: tuple[str, ...]
    inequalities: tuple[str, ...]
    equalities: tuple[str, ...]
    _constraints: tuple[Constraint, ...]
    _branch: EliminationBranch | None = None

    def designs(self, x: ArrayLike) -> Array:
        """Return the designs (..., 3 + k) of points x; NaN where the eliminated equalities have no solution."""
        points = designs_as_array(x, self.names)
        if self._branch is None:
            return points
        designs: Array = self._branch.designs_at_points(points.reshape(-1, len(self.names)))
        return designs.reshape(*points.shape[:-1], designs.shape[1])

    def arrays(self, x: ArrayLike, *, gradients: bool = False) -> Arrays:
        """Return F, G and H at points x (n, 3 + k), with their Jacobians if `gradients`.

        F, G and H are infinite, and their Jacobians NaN, if a design does not rotate fully. The exceptions are the
        first two columns of G, which measure how far it is from rotating fully. If a design cannot make the swing, all
        are infinite. Raises `InputError` as `Problem.evaluate` does.
        """
        points = designs_as_array(x, self.names)
        x = self.designs(points)
        names = tuple(dict.fromkeys([*self.objectives, *(c.quantity for c in self._constraints)]))
        values, slopes = (
            self.problem.evaluate(x, names, gradients=True)
            if gradients
            else (self.problem.evaluate(x, names), np.zeros((*x.shape[:-1], len(names), 0)))
        )
        at = {name: (values[..., i], slopes[..., i, :]) for i, name in enumerate(names)}
        f = [_minimised_value_and_slope(objective, *at[objective.quantity]) for objective in self.problem.objectives]
        g, h = (
            _full_rotation_rows(x, self._constraints, slopes.shape[-1]) if self._must_rotate_fully else [],
            list[Row](),
        )
        for constraint in self._constraints:
            value, slope = at[constraint.quantity]
            for word, bound in reversed(constraint.sides):
                (h if word == "equals" else g).append(
                    _scaled_excess_row(value, slope, bound, -1.0 if word == "min" else 1.0)
                )
        if self._branch is not None:
            g += _computed_range_rows(x, self._branch, slopes.shape[-1])
            f, g, h = (_rule_out_spurious_roots(rows, x, self.problem, self._branch) for rows in (f, g, h))
            if gradients:
                chain = self._branch.jacobian(points.reshape(-1, len(self.names)))
                chain = chain.reshape(*points.shape[:-1], *chain.shape[1:])
                f, g, h = ([(v, (d[..., None, :] @ chain)[..., 0, :]) for v, d in rows] for rows in (f, g, h))
        width = len(self.names) if gradients else 0
        (F, dF), (G, dG), (H, dH) = (_join_rows(rows, x.shape[:-1], width) for rows in (f, g, h))
        return Arrays(F, G, H, dF, dG, dH)

    def scipy(self, objective: str | None = None, *, keep_feasible: bool = False) -> ScipyForm:
        """Return arguments for `scipy.optimize`: `minimize(**form.scipy()._asdict(), method="SLSQP")`.

        objective: name of the objective; required if the problem has several. keep_feasible: whether every iterate must
        rotate fully; trust-constr needs it, SLSQP does not support it. Raises `InputError` if the objective is missing
        or unknown, and for quantities without a gradient.
        """
        from scipy.optimize import Bounds, LinearConstraint, NonlinearConstraint

        column = self._column(objective)
        lacking = self.problem.without_gradient()
        if lacking:
            raise InputError(f'a gradient is needed; got {lacking[0]} with gradient = "none"; use finite differences')
        constraints: list[LinearConstraint | NonlinearConstraint] = []
        first = 0
        if self._branch is None and self._must_rotate_fully:
            share, rest = _greatest_crank_to_rod_ratio(self._constraints), np.zeros((2, len(self.names) - 3))
            turning = np.column_stack([[[1.0, -share, 1.0], [1.0, -share, -1.0]], rest])
            constraints.append(LinearConstraint(turning, -np.inf, 0.0, keep_feasible=keep_feasible))
            first = 2  # linear rows of G
        if len(self.inequalities) > first:
            inner, slope = (lambda x: self.arrays(x).G[first:]), (lambda x: self.arrays(x, gradients=True).dG[first:])
            constraints.append(NonlinearConstraint(inner, -np.inf, 0.0, jac=slope))
        if self.equalities:
            equations, slope = (lambda x: self.arrays(x).H), (lambda x: self.arrays(x, gradients=True).dH)
            constraints.append(NonlinearConstraint(equations, 0.0, 0.0, jac=slope))
        return ScipyForm(
            lambda x: float(self.arrays(x).F[column]),
            lambda x: self.arrays(x, gradients=True).dF[column],
            self.start(),
            Bounds(self.lower, self.upper, keep_feasible=keep_feasible),
            constraints,
        )

    def start(self) -> Array:
        """Return a point near the middle of the bounds whose crank rotates fully, or makes the problem's swing.

        Raises `InputError` if no such point exists.
        """
        if self._branch is not None or not self._must_rotate_fully:
            grid = self.lower + np.random.default_rng(1).random((4096, len(self.names))) * (self.upper - self.lower)
            arrays = self.arrays(grid)
            worst = np.concatenate([arrays.G, np.abs(arrays.H)], axis=1).max(axis=1, initial=-1e300)
            worst[~np.isfinite(arrays.F).all(axis=1)] = np.inf
            if not np.isfinite(worst).any():
                task = "makes the swing" if self._branch is None else "meets the equalities"
                raise InputError(f"no design within the ranges {task}; 4,096 were tried; widen the ranges")
            return np.asarray(grid[np.argmin(worst)])
        middle = 0.5 * (self.lower + self.upper)
        near = min(max(0.0, self.lower[2]), self.upper[2])
        for share in np.linspace(0.0, 1.0, 33):
            start = middle.copy()
            start[0] += share * (self.lower[0] - start[0])
            start[1] += share * (self.upper[1] - start[1])
            start[2] += share * (near - start[2])
            if self.arrays(start).G[:2].max() <= 0.0:
                return start
        raise InputError(
            f"no design within the ranges rotates fully; got a rod of at most {1e3 * self.upper[1]:g} mm; allow a "
            "longer rod or a shorter crank"
        )

    @property
    def _must_rotate_fully(self) -> bool:
        return self.problem.motion is None

    def _column(self, objective: str | None) -> int:
        if objective is None and len(self.objectives) == 1:
            return 0
        if objective not in self.objectives:
            raise InputError(
                f"one objective is needed; got {objective!r} of {', '.join(self.objectives)}; name one of them"
            )
        return self.objectives.index(objective)


def standard_form(problem: Problem, *, eliminate: bool = False, elimination_branch: int | None = None) -> StandardForm:
    """Return a problem in standard form for other optimisers.

    eliminate: whether to eliminate equality constraints exactly, as `solve` does. This leaves fewer unknowns, and suits
    methods that cannot handle equalities, such as most genetic algorithms. elimination_branch: index, from 0, of a
    solution branch of the equalities, such as offsets above and below 0; each branch has its own form.

    The requirements are those of `solve`, with its default floors: a transmission angle of 10 deg and, with friction, a
    self-locking margin of 5 deg. Without equalities, offsets of both signs share one form, whose x are designs. Raises
    `InputError` for a problem with choices (use its `parts`) or with discrete values. With `eliminate`, also raises it
    if the equalities have several branches and none is selected; the message lists them.
    """
    require_problem(problem, "standard_form")
    if problem.variants:
        raise InputError(
            f"other optimisers cannot handle choices ({', '.join(problem.choices)}); got {len(problem.variants)} "
            "variants; use one of problem.parts()"
        )
    if problem.discrete:
        raise InputError(
            "other optimisers need ranges; got discrete values of "
            f"{', '.join(item.name for item in problem.discrete)}; leave out step, series and values"
        )
    if elimination_branch is not None and not eliminate:
        raise InputError(
            f"elimination_branch needs eliminated equalities; got elimination_branch={elimination_branch!r} with "
            "eliminate=False; set eliminate=True, or leave out elimination_branch"
        )
    constraints = constraints_with_floors(problem)
    branch = _requested_branch(problem, elimination_branch) if eliminate else None
    if branch is None:
        names, ranges = tuple(problem.ranges), problem.ranges.values()
        lower, upper = (np.array([getattr(item, end) for item in ranges], np.float64) for end in ("lower", "upper"))
        side = problem.slow_side()
        if side is not None:
            lower[2], upper[2] = (max(lower[2], 0.0), upper[2]) if side > 0.0 else (lower[2], min(upper[2], 0.0))
    else:
        names, lower, upper = branch.free, np.zeros(len(branch.free)), np.ones(len(branch.free))
        constraints = tuple(c for c in constraints if c.quantity not in branch.eliminated)
    bounded = [c.quantity for c in constraints if not c.equality for _ in c.sides]
    computed = [] if branch is None else [name for name in _eliminated_dimension_names(branch) for _ in range(2)]
    return StandardForm(
        problem,
        names,
        lower,
        upper,
        tuple(objective.quantity for objective in problem.objectives),
        (*(() if problem.motion else ("turning", "turning")), *bounded, *computed),
        tuple(c.quantity for c in constraints if c.equality),
        constraints,
        branch,
    )


def _requested_branch(problem: Problem, index: int | None) -> EliminationBranch | None:
    """Return the requested or the only branch of a problem whose equalities are eliminated.

    None if there is nothing to eliminate and no branch is requested. Raises `InputError`.
    """
    branches = elimination_branches(problem)
    if index is None and len(branches) > 1 and not any(constraint.equality for constraint in problem.constraints):
        return None
    if index is None and len(branches) == 1:
        index = 0
    if isinstance(index, bool) or not isinstance(index, int) or not 0 <= index < len(branches):
        if len(branches) == 1:
            raise InputError(
                f"eliminating equalities gives one branch here, 0; got elimination_branch={index!r}; leave "
                "elimination_branch out"
            )
        several = "; ".join(f"{place}: offset {_branch_label(branch)}" for place, branch in enumerate(branches))
        raise InputError(
            f"eliminating equalities needs one of their branches; got {index!r} of {len(branches)} ({several}); make a "
            f"form for each, with elimination_branch=0 to {len(branches) - 1}, or keep the equalities, with "
            "eliminate=False"
        )
    if not branches[index].free:
        raise InputError(
            "the equalities and ranges must leave an unknown free; none is left; widen a range, or use solve"
        )
    return branches[index]


def _branch_label(branch: EliminationBranch) -> str:
    """Describe a branch: the sign of its offsets, and which of several roots it takes."""
    side = "above 0" if branch.sign > 0.0 else "below 0"
    roots = [
        f"root {step.solutions.index(step) + 1} for {step.target}" for step in branch.steps if len(step.solutions) > 1
    ]
    return ", ".join([side, *roots])


def _eliminated_dimension_names(branch: EliminationBranch) -> list[str]:
    return [name for name in branch.names[:3] if any(step.target == name for step in branch.steps)]


def _computed_range_rows(x: Array, branch: EliminationBranch, width: int) -> list[Row]:
    """Columns of G for the bounds on computed dimensions; an offset counts by its magnitude."""
    rows = []
    for name in _eliminated_dimension_names(branch):
        column, ends = branch.names.index(name), branch.bounds[name]
        sign = branch.sign if name == "offset" else 1.0
        slope = np.zeros((*x.shape[:-1], width))
        slope[..., column : column + 1] = sign if width else 0.0
        value = sign * x[..., column]
        rows += [_scaled_excess_row(value, slope, ends.upper, 1.0), _scaled_excess_row(value, slope, ends.lower, -1.0)]
    return rows


def _rule_out_spurious_roots(rows: list[Row], x: Array, problem: Problem, branch: EliminationBranch) -> list[Row]:
    """Return columns that are infinite where an eliminated equality fails because its formula gave another root."""
    equalities = [c for c in problem.constraints if c.quantity in branch.eliminated]
    values = problem.evaluate(x, [c.quantity for c in equalities])
    target = np.array([c.lower for c in equalities], dtype=np.float64)
    holds = (np.abs(values - target) <= FEASIBLE * np.maximum(np.abs(target), 1e-9)).all(axis=-1)
    return [(np.where(holds, value, np.inf), slope) for value, slope in rows]


def _greatest_crank_to_rod_ratio(constraints: tuple[Constraint, ...]) -> float:
    """Greatest allowed ratio of crank + |offset| to rod."""
    floor = next((c.lower for c in constraints if c.quantity == TRANSMISSION_ANGLE.name and c.lower is not None), None)
    return 1.0 - _MARGIN if floor is None or not 0.0 < floor < 1.5 else float(np.cos(floor))


def _full_rotation_rows(x: Array, constraints: tuple[Constraint, ...], width: int) -> list[Row]:
    """Columns of G that keep the crank rotating fully: the transmission angle's floor, linear in the dimensions."""
    share, rows = _greatest_crank_to_rod_ratio(constraints), []
    for sign in (1.0, -1.0):
        size = np.abs(x[..., 1])
        slope = np.zeros((*x.shape[:-1], width))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # infinite for a rod of zero length
            value = (x[..., 0] + sign * x[..., 2] - share * x[..., 1]) / size
            if width:
                slope[..., 0], slope[..., 2] = 1.0 / size, sign / size
                slope[..., 1] = -(x[..., 0] + sign * x[..., 2]) / (size * x[..., 1])
        rows.append((value, slope))
    return rows


def _minimised_value_and_slope(objective: Objective, value: Array, slope: Array) -> tuple[Array, Array]:
    objectives = minimised_values(objective, value)
    if objective.sense == "maximise":
        slope = -slope
    elif objective.target is not None:
        slope = np.sign(value - objective.target)[..., None] * slope
    return np.where(np.isnan(objectives), np.inf, objectives), slope


def _scaled_excess_row(value: Array, slope: Array, bound: float, sign: float) -> tuple[Array, Array]:
    scale = sign / (abs(bound) or 1.0)
    excess = scale * (value - bound)
    return np.where(np.isnan(excess), np.inf, excess), scale * slope


def _join_rows(rows: list[Row], shape: tuple[int, ...], width: int) -> tuple[Array, Array]:
    if not rows:
        return np.zeros((*shape, 0)), np.zeros((*shape, 0, width))
    return np.stack([value for value, _ in rows], axis=-1), np.stack([slope for _, slope in rows], axis=-2)
