"""Requirements of a job and allowable values, and the amount by which a design misses each."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import System, metric_key, metric_unit_in, name_unit_and_factor_of_key, unit_text
from ..render.numerals import format_number
from ..runs.result import Cell, Result, Row
from .columns import find_column

if TYPE_CHECKING:
    from ...model.machine.mechanism import Mechanism
    from ...optimise.problem.problem import Problem

_RPM = 9.549296585513721  # in one rad/s
MET = 1e-8
"""Relative tolerance within which designs meet their constraints."""


@dataclass(frozen=True)
class Requirement:
    """Quantity that must lie between two values, in its unit; None leaves a side open.

    column: its key in the designs. slack: key of the distance to the nearer bound, negative if the bound is violated.
    allowed: deviation that somebody allows for one design.
    """

    quantity: str
    column: str
    title: str
    unit: str
    lower: float | None
    upper: float | None
    slack: str
    allowed: float = 0.0

    def missed_by(self, row: Row) -> float | None:
        """Return the amount by which a design misses the requirement; None if it lacks the quantity.

        Zero if it meets the requirement, or deviates by no more than is allowed.
        """
        missed = self.deviation(row)
        return 0.0 if missed is not None and missed <= self.allowed * (1.0 + MET) else missed

    def deviation(self, row: Row) -> float | None:
        """Return the amount by which a design misses the bounds themselves: zero if met, None without the quantity."""
        value = _number_or_none(row.get(self.column))
        if value is None:
            return None
        shortfall = 0.0 if self.lower is None else self.lower - value
        excess = 0.0 if self.upper is None else value - self.upper
        missed = max(0.0, shortfall, excess)
        return 0.0 if missed <= MET * max(abs(self.lower or 0.0), abs(self.upper or 0.0)) else missed


@dataclass(frozen=True, kw_only=True)
class JudgedRule:
    """Rule of a job evaluated at one design, in the display unit of its quantity.

    lower, upper: None leaves a side open. value: None if the design does not have the quantity. missed_by: zero if the
    rule is met, None if there is no value.
    """

    quantity: str
    title: str
    unit: str
    lower: float | None
    upper: float | None
    value: float | None
    met: bool
    missed_by: float | None

    @property
    def distinguishing_digits(self) -> int:
        """Significant digits, at least six, that distinguish the value from the bound that it misses."""
        ratio = abs(self.value / self.missed_by) if self.value and self.missed_by else 1.0
        return min(12, max(6, math.ceil(math.log10(ratio)) + 2)) if 0.0 < ratio < math.inf else 6


@dataclass(frozen=True, kw_only=True)
class JudgedChoice:
    """Combination of a job's choices, evaluated at one design.

    labels: chosen options. missed: rules violated with it.
    """

    labels: tuple[str, ...]
    missed: tuple[JudgedRule, ...]


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """Evaluation of a job at one design.

    rules: rules of the job, except limits that depend on a choice. choices: combinations of its choices.
    """

    rules: list[JudgedRule]
    choices: list[JudgedChoice]


def requirements_of(part: Problem, allowed: Mapping[str, float] = MappingProxyType({})) -> list[Requirement]:
    """Return the constraints of a problem without choices; default minimum values replace missing ones.

    allowed: allowed deviations by column. Raises `InputError` for one that no constraint has.
    """
    from ...optimise.problem.constraint_violation import constraints_with_floors

    requirements = []
    for constraint in constraints_with_floors(part):
        quantity = part.quantity(constraint.quantity)
        names = (quantity.name, quantity.field, quantity.title, quantity.unit.symbol)
        lower, upper = (
            None if end is None else end * quantity.unit.factor for end in (constraint.lower, constraint.upper)
        )
        deviation = allowed.get(quantity.field, 0.0)
        requirements.append(Requirement(*names, lower, upper, f"slack_{quantity.field}", deviation))
    unknown = sorted({*allowed} - {item.column for item in requirements})
    if unknown:
        columns = ", ".join(item.column for item in requirements) or "it has none"
        raise InputError(f"only requirements of this job allow deviations: {columns}; got {unknown[0]!r}; leave it out")
    return requirements


def ranges_as_requirements(part: Problem) -> list[Requirement]:
    """Return the ranges of crank, rod, offset and the extra variables, in their units."""
    from ...objectives.tables.design_input import columns_of_design_numbers

    columns = columns_of_design_numbers(part.mechanism.varying)
    ranges = []
    for name, bounds in part.ranges.items():
        column, unit = columns[name]
        title = find_column(column, (column,)).title
        bounds_in_unit = (bounds.lower * unit.factor, bounds.upper * unit.factor)
        ranges.append(Requirement(name, column, title, unit.symbol, *bounds_in_unit, f"slack_{column}"))
    return ranges


def quantity_names(part: Problem) -> dict[str, str]:
    """Return the names of all quantities of a problem, custom ones included, by column."""
    from ...objectives.registry import QUANTITIES

    return {quantity.field: quantity.name for quantity in (*QUANTITIES.values(), *part.own)}


def unmet_columns(rules: Iterable[Requirement], row: Row) -> list[str]:
    """Return the columns of the rules that a design does not meet."""
    return [rule.column for rule in rules if rule.missed_by(row) != 0.0]


def deviations_in_words(rules: Iterable[Requirement], row: Row, system: System = "metric") -> list[str]:
    """Describe deviations within what is allowed: "stroke 180.008 mm, within the allowed ±0.05 mm"."""
    texts = []
    for rule in rules:
        value = _number_or_none(row.get(rule.column))
        if value is not None and rule.deviation(row) and rule.missed_by(row) == 0.0:
            unit, factor = metric_unit_in(rule.unit, system)
            value, allowed = value * factor, rule.allowed * factor
            digits = min(12, max(6, math.ceil(math.log10(abs(value / allowed))) + 2)) if value else 6
            sign = "±" if rule.lower == rule.upper else ""
            numbers = [f"{format_number(number, digits)} {unit_text(unit)}".rstrip() for number in (value, allowed)]
            texts.append(f"{rule.title} {numbers[0]}, within the allowed {sign}{numbers[1]}")
    return texts


def faults_in_words(row: Row, broken: Iterable[str], outside: Iterable[str]) -> list[str]:
    """Describe missed requirements and variables out of range: "misses stroke", "outside the job: rod".

    broken: columns of requirements. outside: columns of ranges.
    """
    titles = {**{f"{name}_mm": name for name in DIMENSIONS}, "slow_stroke": "slow stroke"}
    missed = [titles.get(key) or find_column(key, list(row)).title for key in broken]
    left = [titles.get(key, key) for key in outside]
    faults = (missed and f"misses {', '.join(missed)}", left and f"outside the job: {', '.join(left)}")
    return [str(fault) for fault in faults if fault]


def speed_rpm(mechanism: Mechanism) -> float:
    """Return the crank speed, rpm, positive counter-clockwise."""
    return _RPM * float(mechanism.speed)


def judged_rules_of_design(problem: Problem, row: Row, system: System = "metric") -> list[JudgedRule]:
    """Return the ranges of crank, rod and offset and the constraints of a job, evaluated at a design's metric row.

    system: unit system of the answer.
    """
    lengths = (
        [rule for rule in ranges_as_requirements(part) if rule.quantity in DIMENSIONS] for part in problem.parts()
    )
    alternatives = zip(*lengths, strict=True)  # the common part if the job has choices
    ranges = [min(same_length, key=lambda rule: rule.missed_by(row) or 0.0) for same_length in alternatives]
    return [_judge_rule(rule, row, system) for rule in (*ranges, *requirements_of(problem))]


def _number_or_none(cell: Cell) -> float | None:
    return float(cell) if isinstance(cell, int | float) and not math.isnan(cell) else None


def _judge_rule(rule: Requirement, row: Row, system: System) -> JudgedRule:
    missed = rule.missed_by(row)
    unit, factor = metric_unit_in(rule.unit, system)
    numbers = {
        "lower": rule.lower,
        "upper": rule.upper,
        "value": _number_or_none(row.get(rule.column)),
        "missed_by": missed,
    }
    converted = {name: None if item is None else item * factor for name, item in numbers.items()}
    return JudgedRule(quantity=rule.quantity, title=rule.title, unit=unit, met=missed == 0.0, **converted)


def violations_of(mechanism: Mechanism, row: Row) -> dict[str, float]:
    """Return the excess of a design over each violated allowable value, by the quantity's column.

    row: metric row of the design; the returned values are also metric.
    """
    from ...objectives.registry import QUANTITIES
    from ...objectives.tables.evaluate_quantities import violations_of_allowables

    def value_of(name: str) -> float | None:
        value = row.get(QUANTITIES[name].field)
        return value / QUANTITIES[name].unit.factor if isinstance(value, float) else None

    excess_by_quantity = (
        (QUANTITIES[name], excess) for name, excess in violations_of_allowables(mechanism, value_of).items()
    )
    return {quantity.field: quantity.unit.factor * float(excess[0]) for quantity, excess in excess_by_quantity}


def violations_in_words(violated: Mapping[str, float], row: Row) -> list[str]:
    """Return a sentence for each allowable value that a design violates. Row and sentences share a unit system."""
    return [_violation_sentence(key, row, excess, "is") for key, excess in violated.items()]


def front_violations_in_words(result: Result) -> list[str]:
    """Return a sentence for each allowable value that designs of a front violate, in the units of the result."""
    count, sentences = len(result.designs), []
    for key, violated in result.violated.items():
        worst = max(range(count), key=violated.__getitem__)
        broken = sum(excess > 0.0 for excess in violated)
        verb = f"in {broken} of {count} designs, at worst" if count > 1 else "is"
        sentences.append(_violation_sentence(key, result.designs[worst], violated[worst], verb))
    return sentences


def _violation_sentence(key: str, row: Row, excess: float, verb: str) -> str:
    """Return a violated allowable value in words: "shear of the crank pin is 642 MPa, 440 MPa more than ..."."""
    from ...objectives.registry import QUANTITIES

    quantity = next(quantity for quantity in QUANTITIES.values() if quantity.field == metric_key(key))
    value, unit = row[key], name_unit_and_factor_of_key(key)[1]
    assert isinstance(value, float)
    low = quantity.better == "low"
    allowed = value - excess if low else value + excess
    limit = f" the allowed {_with_unit(allowed, unit)}" if math.isfinite(allowed) else " what is allowed"
    comparison = "more" if low else "less"
    cause = "" if low or value > 0.0 else ": a pin as wide as its bar, or wider, leaves no material in the bar"
    sizes = f"{_with_unit(value, unit)}, {_with_unit(excess, unit)} {comparison} than{limit}"
    return f"{quantity.title} {verb} {sizes} ({quantity.allowed_by}){cause}"


def _with_unit(value: float, unit: str) -> str:
    return f"{float(f'{value:.4g}'):.10g} {unit}".rstrip()
