"""Sweeps: quantities over a grid of one, two or more of crank, rod, offset and speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal, get_args

import numpy as np
import pandas as pd

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ..formula.resolve_names import resolve_quantities
from ..quantity import Array, Quantity
from .missing_value_reasons import missing_value_reasons

Parameter = Literal["crank", "rod", "offset", "speed"]
MOST = 1_000_000


@dataclass(frozen=True)
class Axis:
    """The swept parameter and its values, SI: m, or rad/s."""

    parameter: Parameter
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if self.parameter not in get_args(Parameter):
            raise InputError(f"a sweep must be over one of {', '.join(get_args(Parameter))}; got {self.parameter!r}")
        if not self.values or not all(math.isfinite(value) for value in self.values):
            raise InputError(f"a sweep needs at least one value of the {self.parameter}, all finite")


def sweep(
    mechanism: Mechanism,
    dimensions: Array,
    axes: Sequence[Axis],
    quantity_names: Sequence[str],
    *,
    custom: Sequence[Quantity] = (),
) -> pd.DataFrame:
    """Return a table with a row for every combination of axis values; the first axis varies slowest.

    dimensions: (3,) crank, rod, offset, m, of the base design; swept parameters replace its values. quantity_names:
    names of quantities, or formulas. custom: quantities that may be named besides those in the registry. Columns:
    crank_mm, rod_mm, offset_mm, speed_rpm, each quantity under its key in its display unit, and reason: why the row
    lacks values (NaN), else "". An infinite quantity (rod to offset at zero offset) stays infinite. Raises `InputError`
    for unknown names, a repeated axis, or more than a million rows.
    """
    quantities = resolve_quantities(quantity_names, mechanism, custom)
    names = [axis.parameter for axis in axes]
    if not names or not quantities:
        raise InputError("a sweep needs a parameter and a quantity; got none; give at least one of each")
    if len(set(names)) < len(names):
        raise InputError(f"a sweep must be over different parameters; got {', '.join(names)}; leave out the second")
    count = math.prod(len(axis.values) for axis in axes)
    if count > MOST:
        raise InputError(f"a sweep may have at most {MOST:,} combinations; got {count:,}; take fewer values")
    grid = np.array(list(product(*(axis.values for axis in axes))))
    designs = np.tile(np.asarray(dimensions, dtype=np.float64).reshape(1, 3), (count, 1))
    speeds = np.full(count, mechanism.speed)
    for n, name in enumerate(names):
        if name == "speed":
            speeds = grid[:, n]
        else:
            designs[:, DIMENSIONS.index(name)] = grid[:, n]
    reasons = [_why_not_rotating(design, mechanism) for design in designs]
    columns = {f"{name}_mm": 1e3 * designs[:, n] for n, name in enumerate(DIMENSIONS)}
    columns["speed_rpm"] = speeds * 30.0 / math.pi
    turns = np.array([not reason for reason in reasons])
    missing: dict[int, dict[str, list[str]]] = {}  # missing quantities by row and reason
    for item in quantities:
        values = np.full(count, np.nan)
        for speed in np.unique(speeds):
            rows = np.flatnonzero(turns & (speeds == speed))
            if len(rows):
                machine = replace(mechanism, speed=float(speed))
                computed = item.unit.factor * item.evaluate(machine, designs[rows]).values
                why = missing_value_reasons(item, computed, machine, designs[rows])
                values[rows] = np.where([bool(reason) for reason in why], np.nan, computed)
                for row, reason in zip(rows.tolist(), why, strict=True):
                    if reason:
                        missing.setdefault(row, {}).setdefault(reason, []).append(item.title)
        columns[item.field] = values
    for row, found_missing in missing.items():
        reasons[row] = _join_reasons(found_missing, len(quantities))
    table = pd.DataFrame(columns)
    table["reason"] = reasons
    return table


def _join_reasons(missing: Mapping[str, Sequence[str]], count: int) -> str:
    """Return the reasons for a row. missing: titles by reason; omitted if all share one reason."""
    is_shared = any(len(titles) == count for titles in missing.values())
    return "; ".join(reason if is_shared else f"{', '.join(titles)}: {reason}" for reason, titles in missing.items())


def _why_not_rotating(design: Array, mechanism: Mechanism) -> str:
    """Return the reason why a design does not rotate fully; "" if it does."""
    try:
        Linkage(design[0], design[1], design[2], mechanism.branch).require_full_rotation()
    except InputError as error:
        return str(error)
    return ""
