"""Keys that end with their unit, as columns and JSON have them: `peak_torque_Nm`, `crank_in`."""

from __future__ import annotations

import re
from dataclasses import replace

from .kinds import INERTIA, LENGTH, PRESSURE, RATIO, SHOWN, Face, Kind, System, face, kind_in

# How a column's name ends: the longest first, as "_lbf_in" ends like "_in".
_FACES = sorted(
    {face for kind in SHOWN for face in (kind.metric, kind.inch) if face is not None},
    key=lambda face: -len(face.suffix),
)
_KINDS = {kind.metric.suffix: kind for kind in reversed(SHOWN)}
_TO_INCH = {
    kind.metric.suffix: (kind.inch.suffix, kind.inch.factor / kind.metric.factor)
    for kind in SHOWN
    if kind.inch is not None
}
_BESIDE = {
    face("bar", 1e-5): PRESSURE,  # of suction and discharge
    face("um", 1e6): LENGTH,  # of small steps, such as saving_per_um
    Face("kg m^2", "_kgm2"): INERTIA,  # of flywheels
}
"""Units of keys beside those of their kinds."""
_FACES += _BESIDE
_CURRENCY = re.compile("_([A-Z]{3})$")  # ISO 4217, of an amount such as a price
_TO_METRIC = {inch: metric for metric, (inch, _) in _TO_INCH.items()}
for _unit, _kind in _BESIDE.items():
    _KINDS[_unit.suffix] = replace(_kind, metric=_unit)
    _TO_INCH[_unit.suffix] = _kind.face("inch").suffix, _kind.face("inch").factor / _unit.factor


def split_unit(key: str) -> tuple[str, str, float]:
    """Return the name, the unit and the factor from SI of a key such as "peak_torque_Nm"."""
    face = _face(key)
    return (key, "", 1.0) if face is None else (key.removesuffix(face.suffix), face.symbol, face.factor)


def kind_of_key(key: str) -> tuple[str, Kind]:
    """Return the name and the kind of a metric key; a ratio if it ends with no unit."""
    face = _face(key)
    if face is None:
        return key, RATIO
    return key.removesuffix(face.suffix), _KINDS.get(face.suffix) or kind_in(face.symbol, face.factor)


def key_in(key: str, system: System) -> tuple[str, float]:
    """Return the key of a metric column in a system of units, and the factor for its values."""
    face = _face(key)
    if system == "metric" or face is None:
        return key, 1.0
    if key.removesuffix(face.suffix).endswith("_per"):  # a quotient that no kind has: of both its units
        above, _, below = key.rpartition("_per_")
        (upper, up), (lower, down) = key_in(above, system), key_in(f"_{below}", system)
        return f"{upper}_per{lower}", up / down
    if face.suffix not in _TO_INCH:
        return key, 1.0
    suffix, factor = _TO_INCH[face.suffix]
    return key.removesuffix(face.suffix) + suffix, factor


def metric_key(key: str) -> str:
    """Return the metric key of a column of any system."""
    face = _face(key)
    suffix = None if face is None else _TO_METRIC.get(face.suffix)
    return key if face is None or suffix is None else key.removesuffix(face.suffix) + suffix


def _face(key: str) -> Face | None:
    known = next((face for face in _FACES if key.endswith(face.suffix)), None)
    currency = _CURRENCY.search(key) if known is None else None
    return known if currency is None else Face(currency[1], currency[0])
