"""Sensitivity of every quantity of one design to each dimension: a table of exact derivatives.

Sweeps give quantities over a grid of one, two or more of crank, rod, offset and speed.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Literal, get_args

import numpy as np
import pandas as pd

from ...model.errors import InputError
from ...model.kernel.arithmetic import STEP
from ...model.kinematics import geometry
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, with_start_set_by_machine
from ...model.tolerance.error_distributions import limits_of_sources
from ..formula.resolve_names import resolve_quantities
from ..kinds import ANGLE, LENGTH, Kind
from ..quantity import Array, Quantity
from ..registry import QUANTITIES
from .all_quantities import missing_value_reasons
from .swing_columns import linkage_that_can_move, quantities_for_swing, swing_quantities

_TIE = 1e-9  # relative to a quantity: pieces that differ by less count as equal
_ROUNDING = 1e-12  # in units of a quantity over the rod: smaller changes are rounding errors
_TIP = 1e-6  # in units of the rod: a small offset that lifts a quantity, zero without offset, far above rounding
_SIDE_OF_ZERO = 1e-100  # m: less than rounding, a zero offset seen from one side


@dataclass(frozen=True)
class _DeadCentre:
    """A position or a crank angle of a dead centre; `formula` applies to the open branch."""

    name: str
    title: str
    kind: Kind
    formula: Callable[[Any, Any, Any], Any]

    def value_and_slopes(self, linkage: Linkage) -> tuple[float, list[float]]:
        """Return value and gradient, SI; the crossed branch has x -> -x and theta -> pi - theta."""
        at = [float(linkage.crank), float(linkage.rod), float(linkage.offset)]
        value, slopes = float(self.formula(*at)), []
        for n in range(3):
            step = [complex(x, STEP if i == n else 0.0) for i, x in enumerate(at)]
            slopes.append(float(self.formula(*step).imag / STEP))
        angle = self.kind is ANGLE
        if linkage.branch == "crossed":
            value, slopes = (math.pi - value if angle else -value), [-slope for slope in slopes]
        return value % (2.0 * math.pi) if angle else value, slopes


_DEAD_CENTRES = (
    _DeadCentre("inner_dead_centre_position", "inner dead centre, position", LENGTH, geometry.inner_dead_centre),
    _DeadCentre("outer_dead_centre_position", "outer dead centre, position", LENGTH, geometry.outer_dead_centre),
    _DeadCentre("inner_dead_centre", "inner dead centre, crank angle", ANGLE, geometry.inner_crank_angle),
    _DeadCentre("outer_dead_centre", "outer dead centre, crank angle", ANGLE, geometry.outer_crank_angle),
)


def sensitivity(mechanism: Mechanism, dimensions: Array, swing: Swing | None = None) -> pd.DataFrame:
    """Return the sensitivity of each quantity of a design (3,), crank, rod, offset, m, to each dimension.

    swing: motion instead of a full turn, whose ends do not change with the dimensions; the rows are then the swing's
    quantities. There is one row per quantity in the registry, and per dead centre. The columns are quantity, title,
    unit, value (in that unit) and for each dimension
    - <dimension>_per_mm: exact derivative towards larger values, in the display unit per mm;
    - <dimension>_percent: percent change of the quantity per percent change of the dimension (for an offset, of its
      magnitude); NaN if quantity or dimension is zero, and for the crank angle of a dead centre, which has an arbitrary
      zero;
    - <dimension>_tolerance: first-order change due to the dimension's tolerance, in the display unit;
    - the same three with _below: from the derivative towards smaller values (for a percentage, smaller magnitudes).
    The two differ if the quantity has a kink: at two equal peaks, or at zero offset if it depends on |offset|.
    Derivatives that are zero to rounding are exactly zero. An infinite quantity has NaN in all these columns, and so
    does a position error without tolerances, which is undefined.
    Raises `AssemblyError` unless the linkage rotates fully, or can make the `swing`.
    """
    design = np.asarray(dimensions, dtype=np.float64).reshape(3)
    linkage = Linkage(design[0], design[1], design[2], mechanism.branch)
    design[2] = float(linkage.offset)
    if swing is not None:
        linkage_that_can_move(mechanism, linkage, swing)
    tolerances = limits_of_sources(mechanism, linkage)[:3]
    rows = []
    ends = None if swing is None else with_start_set_by_machine(mechanism, swing)
    for quantity in QUANTITIES.values() if ends is None else quantities_for_swing(swing_quantities(ends)):
        value, slopes_below, slopes_above = _value_and_one_sided_derivatives(quantity, mechanism, design)
        if quantity.undefined_because([mechanism]):
            value = math.nan
        rows.append(_sensitivity_row(quantity, value, (slopes_below, slopes_above), design, tolerances, True))
    for centre in _DEAD_CENTRES if ends is None else ():
        value, slopes = centre.value_and_slopes(linkage)
        sides = np.array(slopes), np.array(slopes)
        rows.append(_sensitivity_row(centre, value, sides, design, tolerances, centre.kind is not ANGLE))
    return pd.DataFrame(rows)


def _value_and_one_sided_derivatives(
    quantity: Quantity, mechanism: Mechanism, design: Array
) -> tuple[float, Array, Array]:
    """Return the value for a design and its derivatives (3,) below and above, SI.

    A maximum of pieces changes with its steepest tied piece on either side: the largest slope above, the smallest slope
    below. For a minimum of pieces it is the reverse.
    """
    value = float(quantity.evaluate(mechanism, design[None]).values[0])
    if design[2] == 0.0 and _vanishes_at_zero_offset(quantity, mechanism, design, value):
        return (
            value,
            _one_sided_slopes(quantity, mechanism, design, -1.0),
            _one_sided_slopes(quantity, mechanism, design, 1.0),
        )
    sides = []
    for side in (-1.0, 1.0):
        at = design.copy()
        if at[2] == 0.0:
            at[2] = side * _SIDE_OF_ZERO
        sides.append(_steepest_derivatives(quantity, mechanism, at, side))
    return value, sides[0], sides[1]


def _steepest_derivatives(quantity: Quantity, mechanism: Mechanism, at: Array, side: float) -> Array:
    """Return the derivatives (3,) towards one side of a design, for the steepest of its tied pieces."""
    pieces = quantity.pieces(mechanism, at[None])
    values, slopes = pieces.values[0], pieces.gradients[0]
    best = values.min() if pieces.least else values.max()
    if np.isnan(best):  # undefined: without masses and loads there is no force to compare
        return np.full(3, np.nan)
    with np.errstate(invalid="ignore"):
        equal = np.abs(values - best) <= _TIE * abs(best)
    equal |= values == best
    steepest = slopes[equal].max(axis=0) if (side > 0.0) != pieces.least else slopes[equal].min(axis=0)
    with np.errstate(invalid="ignore"):
        return np.where(np.abs(steepest) * at[1] <= _ROUNDING * abs(best), 0.0, steepest)


def _vanishes_at_zero_offset(quantity: Quantity, mechanism: Mechanism, design: Array, value: float) -> bool:
    """Whether a quantity vanishes at zero offset: its value and the locations of its peaks are then rounding errors."""
    nearby = design + np.array([0.0, 0.0, _TIP * design[1]])
    return abs(value) <= _TIE * abs(float(quantity.evaluate(mechanism, nearby[None]).values[0]))


def _one_sided_slopes(quantity: Quantity, mechanism: Mechanism, design: Array, side: float) -> Array:
    """Return the derivatives (3,) on one side of zero offset, extrapolated from those at two small offsets."""
    near, far = (
        _steepest_derivatives(quantity, mechanism, design + np.array([0.0, 0.0, side * share * _TIP * design[1]]), side)
        for share in (1.0, 2.0)
    )
    slopes = 2.0 * near - far  # terms proportional to the offset cancel
    return np.where(np.abs(slopes) <= _TIE * np.abs(slopes).max(), 0.0, slopes)


def _sensitivity_row(
    quantity: Quantity | _DeadCentre,
    value: float,
    sides: tuple[Array, Array],
    design: Array,
    tolerances: Array,
    relative: bool,
) -> dict[str, Any]:
    unit = quantity.kind.metric
    row: dict[str, Any] = {
        "quantity": quantity.name,
        "title": quantity.title,
        "unit": unit.symbol,
        "value": unit.factor * value,
    }
    is_finite = math.isfinite(value)
    for n, dimension in enumerate(DIMENSIONS):
        defined = relative and is_finite and value != 0.0 and design[n] != 0.0
        slope_below, slope_above = (float(side[n]) if is_finite else math.nan for side in sides)
        # For a negative offset, a larger magnitude lies below it.
        smaller, larger = (slope_below, slope_above) if design[n] >= 0.0 else (slope_above, slope_below)
        for suffix, slope, share in (("", slope_above, larger), ("_below", slope_below, smaller)):
            row[f"{dimension}_per_mm{suffix}"] = unit.factor * slope * 1e-3
            row[f"{dimension}_percent{suffix}"] = share * float(design[n]) / value if defined else math.nan
            row[f"{dimension}_tolerance{suffix}"] = unit.factor * slope * float(tolerances[n])
    return row


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
