"""Elapsed time as a function of the crank angle, for a speed that repeats every turn."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array, Mask
from ..quadrature import Samples, gauss_nodes_and_weights, legendre_fit_matrix, resolve_panels

_TURN = 2.0 * math.pi
_NODES = 20  # nodes in each panel
_TAIL = 2  # last coefficients of a series, which show whether it has converged
_CONVERGED = 1e-14  # relative size of the last coefficients of a converged series
_NOISE = 32.0 * np.finfo(np.float64).eps  # error of p; the error of 1 / p is p^-2 times this
_DEEPEST, _PANELS = 52, 200_000  # maximum halvings of a panel, and panels; then they are left as they are


@dataclass(frozen=True, eq=False)
class ElapsedTime:
    """Integral of 1 / p over the crank angle, rad: the time multiplied by the mean speed.

    Each panel of a turn has a Legendre series, refined until it converges to rounding. ends: panel ends (k + 1,), rad.
    series: coefficients (m, k) of the integral over each panel. up_to_ends: integral (k + 1,) up to each end.
    """

    ends: Array
    series: Array
    up_to_ends: Array

    @classmethod
    def integrate(cls, ratio: Callable[[Array], Array], ends: Array) -> ElapsedTime:
        """Integrate 1 / p for a ratio p > 0. ends: increasing crank angles in a turn, rad; p is analytic in between."""
        nodes, basis = gauss_nodes_and_weights(_NODES)[0], legendre_fit_matrix(_NODES).T

        def sample(low: Array, width: Array) -> Samples:
            values = 1.0 / ratio(low[:, None] + width[:, None] * nodes)
            coefficients = values @ basis
            tail = np.abs(coefficients[:, -_TAIL:]).sum(axis=1)
            rough: Mask = ~(tail <= _CONVERGED * coefficients[:, 0] + _NOISE * values.max(axis=1) ** 2)
            return rough, [0.5 * width[:, None] * coefficients]

        start, _, parts = resolve_panels(sample, ends[:-1], np.diff(ends), deepest=_DEEPEST, limit=_PANELS)
        order = np.argsort(start)
        integrals = legendre.legint(parts[order].T, lbnd=-1.0)
        series = np.asarray(integrals, dtype=np.float64)
        panel_integrals = np.asarray(legendre.legval(1.0, series), dtype=np.float64)
        panels = np.append(start[order], ends[-1])
        return cls(np.asarray(panels, dtype=np.float64), series, np.concatenate([[0.0], np.cumsum(panel_integrals)]))

    @property
    def full_turn(self) -> float:
        """Integral over a turn."""
        return float(self.up_to_ends[-1])

    def up_to(self, crank_angle: Array) -> Array:
        """Return the integral from the start of the first panel up to crank angles, rad, over any number of turns."""
        turns = np.floor((crank_angle - self.ends[0]) / _TURN)
        angle_in_turn = crank_angle - turns * _TURN
        panel = np.clip(np.searchsorted(self.ends, angle_in_turn, side="right") - 1, 0, len(self.ends) - 2)
        low, high = self.ends[panel], self.ends[panel + 1]
        x = np.clip(2.0 * (angle_in_turn - low) / (high - low) - 1.0, -1.0, 1.0)
        within_panel = legendre.legval(x, self.series[:, panel], tensor=False)
        return np.asarray(turns * self.full_turn + self.up_to_ends[panel] + within_panel)
