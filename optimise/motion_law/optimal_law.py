"""The best motion law for a machine with given lengths, with a proof.

The law is first found on coarse cells (`law_on_cells`). These are halved until the law, which is exact on the
continuous turn, is within a thousandth of a bound on all laws (`objective_lower_bound`, `reachable_energies`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.motion_law.law_turn import LawTurn
from ...model.motion_law.motion_law import MotionLaw
from ...model.transient.crank_equation import TURN
from .contradictions import require_consistent_limits, unreachable_limits_error
from .law_limits import LawLimits, LawRequest, resolve_limits
from .law_on_cells import Stage, solve_on_cells
from .objective_lower_bound import lower_bound
from .reachable_energies import Reachable

GAP = 1e-3
"""Greatest relative gap between a law and the bound at which the law counts as proven."""
_ROUNDS = 16
LIMIT_TOLERANCE = 1e-6
"""Greatest relative excess over a limit."""
_STUCK = 0.9  # fraction of the gap: if finer cells leave more of it, the gap is due to the relaxation
_ROUNDING = 1e-9
_NO_TORQUE = 1e-6  # relative to the peak at constant speed: a smaller torque is rounding
_LEAST_CELLS, _MOST_CELLS = 150, 600


@dataclass(frozen=True)
class OptimalLaw:
    """A law, and a lower bound on the objective over all laws within the limits.

    value, bound: peak torque, N m, RMS torque over time, N m, or cycle time, s. relaxed: whether the bound is that of a
    relaxation, which may lie below the best law. rounds: refinements. exceeded: greatest relative excess over a limit
    at a cell's node.
    """

    law: MotionLaw
    limits: LawLimits
    value: float
    bound: float
    relaxed: bool
    rounds: int
    exceeded: float

    @property
    def gap(self) -> float:
        """Greatest relative amount by which the law can be worse than the best one."""
        if self.limits.request.objective != "cycle time":
            terms, speed = self.law.turn.terms, TURN / self.limits.cycle_time
            if self.value <= _NO_TORQUE * float(np.abs(terms.load + 0.5 * terms.inertia_slope * speed**2).max()):
                return 0.0
        return max(0.0, self.value / self.bound - 1.0) if self.bound > 0.0 else math.inf

    @property
    def proven(self) -> bool:
        """Whether the law is within a thousandth of the bound."""
        return self.gap <= GAP


def optimal_law(
    mechanism: Mechanism,
    linkage: Linkage,
    request: LawRequest,
    *,
    names: Mapping[str, str] | None = None,
    cancelled: Callable[[], bool] = lambda: False,
) -> OptimalLaw:
    """Return the best law for one fully rotating linkage.

    names: the interface's names for the request's fields. cancelled: polled between refinements; once true, the latest
    law is returned. Raises `InputError` for machines that `LawTurn` rejects, and for limits that exclude each other or
    the cycle time.
    """
    limits = resolve_limits(mechanism, linkage, request, names)
    at_speed = replace(mechanism, speed=mechanism.direction * TURN / limits.cycle_time)
    turn = LawTurn(at_speed, linkage, limits.window_ends)
    require_consistent_limits(turn, limits)
    best, bound = None, 0.0
    for count in range(_ROUNDS):
        stage = solve_on_cells(turn, limits, None if best is None else best.law)
        if stage is not None:
            dual = max(lower_bound(turn, limits, *proof) for proof in stage.proofs)
            bound = max(bound, _bound_on_objective(dual, stage, limits))
            if stage.exceeded <= LIMIT_TOLERANCE and not stage.coarse.any():
                last = math.inf if best is None else best.gap
                best = OptimalLaw(stage.law, limits, stage.value, bound, stage.relaxed, count, stage.exceeded)
                enough = best.proven or (best.relaxed and best.gap > _STUCK * last)
                if (enough and len(turn.width) >= _LEAST_CELLS) or cancelled():
                    break
        if len(turn.width) > _MOST_CELLS:
            break
        coarse = np.zeros(len(turn.width), np.bool_) if stage is None else stage.coarse
        turn = turn.with_halved_cells(coarse if coarse.any() else np.ones_like(coarse))
    if best is None:
        raise unreachable_limits_error(turn, limits)
    return best


def _bound_on_objective(dual: float, stage: Stage, limits: LawLimits) -> float:
    """Return a bound in the unit of the objective: from multipliers, or from what a torque can reach."""
    request = limits.request
    if request.objective == "rms torque":
        return math.sqrt(max(0.0, dual))
    reachable = Reachable(stage.law.turn, limits)
    if request.objective == "cycle time":
        return max(dual, reachable.laws_within(request.torque_limit or math.inf).shortest)
    least = limits.cycle_time * (1.0 - _ROUNDING) if request.timing == "equal" else 0.0
    guess = float(np.abs(stage.law.torque).max())
    by_reachable = reachable.least_torque(guess, limits.cycle_time * (1.0 + _ROUNDING), least) if guess > 0.0 else 0.0
    return max(dual, by_reachable)
