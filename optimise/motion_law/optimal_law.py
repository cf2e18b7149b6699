"""The best motion law for a machine with given lengths, with a proof.

The law is first found on coarse cells (`law_on_cells`). These are halved until the law, which is exact on the
continuous turn, is within a thousandth of a bound on all laws (`lower_bound`, `law_limits`).

If the limits allow no law, the message says which ones, by how much, and what to change.

Multipliers give a lower bound on the objective of every law, by weak duality of the continuous problem. For any
continuous, periodic p(phi), every law with dK / d(phi) = T - Q has

    integral of p (T - Q) + p' K = 0,

so with multipliers m for the limits of acceleration and l for the time t,

    objective >= objective + integral of p (K' + Q - T) + m (limit exceeded by) + l (time - t),

and the right side is at least the integral of its minimum over K and T at each angle, each within its own limits of
speed and torque. A search over K, with T by formula, finds that minimum at 16 nodes of each cell. Only p and m are
discretised; they may be any functions, here those of the programme, linear in each cell. For a negative l (a least
time), the bound is that of the convex relaxation, and the law may be optimal despite a gap.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.motion_law.law_turn import LawTurn
from ...model.motion_law.motion_law import MotionLaw
from ...model.quadrature import NODES
from ...model.transient.crank_equation import TURN
from .cone_programme import Aim, Margins, Multipliers, Programme, Requirement
from .law_limits import LawLimits, LawRequest, Reachable, resolve_limits, rpm_text
from .law_on_cells import Stage, solve_on_cells

_GRID = 33
_MOST_ROUNDS = 12
_NARROWER = 9  # points in each further round


def lower_bound(turn: LawTurn, limits: LawLimits, aim: Aim, needs: Requirement, multipliers: Multipliers) -> float:
    """Return the lower bound from a programme's multipliers.

    It bounds the peak torque, N m, the mean square torque over the cycle time, N^2 m^2, or the time, s.
    """
    by_torque, by_energy, constant = _integrand_coefficients(turn, limits, multipliers)
    pace = multipliers.pace
    time = needs.longest if pace > 0.0 else needs.least
    low, high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
    torque_limit = math.inf if needs.torque_limit is None else needs.torque_limit

    def least_integrand(energy: Array) -> Array:
        """Return the least integrand over T at K; it omits a torque that only its limit bounds."""
        slowness = np.sqrt(0.5 * turn.terms.inertia / energy)
        value = by_energy * energy + pace * slowness
        if aim != "rms torque":
            return value + (slowness if aim == "cycle time" else 0.0)
        weight = slowness / limits.cycle_time
        torque = np.clip(-0.5 * by_torque / weight, -torque_limit, torque_limit)
        return np.asarray(value + torque * (weight * torque + by_torque))

    least = _least_over_energy(least_integrand, low, high)
    total = float(np.sum(turn.angle_weights * (constant + least))) - (0.0 if time is None else pace * time)
    if aim == "rms torque":
        return total
    size = float(np.sum(turn.angle_weights * np.abs(by_torque)))
    if aim == "peak torque":
        return total / size if size > 0.0 else 0.0
    return total - torque_limit * size


def _integrand_coefficients(turn: LawTurn, limits: LawLimits, multipliers: Multipliers) -> tuple[Array, Array, Array]:
    """Return the integrand's coefficients of T and K and its constant, at the nodes, without time and objective.

    p is continuous. Near a limit of acceleration, it changes as the limit's multipliers require, so that the
    coefficient of K, whose range may be wide, is almost zero there.
    """
    p, place, width = multipliers.momentum, NODES, turn.width
    by_torque, by_energy, constant = np.zeros((3, *turn.angle.shape))
    gains = np.zeros((2, len(p)))  # changes of p by the limit, near the start and the end of a cell
    limit, ends = limits.acceleration_limit(turn.terms), limits.acceleration_limit(turn.end_terms)
    if limit is not None and ends is not None:
        hats = 2.0 * np.stack([1.0 - place, place]) / width[:, None, None]  # (n, 2, 16)
        sides = np.maximum(multipliers.sides, 0.0)
        gains = (sides[:, 0] - sides[:, 1]) * ends.by_energy
        mean = np.einsum("ni,nei,ni->en", turn.angle_weights, hats, limit.by_energy)
        with np.errstate(divide="ignore", invalid="ignore"):
            factor = np.clip(np.nan_to_num(ends.by_energy / mean, nan=1.0), 0.5, 2.0)
        upper, lower = (np.einsum("en,nei->ni", factor * sides[:, side], hats) for side in range(2))
        by_torque, by_energy = upper - lower, (upper - lower) * limit.by_energy
        constant = (lower - upper) * turn.terms.load - (upper + lower) * limit.greatest
    starts = _momentum_at_cell_starts(turn, p, gains)
    for cell, outside in limits.window_cells(turn):
        # K is limited from here on, or up to here: p may jump, but only within the window.
        starts[cell] = p[outside] + (gains[1, outside] if outside != cell else -gains[0, outside])
    even = (np.roll(starts, -1) - starts - np.sum(turn.angle_weights * by_energy, axis=1)) / width
    momentum = starts[:, None] + turn.integrals_to_nodes(by_energy) + (even * width)[:, None] * place
    return by_torque - momentum, np.repeat(-even[:, None], len(place), axis=1), constant + momentum * turn.terms.load


def _momentum_at_cell_starts(turn: LawTurn, p: Array, gains: Array) -> Array:
    """Return p (n,) at the starts of cells.

    p: multipliers of the cells. gains: (2, n), near their ends.

    The programme determines the mean of two cells weighted by their widths, which is p at the centroid of the hat
    function over both. Multipliers of single cells may alternate.
    """
    total = float(gains.sum())
    before = np.concatenate([[0.0], np.cumsum(gains.sum(axis=0))[:-1]])
    rest = p - before - gains[0]
    width, last = turn.width, np.roll(turn.width, 1)
    mean = (last * np.concatenate([rest[-1:] + total, rest[:-1]]) + width * rest) / (last + width)
    centroid = turn.passed + (width - last) / 3.0
    places = np.concatenate([centroid[-2:] - TURN, centroid, centroid[:2] + TURN])
    means = np.concatenate([mean[-2:] + total, mean, mean[:2] - total])
    return np.asarray(before + np.interp(turn.passed, places, means))


def _least_over_energy(function: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Return the least values of a function of K between limits, on successively finer grids over the speed."""
    first, last = np.sqrt(low), np.sqrt(np.maximum(high, low))
    best = np.full(low.shape, np.inf)
    for count in (_GRID, *[_NARROWER] * _MOST_ROUNDS):
        step = (last - first) / (count - 1)
        values = np.stack([function((first + number * step) ** 2) for number in range(count)])
        place = np.argmin(values, axis=0)
        best = np.minimum(best, np.take_along_axis(values, place[None], axis=0)[0])
        first, last = first + np.maximum(place - 1, 0) * step, first + np.minimum(place + 1, count - 1) * step
    return best


_AMPLE = 1e3  # multiple of the loads' greatest torque that is effectively unlimited


def require_consistent_limits(turn: LawTurn, limits: LawLimits) -> None:
    """Raise `InputError` if the least crank speed exceeds what the slider's speed limit allows."""
    low, high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
    worst = np.unravel_index(int(np.argmax(low - high)), low.shape)
    if not low[worst] <= high[worst]:
        allowed = math.sqrt(2.0 * high[worst] / turn.terms.inertia[worst])
        angle = math.degrees(float(turn.angle[worst])) % 360.0
        raise InputError(
            f"limits of a motion law exclude each other: at a crank angle of {angle:.6g} deg the slider's speed limit "
            f"allows {rpm_text(allowed)}, and {limits.name_of_field('least_speed')} is "
            f"{rpm_text(limits.least_speed)}; reduce "
            "the latter or raise the slider's speed"
        )


def unreachable_limits_error(turn: LawTurn, limits: LawLimits) -> InputError:
    """Return the error for limits without a law: which limits exclude each other, and the least change."""
    request, load = limits.request, float(np.abs(turn.terms.load).max())
    programme = Programme(turn, limits, Margins(*np.zeros((3, len(turn.width)))))
    longest = math.inf if request.objective == "cycle time" else limits.cycle_time * (1.0 + _ROUNDING)
    needs = Requirement(longest=None if math.isinf(longest) else longest)
    reachable = Reachable(turn, limits)
    shortest = reachable.laws_within(_AMPLE * max(load, request.torque_limit or 0.0, 1.0)).shortest
    if shortest > longest:
        return InputError(
            f"the speed limits allow no cycle shorter than {shortest:.6g} s; {limits.name_of_field('cycle_time')} is "
            f"{limits.cycle_time:.6g} s; extend it, or raise a limit"
        )
    slower = "; raise it, or widen the speed limits" + ("" if math.isinf(longest) else ", or extend the cycle time")
    if request.crank_acceleration is not None:
        needed = programme.solve("acceleration", needs)
        if needed is not None and needed.value > 1.0:
            return InputError(
                f"a law within these limits needs a crank acceleration of at least "
                f"{needed.value * request.crank_acceleration:.6g} rad/s^2; "
                f"{limits.name_of_field('crank_acceleration')} is "
                f"{request.crank_acceleration:.6g} rad/s^2{slower}"
            )
    if request.torque_limit is not None:
        mean_torque, name = abs(turn.work_absorbed_by_loads) / TURN, limits.name_of_field("torque_limit")
        if mean_torque > request.torque_limit:
            return InputError(
                f"the loads absorb {abs(turn.work_absorbed_by_loads):.6g} J in a turn, a mean torque of "
                f"{mean_torque:.6g} N m; "
                f"{name} is "
                f"{request.torque_limit:.6g} N m; raise it"
            )
        solved = programme.solve("peak torque", needs)
        by_reachable = reachable.least_torque(request.torque_limit, longest, 0.0)
        least = max(by_reachable, 0.0 if solved is None else solved.value)
        if least > request.torque_limit * (1.0 - _ROUNDING):
            return InputError(
                f"a law within these limits needs a torque of at least {least:.6g} N m; {name} is "
                f"{request.torque_limit:.6g} N m{slower}"
            )
    narrow = [limits.name_of_field(field) for field in request.narrowing_fields]
    return InputError(
        "a motion law must be resolved between the speed limits; got a machine whose kinetic energy is too small "
        "compared with the work of its loads, or limits that leave almost no room; state or raise the inertia in "
        f"[drive] (motor_inertia, gear_ratio, flywheel), or widen {' or '.join(narrow) or 'the limits'}"
    )


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
