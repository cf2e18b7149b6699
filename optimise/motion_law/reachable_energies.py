"""Least and greatest kinetic energy of any law within a torque: bounds on the continuous problem.

With |T| <= tau, the energy changes by at most tau -+ Q per angle. So among all laws within the speed limits K_low and
K_high, one is the slowest at every angle simultaneously, and one the fastest:

    K_slowest(phi) = greatest over psi of K_low(psi) less what tau can take or give between psi and phi,

and likewise from K_high. The smaller of two such laws is also such a law, which proves it. So no law within tau has a
shorter turn than the fastest one, or a longer turn than the slowest one. Acceleration limits are ignored: the bounds
hold, but may be loose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array
from ...model.motion_law.law_turn import LawTurn
from ...model.quadrature import NODES
from ...model.transient.crank_equation import TURN
from .law_limits import LawLimits

_DOUBLINGS, _BISECTIONS = 40, 40
_ROUNDING = 1e-12


@dataclass(frozen=True)
class ReachableLaws:
    """Slowest and fastest law within a torque: K at the nodes (n, 16), J, and times of a turn, s.

    exists: whether there is any law.
    """

    slowest: Array
    fastest: Array
    longest: float
    shortest: float
    exists: bool


class Reachable:
    """Laws that a turn allows within the speed limits."""

    def __init__(self, turn: LawTurn, limits: LawLimits) -> None:
        self.turn = turn
        self.low, self.high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
        cell, node = np.divmod(np.arange(turn.angle.size), turn.angle.shape[1])
        place = NODES[node]
        before = np.concatenate([[0.0], np.cumsum(np.sum(turn.angle_weights * turn.terms.load, axis=1))[:-1]])
        self.taken = before[cell] + turn.integral_from_cell_start(turn.terms.load, cell, place)
        self.passed = turn.passed[cell] + place * turn.width[cell]

    def laws_within(self, torque: float) -> ReachableLaws:
        """Return the slowest and fastest law within a torque, N m."""
        loss = self._continue_over_three_turns(torque * self.passed + self.taken, torque * TURN + self.turn.load_work)
        gain = self._continue_over_three_turns(torque * self.passed - self.taken, torque * TURN - self.turn.load_work)
        slowest, fastest = self._least_energies(self.low, loss, gain), -self._least_energies(-self.high, gain, loss)
        within = bool(np.all(slowest <= self.high * (1.0 + _ROUNDING)))
        fastest = np.maximum(fastest, slowest)  # it may be lower if no law exists
        closes = abs(self.turn.load_work) <= torque * TURN * (1.0 + _ROUNDING)
        return ReachableLaws(slowest, fastest, self._time(slowest), self._time(fastest), within and closes)

    def least_torque(self, torque: float, longest: float, least: float) -> float:
        """Return the torque, N m, below which no law takes between `least` and `longest`, s.

        torque: a positive initial guess. Infinite if no reasonable torque is enough.
        """

        def suffices(torque: float) -> bool:
            reach = self.laws_within(torque)
            return reach.exists and reach.shortest <= longest and reach.longest >= least

        low, high = 0.0, torque
        for _ in range(_DOUBLINGS):
            if suffices(high):
                break
            low, high = high, 2.0 * high
        else:
            return math.inf
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if suffices(middle) else (middle, high)
        return low

    def _time(self, energy: Array) -> float:
        return float(np.sum(self.turn.angle_weights * np.sqrt(0.5 * self.turn.terms.inertia / energy)))

    def _least_energies(self, limit: Array, loss: Array, gain: Array) -> Array:
        """Return the least K above a limit that loses at most `loss` and gains at most `gain`.

        It loses after an angle at which it is on the limit, and gains before it.
        """
        three = np.tile(limit.ravel(), 3)
        after = np.maximum.accumulate(three + loss) - loss
        before = np.maximum.accumulate((three - gain)[::-1])[::-1] + gain
        middle = slice(len(self.passed), 2 * len(self.passed))
        return np.asarray(np.maximum(after, before)[middle].reshape(limit.shape))

    @staticmethod
    def _continue_over_three_turns(integral: Array, turn: float) -> Array:
        return np.concatenate([integral, integral + turn, integral + 2.0 * turn])
