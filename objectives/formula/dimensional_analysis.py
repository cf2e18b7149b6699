"""Dimensional analysis of formulas: checks sums, comparisons and function arguments by the units of the names."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from ...model.errors import InputError
from ..kinds import ANGLE, Kind
from ..units import Dimension, dimension_of, dimension_of_kind, kind_of_dimension, unit_of_base_dimension
from .expression import ANGLES, INVERSES, Node, Number, Text, evaluate_in_algebra

_LENGTH, _ANGLE = "[length]", "[angle]"
_LARGEST = 9  # highest power for which units have a notation
_LONGEST = 60  # longest part shown in a message
_SAID = {"+": "adds", "-": "subtracts", "min": "compares", "max": "compares"}
Powers = Mapping[str, Fraction]


@dataclass(frozen=True)
class _Part:
    """Dimension of part of a formula, its text, and its value if it is a plain number."""

    powers: Powers
    written: tuple[str, int]
    value: Fraction | None = None

    @property
    def text(self) -> str:
        """Its text, truncated if it is long."""
        text = self.written[0]
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."

    @property
    def is_dimensionless(self) -> bool:
        return not any(self.powers.values())


def kind_of_formula(node: Node, kinds: Mapping[str, Kind]) -> Kind:
    """Return the kind of a formula's values. kinds: kinds of the names in it. Raises InputError if dimensions clash."""
    part = evaluate_in_algebra(
        node, _Dimensions({name: _powers_of(dimension_of_kind(kind)) for name, kind in kinds.items()})
    )
    if any(power.denominator != 1 or abs(power) > _LARGEST for power in part.powers.values()):
        raise InputError(
            f"the unit of a formula's value must have whole powers, at most {_LARGEST}; got {part.text} in "
            f"{_unit_symbol(part.powers)}; raise it to a power that leaves such a unit"
        )
    return _kind_of_powers(part.powers)


class _Dimensions:
    """An algebra of dimensions. known: dimensions of the names."""

    def __init__(self, name_powers: Mapping[str, Powers]) -> None:
        self.known, self.text = name_powers, Text()

    def number(self, number: Number) -> _Part:
        value = None if number.unit else Fraction(number.digits)
        return _Part(_powers_of(dimension_of(number.unit)), self.text.number(number), value)

    def name(self, name: str) -> _Part:
        return _Part(self.known[name], self.text.name(name))

    def call(self, function: str, arguments: list[_Part]) -> _Part:
        first, last = arguments[0], arguments[-1]
        written = self.text.call(function, [item.written for item in arguments])
        text = _Part({}, written).text
        if function in _SAID:
            for item in arguments[1:]:
                if not _may_be_added(first.powers, item.powers):
                    raise InputError(
                        f"{text} {_SAID[function]} {_unit_symbol(first.powers)} and {_unit_symbol(item.powers)}; "
                        "only values of "
                        "one kind can be combined; correct the names, or give numbers their units"
                    )
            return _Part(first.powers, written, _constant_exponent_value(function, arguments))
        if function in "*/":
            sign = 1 if function == "*" else -1
            powers = {base: Fraction(0) for base in (*first.powers, *last.powers)}
            powers |= first.powers
            powers = {base: power + sign * last.powers.get(base, 0) for base, power in powers.items()}
            return _Part(
                {base: power for base, power in powers.items() if power},
                written,
                _constant_exponent_value(function, arguments),
            )
        if function == "**":
            return _Part(_raised_to_power(first, last, text), written)
        if function == "sqrt":
            return _Part({base: power / 2 for base, power in first.powers.items()}, written)
        if function in ANGLES:
            if not _may_be_added(first.powers, _powers_of(dimension_of(ANGLE.unit))):
                raise InputError(
                    f"{function} needs an angle; got {text} of {_unit_symbol(first.powers)}; "
                    "give a number its unit, 30 "
                    "deg, or multiply a ratio by 1 rad"
                )
            return _Part({}, written)
        if function in INVERSES:
            if not first.is_dimensionless:
                raise InputError(
                    f"{function} needs a ratio; got {text} of {_unit_symbol(first.powers)}; "
                    "divide by a value of the same kind"
                )
            return _Part(_powers_of(dimension_of(ANGLE.unit)), written)
        return _Part(first.powers, written, _constant_exponent_value(function, arguments))  # neg, abs


def _raised_to_power(base: _Part, exponent: _Part, text: str) -> Powers:
    if not exponent.is_dimensionless:
        raise InputError(
            f"an exponent must be a ratio; got {text} with one in {_unit_symbol(exponent.powers)}; divide it by a "
            "value of the same kind"
        )
    if base.is_dimensionless:
        return {}
    if exponent.value is None:
        raise InputError(
            f"a value with a unit may only be raised to a plain number; got {text} of {_unit_symbol(base.powers)}; "
            "write "
            "the exponent as a number, or divide the base by a value of the same kind"
        )
    return {name: power * exponent.value for name, power in base.powers.items() if exponent.value}


def _constant_exponent_value(function: str, arguments: list[_Part]) -> Fraction | None:
    """Return the value of an exponent such as 1/3; None if it is not a number, or is too large."""
    values = [item.value for item in arguments]
    first, last = values[0], values[-1]
    if first is None or last is None or max(map(abs, (first, last))) > 1000:
        return None
    if function == "neg":
        return -first
    if function == "/":
        return first / last if last else None
    return {"+": first + last, "-": first - last, "*": first * last}.get(function)


def _powers_of(dimension: Dimension) -> Powers:
    return {base: Fraction(power) for base, power in dimension}


def _may_be_added(first: Powers, second: Powers) -> bool:
    """Return whether values may be added. An angle times a length counts as a length, like an arc."""
    return _without_angle_of_arc(first) == _without_angle_of_arc(second)


def _without_angle_of_arc(powers: Powers) -> Powers:
    arc = bool(powers.get(_LENGTH))
    return {base: power for base, power in powers.items() if power and not (arc and base == _ANGLE)}


def _kind_of_powers(powers: Powers) -> Kind:
    return kind_of_dimension(frozenset((base, int(power)) for base, power in _without_angle_of_arc(powers).items()))


def _unit_symbol(powers: Powers) -> str:
    """Return the display unit for values with a dimension."""
    significant = _without_angle_of_arc(powers)
    if all(power.denominator == 1 and abs(power) <= _LARGEST for power in significant.values()):
        return _kind_of_powers(significant).metric.symbol or "no unit"
    return " ".join(f"{unit_of_base_dimension(base)}^{power}" for base, power in sorted(significant.items()))
