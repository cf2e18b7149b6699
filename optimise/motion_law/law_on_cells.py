"""The best law on the cells of a turn.

A required cycle time makes the problem non-convex only if the best law would be faster. Then the tangent to the time is
renewed until it changes nothing (`cone_programme`). The law is the convex combination of the slow and the fast law with
exactly the cycle time. It is no worse, because limits, peak and RMS torque are convex.

Among the laws with the least peak torque, the one with the least RMS torque is chosen, at the cost of a ten-thousandth
of the peak.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array, Mask
from ...model.motion_law.law_turn import LawTurn
from ...model.motion_law.motion_law import MotionLaw
from ...model.transient.crank_equation import TURN
from .cone_programme import Aim, Margins, Multipliers, Programme, Requirement, Solution
from .law_limits import LawLimits, LawRequest

_RENEWALS = 20
_DOUBLINGS = 8
_CONVERGED = 1e-6
_NOTHING = 1e-8  # relative to a programme's unit: ten times the error of its solution
_TIE = 1e-4  # relative to the peak torque
_EQUAL = 1e-7  # relative to the cycle time
_MARGIN = 2e-7  # of a limit
_ROUNDS = 8
_COARSE = 0.01  # relative excess over a limit within a cell above which the cell is too coarse for margins ...
_UNTIMED = 1e-5  # ... as it is if its time is wrong by more than this fraction of the cycle time

Proof = tuple[Aim, Requirement, Multipliers]


@dataclass(frozen=True)
class Stage:
    """A law on the cells of a turn.

    value: its objective. proofs: programmes whose multipliers bound the objective from below.

    relaxed: whether a least time is active, so that these bounds are those of a relaxation. exceeded: greatest relative
    excess over a limit at a node. coarse: cells (n,) that do not resolve the law.
    """

    law: MotionLaw
    value: float
    proofs: list[Proof]
    relaxed: bool
    exceeded: float
    coarse: Mask


def solve_on_cells(turn: LawTurn, limits: LawLimits, guess: MotionLaw | None) -> Stage | None:
    """Return the best law on the cells, or None. guess: a law on other cells.

    Between the programme's angles, a law may exceed limits, and its time differs from that of Simpson's rule. Both
    deviations are measured, and the programme is solved again with margins.
    """
    margins, target = Margins(*np.full((3, len(turn.width)), _MARGIN)), limits.cycle_time
    for _ in range(_ROUNDS):
        search = _Search(Programme(turn, limits, margins), guess, target)
        answer = search.best_law_and_faster()
        if answer is None:
            return None
        law, missing, fast = _law_with_cycle_time(turn, limits, *answer)
        found = _relative_excess(law, limits)
        excess = np.max([found.least, found.greatest, found.acceleration], axis=0)
        coarse = (excess > _COARSE) | (np.abs(search.simpson_time_errors(law)) > _UNTIMED * limits.cycle_time)
        if coarse.any() or (excess.max() <= _MARGIN and abs(missing) <= _EQUAL * limits.cycle_time):
            break
        guess, target = law, target + missing
        parts = ((getattr(margins, name), getattr(found, name)) for name in ("least", "greatest", "acceleration"))
        margins = Margins(*(margin + 1.5 * np.maximum(part, 0.0) for margin, part in parts))
    value = objective_value(law, limits) if law.node_energies.min() > 0.0 else math.inf
    return Stage(law, value, search.proofs, fast, float(excess.max()), coarse)


def objective_value(law: MotionLaw, limits: LawLimits) -> float:
    """Return peak torque, N m, RMS torque over time, N m, or cycle time, s, whichever is the objective."""
    objective = limits.request.objective
    if objective == "peak torque":
        return float(np.abs(law.torque).max())
    if objective == "cycle time":
        return law.period
    return law.rms_torque


class _Search:
    """The search for the best law of a programme. proofs: solved programmes with their multipliers."""

    def __init__(self, programme: Programme, guess: MotionLaw | None, cycle_time: float) -> None:
        self.programme, self.limits, self.guess, self.cycle_time = programme, programme.limits, guess, cycle_time
        self.proofs: list[Proof] = []

    def best_law_and_faster(self) -> tuple[Solution, Solution | None] | None:
        """Return the best law, and a faster one to combine with it if a least time is active; or None."""
        request = self.limits.request
        if request.objective == "cycle time":
            only = self._solve_and_record("cycle time", Requirement(torque_limit=request.torque_limit))
            return None if only is None else (only, None)
        needs = Requirement(torque_limit=request.torque_limit, longest=self.cycle_time)
        fast = self._solve_and_record(request.objective, needs)
        if fast is None:
            return None
        if request.objective == "rms torque":
            if not self._is_too_fast(fast):
                return fast, None
            self._solve_and_record("rms torque", replace(needs, longest=None, least=self.cycle_time))
            slow = self._solve_by_tangents("rms torque", needs, self._reference_energies(None), prove=True)
            return None if slow is None else (slow, fast)
        peak, reference = fast.value, fast.energies
        if self._is_too_fast(fast):
            slow = self.programme.solve("long cycle", Requirement(torque_limit=peak * (1.0 + _TIE)))
            if slow is not None and self.programme.turn_time(slow.energies) >= self.cycle_time:
                reference = self._combine_to_cycle_time(fast.energies, slow.energies)
            else:
                slow = self._solve_by_tangents("peak torque", needs, self._reference_energies(slow), prove=True)
                slow = slow or self._solve_by_tangents(
                    "peak torque", needs, self._slow_reference_energies(fast, request), prove=True
                )
                if slow is None:
                    return None
                peak, reference = max(peak, slow.value), slow.energies
        needs = replace(needs, torque_limit=peak * (1.0 + _TIE))
        calm = self.programme.solve("rms torque", needs) or fast
        if not self._is_too_fast(calm):
            return calm, None
        slow = self._solve_by_tangents("rms torque", needs, reference)
        return None if slow is None else (slow, calm)

    def simpson_time_errors(self, law: MotionLaw) -> Array:
        """Return the errors of the programme's time in each cell of a law, (n,), s."""
        turn = self.programme.turn
        if not law.node_energies.min() > 0.0:
            return np.full(len(turn.width), math.inf)
        inertia, energies = (
            self.programme.inertia,
            np.stack([law.energy_at(angles) for angles in self.programme.angles]),
        )
        starts, middles = np.sqrt(0.5 * inertia / np.maximum(energies, 1e-300))
        simpson = turn.width * (starts + 4.0 * middles + np.roll(starts, -1)) / 6.0
        return np.asarray(simpson - np.sum(turn.angle_weights * law.node_slowness, axis=1))

    def _is_too_fast(self, solution: Solution) -> bool:
        if self.limits.request.timing != "equal":
            return False
        return self.programme.turn_time(solution.energies) < self.cycle_time * (1.0 - _EQUAL)

    def _solve_and_record(self, aim: Aim, needs: Requirement) -> Solution | None:
        solution = self.programme.solve(aim, needs)
        if solution is not None:
            self.proofs.append((aim, needs, solution.multipliers))
        return solution

    def _combine_to_cycle_time(self, fast: Array, slow: Array) -> Array:
        """Return the convex combination of a faster and a slower K that has the cycle time."""
        from scipy.optimize import brentq

        def lateness(share: float) -> float:
            return self.programme.turn_time(fast + share * (slow - fast)) - self.cycle_time

        return np.asarray(fast + float(brentq(lateness, 0.0, 1.0, xtol=1e-15)) * (slow - fast))

    def _reference_energies(self, slow: Solution | None) -> Array:
        """Return K of a law near the best one: the guess, otherwise a slow one, otherwise constant speed."""
        if self.guess is not None:
            return np.stack([self.guess.energy_at(angles) for angles in self.programme.angles])
        if slow is not None:
            return slow.energies
        return self._constant_speed_energies

    def _slow_reference_energies(self, fast: Solution, request: LawRequest) -> Array:
        """Return K of a law with the cycle time, found with torques above those of a faster law.

        Without such a law, return K of constant speed. The tangent to the time at a law is at most 1.5 times that law's
        own time. If that law is much too fast, the tangent therefore never reaches the cycle time.
        """
        torque, most = fast.value, request.torque_limit or math.inf
        for _ in range(_DOUBLINGS):
            torque = min(2.0 * torque, most)
            slow = self.programme.solve("long cycle", Requirement(torque_limit=torque))
            if slow is not None and self.programme.turn_time(slow.energies) >= self.cycle_time:
                return self._combine_to_cycle_time(fast.energies, slow.energies)
            if torque == most:
                break
        return self._constant_speed_energies

    @property
    def _constant_speed_energies(self) -> Array:
        return np.asarray(0.5 * self.programme.inertia * (TURN / self.cycle_time) ** 2)

    def _solve_by_tangents(
        self, aim: Aim, needs: Requirement, reference: Array, *, prove: bool = False
    ) -> Solution | None:
        """Return the best law of at least the cycle time near a reference, with tangents to the time."""
        least = replace(needs, longest=None, least=self.cycle_time)
        last = None
        for _ in range(_RENEWALS):
            least = replace(least, energies=reference)
            solution = self.programme.solve(aim, least)
            if solution is None:
                break
            least_change = max(_CONVERGED * abs(solution.value), _NOTHING * self.programme.objective_unit(aim))
            converged = last is not None and abs(last.value - solution.value) <= least_change
            last, reference = solution, solution.energies
            if converged:
                break
        if last is not None and prove:
            self.proofs.append((aim, least, last.multipliers))
        return last


def _law_with_cycle_time(
    turn: LawTurn, limits: LawLimits, slow: Solution, fast: Solution | None
) -> tuple[MotionLaw, float, bool]:
    """Return the law with the cycle time, or at most that; the time that was missing; whether laws were combined."""
    law = MotionLaw.from_torque_made_periodic(turn, slow.torque, float(slow.energy[0]))
    request, cycle_time = limits.request, limits.cycle_time
    if not law.node_energies.min() > 0.0 or request.objective == "cycle time":
        return law, 0.0, fast is not None
    missing = cycle_time - law.period
    if request.timing == "at most" and missing >= 0.0:
        return law, 0.0, False
    if fast is not None:
        other = MotionLaw.from_torque_made_periodic(turn, fast.torque, float(fast.energy[0]))
        if missing <= 0.0 and other.node_energies.min() > 0.0:
            return _law_with_period(lambda share: law.mixed_with(other, share), 0.0, 1.0, cycle_time), 0.0, True
    # A constant added to K changes no torque.
    room = 1e-2 * float(law.node_energies.min())
    near = _law_with_period(lambda added: replace(law, start_energy=law.start_energy + added), -room, room, cycle_time)
    return near, missing, fast is not None


def _law_with_period(law_of: Callable[[float], MotionLaw], first: float, last: float, period: float) -> MotionLaw:
    """Return the law with a given period, s, from a family; if none has it, the nearer end."""
    from scipy.optimize import brentq

    errors = [law_of(number).period - period for number in (first, last)]
    if errors[0] * errors[1] >= 0.0:
        return law_of((first, last)[int(np.argmin(np.abs(errors)))])
    return law_of(float(brentq(lambda number: law_of(number).period - period, first, last, xtol=1e-15, rtol=1e-14)))


def _relative_excess(law: MotionLaw, limits: LawLimits) -> Margins:
    """Return the greatest relative excess of a law over limits at the nodes of each cell."""
    turn, energy = law.turn, law.node_energies
    low, high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
    limit = limits.acceleration_limit(turn.terms)
    by_node = [1.0 - energy / low, energy / high - 1.0, np.full(energy.shape, -1.0)]
    if limit is not None:
        by_node[2] = np.abs(law.node_torques - turn.terms.load + limit.by_energy * energy) / limit.greatest - 1.0
    return Margins(*(part.max(axis=1) for part in by_node))
