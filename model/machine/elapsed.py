"""Time over the crank angle of a crank whose speed repeats with every turn."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from ..arrays import Array

_TURN = 2.0 * math.pi
_NODES = 20  # of a panel
_TAIL = 2  # last coefficients of a series, which say whether it has settled
_SETTLED = 1e-14  # of a series, relative
_NOISE = 32.0 * np.finfo(np.float64).eps  # of p, through which 1 / p is known to p^-2 times that only
_PANELS = 200_000


@dataclass(frozen=True, eq=False)
class Elapsed:
    """Integral of 1 / p over the crank angle, rad: the time in units of one over the mean speed.

    Panels of a turn have a Legendre series each, refined until it settles to rounding. ends: of the panels
    (k + 1,), rad. series: coefficients (m, k) of the integrals over each. before: integral (k + 1,) up to each end.
    """

    ends: Array
    series: Array
    before: Array

    @classmethod
    def of(cls, ratio: Callable[[Array], Array], ends: Array) -> Elapsed:
        """Return it for a ratio p > 0. ends: increasing crank angles, rad, of a turn; p is analytic in between."""
        nodes, weights = legendre.leggauss(_NODES)
        basis = weights[:, None] * legendre.legvander(nodes, _NODES - 1) * (np.arange(_NODES) + 0.5)
        begin, end = ends[:-1], ends[1:]
        starts, parts = [np.zeros(0)], [np.zeros((0, _NODES))]
        while len(begin):
            half = 0.5 * (end - begin)
            values = 1.0 / ratio(begin[:, None] + half[:, None] * (1.0 + nodes))
            found = values @ basis
            tail = np.abs(found[:, -_TAIL:]).sum(axis=1)
            good = tail <= _SETTLED * found[:, 0] + _NOISE * values.max(axis=1) ** 2
            good |= len(begin) > _PANELS
            starts.append(begin[good])
            parts.append(half[good, None] * found[good])
            middle = begin[~good] + half[~good]
            begin, end = np.concatenate([begin[~good], middle]), np.concatenate([middle, end[~good]])
        start = np.concatenate(starts)
        order = np.argsort(start)
        integrals = legendre.legint(np.concatenate(parts)[order].T, lbnd=-1.0)
        series = np.asarray(integrals, dtype=np.float64)
        whole = np.asarray(legendre.legval(1.0, series), dtype=np.float64)
        panels = np.append(start[order], ends[-1])
        return cls(np.asarray(panels, dtype=np.float64), series, np.concatenate([[0.0], np.cumsum(whole)]))

    @property
    def turn(self) -> float:
        """The integral over a turn."""
        return float(self.before[-1])

    def at(self, crank_angle: Array) -> Array:
        """Return the integral up to crank angles of any number of turns, rad, from the first panel on."""
        turns = np.floor((crank_angle - self.ends[0]) / _TURN)
        within = crank_angle - turns * _TURN
        panel = np.clip(np.searchsorted(self.ends, within, side="right") - 1, 0, len(self.ends) - 2)
        low, high = self.ends[panel], self.ends[panel + 1]
        x = np.clip(2.0 * (within - low) / (high - low) - 1.0, -1.0, 1.0)
        found = legendre.legval(x, self.series[:, panel], tensor=False)
        return np.asarray(turns * self.turn + self.before[panel] + found)
