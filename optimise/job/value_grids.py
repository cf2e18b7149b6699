"""Values that a number may have, as a job writes them: multiples of a step, preferred numbers, a list.

Preferred numbers are those of ISO 3:1973, the rounded values of its basic series R5, R10, R20 and R40, times powers of
ten in the unit of `min`.
"""

import contextlib
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise
from typing import Any

from ...model.errors import InputError
from ...objectives.units import quote

KEYS = frozenset({"min", "max", "step", "series", "values"})
"""Keys of a table that states the values of a variable."""
MOST = 10_000
"""Maximum number of values for one variable."""
_R40 = (
    *("1", "1.06", "1.12", "1.18", "1.25", "1.32", "1.4", "1.5", "1.6", "1.7"),
    *("1.8", "1.9", "2", "2.12", "2.24", "2.36", "2.5", "2.65", "2.8", "3"),
    *("3.15", "3.35", "3.55", "3.75", "4", "4.25", "4.5", "4.75", "5", "5.3"),
    *("5.6", "6", "6.3", "6.7", "7.1", "7.5", "8", "8.5", "9", "9.5"),
)
SERIES = {f"R{count}": tuple(map(Decimal, _R40[:: 40 // count])) for count in (5, 10, 20, 40)}
"""Preferred numbers in one decade, by series."""
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*?)\s*")
_FRACTION = re.compile(r"\s*([+-]?\d{1,9})\s*/\s*(\d{1,9})\s*([A-Za-z].*)", re.ASCII)
_ROUNDING = 1e-9  # relative: a multiple within this distance beyond the end of a range counts


@dataclass(frozen=True)
class Grid:
    """The values, SI, ascending, and the rule behind them, in words."""

    values: tuple[float, ...]
    rule: str


def crossed_ends_remedy(lower: object, upper: object) -> str:
    """Return the remedy for a range whose ends cross.

    A plain number beside a value with a unit usually lacks its unit.
    """
    plain = [end for end in (lower, upper) if isinstance(end, float | int) and end]
    mixed = len(plain) == 1 and any(isinstance(end, str) for end in (lower, upper))
    return f"give {plain[0]:g} its unit" if mixed else "swap the two"


def states_value_grid(value: object) -> bool:
    """Return whether a value in a job contains a key that is used in a table of values."""
    return isinstance(value, Mapping) and not KEYS.isdisjoint(value)


def read_grid(table: Mapping[str, Any], read: Callable[[object], float]) -> Grid:
    """Return the values that a table states.

    read: converts a value to SI, by the rules of its key. Raises `InputError`.
    """
    for key in table:
        if key not in KEYS:
            raise InputError(
                f"discrete values may only have the keys {', '.join(sorted(KEYS))}; got {quote(key)}; correct or "
                "remove it"
            )
    words = [key for key in ("step", "series", "values") if key in table]
    if len(words) != 1:
        raise InputError(
            f"must have one of step, series and values; got {' and '.join(words) or 'none'}; write it like "
            '{ min = "20 mm", max = "60 mm", step = "0.5 mm" }, or a range without steps like ["20 mm", "60 mm"]'
        )
    if words == ["values"]:
        return _grid_of_list(table, read)
    for end in ("min", "max"):
        if end not in table:
            raise InputError(f"must have min and max with {words[0]}; {end} is missing; add it")
    lower, upper = read(table["min"]), read(table["max"])
    if lower > upper:
        raise InputError(
            f"must run from min to max; got {quote(table['min'])} to {quote(table['max'])}, an empty range; "
            f"{crossed_ends_remedy(table['min'], table['max'])}"
        )
    rounding = _ROUNDING * max(abs(lower), abs(upper))
    expand = _grid_of_multiples if words == ["step"] else _grid_of_preferred_numbers
    values, rule = expand(table, read, lower - rounding, upper + rounding)
    if not values:
        raise InputError(
            f"must have a value from {quote(table['min'])} to {quote(table['max'])}; {rule} has none; widen the "
            "range, or choose other values"
        )
    return Grid(tuple(values), rule)


def _grid_of_list(table: Mapping[str, Any], read: Callable[[object], float]) -> Grid:
    if len(table) > 1:
        raise InputError("a list of values must not be combined with min or max; got both; leave min and max out")
    values = table["values"]
    if not isinstance(values, list | tuple) or len(values) < 2:
        raise InputError(
            f'values must be a list of two or more, like ["20 mm", "25 mm"]; got {quote(values)}; give a single value '
            "without a list"
        )
    if len(values) > MOST:
        raise InputError(f"values must be at most {MOST}; got {len(values)}; leave out some")
    numbers = sorted(read(value) for value in values)
    for lower, upper in pairwise(numbers):
        if lower == upper:
            raise InputError(f"values must differ; got {quote(values)}; leave out the second")
    return Grid(tuple(numbers), f"one of {len(numbers)} values")


def _grid_of_multiples(
    table: Mapping[str, Any], read: Callable[[object], float], lower: float, upper: float
) -> tuple[list[float], str]:
    try:
        step = read_step(table["step"], read)
    except InputError as error:
        raise InputError(f"step {error}") from None
    if not step > 0.0:
        raise InputError(f"step must be above zero; got {quote(table['step'])}; give its size")
    if (upper - lower) / step > MOST:
        raise InputError(
            f"step must give at most {MOST} values; got {quote(table['step'])}, which gives "
            f"{(upper - lower) / step:.4g}; use a larger step, or a range [lower, upper]"
        )
    exact = Decimal(repr(step))  # a multiple as written: the step's decimals times a whole number, rounded once
    every = (float(exact * k) for k in range(math.floor(lower / step), math.ceil(upper / step) + 1))
    written = table["step"].strip() if isinstance(table["step"], str) else f"{table['step']:g}"
    return [value for value in every if lower <= value <= upper], f"multiples of {written}"


def read_step(value: object, read: Callable[[object], float]) -> float:
    """Return a step, SI. A fraction of a unit is allowed: "1/32 in". Raises `InputError`."""
    fraction = _FRACTION.fullmatch(value) if isinstance(value, str) else None
    if fraction is not None and int(fraction[2]):
        with contextlib.suppress(InputError):  # reported below, with the text as written
            return read(f"{fraction[1]} {fraction[3]}") / int(fraction[2])
    return read(value)


def _grid_of_preferred_numbers(
    table: Mapping[str, Any], read: Callable[[object], float], lower: float, upper: float
) -> tuple[list[float], str]:
    name = table["series"]
    if name not in SERIES:
        raise InputError(f"series must be one of {', '.join(SERIES)}; got {quote(name)}; choose one of these")
    if not read(table["min"]) > 0.0:
        raise InputError(
            f"preferred numbers must be above zero; got min {quote(table['min'])}; raise it, or give the values as a "
            "list"
        )
    number, unit = _number_and_unit_text(table["min"])
    # The unit in SI, without the rounding error of the division.
    factor = Decimal(f"{read(table['min']) / float(number):.15g}")
    first, last = (math.floor(math.log10(end / float(factor))) for end in (lower, upper))
    every = (number.scaleb(k) * factor for k in range(first - 1, last + 2) for number in SERIES[name])
    values = [float(value) for value in every if lower <= float(value) <= upper]
    return values, f"{name} in {unit or 'SI'}"


def _number_and_unit_text(value: object) -> tuple[Decimal, str]:
    """Return number and unit of a value; a plain number has none."""
    parts = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    return (Decimal(str(value)), "") if parts is None else (Decimal(parts[1]), parts[2])


def grid_schema(entryschemas: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the JSON Schemas of the tables that state values. entryschemas: schemas of a single value."""
    value = {"anyOf": entryschemas}
    ends = {"min": value, "max": value}
    fraction = {"type": "string", "pattern": f"^{_FRACTION.pattern}$", "examples": ["1/32 in"]}
    kinds: list[dict[str, Any]] = [{"step": {"anyOf": [*entryschemas, fraction]}}, {"series": {"enum": list(SERIES)}}]
    tables = [ends | kind for kind in kinds] + [{"values": {"type": "array", "items": value, "minItems": 2}}]
    return [
        {"type": "object", "properties": table, "required": list(table), "additionalProperties": False}
        for table in tables
    ]
