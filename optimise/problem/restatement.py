"""Constraints on formulas that are equivalent to a known quantity, restated as constraints on that quantity.

A formula may be a factor times a quantity plus a constant, such as `2 * stroke - 10 mm`, or the closed form of a
quantity written out, such as `rod / crank`. Elimination, bounds and floors work with the quantity. A quantity that a
formula names is recognised exactly. A closed form is recognised by its values: analytic functions that agree to
rounding at many random designs within the job's ranges are the same; formulas with several such functions (min, max,
abs) are left unchanged.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...model.arrays import Array
from ...model.machine.mechanism import Branch, Mechanism
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.formula.expression import Call, Name, Node, Number
from ...objectives.formula.quantity import FormulaQuantity, linear_form
from ...objectives.lengths_and_time_ratio import ROD_TO_CRANK, ROD_TO_OFFSET, STROKE, TIME_RATIO
from ...objectives.quantity import Quantity
from ...objectives.registry import QUANTITIES
from .problem import Problem
from .requirements import Constraint, Range

_DRAWN, _COMPARED, _FEWEST = 4096, 256, 32
"""Random designs to draw; fully rotating ones to compare; fewest designs that prove equality."""
_SEED = 14
_SAME = 1e-11  # relative to the values' range: agreement to rounding
_SNAP = 1e-12  # a factor this close to one is one; a constant this close to zero is zero

RealFunction = Callable[[float], float]


@dataclass(frozen=True)
class Restatement:
    """A formula as factor * form(quantity) + constant, SI. inverse: inverse of the form, which is monotonic."""

    quantity: str
    factor: float
    constant: float
    rises: bool = True
    inverse: RealFunction = float

    def quantity_value(self, bound: float) -> float:
        """Return the value of the quantity at which the formula has a given value; NaN if there is none."""
        try:
            return self.inverse((bound - self.constant) / self.factor)
        except (ValueError, ZeroDivisionError):
            return math.nan


_FORMS: tuple[tuple[Quantity, Callable[[Array], Array], RealFunction, bool], ...] = (
    (STROKE, np.asarray, float, True),
    (ROD_TO_CRANK, np.asarray, float, True),
    (ROD_TO_CRANK, np.reciprocal, lambda x: 1.0 / x, False),
    (ROD_TO_OFFSET, np.asarray, float, True),
    (ROD_TO_OFFSET, np.reciprocal, lambda x: 1.0 / x, False),
    (TIME_RATIO, np.asarray, float, True),
    # Excess angle: pi (q - 1) / (q + 1).
    (TIME_RATIO, lambda q: (q - 1.0) / (q + 1.0), lambda x: (1.0 + x) / (1.0 - x), True),
    (TRANSMISSION_ANGLE, np.asarray, float, True),
    (TRANSMISSION_ANGLE, np.cos, math.acos, False),
    (TRANSMISSION_ANGLE, np.sin, math.asin, True),
    (TRANSMISSION_ANGLE, np.tan, math.atan, True),
)
"""Closed forms, functions of them, the inverses of these functions, and whether they increase."""


def restate_constraint(problem: Problem, constraint: Constraint) -> Constraint:
    """Return a constraint of a problem without choices, restated on its formula's quantity if there is one."""
    if constraint.quantity in QUANTITIES:
        return constraint
    of = next((own for own in problem.own if own.name == constraint.quantity), None)
    if not isinstance(of, FormulaQuantity):
        return constraint
    machine = problem.mechanism.with_largest_variables
    steady = machine.speed_profile is None
    known = _restatement(of, machine.branch, steady, problem.crank, problem.rod, problem.offset)
    if known is None or not (known.quantity in QUANTITIES or any(own.name == known.quantity for own in problem.own)):
        return constraint
    rises = known.rises == (known.factor > 0.0)
    ends = (constraint.lower, constraint.upper)[:: 1 if rises else -1]
    lower, upper = (None if end is None else known.quantity_value(end) for end in ends)
    quantity = problem.quantity(known.quantity)
    for value, least in ((lower, True), (upper, False)):
        if value is not None and not _is_possible(quantity, value, least=least):
            return constraint
    return Constraint(quantity=known.quantity, lower=lower, upper=upper)


def _is_possible(quantity: Quantity, value: float, *, least: bool) -> bool:
    """Return whether a value is a possible bound on the quantity."""
    refused = quantity.domain is not None and quantity.domain.refuses_bound(value, least=least)
    return math.isfinite(value) and not refused and (quantity.signed or value >= 0.0)


@lru_cache(maxsize=256)
def _restatement(
    of: FormulaQuantity, branch: Branch, steady: bool, crank: Range, rod: Range, offset: Range
) -> Restatement | None:
    linear = linear_form(of)
    names = {part.name for part in _known_parts(of)}
    if linear is not None and len(linear.factors) == 1 and linear.names[0] in names:
        return Restatement(linear.names[0], float(linear.factors[0][1]), float(linear.constant))
    if not of.depends_only_on_dimensions or not _is_analytic(of):
        return None
    machine = Mechanism(speed=1.0, branch=branch)
    designs = _random_designs(crank, rod, offset)
    if len(designs) < _FEWEST:
        return None
    values = of.evaluate(machine, designs).values
    for quantity, form, inverse, rises in _FORMS:
        if quantity is TIME_RATIO and not steady:  # with a speed profile, it is not a formula of the dimensions
            continue
        found = _line_through(form(quantity.evaluate(machine, designs).values), values)
        if found is not None:
            return Restatement(quantity.name, *found, rises, inverse)
    return None


def _known_parts(formula: FormulaQuantity) -> Iterator[Quantity]:
    """Yield the quantities in a formula, including those of its parts."""
    for part in formula.parts:
        yield from _known_parts(part) if isinstance(part, FormulaQuantity) else (part,)


def _is_analytic(formula: FormulaQuantity) -> bool:
    """Return whether a formula and its parts are analytic for each sign of the offset.

    An argument of an inverse sine or cosine may be clipped to 1, because the function is undefined beyond it.
    """

    def has_analytic_form(node: Node) -> bool:
        if not isinstance(node, Call):
            return True
        if node.function in ("asin", "acos"):
            inner = node.arguments[0]
            if isinstance(inner, Call) and inner.function in ("min", "max") and len(inner.arguments) == 2:
                end = 1.0 if inner.function == "min" else -1.0
                left = [item for item in inner.arguments if not (isinstance(item, Number) and item.si == end)]
                return len(left) == 1 and has_analytic_form(left[0])
        if node.function == "abs":
            return node.arguments[0] == Name("offset")
        return node.function not in ("min", "max") and all(map(has_analytic_form, node.arguments))

    return has_analytic_form(formula.expression) and all(
        _is_analytic(part) for part in formula.parts if isinstance(part, FormulaQuantity)
    )


def _random_designs(crank: Range, rod: Range, offset: Range) -> Array:
    """Return random fully rotating designs (n, 3) with an offset, within the ranges."""
    lower, upper = (np.array([getattr(ends, end) for ends in (crank, rod, offset)]) for end in ("lower", "upper"))
    drawn = lower + (upper - lower) * np.random.default_rng(_SEED).random((_DRAWN, 3))
    turning = (drawn[:, 0] > 0.0) & (drawn[:, 2] != 0.0) & (drawn[:, 1] > drawn[:, 0] + np.abs(drawn[:, 2]))
    return np.asarray(drawn[turning][:_COMPARED])


def _line_through(x: Array, y: Array) -> tuple[float, float] | None:
    """Return factor and constant of the line through all points (n,); None if they are not on a line."""
    if not (np.isfinite(x).all() and np.isfinite(y).all()):
        return None
    low, high = int(np.argmin(x)), int(np.argmax(x))
    width, height = x[high] - x[low], np.ptp(y)
    size = max(float(np.abs(y).max()), 1e-300)
    if width <= 1e-6 * np.abs(x).max() or height <= 1e-6 * size:
        return None
    factor = float((y[high] - y[low]) / width)
    constant = float(y[low] - factor * x[low])
    if np.abs(factor * x + constant - y).max() > _SAME * size:
        return None
    factor = 1.0 if abs(factor - 1.0) < _SNAP else factor
    return factor, 0.0 if abs(constant) < _SNAP * size else constant
