"""Columns of the table of designs with their units, by the names that people use."""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import System, column_key_in_system, metric_key, name_unit_and_factor_of_key

if TYPE_CHECKING:
    from ...objectives.quantity import Group

_MOST = 12  # maximum number of keys in a message


@dataclass(frozen=True)
class Column:
    """Table column. key: key in JSON and CSV. title: human-readable title. factor: one SI unit in its unit.

    plain: factor from a number without a unit to the column's unit, such as 25.4 for `crank_mm` entered as `crank_in`;
    None if the column has a unit but the name does not. group: group under which it is shown.
    """

    key: str
    title: str
    unit: str
    factor: float
    plain: float | None = 1.0
    group: Group | None = None


def find_column(name: str, keys: Collection[str]) -> Column:
    """Return the column for a name: a key of the table, or a quantity as in job files ("peak_torque").

    Keys in every unit system are accepted: `crank_in` finds `crank_mm`. Raises `InputError` that suggests the nearest
    names.
    """
    name = name.strip()
    metric = metric_key(name)
    same = name if name in keys else next((key for key in keys if metric_key(key) == metric), None)
    key = _key_of_name(name, keys) if same is None else same
    plain, unit, factor = name_unit_and_factor_of_key(key)
    from ...objectives.quantity import Group
    from ...objectives.tables.design_input import words_of_number_name

    slack = key.startswith("slack_")
    words = words_of_number_name(plain.removeprefix("slack_").removeprefix("choice_"))
    sufficient = [other.removeprefix("choice_") for other in keys if other.startswith("choice_least_")]
    if any(plain.removeprefix("choice_").startswith(stem) for stem in sufficient):
        words = words.replace("least", "smallest sufficient", 1)
    title = _quantity_titles().get(metric_key(key).removeprefix("slack_"), words)
    return Column(
        key,
        f"slack of {title}" if slack else title,
        unit,
        factor,
        factor / name_unit_and_factor_of_key(name)[2] if same is not None else None if unit else 1.0,
        Group.DIMENSIONS if key in choice_column_keys(keys) else _display_group_of_column(metric_key(key)),
    )


@functools.cache
def _display_group_of_column(key: str) -> Group:
    """Return the group under which a metric column is shown."""
    from ...objectives.quantity import Group
    from ...objectives.registry import FACTS
    from ...objectives.torque_and_power import PEAK_TORQUE

    groups = {f"{dimension}_mm": Group.DIMENSIONS for dimension in DIMENSIONS}
    groups |= {f"{PEAK_TORQUE.name}_angle_deg": PEAK_TORQUE.group, "slow_stroke": Group.MOTION}
    groups |= {"loaded_stroke": Group.MOTION}
    if "_dead_centre" in key:
        return Group.MOTION
    return ({quantity.field: quantity.group for quantity in FACTS.values()} | groups).get(key, Group.FURTHER)


def choice_column_keys(keys: Iterable[str]) -> list[str]:
    """Return the choice columns, which are those between the offset and the quantities."""
    from_offset = itertools.dropwhile(lambda key: metric_key(key) != "offset_mm", keys)
    return list(
        itertools.takewhile(
            lambda key: metric_key(key) not in _quantity_titles(), itertools.islice(from_offset, 1, None)
        )
    )


@functools.cache
def _quantity_titles() -> dict[str, str]:
    """Return the titles of quantity columns, by key."""
    from ...objectives.registry import FACTS

    return {quantity.field: quantity.title for quantity in FACTS.values()}


def _key_of_name(name: str, keys: Collection[str]) -> str:
    """Return the key for a name without a unit. Raises `InputError` that suggests the nearest names."""
    from ...objectives.registry import QUANTITIES

    system: System = "metric" if "crank_mm" in keys or "crank_in" not in keys else "inch"
    aliases = {dimension: column_key_in_system(f"{dimension}_mm", system)[0] for dimension in DIMENSIONS}
    aliases |= {quantity.name: column_key_in_system(quantity.field, system)[0] for quantity in QUANTITIES.values()}
    for plain, key in ((name_unit_and_factor_of_key(key)[0], key) for key in keys if "_robust" in key):
        for quantity in QUANTITIES.values():
            stem = name_unit_and_factor_of_key(quantity.field)[
                0
            ]  # key and name of a robust quantity have the same ending
            if plain.startswith(f"{stem}_robust"):
                aliases[quantity.name + plain.removeprefix(stem)] = key
    aliases |= {
        name_unit_and_factor_of_key(key)[0]: key for key in keys if name_unit_and_factor_of_key(key)[0] not in aliases
    }
    aliases |= {f"slack_{alias}": f"slack_{key}" for alias, key in aliases.items()}
    names = {alias: key for alias, key in aliases.items() if key in keys}
    if name in names:
        return names[name]
    # In the key of a custom quantity the unit follows the name.
    longer = [key for key in keys if name and key.startswith(f"{name}_") and metric_key(key) not in _quantity_titles()]
    if len(longer) == 1:
        return longer[0]

    from ...objectives.units import closest_word

    near = closest_word(name, [*keys, *names]) if name else None
    hint = f"did you mean {near}?" if near else f"choose from {_keys_text(keys)}"
    raise InputError(f"there is no quantity or column {name!r}; {hint}")


def _keys_text(keys: Collection[str]) -> str:
    remaining = len(keys) - _MOST
    return ", ".join(list(keys)[:_MOST]) + (f" and {remaining} more, the columns of front.csv" if remaining > 0 else "")


def all_columns(keys: Collection[str]) -> list[Column]:
    """Return the columns of a table, by key."""
    return [find_column(key, keys) for key in keys]


def find_columns(text: str, keys: Collection[str]) -> list[Column]:
    """Return the columns for a comma-separated list of names."""
    return [find_column(name, keys) for name in re.split(r"[,\s]+", text.strip(" ,"))]
