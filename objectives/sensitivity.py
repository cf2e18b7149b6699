"""How every quantity of one design changes with each dimension: exact derivatives, as a table."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from ..model import geometry
from ..model.arithmetic import STEP
from ..model.linkage import Linkage
from ..model.mechanism import Mechanism
from ..model.tolerance.sources import limits
from .average_torque import MEAN_TORQUE, RMS_TORQUE
from .position_error import POSITION_ERRORS
from .quantity import DEGREE, MILLIMETRE, Array, Unit
from .registry import QUANTITIES

DIMENSIONS = ("crank", "rod", "offset")


@dataclass(frozen=True)
class _DeadCentre:
    """A position or a crank angle of a dead centre; `formula` is that of the open branch."""

    name: str
    title: str
    unit: Unit
    formula: Callable[[Any, Any, Any], Any]

    def on(self, linkage: Linkage) -> tuple[float, list[float]]:
        """Return value and gradient, SI; on the crossed branch x -> -x and theta -> pi - theta."""
        at = [float(linkage.crank), float(linkage.rod), float(linkage.offset)]
        value, slopes = float(self.formula(*at)), []
        for n in range(3):
            step = [complex(x, STEP if i == n else 0.0) for i, x in enumerate(at)]
            slopes.append(float(self.formula(*step).imag / STEP))
        angle = self.unit is DEGREE
        if linkage.branch == "crossed":
            value, slopes = (math.pi - value if angle else -value), [-slope for slope in slopes]
        return value % (2.0 * math.pi) if angle else value, slopes


_DEAD_CENTRES = (
    _DeadCentre("inner_dead_centre_position", "inner dead centre, position", MILLIMETRE, geometry.inner_dead_centre),
    _DeadCentre("outer_dead_centre_position", "outer dead centre, position", MILLIMETRE, geometry.outer_dead_centre),
    _DeadCentre("inner_dead_centre", "inner dead centre, crank angle", DEGREE, geometry.inner_crank_angle),
    _DeadCentre("outer_dead_centre", "outer dead centre, crank angle", DEGREE, geometry.outer_crank_angle),
)


def sensitivity(mechanism: Mechanism, dimensions: Array) -> pd.DataFrame:
    """Return how each quantity of a design (3,), crank, rod, offset, m, changes with each dimension.

    One row a quantity, all of the registry and the dead centres, with the columns quantity, title, unit, value (as
    shown) and for each dimension
    - <dimension>_per_mm: exact derivative, in the shown unit per mm;
    - <dimension>_percent: percent of the quantity per percent of the dimension (for an offset, of its size); NaN where
      quantity or dimension is zero, and for the crank angle of a dead centre, whose zero is arbitrary;
    - <dimension>_tolerance: first-order change for the dimension's tolerance, in the shown unit.
    A quantity that is infinite has NaN in all; so has a position error without tolerances, which is not defined. Where
    it has a kink (two equal peaks; no offset, for what depends on the size of the offset) the derivative is that of one
    side: of the peak found, towards positive offsets.
    Raises `AssemblyError` unless the linkage turns fully.
    """
    design = np.asarray(dimensions, dtype=np.float64).reshape(1, 3)
    linkage = Linkage(design[0, 0], design[0, 1], design[0, 2], mechanism.branch)
    tolerances = limits(mechanism, linkage)[:3]
    rows, rms = [], RMS_TORQUE.evaluate(mechanism, design).values[0]
    for quantity in QUANTITIES.values():
        found = quantity.evaluate(mechanism, design, gradients=True)
        assert found.gradients is not None
        undefined = quantity in POSITION_ERRORS and not mechanism.tolerances.given
        value = math.nan if undefined else float(found.values[0])
        entry = (quantity.name, quantity.title, quantity.unit, value, found.gradients[0])
        relative = not _balances_out(quantity.name, value, float(rms))
        rows.append(_row(*entry, design[0], tolerances, relative))
    for centre in _DEAD_CENTRES:
        value, slopes = centre.on(linkage)
        relative = centre.unit is not DEGREE
        rows.append(
            _row(centre.name, centre.title, centre.unit, value, np.array(slopes), design[0], tolerances, relative)
        )
    return pd.DataFrame(rows)


def _balances_out(name: str, value: float, rms: float) -> bool:
    """Whether a mean torque is zero but for rounding: its percentages would be those of the rounding."""
    return name == MEAN_TORQUE.name and abs(value) < 1e-9 * rms


def _row(
    name: str, title: str, unit: Unit, value: float, slopes: Array, design: Array, tolerances: Array, relative: bool
) -> dict[str, Any]:
    row: dict[str, Any] = {"quantity": name, "title": title, "unit": unit.symbol, "value": unit.factor * value}
    known = math.isfinite(value)
    for n, dimension in enumerate(DIMENSIONS):
        slope = float(slopes[n]) if known else math.nan
        defined = relative and known and value != 0.0 and design[n] != 0.0
        row[f"{dimension}_per_mm"] = unit.factor * slope * 1e-3
        row[f"{dimension}_percent"] = slope * float(design[n]) / value if defined else math.nan
        row[f"{dimension}_tolerance"] = unit.factor * slope * float(tolerances[n])
    return row
