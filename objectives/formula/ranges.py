"""Bounds of formulas within a problem's ranges: guaranteed signs, and divisors that may be zero."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ...model.errors import InputError
from .expression import SIZE, Call, Linear, Name, Node, Number, formula_text, linear_form_of_node

_ROUNDING = 1e-14


@dataclass(frozen=True)
class Interval:
    """An interval from lower to upper, SI. excludes_zero: whether zero is certainly excluded."""

    lower: float
    upper: float
    excludes_zero: bool = False

    @property
    def spans_zero(self) -> bool:
        """Whether a value in it may be zero."""
        return self.lower <= 0.0 <= self.upper and not self.excludes_zero


ANY = Interval(-math.inf, math.inf)
_TRIG = Interval(-1.0, 1.0)
_IMAGES: dict[str, tuple[Callable[[float], float], float, float]] = {
    "sqrt": (math.sqrt, 0.0, math.inf),
    "asin": (math.asin, -1.0, 1.0),
    "acos": (math.acos, -1.0, 1.0),
    "atan": (math.atan, -math.inf, math.inf),
}
"""Functions that increase or decrease throughout, with their domains."""


@dataclass(frozen=True)
class FormulaBounds:
    """Ranges for the names in formulas.

    intervals: interval for every name, SI. linears: names that are linear in dimensions and variables. advice: remedies
    for names that may be zero.
    """

    intervals: Mapping[str, Interval]
    linears: Mapping[str, Linear | None]
    advice: Mapping[str, str]

    def bounds_of_formula(self, node: Node) -> Interval:
        """Return the bounds of a formula.

        Raises `InputError` for a divisor that may be zero, and for a function that is undefined throughout the ranges.
        """
        if isinstance(node, Number):
            return Interval(node.si, node.si)
        if isinstance(node, Name):
            return self.intervals[node.name]
        given = [self.bounds_of_formula(item) for item in node.arguments]
        if node.function == "/" and given[1].spans_zero:
            self._raise_zero_divisor_error(node.arguments[1], given[1])
        if node.function == "**" and given[0].spans_zero and given[1].lower < 0.0:
            self._raise_zero_divisor_error(node.arguments[0], given[0])
        found = _interval_of_call(node, given)
        linear = linear_form_of_node(node, self.linears)
        if node.function == "/" and linear is None:
            found = _intersection(
                found,
                self._bounds_of_linear_quotient(*(linear_form_of_node(item, self.linears) for item in node.arguments)),
            )
        return found if linear is None else _intersection(found, self._bounds_of_linear(linear))

    def _raise_zero_divisor_error(self, node: Node, found: Interval) -> None:
        if isinstance(node, Name):
            remedy = self.advice.get(node.name, "divide by something else")
        else:
            remedy = "change the ranges, or rewrite the formula without that division"
        always = found.lower == found.upper == 0.0
        raise InputError(
            f"a formula must not divide by a value that may be zero; got {formula_text(node)} as a divisor, which "
            f"{'is zero for every design' if always else 'may be zero within the ranges'}; {remedy}"
        )

    def _bounds_of_linear(self, linear: Linear) -> Interval:
        """Return the bounds of a linear formula over fully rotating linkages: rod > crank + |offset|."""
        factors = {name: float(factor) for name, factor in linear.factors}
        least = greatest = float(linear.constant)
        for name, factor in factors.items():
            if name not in _TURNING:
                ends = [factor * end for end in (self.intervals[name].lower, self.intervals[name].upper)]
                least, greatest = least + min(ends), greatest + max(ends)
        values = [(_sum_at_corner(factors, corner), corner.edge) for corner in self._range_corners()]
        if not values:
            return ANY
        low, high = min(value for value, _ in values), max(value for value, _ in values)
        rounding = _ROUNDING * max(abs(float(linear.constant)), *(abs(value) for value, _ in values))
        zeros = [edge for value, edge in values if abs(value + float(linear.constant)) <= rounding]
        rest = factors.keys() - _TURNING
        alone = (not rest and low + float(linear.constant) >= -rounding) or high + float(linear.constant) <= rounding
        return Interval(least + low, greatest + high, bool(alone and all(zeros)))

    def _bounds_of_linear_quotient(self, numerator: Linear | None, denominator: Linear | None) -> Interval:
        """Return the bounds of a quotient of two formulas, linear in the dimensions, over fully rotating linkages.

        The extremes are at corners. A bound at the edge of full rotation, which no design attains, is left out.
        """
        if numerator is None or denominator is None or not {*numerator.names, *denominator.names} <= _TURNING:
            return ANY
        tops, bottoms = (
            {name: float(factor) for name, factor in linear.factors} for linear in (numerator, denominator)
        )
        corners = self._range_corners()
        divisors = [_sum_at_corner(bottoms, corner) + float(denominator.constant) for corner in corners]
        if not divisors or not (min(divisors) > 0.0 or max(divisors) < 0.0):
            return ANY
        values = [
            ((_sum_at_corner(tops, corner) + float(numerator.constant)) / divisor, corner.edge)
            for corner, divisor in zip(corners, divisors, strict=True)
        ]
        low, high = min(value for value, _ in values), max(value for value, _ in values)
        rounding = _ROUNDING * max(abs(low), abs(high))
        if all(edge for value, edge in values if value <= low + rounding):
            low = math.nextafter(low, math.inf)
        if all(edge for value, edge in values if value >= high - rounding):
            high = math.nextafter(high, -math.inf)
        return Interval(low, high) if low <= high else ANY

    def _range_corners(self) -> list[_Corner]:
        """Return the corners of the fully rotating part of the ranges, for both signs of the offset."""
        crank, rod, offset = (self.intervals[name] for name in ("crank", "rod", "offset"))
        corners = []
        for sign in (1.0, -1.0):
            low, high = (offset.lower, offset.upper) if sign > 0.0 else (-offset.upper, -offset.lower)
            if high < 0.0:
                continue
            ends = [(crank.lower, crank.upper), (rod.lower, rod.upper), (max(low, 0.0), high)]
            corners += [_Corner(x, y, z, sign) for x, y, z in itertools.product(*ends) if y > x + z]
            # Points where the plane rod = crank + |offset| cuts the edges of the box.
            cuts = [(y - z, y, z) for y, z in itertools.product(ends[1], ends[2])]
            cuts += [(x, x + z, z) for x, z in itertools.product(ends[0], ends[2])]
            cuts += [(x, y, y - x) for x, y in itertools.product(ends[0], ends[1])]
            corners += [
                _Corner(*cut, sign, edge=True)
                for cut in cuts
                if all(low <= n <= high for n, (low, high) in zip(cut, ends, strict=True))
            ]
        return corners


class _Corner(NamedTuple):
    """A corner of the ranges: crank, rod, |offset| and its sign; whether it is at the edge of full rotation."""

    crank: float
    rod: float
    size: float
    sign: float
    edge: bool = False


_TURNING = {"crank", "rod", "offset", SIZE}


def _sum_at_corner(factors: Mapping[str, float], corner: _Corner) -> float:
    """Return the sum of factors times dimensions at a corner."""
    offset_factor = corner.sign * factors.get("offset", 0.0) + factors.get(SIZE, 0.0)
    return factors.get("crank", 0.0) * corner.crank + factors.get("rod", 0.0) * corner.rod + offset_factor * corner.size


def _intersection(first: Interval, second: Interval) -> Interval:
    lower, upper = max(first.lower, second.lower), min(first.upper, second.upper)
    return Interval(min(lower, upper), max(lower, upper), first.excludes_zero or second.excludes_zero)


def _interval_of_call(node: Call, arguments: list[Interval]) -> Interval:
    function, first, last = node.function, arguments[0], arguments[-1]
    if function == "neg":
        return Interval(-first.upper, -first.lower, first.excludes_zero)
    if function == "+":
        return _interval_sum(first, last)
    if function == "-":
        return _interval_sum(first, Interval(-last.upper, -last.lower, last.excludes_zero))
    if function == "*":
        return _hull_of_ends(
            first, last, lambda a, b: 0.0 if 0.0 in (a, b) else a * b, first.excludes_zero and last.excludes_zero
        )
    if function == "/":
        return _hull_of_ends(first, last, _divide_ends, first.excludes_zero)
    if function == "**":
        return _interval_power(first, last)
    if function == "abs":
        ends = sorted((abs(first.lower), abs(first.upper)))
        return Interval(0.0 if first.lower <= 0.0 <= first.upper else ends[0], ends[1], first.excludes_zero)
    if function in ("min", "max"):
        pick = min if function == "min" else max
        return Interval(
            pick(item.lower for item in arguments),
            pick(item.upper for item in arguments),
            all(item.excludes_zero for item in arguments),
        )
    if function in _IMAGES:
        image, least, greatest = _IMAGES[function]
        if first.upper < least or first.lower > greatest:
            raise InputError(
                f"the argument of {function} must be from {least:g} to {greatest:g}; got "
                f"{formula_text(node.arguments[0])}, which is always outside it within the ranges; correct the formula"
            )
        ends = sorted(image(min(max(end, least), greatest)) for end in (first.lower, first.upper))
        return Interval(ends[0], ends[1], first.excludes_zero and function == "sqrt")
    return _interval_of_trigonometric(function, first)


def _interval_of_trigonometric(function: str, angle: Interval) -> Interval:
    """Return the bounds of sine, cosine or tangent between two angles."""
    # Within half a turn of zero, sine and tangent are zero only at zero.
    excludes_zero = angle.excludes_zero and function != "cos" and -math.pi < angle.lower and angle.upper < math.pi
    if not math.isfinite(angle.upper - angle.lower):
        return ANY if function == "tan" else _TRIG
    image = {"sin": math.sin, "cos": math.cos, "tan": math.tan}[function]
    low, high = sorted((image(angle.lower), image(angle.upper)))
    # Quarter turns at which sine and cosine have their extremes and the tangent is unbounded.
    quarters = {"sin": (1, 3), "cos": (0, 2), "tan": (1, 3)}[function]
    first, last = angle.lower / (0.5 * math.pi), angle.upper / (0.5 * math.pi)
    top, bottom = (math.floor((last - place) / 4.0) >= math.ceil((first - place) / 4.0) for place in quarters)
    if function == "tan":
        return Interval(-math.inf, math.inf, excludes_zero) if top or bottom else Interval(low, high, excludes_zero)
    return Interval(-1.0 if bottom else low, 1.0 if top else high, excludes_zero)


def _interval_sum(first: Interval, second: Interval) -> Interval:
    lower, upper = first.lower + second.lower, first.upper + second.upper
    same = (first.lower >= 0.0 and second.lower >= 0.0) or (first.upper <= 0.0 and second.upper <= 0.0)
    return Interval(lower, upper, same and (first.excludes_zero or second.excludes_zero))


def _divide_ends(a: float, b: float) -> float:
    if a == 0.0 or math.isinf(b):
        return 0.0
    return math.copysign(math.inf, a) * math.copysign(1.0, b) if b == 0.0 else a / b


def _hull_of_ends(
    first: Interval, second: Interval, operation: Callable[[float, float], float], excludes_zero: bool
) -> Interval:
    # A divisor that is never zero may approach zero from one side: that end then has the sign of that side.
    ends = [end if end or second.upper > 0.0 else -0.0 for end in (second.lower, second.upper)]
    if second.lower < 0.0 < second.upper and operation is _divide_ends:
        return Interval(-math.inf, math.inf, excludes_zero)
    values = [operation(a, b) for a in (first.lower, first.upper) for b in ends]
    return Interval(min(values), max(values), excludes_zero)


def _interval_power(base: Interval, exponent: Interval) -> Interval:
    if exponent.lower != exponent.upper or base.lower < 0.0:
        even = exponent.lower == exponent.upper and exponent.lower % 2 == 0
        return Interval(0.0 if base.lower >= 0.0 or even else -math.inf, math.inf, base.excludes_zero)
    power = exponent.lower

    def raised(x: float) -> float:
        try:
            return float(x**power)
        except (OverflowError, ZeroDivisionError):
            return math.inf

    ends = sorted((raised(base.lower), raised(base.upper)))
    return Interval(ends[0], ends[1], base.excludes_zero)
