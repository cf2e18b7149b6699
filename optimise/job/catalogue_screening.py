"""Screening of a catalogue: rows to search, and rows that may be the smallest sufficient option for a design.

Rows are compared in their limits, unless the job's constraints are tighter, and in the amounts that are objectives or
constraints. Consider two rows with the same numbers of the job, where the first is nowhere worse in this comparison.
The first then allows every design that the second allows, with objectives at least as good. So the front of all rows
does not need the second, which is dominated. Among equal rows, the smallest stays. Limits that are equalities can be
compared only if equal. The same applies to maxima of quantities whose floor depends on them (see
`constraint_violation.constraints_with_floors`), and to amounts in a formula.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError, JobError
from ...objectives.formula.formulas import identifiers_in
from ...objectives.units import to_si
from ..problem.constraint_violation import FEASIBLE
from .catalogue_columns import Column
from .named_files import table_in
from .option_amounts import excess_amount_text

ORDER = ("price", "mass")
"""Amounts that make one row smaller than another, compared before their limits."""


@dataclass(frozen=True)
class _Request:
    """A job's requirement on an amount.

    way: 1 if low is better, -1 if high is, 0 for a value. bound: values beyond it are equal.
    """

    way: int
    bound: float | None = None


def _requirements_on_amounts(tables: Mapping[str, Any], columns: Sequence[Column]) -> dict[str, _Request]:
    """Return a job's requirements on the amounts of a catalogue."""
    objectives, constraints, quantity_tables = (
        table_in(tables, name) for name in ("objectives", "constraints", "quantity")
    )
    plain = {column.name for column in columns if column.is_amount}
    words: set[str] = set()  # names in formulas, where more or less may be better
    for key, value in (*objectives.items(), *constraints.items()):
        words |= set() if key in plain else set(identifiers_in(key))
        words |= (
            {word for bound in value.values() for word in identifiers_in(bound)}
            if isinstance(value, Mapping)
            else set()
        )
    for part in quantity_tables.values():
        words |= set(identifiers_in(part.get("formula"))) if isinstance(part, Mapping) else set()
    requests = {}
    for column in columns:
        if not column.is_amount or column.kind is None:
            continue
        wish, stated_bounds = objectives.get(column.name), table_in(constraints, column.name)
        ways = {0} if column.name in words else set()
        ways |= set() if wish is None else {_WAYS.get(wish, 0) if isinstance(wish, str) else 0}
        ways |= {_WAYS.get(word, 0) for word in stated_bounds}
        bound = (
            None
            if wish is not None or len(stated_bounds) != 1
            else _value_in_si(next(iter(stated_bounds.values())), column)
        )
        if ways:
            requests[column.name] = _Request(ways.pop(), bound) if len(ways) == 1 else _Request(0)
    return requests


_WAYS = {"minimise": 1, "minimize": 1, "max": 1, "maximise": -1, "maximize": -1, "min": -1}


def _value_in_si(value: Any, column: Column) -> float | None:
    try:
        return None if column.kind is None else to_si(value, column.kind)
    except InputError:  # a formula, or invalid
        return None


@dataclass(frozen=True)
class Screened:
    """Rows after screening. order: positions of the rows to search or name, smallest first.

    searched: positions of the rows to search. lost: positions of other rows, each with one that dominates it. excluded:
    positions of rows that lack a required amount, or have one that the job's constraints exclude, each with the reason
    in words; empty if that excludes every row. compared: criteria for the comparison. requested: the amounts among
    them.
    """

    order: list[int]
    searched: set[int]
    lost: dict[int, int]
    excluded: dict[int, str]
    compared: tuple[str, ...]
    requested: frozenset[str]


def screen_rows(
    columns: Sequence[Column], rows: Sequence[list[str]], tables: Mapping[str, Any], file_name: str
) -> Screened:
    """Return which rows to search, and which may be the smallest sufficient option.

    columns: columns with checked cells. rows: cells. tables: the job's tables, with its requirements. file_name: prefix
    for messages. Raises JobError if no row has all required amounts.
    """
    requests, constraints = _requirements_on_amounts(tables, columns), table_in(tables, "constraints")
    fixed, costs = list[Array](), list[Array]()
    compared = list[str]()
    blanks, exclusions = dict[int, str](), dict[int, str]()
    for column in columns:
        blank = np.array([not row[column.place] for row in rows])
        request = requests.get(column.name) if column.is_amount else None
        if column.is_amount and request is None:
            continue
        factor = 1.0 if column.kind is None or not column.unit else to_si(f"1 {column.unit}", column.kind)
        values = factor * np.array([float(row[column.place] or 0.0) for row in rows])
        compared += [] if column.word is None and request is None else [column.header_text.partition(" (")[0]]
        if request is not None:
            blank_reason = f"no {column.name.replace('_', ' ')}, which the job requires"
            blanks |= dict.fromkeys(np.flatnonzero(blank).tolist(), blank_reason)
            exclusions |= _excluded_rows(table_in(constraints, column.name), column, values, rows)
            floor = -math.inf if request.bound is None else request.way * request.bound
            (costs if request.way else fixed).append(np.maximum(request.way * values, floor) if request.way else values)
        elif column.word is not None and column.looser_limit_allows_more:
            side = -1.0 if column.word == "max" else 1.0
            floor = _cost_of_job_limit(table_in(constraints, column.name), column, side)
            costs.append(np.maximum(np.where(blank, -math.inf, side * values), floor))
        else:
            fixed += [np.where(blank, 0.0, values), blank.astype(np.float64)]
    excluded = blanks if len({**blanks, **exclusions}) == len(rows) else {**exclusions, **blanks}
    complete = np.array([row not in excluded for row in range(len(rows))], np.bool_)
    if not complete.any():
        names = " and ".join(requests)
        raise JobError(f"{file_name} must have a row with {names}, which the job requires; got none; fill the cells")
    order = _order_rows(columns, rows)
    rank = np.empty(len(rows))
    rank[order] = np.arange(len(rows))
    groups, tight = _row_groups(fixed, len(rows)), _stack_columns(costs, len(rows))
    least = np.column_stack([tight, rank])
    searched, named, lost = list[int](), list[int](), dict[int, int]()
    for group in range(int(groups.max()) + 1):
        group_rows = order[(groups == group)[order]]
        complete_rows = group_rows[complete[group_rows]]
        best = complete_rows[_undominated_rows(tight[complete_rows])]
        searched += best.tolist()
        named += complete_rows[_undominated_rows(least[complete_rows])].tolist()
        for row in np.setdiff1d(complete_rows, best).tolist():
            lost[row] = int(best[(tight[best] <= tight[row]).all(axis=1)][0])
    return Screened(
        order=sorted({*searched, *named}, key=lambda row: rank[row]),
        searched={*searched},
        lost=lost,
        excluded=dict(sorted(excluded.items())),
        compared=tuple(compared),
        requested=frozenset(requests),
    )


def _excluded_rows(
    bounds: Mapping[str, Any], column: Column, values: Array, rows: Sequence[list[str]]
) -> dict[int, str]:
    """Return which rows have an amount beyond the job's own constraints, each with the reason in words.

    values: values of the amount, SI.
    """
    reasons: dict[int, str] = {}
    for word, bound in bounds.items():
        limit = _value_in_si(bound, column)
        if limit is None:
            continue
        rounding = FEASIBLE * abs(limit)
        outside = (values > limit + rounding) & (word != "min") | (values < limit - rounding) & (word != "max")
        for row in np.flatnonzero(outside).tolist():
            if rows[row][column.place]:
                cell = f"{rows[row][column.place]} {column.unit}".rstrip()
                reasons[row] = excess_amount_text(column.name, cell, word, bound)
    return reasons


def _cost_of_job_limit(bounds: Mapping[str, Any], column: Column, side: float) -> float:
    """Return the cost of the job's own limit on a column's quantity, below which rows are equal.

    side: 1 for a minimum, -1 for a maximum.
    """
    limits = [_value_in_si(bounds[word], column) for word in (column.word, "equals") if word and word in bounds]
    return max((side * bound for bound in limits if bound is not None), default=-math.inf)


def _order_rows(columns: Sequence[Column], rows: Sequence[list[str]]) -> IntArray:
    """Return the rows, smallest first: by price, mass and limits, tighter first, as far as there are columns.

    A blank price, mass or limit comes last; equal rows keep their order.
    """
    amounts = {column.name: (1.0, column) for column in columns if column.is_amount and column.kind is not None}
    limits = [(-1.0 if column.word == "min" else 1.0, column) for column in columns if column.word is not None]
    keys = [amounts[name] for name in ORDER if name in amounts] + limits
    table = [
        np.array([sign * float(row[column.place]) if row[column.place] else math.inf for row in rows])
        for sign, column in keys
    ]
    return np.asarray(np.lexsort(table[::-1]) if table else np.arange(len(rows)), np.int64)


def _stack_columns(columns: Sequence[Array], count: int) -> Array:
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))


def _row_groups(columns: Sequence[Array], count: int) -> IntArray:
    """Return a number for each row that is the same for rows with equal values in some columns."""
    if not columns:
        return np.zeros(count, np.int64)
    return np.asarray(np.unique(_stack_columns(columns, count), axis=0, return_inverse=True)[1].ravel(), np.int64)


def _undominated_rows(costs: Array) -> IntArray:
    """Return the rows (n, k) that no other row dominates; of equal ones, the first."""
    from ..front.dominance import nondominated  # brings what computes

    if not costs.shape[1] or not len(costs):
        return np.arange(min(1, len(costs)))
    _, first = np.unique(costs, axis=0, return_index=True)
    different = np.sort(first)
    # Ranks replace the values, because missing limits are infinite, which moocore does not accept.
    places = [np.unique(column, return_inverse=True)[1].ravel() for column in costs[different].T]
    return np.asarray(different[nondominated(np.stack(places, axis=1).astype(np.float64))], np.int64)
