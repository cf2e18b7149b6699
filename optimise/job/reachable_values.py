"""Possible values within the ranges of crank, rod and offset, from the `Reach` of quantities."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...model.arrays import Array
from ...model.errors import InfeasibleError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.bounds_over_ranges import CLEAR, LengthRanges
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.formula.quantity import FormulaQuantity, linear_equation_of
from ...objectives.lengths_and_time_ratio import (
    CRANK_ANGLE_RATIO,
    ROD_TO_CRANK,
    ROD_TO_OFFSET,
    STROKE,
    TIME_RATIO,
    time_ratio_of_excess_angle,
)
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from ..problem.problem import Problem
from ..problem.requirements import RELATIONS, Constraint, Range
from .mistake_messages import key_of_location

if TYPE_CHECKING:
    from ..feasibility.relaxation import Relaxation

SLACK = 1e-9
"""Requirements at the very edge are left to the optimiser, so that rounding does not make them contradictions."""
STROKE_RATIOS = (TIME_RATIO, CRANK_ANGLE_RATIO)
"""Stroke ratios that conflict with the transmission angle."""
_CELLS = 10_000
_OTHERS = "the other requirements on the dimensions"
_ACTIVE = 1e-6
"""Relative distance from a bound within which a rule counts as active at the best design."""
_ANY = Range(lower=0.0, upper=1.0)


@dataclass(frozen=True, kw_only=True)
class Box:
    """Ranges of crank, rod and |offset|, m, and of offset / rod, narrowed by the constraints."""

    crank: Range
    rod: Range
    offset: Range
    share: Range = _ANY

    @classmethod
    def from_problem(cls, problem: Problem) -> Box:
        """Return the ranges of a problem, not yet narrowed."""
        return cls(crank=problem.crank, rod=problem.rod, offset=_offset_magnitude_range(problem.offset))

    def bounds_on_quantity(self, quantity: Quantity) -> tuple[float, float]:
        """Return bounds on a quantity that has a reach, SI; needs `turns`."""
        assert quantity.bounds is not None
        ends = ((ends.lower, ends.upper) for ends in (self.crank, self.rod, self.offset))
        return quantity.bounds.compute(LengthRanges(*(end for pair in ends for end in pair)))

    @property
    def may_rotate_fully(self) -> bool:
        """Whether some linkage within the ranges may rotate fully."""
        clear = self.rod.upper > (self.crank.lower + self.offset.lower) * CLEAR
        return clear and self.rod.upper * (1.0 - self.share.lower) > self.crank.lower


def require_reachable(problem: Problem) -> None:
    """Raise InfeasibleError if full rotation or a constraint on geometry is out of reach within the ranges."""
    box = Box.from_problem(problem)
    if not box.may_rotate_fully:
        raise InfeasibleError(
            "variables: the rod must exceed crank + |offset| for full rotation; "
            f"got {_extremes_text(box)}; lengthen the rod or reduce the other two"
        )
    constraints = {constraint.quantity: constraint for constraint in problem.constraints}
    if ROD_TO_OFFSET.name in constraints:
        box = _narrow_by_rod_to_offset(box, constraints[ROD_TO_OFFSET.name], problem)
    formulas = (of for of in problem.own if isinstance(of, FormulaQuantity) and of.depends_only_on_dimensions)
    for of in (ROD_TO_CRANK, STROKE, *STROKE_RATIOS, TRANSMISSION_ANGLE, *formulas):
        if of.name in constraints:
            _require_overlap(of, constraints[of.name], box, problem)
    for of in STROKE_RATIOS:
        wrong = ratio_and_angle_conflict(problem, of, box.share)
        if wrong:
            raise InfeasibleError(f"constraints.{of.name}: {wrong}")


def _narrow_by_rod_to_offset(box: Box, constraint: Constraint, problem: Problem) -> Box:
    """Return the box narrowed to k_min |offset| <= rod <= k_max |offset|; raise InfeasibleError if nothing remains."""
    if box.offset.upper == 0.0:
        raise InfeasibleError(
            f"constraints.{ROD_TO_OFFSET.name}: needs an offset; the offset is fixed at 0; give variables.offset a "
            "range"
        )
    _require_overlap(ROD_TO_OFFSET, constraint, box, problem)
    least, greatest = constraint.lower or 0.0, constraint.upper or math.inf
    l0, l1 = box.rod.lower, box.rod.upper
    a0, a1 = box.offset.lower, box.offset.upper
    l0, l1 = max(l0, least * a0), min(l1, greatest * a1)
    a0, a1 = max(a0, l0 / greatest), min(a1, l1 / least if least else a1)
    narrowed = Box(
        crank=box.crank,
        rod=Range(lower=min(l0, l1), upper=l1),
        offset=Range(lower=min(a0, a1), upper=a1),
        share=Range(lower=1.0 / greatest, upper=min(1.0, 1.0 / least if least else 1.0)),
    )
    if not narrowed.may_rotate_fully:
        raise InfeasibleError(
            f"constraints.{ROD_TO_OFFSET.name}: full rotation needs a crank below rod - |offset|; got "
            f"{_bounds_text(constraint)} and with it {_extremes_text(narrowed)}; shorten the crank, or raise the "
            "ratio"
        )
    return narrowed


def _require_overlap(quantity: Quantity, constraint: Constraint, box: Box, problem: Problem) -> None:
    """Raise InfeasibleError unless the constraint overlaps the possible values."""
    key, bounds = key_of_location(["constraints", quantity.name]), problem.common_bounds(quantity)
    if bounds is None:
        return
    least, greatest = box.bounds_on_quantity(quantity)
    rounding = SLACK * max((abs(end) for end in (least, greatest) if math.isfinite(end)), default=0.0)
    if constraint.lower is not None and constraint.lower > greatest + rounding:
        allowed, instead = bounds.to_raise, "ask for less"
    elif constraint.upper is not None and constraint.upper + rounding < least:
        allowed, instead = bounds.to_lower, "ask for more"
    else:
        return
    sentence, active = _possible_values_text(problem, constraint)
    remedy = ", ".join([f"allow {allowed}", *([f"relax {' and '.join(active)}"] if active else []), f"or {instead}"])
    same = linear_equation_of(quantity, 0.0) if isinstance(quantity, FormulaQuantity) else None
    if same is not None and not same.names:
        sentence, remedy = f"it is {_format_value(quantity, float(same.constant))} for every design", "leave it out"
    raise InfeasibleError(f"{key}: {sentence}; got {_bounds_text(constraint, quantity)}; {remedy}")


def _possible_values_text(problem: Problem, constraint: Constraint) -> tuple[str, list[str]]:
    """Describe the possible values of a quantity that cannot meet its constraint, and return the active rules.

    Considers rod / offset, which narrows the ranges, and all other rules on the dimensions if these allow any design.
    """
    ranges = "within the ranges of crank, rod and offset"
    if not problem.variants and all(ends.fixed for ends in (problem.crank, problem.rod, problem.offset)):
        nearest, _ = _nearest_relaxation(problem, constraint, (constraint,))
        crank, rod, offset = (f"{name} {1e3 * getattr(problem, name).lower:.6g} mm" for name in DIMENSIONS)
        if nearest is not None:
            return f"{crank}, {rod} and {offset}, all fixed, give {nearest.with_unit}", []
    narrowing = tuple(c for c in problem.constraints if c.quantity == ROD_TO_OFFSET.name and c is not constraint)
    requirements = _rules_on_dimensions(problem)
    nearest, active = _nearest_relaxation(problem, constraint, requirements)
    if nearest is None:  # the other rules contradict each other
        requirements = (constraint, *narrowing)
        (nearest, _), active = _nearest_relaxation(problem, constraint, requirements), [*narrowing]
    if nearest is None:
        return f"{ranges} it is impossible", []
    rules = [_requirement_in_words(problem, rule) for rule in active]
    rules += [_OTHERS] if len(requirements) > 1 + len({rule.quantity for rule in active}) else []
    conditions = f" and with {' and '.join(rules)}," if rules else ""
    side = "at most" if nearest.reachable < nearest.requested else "at least"
    return f"{ranges}{conditions} {side} {nearest.with_unit} is possible", [rule.quantity for rule in active]


def _requirement_in_words(problem: Problem, rule: Constraint) -> str:
    quantity = problem.quantity(rule.quantity)
    bounds = (f"{RELATIONS[word]} {_format_value(quantity, bound)}" for word, bound in rule.sides)
    return f"{rule.quantity} {' and '.join(bounds)}"


def _rules_on_dimensions(problem: Problem) -> tuple[Constraint, ...]:
    from ..feasibility.best_value import rules_on_dimensions

    return rules_on_dimensions(problem)


def _nearest_relaxation(
    problem: Problem, constraint: Constraint, requirements: tuple[Constraint, ...]
) -> tuple[Relaxation | None, list[Constraint]]:
    """Return the reachable value for one of the constraints, and which of the others are active there.

    None if nothing is reachable even then. Each active constraint is a single bound; none are reported if there are
    choices.
    """
    from ..feasibility.best_value import Best, find_best_dimensions
    from ..feasibility.relaxation import Relaxation, relaxations

    tried: list[Best] = []

    def best(relaxed_problem: Problem) -> Best | None:
        reachable = find_best_dimensions(relaxed_problem)
        tried.extend([reachable] if reachable else [])
        return reachable

    reachable = relaxations(replace(problem, constraints=requirements), constraint, best)
    nearest = next((item for item in reachable if isinstance(item, Relaxation)), None)
    if nearest is None or problem.variants:
        return nearest, []
    other_rules = [rule for rule in requirements if rule.quantity != constraint.quantity]
    return nearest, [side for rule in other_rules for side in _active_bounds(problem, rule, tried[0].design)]


def _active_bounds(problem: Problem, rule: Constraint, design: Array) -> list[Constraint]:
    """Return a rule's active bounds at the best design of a search, each as a separate rule."""
    value = float(problem.quantity(rule.quantity).evaluate(problem.mechanism, design[None]).values[0])
    if rule.equality:
        return [rule]
    single = [Constraint(quantity=rule.quantity, lower=rule.lower)] if rule.lower is not None else []
    single += [Constraint(quantity=rule.quantity, upper=rule.upper)] if rule.upper is not None else []
    return [bound for bound in single if abs(value - bound.sides[0][1]) <= _ACTIVE * (abs(bound.sides[0][1]) or 1.0)]


def ratio_and_angle_conflict(problem: Problem, ratio_quantity: Quantity, share: Range = _ANY) -> str | None:
    """Return why no linkage can meet both a ratio of `STROKE_RATIOS` and the transmission angle; None if one may.

    share: range of offset / rod.
    """
    constraints = {
        constraint.quantity: constraint
        for constraint in problem.constraints
        if problem.common_bounds(ratio_quantity) is not None
    }
    ratio, angle = constraints.get(ratio_quantity.name), constraints.get(TRANSMISSION_ANGLE.name)
    if ratio is None or angle is None or ratio.lower is None or angle.lower is None:
        return None
    if not 0.0 < angle.lower < 0.5 * math.pi or ratio.lower <= greatest_time_ratio(math.cos(angle.lower), share) * (
        1.0 + SLACK
    ):
        return None
    condition = f"with a least transmission angle of {_format_value(TRANSMISSION_ANGLE, angle.lower)}"
    for requirements in (_rules_on_dimensions(problem), (ratio, angle)):
        ratios, angles = (_nearest_relaxation(problem, item, requirements)[0] for item in (ratio, angle))
        held_too = f" and {_OTHERS}" if len(requirements) > 2 else ""
        angle_remedy = angles and f"lower constraints.{angle.quantity} to {angles.with_unit} at most"
        if ratios is not None:
            limit_text = f"it is at most {ratios.with_unit}; got {_bounds_text(ratio)}; lower it to that"
            return f"{condition}{held_too} {limit_text}{f', or {angle_remedy}' if angle_remedy else ''}"
        if angle_remedy:
            return f"{condition}{held_too} no linkage reaches it; got {_bounds_text(ratio)}; {angle_remedy}"
    return f"{condition} no linkage reaches it; got {_bounds_text(ratio)}; lower both"


def greatest_time_ratio(cosine: float, share: Range) -> float:
    """Return an upper bound on the time ratio for (r+a)/l <= cosine and a/l within `share`.

    With p = r / l and q = a / l, the excess angle increases with both, so its greatest value lies on p + q = cosine.
    That line is divided into cells of p, each bounded by its greatest p and its greatest q. The bound is never below
    the true maximum, and above it by about 1 / cells.
    """
    best = 0.0
    top = max(cosine - share.lower, 0.0)
    for cell in range(_CELLS):
        p = top * (cell + 1) / _CELLS
        q = min(cosine - top * cell / _CELLS, share.upper)
        sine = q / (1.0 - p) if p < 1.0 else 1.0
        best = max(best, math.asin(min(sine, 1.0)) - math.asin(min(q / (1.0 + p), 1.0)))
    return time_ratio_of_excess_angle(best)


def _offset_magnitude_range(offset: Range) -> Range:
    """Return the range of |offset|."""
    ends = sorted((abs(offset.lower), abs(offset.upper)))
    spans_zero = offset.lower <= 0.0 <= offset.upper
    return Range(lower=0.0 if spans_zero else ends[0], upper=ends[1])


def _format_value(quantity: Quantity, value: float) -> str:
    unit = quantity.unit
    return f"{float(f'{value * unit.factor:.5g}'):.12g} {unit.symbol}".rstrip()  # 100000, not 1e+05


def _bounds_text(constraint: Constraint, quantity: Quantity | None = None) -> str:
    quantity = quantity or QUANTITIES[constraint.quantity]
    return " and ".join(f"{word} {_format_value(quantity, bound)}" for word, bound in constraint.sides)


def _extremes_text(box: Box) -> str:
    return (
        f"a rod of at most {1e3 * box.rod.upper:.6g} mm, a crank of at least "
        f"{1e3 * box.crank.lower:.6g} mm, an offset of at least {1e3 * box.offset.lower:.6g} mm"
    )
