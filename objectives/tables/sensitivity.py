"""Sensitivity of every quantity of one design to each dimension: a table of exact derivatives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from ...model.kernel.arithmetic import STEP
from ...model.kinematics import geometry
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, with_start_of_machine
from ...model.tolerance.error_sources import limits_of_sources
from ..kinds import ANGLE, LENGTH, Kind
from ..quantity import Array, Quantity
from ..registry import QUANTITIES
from .swing_columns import quantities_for_swing, require_motion, swing_quantities

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
        require_motion(mechanism, linkage, swing)
    tolerances = limits_of_sources(mechanism, linkage)[:3]
    rows = []
    ends = None if swing is None else with_start_of_machine(mechanism, swing)
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
