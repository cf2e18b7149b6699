"""Possible values within the ranges of crank, rod and offset, by the `Reach` of quantities."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...model.arrays import Array
from ...model.errors import InfeasibleError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.bounds import CLEAR, LengthRanges
from ...objectives.formula.quantity import FormulaQuantity, equation_of
from ...objectives.proportions import ROD_TO_CRANK, ROD_TO_OFFSET, STROKE
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from ...objectives.time_ratio import CRANK_ANGLE_RATIO, TIME_RATIO, ratio_of
from ...objectives.transmission_angle import TRANSMISSION_ANGLE
from ..problem.problem import Problem
from ..problem.requirements import RELATIONS, Constraint, Range
from .messages import key_of

if TYPE_CHECKING:
    from ..feasibility.relaxation import Relaxation

SLACK = 1e-9
"""Requirements at the very edge are left to the optimiser: rounding must not make them contradictions."""
STROKE_RATIOS = (TIME_RATIO, CRANK_ANGLE_RATIO)
"""Ratios of the strokes that conflict with the transmission angle."""
_CELLS = 10_000
_OTHERS = "the other requirements on the dimensions"
_ACTIVE = 1e-6
"""Relative distance from a bound within which a rule is active at a design that was searched for."""
_ANY = Range(lower=0.0, upper=1.0)


@dataclass(frozen=True, kw_only=True)
class Box:
    """Ranges of crank, rod and |offset|, m, and of offset / rod, narrowed by what must hold."""

    crank: Range
    rod: Range
    offset: Range
    share: Range = _ANY

    @classmethod
    def from_problem(cls, problem: Problem) -> Box:
        """Return the ranges of a problem, narrowed by nothing yet."""
        return cls(crank=problem.crank, rod=problem.rod, offset=_sizes(problem.offset))

    def possible(self, of: Quantity) -> tuple[float, float]:
        """Return bounds of a quantity that has a reach, SI; needs `turns`."""
        assert of.bounds is not None
        ends = ((ends.lower, ends.upper) for ends in (self.crank, self.rod, self.offset))
        return of.bounds.compute(LengthRanges(*(end for pair in ends for end in pair)))

    @property
    def turns(self) -> bool:
        """Whether a linkage within the ranges may turn fully."""
        clear = self.rod.upper > (self.crank.lower + self.offset.lower) * CLEAR
        return clear and self.rod.upper * (1.0 - self.share.lower) > self.crank.lower


def require_reachable(problem: Problem) -> None:
    """Raise InfeasibleError if full rotation or a constraint on geometry is out of reach within the ranges."""
    box = Box.from_problem(problem)
    if not box.turns:
        raise InfeasibleError(
            "variables: the rod must exceed crank + |offset| for full rotation; "
            f"got {_extremes(box)}; lengthen the rod or reduce the other two"
        )
    constraints = {constraint.quantity: constraint for constraint in problem.constraints}
    if ROD_TO_OFFSET.name in constraints:
        box = _with_rod_to_offset(box, constraints[ROD_TO_OFFSET.name], problem)
    formulas = (of for of in problem.own if isinstance(of, FormulaQuantity) and of.of_dimensions)
    for of in (ROD_TO_CRANK, STROKE, *STROKE_RATIOS, TRANSMISSION_ANGLE, *formulas):
        if of.name in constraints:
            _require_within(of, constraints[of.name], box, problem)
    for of in STROKE_RATIOS:
        wrong = beyond_both(problem, of, box.share)
        if wrong:
            raise InfeasibleError(f"constraints.{of.name}: {wrong}")


def _with_rod_to_offset(box: Box, constraint: Constraint, problem: Problem) -> Box:
    """Return the box narrowed to k_min |offset| <= rod <= k_max |offset|; raise InfeasibleError if nothing is left."""
    if box.offset.upper == 0.0:
        raise InfeasibleError(
            f"constraints.{ROD_TO_OFFSET.name}: needs an offset; the offset is fixed at 0; give variables.offset a "
            "range"
        )
    _require_within(ROD_TO_OFFSET, constraint, box, problem)
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
    if not narrowed.turns:
        raise InfeasibleError(
            f"constraints.{ROD_TO_OFFSET.name}: full rotation leaves the crank less than rod - |offset|; got "
            f"{_bounds(constraint)} and with it {_extremes(narrowed)}; shorten the crank, or raise the ratio"
        )
    return narrowed


def _require_within(of: Quantity, constraint: Constraint, box: Box, problem: Problem) -> None:
    """Raise InfeasibleError unless the constraint overlaps what is possible."""
    key, bounds = key_of(["constraints", of.name]), problem.reach_of(of)
    if bounds is None:
        return
    least, greatest = box.possible(of)
    room = SLACK * max((abs(end) for end in (least, greatest) if math.isfinite(end)), default=0.0)
    if constraint.lower is not None and constraint.lower > greatest + room:
        allowed, instead = bounds.to_raise, "ask for less"
    elif constraint.upper is not None and constraint.upper + room < least:
        allowed, instead = bounds.to_lower, "ask for more"
    else:
        return
    told, active = _possible(problem, constraint)
    remedy = ", ".join([f"allow {allowed}", *([f"relax {' and '.join(active)}"] if active else []), f"or {instead}"])
    same = equation_of(of, 0.0) if isinstance(of, FormulaQuantity) else None
    if same is not None and not same.names:
        told, remedy = f"it is {_format_value(of, float(same.constant))} for every design", "leave it out"
    raise InfeasibleError(f"{key}: {told}; got {_bounds(constraint, of)}; {remedy}")


def _possible(problem: Problem, constraint: Constraint) -> tuple[str, list[str]]:
    """Return in words what is possible of a quantity that the ranges do not give as it is asked for, and active rules.

    With rod / offset, which narrows the ranges, and with all other rules on the dimensions if these allow anything.
    """
    ranges = "within the ranges of crank, rod and offset"
    if not problem.variants and all(of.fixed for of in (problem.crank, problem.rod, problem.offset)):
        found, _ = _nearest(problem, constraint, (constraint,))
        crank, rod, offset = (f"{name} {1e3 * getattr(problem, name).lower:.6g} mm" for name in DIMENSIONS)
        if found is not None:
            return f"{crank}, {rod} and {offset}, all fixed, give {found.with_unit}", []
    narrowing = tuple(c for c in problem.constraints if c.quantity == ROD_TO_OFFSET.name and c is not constraint)
    kept = _rules_on_dimensions(problem)
    found, active = _nearest(problem, constraint, kept)
    if found is None:  # the other rules contradict one another
        kept = (constraint, *narrowing)
        (found, _), active = _nearest(problem, constraint, kept), [*narrowing]
    if found is None:
        return f"{ranges} it is impossible", []
    rules = [_in_words(problem, rule) for rule in active]
    rules += [_OTHERS] if len(kept) > 1 + len({rule.quantity for rule in active}) else []
    held = f" and with {' and '.join(rules)}," if rules else ""
    side = "at most" if found.reachable < found.requested else "at least"
    return f"{ranges}{held} {side} {found.with_unit} is possible", [rule.quantity for rule in active]


def _in_words(problem: Problem, rule: Constraint) -> str:
    of = problem.quantity(rule.quantity)
    return (
        f"{rule.quantity} {' and '.join(f'{RELATIONS[word]} {_format_value(of, bound)}' for word, bound in rule.sides)}"
    )


def _rules_on_dimensions(problem: Problem) -> tuple[Constraint, ...]:
    from ..feasibility.best import rules_on_dimensions

    return rules_on_dimensions(problem)


def _nearest(
    problem: Problem, constraint: Constraint, kept: tuple[Constraint, ...]
) -> tuple[Relaxation | None, list[Constraint]]:
    """Return the reachable value for one of the constraints that are kept, and which of the others are active there.

    None where even then nothing is reachable. Active are single bounds; none are reported where there are choices.
    """
    from ..feasibility.best import Best, best_on_dimensions
    from ..feasibility.relaxation import Relaxation, relaxations

    tried: list[Best] = []

    def best(wanted: Problem) -> Best | None:
        found = best_on_dimensions(wanted)
        tried.extend([found] if found else [])
        return found

    found = relaxations(replace(problem, constraints=kept), constraint, best)
    nearest = next((one for one in found if isinstance(one, Relaxation)), None)
    if nearest is None or problem.variants:
        return nearest, []
    others = [rule for rule in kept if rule.quantity != constraint.quantity]
    return nearest, [side for rule in others for side in _active(problem, rule, tried[0].design)]


def _active(problem: Problem, rule: Constraint, design: Array) -> list[Constraint]:
    """Return the bounds of a rule on which a design, the best of a search, lies: each as a rule of its own."""
    value = float(problem.quantity(rule.quantity).evaluate(problem.mechanism, design[None]).values[0])
    if rule.equality:
        return [rule]
    single = [Constraint(quantity=rule.quantity, lower=rule.lower)] if rule.lower is not None else []
    single += [Constraint(quantity=rule.quantity, upper=rule.upper)] if rule.upper is not None else []
    return [one for one in single if abs(value - one.sides[0][1]) <= _ACTIVE * (abs(one.sides[0][1]) or 1.0)]


def beyond_both(problem: Problem, of: Quantity, share: Range = _ANY) -> str | None:
    """Return why no linkage can meet a ratio of `STROKE_RATIOS` and the transmission angle; None if one may.

    share: where offset / rod may lie.
    """
    asked = {constraint.quantity: constraint for constraint in problem.constraints if problem.reach_of(of) is not None}
    ratio, angle = asked.get(of.name), asked.get(TRANSMISSION_ANGLE.name)
    if ratio is None or angle is None or ratio.lower is None or angle.lower is None:
        return None
    if not 0.0 < angle.lower < 0.5 * math.pi or ratio.lower <= greatest_time_ratio(math.cos(angle.lower), share) * (
        1.0 + SLACK
    ):
        return None
    held = f"with a least transmission angle of {_format_value(TRANSMISSION_ANGLE, angle.lower)}"
    for kept in (_rules_on_dimensions(problem), (ratio, angle)):
        ratios, angles = (_nearest(problem, item, kept)[0] for item in (ratio, angle))
        held_too = f" and {_OTHERS}" if len(kept) > 2 else ""
        other = angles and f"lower constraints.{angle.quantity} to {angles.with_unit} at most"
        if ratios is not None:
            what = f"it is at most {ratios.with_unit}; got {_bounds(ratio)}; lower it to that"
            return f"{held}{held_too} {what}{f', or {other}' if other else ''}"
        if other:
            return f"{held}{held_too} no linkage reaches it; got {_bounds(ratio)}; {other}"
    return f"{held} no linkage reaches it; got {_bounds(ratio)}; lower both"


def greatest_time_ratio(cosine: float, share: Range) -> float:
    """Return an upper bound on the time ratio while (r+a)/l <= cosine and a/l lies in `share`.

    With p = r / l and q = a / l the excess angle rises with both, so that the greatest lies on p + q = cosine. It is
    cut into cells of p, each bounded by its greatest p and its greatest q: never below the true maximum, and above it
    by about 1 / cells.
    """
    best = 0.0
    top = max(cosine - share.lower, 0.0)
    for cell in range(_CELLS):
        p = top * (cell + 1) / _CELLS
        q = min(cosine - top * cell / _CELLS, share.upper)
        reach = q / (1.0 - p) if p < 1.0 else 1.0
        best = max(best, math.asin(min(reach, 1.0)) - math.asin(min(q / (1.0 + p), 1.0)))
    return ratio_of(best)


def _sizes(offset: Range) -> Range:
    """Return the range of |offset|."""
    ends = sorted((abs(offset.lower), abs(offset.upper)))
    across = offset.lower <= 0.0 <= offset.upper
    return Range(lower=0.0 if across else ends[0], upper=ends[1])


def _format_value(of: Quantity, value: float) -> str:
    unit = of.unit
    return f"{float(f'{value * unit.factor:.5g}'):.12g} {unit.symbol}".rstrip()  # 100000, not 1e+05


def _bounds(constraint: Constraint, of: Quantity | None = None) -> str:
    of = of or QUANTITIES[constraint.quantity]
    return " and ".join(f"{word} {_format_value(of, bound)}" for word, bound in constraint.sides)


def _extremes(box: Box) -> str:
    return (
        f"a rod of at most {1e3 * box.rod.upper:.6g} mm, a crank of at least "
        f"{1e3 * box.crank.lower:.6g} mm, an offset of at least {1e3 * box.offset.lower:.6g} mm"
    )
