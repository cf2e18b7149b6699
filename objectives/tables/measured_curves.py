"""Measured curves of a machine: meanings of table columns, and samples over the crank angle in SI."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ..kinds import ANGLE, DISPLAYED_KINDS, TIME, DisplayUnit, Kind
from ..quantity import Array
from ..units import letters_and_digits, without_word_in
from .curve_extremes import every_curve, undefined_curve_reason

if TYPE_CHECKING:
    import pandas as pd

Table = Mapping[str, ArrayLike]
Units = Callable[[str, Kind], float | None]
"""Value in SI of a unit as spelled in a column name; None if the text is not a unit of a kind."""
CRANK_ANGLE, TIME_OF = "crank_angle", "time"
_FARTHEST = 1e9  # rad or s: above this, a double does not resolve a crank angle to a millionth
_ANGLE_NEEDED = "a measured table must have the column crank_angle_deg, or time_s at constant speed"
_BRACKETED = re.compile(r"(.*?)[\s,:/]*[\[(](.*)[\])]\s*", re.DOTALL)


@dataclass(frozen=True)
class Column:
    """Meaning of a column: the measured curve, crank angle or time. factor: factor from the column's values to SI."""

    name: str
    factor: float
    kind: Kind


@dataclass(frozen=True)
class Measured:
    """Measured samples, SI. crank_angle: (n,), rad. values: (n,) by the name of a curve; NaN where there is no value.

    left_out: columns that are unknown or empty. without_angle: number of rows omitted because they have no crank angle.
    by_time: whether the crank angle is the crank speed times the time. understood: summary of what was read from a
    file, in words.
    """

    crank_angle: Array
    values: Mapping[str, Array]
    left_out: tuple[str, ...] = ()
    without_angle: int = 0
    by_time: bool = False
    understood: str = ""


def meaningful_columns(
    names: Iterable[str], mechanism: Mechanism, linkage: Linkage, units: Units | None = None
) -> dict[str, Column]:
    """Return the columns that have a meaning: crank angle, or else time, and curves of the machine.

    Columns have the names in this project's tables: slider_position_mm, slider_position_in, "slider position [m]",
    torque_N_m, "torque in N m". units: additional units besides the display units. Raises `InputError` for a known name
    without a unit or with a unit of another kind, for two columns with the same meaning, and without a crank angle or a
    curve.
    """
    names = [str(name) for name in names]
    moving = (
        mechanism if mechanism.speed else replace(mechanism, speed=1.0)
    )  # velocities have the units usual for their kind
    curves = {curve.name: curve for curve in every_curve(moving, linkage, np.zeros(1))}
    spoken = {_normalised_column_name(curve.title): name for name, curve in curves.items()} | {
        name: name for name in curves
    }
    spoken |= {CRANK_ANGLE: CRANK_ANGLE, TIME_OF: TIME_OF}
    kinds = {name: curve.kind for name, curve in curves.items()} | {CRANK_ANGLE: ANGLE, TIME_OF: TIME}
    columns: dict[str, Column] = {}
    for name in names:
        column = _column_meaning(name, spoken, kinds, units)
        if column is None:
            continue
        first = next((earlier for earlier, column_names in columns.items() if column_names.name == column.name), None)
        if first is not None:
            raise InputError(f"a curve may only be measured once; got the columns {first!r} and {name!r}; drop one")
        columns[name] = column
    column_names = {column.name: name for name, column in columns.items()}
    if CRANK_ANGLE in column_names:
        columns.pop(column_names.get(TIME_OF, ""), None)
    elif TIME_OF not in column_names:
        near = next((name for name in names if _likely_word(name, ("crank_angle_deg", "time_s"))), None)
        hint = f"is {near!r} one of them?" if near is not None else f"add one to {_names_text(names)}"
        raise InputError(f"{_ANGLE_NEEDED}; got neither; {hint}")
    elif not mechanism.speed:
        raise InputError(
            "converting times to crank angles needs a crank speed; got none; add one, or give crank angles"
        )
    elif mechanism.acceleration:
        raise InputError(
            "converting times to crank angles needs a constant speed; got a crank acceleration of "
            f"{mechanism.acceleration:g} rad/s^2; give crank angles"
        )
    elif mechanism.speed_profile is not None:
        raise InputError(
            "converting times to crank angles needs a constant speed; got a speed profile, "
            f"{mechanism.speed_profile.description}; give crank angles"
        )
    measured = [name for name in columns if columns[name].name not in (CRANK_ANGLE, TIME_OF)]
    if not measured:
        near = next((close for name in names if name not in columns and (close := _likely_curve(name, spoken))), None)
        hint = f"did you mean {near}?" if near else f"curves are {', '.join(curves)}"
        raise InputError(
            f"a column must be a curve with its unit, such as slider_position_mm; got {_names_text(names)}; {hint}"
        )
    return columns


def samples_of_measured_table(
    table: Table | pd.DataFrame, mechanism: Mechanism, linkage: Linkage, units: Units | None = None
) -> Measured:
    """Return the samples in a table; columns without any number are left out.

    Raises `InputError` as `meaningful_columns` does, for impossible values, and for curves that the machine does not
    define.
    """
    if not hasattr(table, "keys"):
        raise InputError(
            f"a measured table must have named columns; got {type(table).__name__}; give a dict or a DataFrame"
        )
    names = [str(name) for name in table]
    columns = meaningful_columns(names, mechanism, linkage, units)
    values: dict[str, Array] = {}
    for name, column in columns.items():
        try:
            read = np.asarray(table[name], dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError(
                f"{name!r} must contain numbers; got other values; leave cells without measurements empty"
            ) from None
        if read.ndim != 1 or (values and len(read) != len(next(iter(values.values())))):
            raise InputError(f"columns must be lists of equal length; got {name!r} of shape {read.shape}; correct it")
        scaled = column.factor * read
        limit = _FARTHEST if column.name in (CRANK_ANGLE, TIME_OF) else column.kind.limit
        wrong = np.flatnonzero(np.abs(scaled) > limit)
        if len(wrong):
            raise InputError(
                f"{name!r} must be at most {limit:g} {column.kind.unit} in size; got {read[wrong[0]]:g} in row "
                f"{wrong[0] + 1}; check the unit, or leave cells without measurements empty"
            )
        values[column.name] = scaled
    by_time = TIME_OF in values
    theta = mechanism.speed * values.pop(TIME_OF) if by_time else values.pop(CRANK_ANGLE)
    has_angle = np.isfinite(theta)
    curves = {name: _rod_angles_in_computed_turn(name, samples[has_angle], linkage) for name, samples in values.items()}
    column_names = {column.name: name for name, column in columns.items()}
    empty = [name for name, samples in curves.items() if not np.isfinite(samples).any()]
    for name in empty:
        del curves[name]
    if not curves:
        empty_columns = ", ".join(repr(column_names[name]) for name in empty)
        raise InputError(
            f"a curve must have numbers in at least one row with a crank angle; got none in {empty_columns}; add values"
        )
    for name in curves:
        reason = undefined_curve_reason(name, mechanism)
        if reason:
            raise InputError(f"{column_names[name]!r} is not defined for this machine: {reason}; or drop the column")
    left_out = tuple(name for name in names if name not in columns or columns[name].name in empty)
    return Measured(theta[has_angle], curves, left_out, int(len(theta) - has_angle.sum()), by_time)


def _rod_angles_in_computed_turn(name: str, values: Array, linkage: Linkage) -> Array:
    """Return rod angles in the same turn as the computed ones; other curves are unchanged."""
    if name != "rod_angle":
        return values
    start = -np.pi if linkage.branch == "open" else 0.0
    turned: Array = np.mod(values - start, 2.0 * np.pi) + start
    return turned


def _column_meaning(
    text: str, spoken: Mapping[str, str], kinds: Mapping[str, Kind], units: Units | None
) -> Column | None:
    """Return the meaning of a column; None if it has no meaning."""
    bracketed = _BRACKETED.fullmatch(text)
    stem = _normalised_column_name(text if bracketed is None else bracketed[1])
    if bracketed is not None:
        curve_name, unit = (stem if stem in spoken else None), bracketed[2].strip()
    else:
        curve_name = max((name for name in spoken if f"{stem}_".startswith(f"{name}_")), key=len, default=None)
        # Any characters may separate the words in the name; the rest is the unit.
        pattern = "[^a-z0-9]*" + "[^a-z0-9]+".join((curve_name or "").split("_"))
        unit = "" if curve_name is None else re.sub(pattern, "", text, count=1, flags=re.IGNORECASE).strip(" _,:/")
    if curve_name is None:
        return None
    kind = kinds[spoken[curve_name]]
    example = curve_name + kind.metric.suffix
    if not unit:
        raise InputError(f"a column must have its unit in its name; got {text!r}; write it like {example}")
    factor = _unit_factor(unit, kind)
    if factor is None:
        unit = without_word_in(unit)
        factor = _unit_factor(unit, kind)
    if factor is None and units is not None:
        factor = units(unit, kind)
    if factor is not None:
        return Column(spoken[curve_name], factor, kind)
    if unit in kind.typed or letters_and_digits(unit) in map(letters_and_digits, kind.typed):
        units_read = " or ".join(dict.fromkeys(display_unit.symbol for display_unit in _display_units(kind)))
        raise InputError(f"{curve_name} must be in {units_read}; got {text!r}; write it like {example}")
    matching_kinds = (
        other_kind
        for other_kind in DISPLAYED_KINDS
        if _unit_factor(unit, other_kind) or (units is not None and units(unit, other_kind))
    )
    other_kind = next(matching_kinds, None)
    if other_kind is None:  # not a unit: part of a longer, unknown name
        return None
    raise InputError(f"{curve_name} must be {kind.name}; got {text!r}, {other_kind.name}; write it like {example}")


def _unit_factor(unit: str, kind: Kind) -> float | None:
    """Return the SI value of a unit in a table; None if the kind does not have it."""
    for display_unit in _display_units(kind):
        if letters_and_digits(unit) in (
            letters_and_digits(display_unit.symbol),
            letters_and_digits(display_unit.suffix),
        ):
            return 1.0 / display_unit.factor
    return None


def _display_units(kind: Kind) -> list[DisplayUnit]:
    return [unit for unit in (kind.metric, DisplayUnit(kind.unit, ""), kind.inch) if unit is not None and unit.symbol]


def _normalised_column_name(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.strip().casefold()).strip("_")


def _likely_curve(name: str, spoken: Iterable[str]) -> str | None:
    """Return the curve that a column may mean, by its first word or a similar name."""
    word = _normalised_column_name(name).partition("_")[0]
    return next((curve for curve in spoken if word in curve.split("_")), None) or _likely_word(name, spoken)


def _likely_word(name: str, words: Iterable[str]) -> str | None:
    """Return the word that a misspelt name probably means; None if none is close."""
    return next(iter(difflib.get_close_matches(_normalised_column_name(name)[:60], list(words), n=1)), None)


def _names_text(names: list[str]) -> str:
    quoted_names = [repr(name) for name in names[:6]]
    return ", ".join(quoted_names) + (" ..." if len(names) > 6 else "") if quoted_names else "no columns"
