"""Columns of the table of designs by the names that people use, with their units."""

from __future__ import annotations

import functools
import re
from collections.abc import Collection
from dataclasses import dataclass

from ...model.errors import InputError

# How a column's name ends, and its unit. The factors are what one SI unit is in it.
_SUFFIXES = (
    ("_m_s3", "m/s^3", 1.0),
    ("_m_s2", "m/s^2", 1.0),
    ("_m_s", "m/s", 1.0),
    ("_kg_m2", "kg m^2", 1.0),
    ("_kg_m3", "kg/m^3", 1.0),
    ("_kg", "kg", 1.0),
    ("_rad_s2", "rad/s^2", 1.0),
    ("_rpm", "rpm", 9.549296585513721),
    ("_Ns_per_m", "N s/m", 1.0),
    ("_N_per_m", "N/m", 1.0),
    ("_m2", "m^2", 1.0),
    ("_Nm", "N m", 1.0),
    ("_mm", "mm", 1e3),
    ("_deg", "deg", 57.29577951308232),
    ("_N", "N", 1.0),
    ("_W", "W", 1.0),
    ("_MPa", "MPa", 1e-6),
)
DIMENSIONS = ("crank", "rod", "offset")


@dataclass(frozen=True)
class Column:
    """A column. key: as in JSON and CSV. title: for people. factor: what one SI unit is in its unit.

    own_unit: whether it was called by the key that carries the unit, so that a plain number is in that unit.
    """

    key: str
    title: str
    unit: str
    factor: float
    own_unit: bool


def find_column(name: str, keys: Collection[str]) -> Column:
    """Return the column that a name means: a key of the table, or a quantity as in job files ("peak_torque").

    Raises `InputError` with the nearest names.
    """
    name = name.strip()
    key = name if name in keys else _meant(name, keys)
    plain, unit, factor = split_unit(key)
    slack = key.startswith("slack_")
    title = _titles().get(
        key.removeprefix("slack_"), plain.removeprefix("slack_").removeprefix("choice_").replace("_", " ")
    )
    return Column(key, f"slack of {title}" if slack else title, unit, factor, name == key)


@functools.cache
def _titles() -> dict[str, str]:
    """Return what the columns of quantities are called, by their keys."""
    from ...objectives.registry import QUANTITIES

    return {quantity.field: quantity.title for quantity in QUANTITIES.values()}


def _meant(name: str, keys: Collection[str]) -> str:
    """Return the key that a name without unit means. Raises `InputError` with the nearest names."""
    from ...objectives.registry import QUANTITIES

    aliases = {dimension: f"{dimension}_mm" for dimension in DIMENSIONS}
    aliases |= {quantity.name: quantity.field for quantity in QUANTITIES.values()}
    for plain, key in ((split_unit(key)[0], key) for key in keys if "_robust" in key):
        for quantity in QUANTITIES.values():
            stem = split_unit(quantity.field)[0]  # a robust quantity's key and name end alike
            if plain.startswith(f"{stem}_robust"):
                aliases[quantity.name + plain.removeprefix(stem)] = key
    aliases |= {split_unit(key)[0]: key for key in keys if split_unit(key)[0] not in aliases}
    aliases |= {f"slack_{alias}": f"slack_{key}" for alias, key in aliases.items()}
    meant = {alias: key for alias, key in aliases.items() if key in keys}
    if name in meant:
        return meant[name]
    longer = [key for key in keys if name and key.startswith(f"{name}_")]  # a unit of an own quantity's
    if len(longer) == 1:
        return longer[0]

    from ...optimise.units import closest

    near = closest(name, [*keys, *meant]) if name else None
    hint = f"did you mean {near}?" if near else f"choose from {', '.join(keys)}"
    raise InputError(f"no quantity or column is called {name!r}; {hint}")


def split_unit(key: str) -> tuple[str, str, float]:
    """Return the name, the unit and the factor from SI of a key such as "peak_torque_Nm"."""
    for suffix, unit, factor in _SUFFIXES:
        if key.endswith(suffix):
            return key.removesuffix(suffix), unit, factor
    return key, "", 1.0


def find_columns(text: str, keys: Collection[str]) -> list[Column]:
    """Return the columns of a list of names, separated by commas."""
    return [find_column(name, keys) for name in re.split(r"[,\s]+", text.strip(" ,"))]
