"""Jobs derived from a front: wider limits for its active constraints, and a search near one of its designs."""

import math
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import Any, Literal

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.tables.design_input import column_of_variable
from ...optimise.problem.problem import Problem
from ..runs.result import Result
from .columns import find_column
from .judged_requirements import requirements_of
from .stored_designs import stored_design

_REST = 1e-6
"""Fraction of a range or bound within which the constraint counts as active: searches end within about 1e-9 of it."""
_WIDER = 0.25  # of a range
_FURTHER = 0.1  # of a bound
_LONGEST_NAME = 80  # of a job
SHARE = 0.1
"""Fraction of a length, on either side."""
Side = Literal["lower", "upper"]
_WORDS: dict[Side, str] = {"lower": "at least", "upper": "at most"}


@dataclass(frozen=True, kw_only=True)
class Limit:
    """Limit that a job sets, in its unit. of: its path in the job, such as "variables.rod".

    designs: numbers of the front designs at the limit, from 1. wider: wider value to try; None if the job states the
    limit in a form that no number can replace. size: reference value for relative distances from it.
    """

    of: str
    side: Side
    column: str
    title: str
    unit: str
    value: float
    wider: float | None
    size: float
    designs: tuple[int, ...] = ()

    @property
    def limit_in_words(self) -> str:
        """Limit in words, such as "rod at most 400 mm"."""
        return f"{self.title} {_WORDS[self.side]} {_with_unit(self.value, self.unit)}"


def active_limits(problem: Problem, result: Result, tables: Mapping[str, Any]) -> list[Limit]:
    """Return the active limits of a front, those with the most designs first. tables: tables of the job.

    Values that the job fixes, or requires exactly, are not limits, since every design lies on them.
    """
    variants = range(max(1, len(problem.variants)))
    limits = {variant: _all_limits_of_problem(problem.part(variant), tables) for variant in variants}
    variants_of_designs = (
        (result.exact.variants if result.exact is not None else ()) if problem.variants else (0,) * len(result.designs)
    )
    designs_at_limit: dict[tuple[str, Side], tuple[Limit, list[int]]] = {}
    for number, row in enumerate(result.designs, 1):
        variant = (
            variants_of_designs[number - 1] if variants_of_designs else stored_design(problem, result, number).variant
        )
        for limit in limits[variant]:
            value = row.get(limit.column)
            if isinstance(value, float) and abs(value - limit.value) <= _REST * limit.size:
                designs_at_limit.setdefault((limit.of, limit.side), (limit, []))[1].append(number)
    resting = [replace(limit, designs=tuple(numbers)) for limit, numbers in designs_at_limit.values()]
    return sorted(resting, key=lambda limit: -len(limit.designs))


def widen_limits(
    problem: Problem, tables: Mapping[str, Any], new_values: Sequence[tuple[str, Side, float]]
) -> dict[str, Any]:
    """Return the tables of a job with other limits, each given by path, side and value in its unit.

    Raises `InputError` for a limit that the job does not have, or that no number can replace.
    """
    limits = {
        (limit.of, limit.side): limit for part in problem.parts() for limit in _all_limits_of_problem(part, tables)
    }
    job = deepcopy(dict(tables))
    changes = []
    for limit_path, side, value in new_values:
        limit = limits.get((limit_path, side))
        if limit is None or limit.wider is None:
            places = ", ".join(
                f"{place} ({end})" for (place, end), known_limit in limits.items() if known_limit.wider is not None
            )
            raise InputError(
                f"a limit of the job must be named by its place; got {limit_path!r} ({side}); choose from {places}"
            )
        further = value < limit.value if side == "lower" else value > limit.value
        if not (further and math.isfinite(value)):
            way = "below" if side == "lower" else "above"
            raise InputError(
                f"a wider limit must be {way} {limit.value:g} {limit.unit}; got {value:g}; give another one"
            )
        text: str | float = f"{value:.12g} {limit.unit}" if limit.unit else value
        table, _, path = limit_path.partition(".")
        if table == "variables":
            holder, key = _table_and_key(job[table], path)
            holder[key] = [text, holder[key][1]] if side == "lower" else [holder[key][0], text]
        else:
            job.setdefault(table, {}).setdefault(path, {})["min" if side == "lower" else "max"] = text
        changes.append(f"{limit.title} {_WORDS[side]} {_with_unit(value, limit.unit)}")
    return _with_change_in_job_name(job, ", ".join(changes))


def _all_limits_of_problem(part: Problem, tables: Mapping[str, Any]) -> list[Limit]:
    """Return every limit of a problem without choices."""
    limits = []
    for path, column, title, unit, low, high in _variable_ranges(part):
        if low == high:
            continue
        holder, key = _table_and_key(tables.get("variables", {}), path)
        stated_range = holder.get(key)
        range_fields: dict[str, Any] = {
            "of": f"variables.{path}",
            "column": column,
            "title": title,
            "unit": unit,
            "size": high - low,
        }
        for side, value in _sides_with_bounds(low, high):
            step = _WIDER * (high - low)
            if side == "lower" and value > 0.0:
                step = min(step, _WIDER * value)  # a length stays a length
            wider = _round_to_step(value - step if side == "lower" else value + step, step)
            changed = wider if isinstance(stated_range, list | tuple) and len(stated_range) == 2 else None
            limits.append(Limit(side=side, value=value, wider=changed, **range_fields))
    for item in requirements_of(part):
        if item.lower is not None and item.lower == item.upper:
            continue
        stated = isinstance(tables.get("constraints", {}).get(item.quantity, {}), Mapping)
        named: dict[str, Any] = {"column": item.column, "title": item.title, "unit": item.unit}
        for side, bound in _sides_with_bounds(item.lower, item.upper):
            step = _FURTHER * abs(bound)
            changed = (
                _round_to_step(bound - step if side == "lower" else bound + step, step) if stated and step else None
            )
            limits.append(
                Limit(
                    of=f"constraints.{item.quantity}",
                    side=side,
                    value=bound,
                    wider=changed,
                    size=max(abs(bound), 1e-300),
                    **named,
                )
            )
    return limits


def _variable_ranges(part: Problem) -> list[tuple[str, str, str, str, float, float]]:
    """Return the variables: path in [variables], column, title, unit, and both bounds in that unit."""
    ranges = [(name, f"{name}_mm", name, "mm", getattr(part, name), 1e3) for name in DIMENSIONS]
    for item in part.mechanism.varying:
        key, unit = column_of_variable(item)
        ranges.append((item.name, key, find_column(key, [key]).title, unit.symbol, item, unit.factor))
    return [(path, *words, factor * ends.lower, factor * ends.upper) for path, *words, ends, factor in ranges]


def _sides_with_bounds(lower: float | None, upper: float | None) -> list[tuple[Side, float]]:
    ends: tuple[tuple[Side, float | None], ...] = (("lower", lower), ("upper", upper))
    return [(side, bound) for side, bound in ends if bound is not None]


def _table_and_key(table: Any, path: str) -> tuple[Any, str]:
    """Return the table that a path leads to, and the key in it; a key may be in quotes."""
    while path not in table and "." in path:
        step, _, rest = path.partition(".")
        table, path = table.get(step, {}), rest
    return table, path


def _round_to_step(value: float, step: float) -> float:
    """Return a value rounded to half of the leading digit of a step."""
    digit = 0.5 * 10.0 ** math.floor(math.log10(step))
    return float(f"{digit * round(value / digit):.12g}")


def _with_unit(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".rstrip()


def job_near_lengths(
    problem: Problem, tables: Mapping[str, Any], lengths: tuple[float, float, float], *, share: float = SHARE
) -> dict[str, Any]:
    """Return the tables of a job whose crank, rod and offset vary around given lengths, mm.

    Lengths that the job fixes are unchanged.

    share: fraction of each length, on either side; for the offset at least that fraction of the crank. Raises
    `InputError` if the job fixes all three lengths.
    """
    part = problem.parts()[0]
    free = [name for name in DIMENSIONS if (bounds := getattr(part, name)).lower < bounds.upper]
    if not free:
        raise InputError("a search near a design needs a variable length; this job fixes all three; give one a range")
    job = deepcopy(dict(tables))
    length_of = dict(zip(DIMENSIONS, lengths, strict=True))
    for name in free:
        margin = share * max(abs(length_of[name]), length_of[DIMENSIONS[0]])
        if name != DIMENSIONS[2]:
            margin = share * length_of[name]
        job["variables"][name] = [f"{length_of[name] - margin:.6g} mm", f"{length_of[name] + margin:.6g} mm"]
    sizes = ", ".join(f"{length_of[name]:.4g}" for name in DIMENSIONS)
    return _with_change_in_job_name(job, f"near {sizes} mm")


def _with_change_in_job_name(job: dict[str, Any], change: str) -> dict[str, Any]:
    """Return a job with a change appended to its name, unless the name becomes too long."""
    name = f"{job['name']}, {change}"
    return job | {"name": name} if len(name) <= _LONGEST_NAME else job
