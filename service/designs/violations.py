"""Excess of designs over allowable values, as numbers and in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from ...objectives.column_keys import metric_key, name_unit_and_factor_of_key
from ..runs.result import Result, Row

if TYPE_CHECKING:
    from ...model.machine.mechanism import Mechanism


def violations_of(mechanism: Mechanism, row: Row) -> dict[str, float]:
    """Return the excess of a design over each violated allowable value, by the quantity's column.

    row: metric row of the design; the returned values are also metric.
    """
    from ...objectives.registry import QUANTITIES
    from ...objectives.tables.violations import violations

    def value_of(name: str) -> float | None:
        value = row.get(QUANTITIES[name].field)
        return value / QUANTITIES[name].unit.factor if isinstance(value, float) else None

    excess_by_quantity = ((QUANTITIES[name], excess) for name, excess in violations(mechanism, value_of).items())
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
