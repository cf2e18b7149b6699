"""A lower bound on the objective of every motion law, from multipliers, by weak duality of the continuous problem.

For any continuous, periodic p(phi), every law with dK / d(phi) = T - Q has

    integral of p (T - Q) + p' K = 0,

so with multipliers m for the limits of acceleration and l for the time t,

    objective >= objective + integral of p (K' + Q - T) + m (limit exceeded by) + l (time - t),

and the right side is at least the integral of its minimum over K and T at each angle, each within its own limits of
speed and torque. A search over K, with T by formula, finds that minimum at 16 nodes of each cell. Only p and m are
discretised; they may be any functions, here those of the programme, linear in each cell. For a negative l (a least
time), the bound is that of the convex relaxation, and the law may be optimal despite a gap.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...model.arrays import Array
from ...model.motion_law.law_turn import LawTurn
from ...model.quadrature import NODES
from ...model.transient.crank_equation import TURN
from .cone_programme import Aim, Multipliers, Requirement
from .law_limits import LawLimits

_GRID = 33
_ROUNDS = 12
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
    for count in (_GRID, *[_NARROWER] * _ROUNDS):
        step = (last - first) / (count - 1)
        values = np.stack([function((first + number * step) ** 2) for number in range(count)])
        place = np.argmin(values, axis=0)
        best = np.minimum(best, np.take_along_axis(values, place[None], axis=0)[0])
        first, last = first + np.maximum(place - 1, 0) * step, first + np.minimum(place + 1, count - 1) * step
    return best
