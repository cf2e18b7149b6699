"""Keys that end with a unit, as in table columns and JSON: `peak_torque_Nm`, `crank_in`."""

from __future__ import annotations

import re
from dataclasses import replace

from .kinds import DISPLAYED_KINDS, INERTIA, LENGTH, PRESSURE, RATIO, DisplayUnit, Kind, System, display_unit, kind_in


def count_with_noun(count: int, noun: str) -> str:
    """Return a count with its noun: "1 design", "20 designs". The plural ends in s."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


# Suffixes of column names, longest first because "_lbf_in" also ends with "_in".
_DISPLAY_UNITS = sorted(
    {unit for kind in DISPLAYED_KINDS for unit in (kind.metric, kind.inch) if unit is not None},
    key=lambda unit: -len(unit.suffix),
)
_KINDS = {kind.metric.suffix: kind for kind in reversed(DISPLAYED_KINDS)}
_TO_INCH = {
    kind.metric.suffix: (kind.inch.suffix, kind.inch.factor / kind.metric.factor)
    for kind in DISPLAYED_KINDS
    if kind.inch is not None
}
_EXTRA_UNITS = {
    display_unit("bar", 1e-5): PRESSURE,  # for suction and discharge
    display_unit("um", 1e6): LENGTH,  # for small steps, such as saving_per_um
    DisplayUnit("kg m^2", "_kgm2"): INERTIA,  # of flywheels
}
"""Units in keys beyond those of the kinds."""
_DISPLAY_UNITS += _EXTRA_UNITS
_DISPLAY_UNITS += (display_unit("1/min", 60.0), display_unit("1/s"))  # for catalogues, such as an output speed
_CURRENCY = re.compile("_([A-Z]{3})$")  # ISO 4217, for an amount such as a price
_TO_METRIC = {inch: metric for metric, (inch, _) in _TO_INCH.items()}
for _unit, _kind in _EXTRA_UNITS.items():
    _KINDS[_unit.suffix] = replace(_kind, metric=_unit)
    _TO_INCH[_unit.suffix] = _kind.display_unit("inch").suffix, _kind.display_unit("inch").factor / _unit.factor


def name_unit_and_factor_of_key(key: str) -> tuple[str, str, float]:
    """Return the name, the unit and the factor from SI for a key such as "peak_torque_Nm"."""
    unit = _display_unit_of(key)
    return (key, "", 1.0) if unit is None else (key.removesuffix(unit.suffix), unit.symbol, unit.factor)


def kind_of_key(key: str) -> tuple[str, Kind]:
    """Return name and kind of a metric key; without a unit, the kind is a ratio."""
    unit = _display_unit_of(key)
    if unit is None:
        return key, RATIO
    return key.removesuffix(unit.suffix), _KINDS.get(unit.suffix) or kind_in(unit.symbol, unit.factor)


def column_key_in_system(key: str, system: System) -> tuple[str, float]:
    """Return the key for a metric column in a system of units, and the factor for its values."""
    unit = _display_unit_of(key)
    if system == "metric" or unit is None:
        return key, 1.0
    if key.removesuffix(unit.suffix).endswith("_per"):  # a quotient without a kind: convert both its units
        numerator, _, denominator = key.rpartition("_per_")
        (upper, up), (lower, down) = (
            column_key_in_system(numerator, system),
            column_key_in_system(f"_{denominator}", system),
        )
        return f"{upper}_per{lower}", up / down
    if unit.suffix not in _TO_INCH:
        return key, 1.0
    suffix, factor = _TO_INCH[unit.suffix]
    return key.removesuffix(unit.suffix) + suffix, factor


def metric_key(key: str) -> str:
    """Return the metric key for a column in any system of units."""
    unit = _display_unit_of(key)
    suffix = None if unit is None else _TO_METRIC.get(unit.suffix)
    return key if unit is None or suffix is None else key.removesuffix(unit.suffix) + suffix


def _display_unit_of(key: str) -> DisplayUnit | None:
    listed = next((unit for unit in _DISPLAY_UNITS if key.endswith(unit.suffix)), None)
    currency = _CURRENCY.search(key) if listed is None else None
    return listed if currency is None else DisplayUnit(currency[1], currency[0])
