"""The position error as linear rows in scaled tolerances, and its exact peaks: the constraints of an allocation."""

from dataclasses import replace
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism, Tolerance
from ...model.signals.peaks import find_peaks
from ...model.signals.signals import Signal
from ...model.tolerance.error_distributions import angle_ranges_where_error_counts, limits_of_sources, source_influences
from ..problem.tolerance_costs import NAMES, Costs
from .input_words import Kind

_START = 32  # crank angles per turn in `start`
_TURN = 2.0 * np.pi


class ErrorRows:
    """Rows of (error / limit)^p for one linkage, linear in x_i = t_i^p / scale_i, of order one.

    p: 1 for the worst case, 2 for the root-sum-square. t_i: the n tolerances that have a cost, m and rad. start: crank
    angles spread over the counted part of the cycle, rad.
    """

    def __init__(self, mechanism: Mechanism, linkage: Linkage, costs: Costs, limit: float, kind: Kind) -> None:
        self.mechanism, self.linkage, self.limit = mechanism, linkage, limit
        self.power = 1 if kind == "worst case" else 2
        self.names = tuple(costs.costs_by_name)
        self._chosen = [NAMES.index(name) for name in self.names]
        self._given = limits_of_sources(mechanism, linkage)
        self._given[self._chosen] = 0.0
        self.start = np.mod(np.concatenate(angle_ranges_where_error_counts(mechanism, linkage, count=_START)), _TURN)
        self.scale = np.ones(len(self._chosen))
        share = 1.0 / (len(self._chosen) * self.rows_at_angles(self.start)[0].max(axis=0))
        self.scale = np.minimum(share, np.array([cost.greatest for cost in costs.costs_by_name.values()]) ** self.power)

    def rows_at_angles(self, angles: Array) -> tuple[Array, Array]:
        """Return the coefficients (m, n) of x and the remaining limit (m,) at crank angles (m,), rad."""
        parts = (np.abs(source_influences(self.mechanism, self.linkage, angles)) / self.limit) ** self.power
        return parts[self._chosen].T * self.scale, 1.0 - self._given**self.power @ parts

    def scale_tolerances(self, tolerances: Array) -> Array:
        """Return x for tolerances (n,), m and rad."""
        return np.asarray(tolerances**self.power / self.scale)

    def tolerances(self, x: Array) -> Array:
        """Return the tolerances (n,), m and rad, for x."""
        return np.asarray((x * self.scale) ** (1.0 / self.power))

    def mechanism_with_tolerances(self, x: Array) -> Mechanism:
        """Return the mechanism with the tolerances for x."""
        machine_tolerances: dict[str, Any] = {
            name: Tolerance(absolute=float(value)) for name, value in zip(self.names, self.tolerances(x), strict=True)
        }
        return replace(self.mechanism, tolerances=replace(self.mechanism.tolerances, **machine_tolerances))

    def error_peaks(self, x: Array) -> tuple[Array, Array]:
        """Return the exact local peaks (k,) over the counted angles, highest first, and their crank angles, rad."""
        signal = Signal.POSITION_ERROR if self.power == 1 else Signal.POSITION_ERROR_RSS
        design = np.array([[self.linkage.crank, self.linkage.rod, self.linkage.offset]], dtype=np.float64)
        found = find_peaks(self.mechanism_with_tolerances(x), signal, design)
        there = np.isfinite(found.values[0])
        return (found.values[0, there] / self.limit) ** self.power, found.angles[0, there]
