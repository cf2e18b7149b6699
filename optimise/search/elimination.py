"""Exact elimination of equality requirements: the search moves only in the remaining free unknowns.

Unknowns are crank r, rod l and a = |offset|. Each requirement is a rule that computes one unknown from others. A set of
free unknowns is chosen from which the rules, applied in turn, give the rest. Requirements without a rule remain
equality constraints for the solver. Extra variables are free, because no rule computes them.
"""

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.errors import InfeasibleError
from ...model.kernel.arithmetic import STEP
from ...model.kinematics import geometry
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.formula.expression import Linear
from ...objectives.lengths_and_time_ratio import CRANK_ANGLE_RATIO, ROD_TO_CRANK, ROD_TO_OFFSET, STROKE, TIME_RATIO
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Range
from ..problem.restatement import restate_constraint
from .lever_rules import lever_rules
from .linear_rules import (
    NOTHING,
    Block,
    Rule,
    equation_blocks,
    evaluate_linear_rule,
    linear_equations,
    solve_for_target,
    swing_rules,
)

_LINEAR = "linear: "
"""Prefix for the origin of a rule from linear equalities."""
ZERO = 1e-300
"""An offset of this magnitude counts as zero."""


class ClosedRule(Rule):
    """A rule from `_FORMULAS`."""

    def formula(self, *sources: Any) -> Any:
        """Return the target computed from the sources."""
        return _FORMULAS[self.origin, self.target][1](*self.values, *sources)


class LinearRule(Rule):
    """A rule from a set of linear equalities. wanted: numbers from `linear_rules.solve_for_target`."""

    def formula(self, *sources: Any) -> Any:
        """Return the target computed from the sources."""
        return evaluate_linear_rule(*self.values, *sources)


@dataclass(frozen=True)
class EliminationBranch:
    """One sign of the offset, with the free unknowns and the steps that compute the others.

    sign: sign of the offset. free: names of the free unknowns; crank, rod and offset precede extra variables. lower,
    upper: bounds on the free unknowns, SI. bounds: bounds on all unknowns, SI. names: names of all unknowns, in the
    order of a design's numbers. variant: index of the combination of the problem's choices, see `Problem.part`.
    eliminated: requirements that hold exactly unless a chosen root is spurious, which `evaluation` checks. remaining:
    constraints left to the solver.
    """

    sign: float
    free: tuple[str, ...]
    lower: Array
    upper: Array
    bounds: dict[str, Range]
    steps: tuple[Rule, ...]
    eliminated: tuple[str, ...]
    remaining: tuple[Constraint, ...]
    names: tuple[str, ...] = DIMENSIONS
    variant: int = 0

    def designs_at_points(self, u: Any) -> Any:
        """Return designs (n, 3 + v) for points (n, k) in the unit box; NaN where requirements cannot hold.

        Columns: crank, rod, offset, m, and extra variables, SI. Complex points give complex designs.
        """
        u = np.atleast_2d(u)
        unknowns: dict[str, Any] = {
            name: np.full(len(u), bounds.lower, dtype=u.dtype) for name, bounds in self.bounds.items() if bounds.fixed
        }
        for column, name in enumerate(self.free):
            unknowns[name] = self.lower[column] * (1.0 - u[:, column]) + self.upper[column] * u[:, column]  # exact ends
        if self.steps:
            with np.errstate(all="ignore"):
                as_many = 0.0 * u.sum(axis=1)
                for step in self.steps:
                    unknowns[step.target] = step.formula(*(unknowns[name] for name in step.sources)) + as_many
        offset = self.sign * unknowns["offset"]
        if self.sign < 0.0:  # keeps its side of the kink of |offset| at zero, where the derivative depends on the sign
            offset = np.where(offset == 0.0, offset - ZERO, offset)
        designs = np.empty((len(u), len(self.names)), dtype=u.dtype)
        designs[:, 0], designs[:, 1], designs[:, 2] = unknowns["crank"], unknowns["rod"], offset
        for column, name in enumerate(self.names[3:], 3):
            designs[:, column] = unknowns[name]
        return designs

    def points_of_designs(self, designs: Array) -> Array:
        """Return the points (n, k) in the unit box with the free unknowns of designs (n, 3 + v).

        Values outside their range move to the nearer end. A design that meets the eliminated requirements is
        reproduced.
        """
        sizes = np.concatenate([np.abs(designs[:, :3]), designs[:, 3:]], axis=1)
        columns = [sizes[:, self.names.index(name)] for name in self.free]
        u = np.stack(columns, axis=1) if columns else np.zeros((len(designs), 0))
        return np.clip((u - self.lower) / np.where(self.upper > self.lower, self.upper - self.lower, 1.0), 0.0, 1.0)

    def jacobian(self, u: Array) -> Array:
        """Return the derivatives (n, 3 + v, k) of the designs by the unit-box coordinates, by complex step."""
        n, k = u.shape
        stepped = u[:, None] + 1j * STEP * np.eye(k)
        slopes = self.designs_at_points(stepped.reshape(n * k, k)).imag / STEP
        return np.ascontiguousarray(slopes.reshape(n, k, len(self.names)).transpose(0, 2, 1))


def elimination_branches(problem: Problem, *, eliminate: bool = True) -> tuple[EliminationBranch, ...]:
    """Return the branches of a problem: one for each possible sign of the offset, in every variant of its choices.

    Each solution of a rule has a separate branch. Branches with free unknowns come first, for the search; each of the
    others has a single design. eliminate: whether to eliminate equality constraints (fixed dimensions always are). At
    constant speed, a required slow stroke leaves one sign. Raises `InfeasibleError` if the ranges have no offset with
    that sign.
    """
    parts = problem.parts()
    require_offset_for_slow_stroke(problem, parts)
    branches = (
        replace(branch, steps=steps)
        for variant, part in enumerate(parts)
        for sign, offset in offset_signs(part)
        for branch in [_build_branch(part, sign, offset, eliminate=eliminate, variant=variant)]
        for steps in itertools.product(*(step.solutions for step in branch.steps))
    )
    return tuple(sorted(branches, key=lambda branch: not branch.free))


def require_offset_for_slow_stroke(problem: Problem, parts: tuple[Problem, ...]) -> None:
    """Raise `InfeasibleError` if no offset within the range of any part gives the required slow stroke."""
    if any(offset_signs(part) for part in parts):
        return
    part = parts[0]
    side = part.slow_side()
    assert side is not None
    turning, opposite = ("counter-clockwise", "clockwise")[:: 1 if part.mechanism.direction > 0.0 else -1]
    position = "above" if side > 0.0 else "below"
    raise InfeasibleError(
        f"constraints.slow_stroke: with a crank that turns {turning}, on the {part.mechanism.branch} branch, the "
        f"{part.slow_stroke} stroke is slow if the offset is {position} 0; got an offset from "
        f"{1e3 * problem.offset.lower:.6g} to {1e3 * problem.offset.upper:.6g} mm; let the offset go {position} 0"
        + ("" if part.offset.lower == part.offset.upper == 0.0 else f", or let the crank turn {opposite}")
    )


def offset_signs(problem: Problem) -> list[tuple[float, Range]]:
    """Return the signs that the offset may have, each with the range of its magnitude."""
    lower, upper = problem.offset.lower, problem.offset.upper
    signed = []
    if upper > 0.0 or lower == upper == 0.0:
        signed.append((1.0, Range(lower=max(lower, 0.0), upper=upper)))
    if lower < 0.0:
        signed.append((-1.0, Range(lower=max(-upper, 0.0), upper=-lower)))
    side = problem.slow_side()
    return signed if side is None else [(sign, sizes) for sign, sizes in signed if sign == side and sizes.upper > 0.0]


def _build_branch(problem: Problem, sign: float, offset: Range, *, eliminate: bool, variant: int) -> EliminationBranch:
    bounds = problem.ranges | {"offset": offset}
    required, restated = _requested_values(problem)
    equations: dict[str, Linear] = {}
    if eliminate:
        equations = linear_equations({problem.quantity(name): value for name, value in required.items()}, sign)
    unsolved = {name: value for name, value in required.items() if name not in equations and eliminate}
    rules = [
        *_closed_rules(unsolved, steady=problem.mechanism.speed_profile is None),
        *swing_rules(problem, unsolved, sign),
        *lever_rules(problem, unsolved),
    ]
    fixed = tuple(name for name in DIMENSIONS if bounds[name].fixed)
    # Rod and offset first, because a crank computed from the stroke is the best-conditioned direction of that relation.
    loose = [name for name in ("rod", "offset", "crank") if name not in fixed]
    solved = [block for block in equation_blocks(equations, loose) if block.targets] or [NOTHING]
    extra = [*bounds][len(DIMENSIONS) :]
    best: tuple[tuple[int, int, bool, int], tuple[str, ...], tuple[Rule, ...], set[str]] | None = None
    for size in range(len(loose) + 1):
        for free in itertools.combinations(loose, size):
            for block in solved:
                for steps in _rule_orders({*free, *fixed, *extra}, [*rules, *_linear_rules(block)]):
                    fulfilled = _fulfilled_requirements(steps, block)
                    roots = math.prod(len(step.solutions) for step in steps)
                    score = (len(required) - len(fulfilled), size, not fulfilled.issuperset(block.origins), roots)
                    if best is None or score < best[0]:
                        best = (score, free, steps, fulfilled)
    assert best is not None  # it always works with all unknowns free
    _, free, steps, fulfilled = best
    free = (*free, *(name for name in extra if not bounds[name].fixed))
    return EliminationBranch(
        sign=sign,
        free=free,
        lower=np.array([bounds[name].lower for name in free]),
        upper=np.array([bounds[name].upper for name in free]),
        bounds=bounds,
        steps=steps,
        eliminated=tuple(name for name, quantity in restated.items() if quantity in fulfilled),
        remaining=tuple(c for c in problem.constraints if restated.get(c.quantity) not in fulfilled),
        names=tuple(bounds),
        variant=variant,
    )


def _requested_values(problem: Problem) -> tuple[dict[str, float], dict[str, str]]:
    """Return the values required by equalities, by quantity, and the quantity of each equality.

    A formula that restates a known quantity counts as that quantity, unless another value of it is required too.
    """
    equalities = {c.quantity: float(c.lower) for c in problem.constraints if c.equality and c.lower is not None}
    required: dict[str, float] = {}
    restated: dict[str, str] = {}
    for constraint in problem.constraints:
        if constraint.quantity in equalities:
            restated_constraint = restate_constraint(problem, constraint)
            value = (
                equalities[constraint.quantity]
                if restated_constraint.lower is None
                else float(restated_constraint.lower)
            )
            same = {**equalities, **required}.get(restated_constraint.quantity, value) == value
            name, value = (
                (restated_constraint.quantity, value)
                if same
                else (constraint.quantity, equalities[constraint.quantity])
            )
            required[name], restated[constraint.quantity] = value, name
    return required, restated


def _rule_orders(computed: set[str], rules: list[Rule], steps: tuple[Rule, ...] = ()) -> Iterator[tuple[Rule, ...]]:
    """Yield every order of rules that computes the remaining unknowns.

    Each requirement is one equation, so each rule is used once. A combination of two requirements may be followed by
    one of them alone, which completes the pair.
    """
    if computed.issuperset(DIMENSIONS):
        yield steps
    spent = {step.origin for step in steps}
    for rule in rules:
        if rule.origin not in spent and rule.target not in computed and set(rule.sources) <= computed:
            yield from _rule_orders(computed | {rule.target}, rules, (*steps, rule))


def _linear_rules(block: Block) -> Iterator[LinearRule]:
    """Yield the rules from solved linear equalities, one for each target."""
    for target, row in zip(block.targets, block.rows, strict=True):
        yield LinearRule(f"{_LINEAR}{target}", target, *solve_for_target(row, target))


def _fulfilled_requirements(steps: tuple[Rule, ...], block: Block) -> set[str]:
    """Return the requirements that hold exactly after these steps.

    On its own, a combination's rule enforces one relation between two requirements, but satisfies neither. Linear
    equalities hold once all their rules are used.
    """
    single = {step.origin for step in steps if "+" not in step.origin and not isinstance(step, LinearRule)}
    if sum(isinstance(step, LinearRule) for step in steps) == len(block.targets):
        single |= set(block.origins)
    for step in steps:
        parts = set() if isinstance(step, LinearRule) else set(step.origin.split("+"))
        if len(parts) > 1 and parts & single:
            single |= parts
    return single


def _closed_rules(required: dict[str, float], *, steady: bool) -> list[Rule]:
    """Return every rule for the required values. steady: whether the time ratio follows from the crank angles."""
    rules: list[Rule] = []
    for (origin, target), (sources, _) in _FORMULAS.items():
        names = origin.split("+")
        if all(name in required for name in names) and (steady or TIME_RATIO.name not in names):
            rules.append(ClosedRule(origin, target, sources, tuple(required[name] for name in names)))
    # At a ratio of one, the dead centres are opposite for any rod.
    level = {
        pair
        for name, pair in _PAIRS.items()
        if name in required and _sine_and_cosine_of_excess_angle(required[name])[1] == 1.0
    }
    return [rule for rule in rules if rule.origin not in level or rule.target != "rod"]


def _sine_and_cosine_of_excess_angle(ratio: float) -> tuple[float, float]:
    """Return sine and cosine of the excess angle b for a crank angle ratio."""
    b = math.pi * (ratio - 1.0) / (ratio + 1.0)
    return math.sin(b), math.cos(b)


def _crank_from_stroke_and_ratio(stroke: float, ratio: float, l: Any) -> Any:
    """Return the crank from the cosine rule in the triangle of crank pivot and dead centres.

    l^2 (1 - cos b) + r^2 (1 + cos b) = S^2 / 2.
    """
    cosine = _sine_and_cosine_of_excess_angle(ratio)[1]
    return np.sqrt((0.5 * stroke**2 - l * l * (1.0 - cosine)) / (1.0 + cosine))


def _rod_from_stroke_and_ratio(stroke: float, ratio: float, r: Any) -> Any:
    """Return the rod from the same rule."""
    cosine = _sine_and_cosine_of_excess_angle(ratio)[1]
    return np.sqrt((0.5 * stroke**2 - r * r * (1.0 + cosine)) / (1.0 - cosine))


def _offset_from_ratio(ratio: float, r: Any, l: Any) -> Any:
    return geometry.offset_from_excess_angle(r, l, *_sine_and_cosine_of_excess_angle(ratio))


_PAIRS = {ratio.name: f"{STROKE.name}+{ratio.name}" for ratio in (TIME_RATIO, CRANK_ANGLE_RATIO)}
_FORMULAS: dict[tuple[str, str], tuple[tuple[str, ...], Callable[..., Any]]] = {
    (ROD_TO_OFFSET.name, "rod"): (("offset",), lambda k, a: k * a),
    (ROD_TO_OFFSET.name, "offset"): (("rod",), lambda k, l: l / k),
    (ROD_TO_CRANK.name, "rod"): (("crank",), lambda q, r: q * r),
    (ROD_TO_CRANK.name, "crank"): (("rod",), lambda q, l: l / q),
    (TRANSMISSION_ANGLE.name, "rod"): (("crank", "offset"), lambda mu, r, a: (r + a) / math.cos(mu)),
    (TRANSMISSION_ANGLE.name, "crank"): (("rod", "offset"), lambda mu, l, a: math.cos(mu) * l - a),
    (TRANSMISSION_ANGLE.name, "offset"): (("crank", "rod"), lambda mu, r, l: math.cos(mu) * l - r),
    (_PAIRS[TIME_RATIO.name], "crank"): (("rod",), _crank_from_stroke_and_ratio),
    (_PAIRS[TIME_RATIO.name], "rod"): (("crank",), _rod_from_stroke_and_ratio),
    (TIME_RATIO.name, "offset"): (("crank", "rod"), _offset_from_ratio),
    (STROKE.name, "crank"): (("rod", "offset"), geometry.crank_from_stroke),
    (STROKE.name, "rod"): (("crank", "offset"), geometry.rod_from_stroke),
    (STROKE.name, "offset"): (("crank", "rod"), geometry.offset_from_stroke),
    (_PAIRS[CRANK_ANGLE_RATIO.name], "crank"): (("rod",), _crank_from_stroke_and_ratio),
    (_PAIRS[CRANK_ANGLE_RATIO.name], "rod"): (("crank",), _rod_from_stroke_and_ratio),
    (CRANK_ANGLE_RATIO.name, "offset"): (("crank", "rod"), _offset_from_ratio),
}
"""By requirements and target: the sources, and the formula for the target from the required values and the sources."""
