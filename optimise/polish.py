"""Sequential quadratic programming that moves designs onto the Pareto front.

Each design solves Benson's problem from where it stands, min sum_i f_i with no objective made worse and all constraints
held, whose solutions are Pareto-optimal (H. P. Benson, "Existence of efficient solutions for vector maximization
problems", JOTA 26(4), 1978). Merely mutual non-dominance, or a vanishing convex combination of some gradients, is not
enough: where two objectives do not change with the size of the linkage, a smaller copy may be better in all others.
With scaled objective pieces p of gradient g, constraint rows c <= 0 of gradient a, a step solves

    min  sum_i (t_i + t_i^2 / 2) + sum_i (K v_i + K^2 v_i^2 / 2) + (C w + C^2 w^2 / 2) + d' B d / 2   over d, t, v, w
    subject to  p + g d <= F_i + t_i  (each piece p of objective i),   t_i <= v_i,   0 <= v_i,
                c + a d <= w,   0 <= w,   0 <= u + d <= 1,

where F_i is the objective's present value (the greatest of its pieces) and B the Hessian of the Lagrangian, taken by
differences of exact gradients and made positive definite. v and w are exact penalties: where an objective and a
constraint oppose each other exactly, rounding would leave a hard-bounded programme without a solution. Peaks that tie
enter as separate pieces: a kink is a minimax, not noise. Designs advance together, so that every evaluation is a batch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from .evaluation import Rows
from .stationarity import Array, multipliers, strict_multipliers

ITERATIONS = 60
ACTIVE = 1e-8
"""Constraint rows nearer to zero than this, and objective pieces nearer to their greatest (scaled), are active."""
CONVERGED = 1e-9
"""Residual of Benson's problem at which a design is done."""
_GRAIN = 1e-12  # losses and violations below it are rounding
_STALLED = 1e-9  # gain (objectives scaled by their range) of two steps in a row that ends a design's polish
_DIFFERENCE = 1e-6  # of the unit box, for differences of gradients
_CURVATURE = 1e-6  # least eigenvalue of the step's Hessian, objectives and box scaled to one
_LOSS = 1e3  # K: what an objective's loss weighs against another's gain, ranges scaled to one
_VIOLATION = 1e4  # C: the same for a constraint's relative violation
_HALVINGS = 16


class Evaluates(Protocol):
    """What the polish needs of an evaluator."""

    def valid(self, u: Array) -> NDArray[np.bool_]:
        """Return which points can be evaluated."""
        ...

    def exact(self, u: Array) -> tuple[Rows, Rows]:
        """Return objective rows and constraint rows."""
        ...


@dataclass(frozen=True)
class Polished:
    """Designs after the polish.

    u: (n, k) points. values: (n, m) scaled objectives. violation: (n,) greatest relative. residual: (n,), see
    `stationarity.multipliers`. goals: for each design, owner and gradient of the active objective pieces. active: the
    gradients of its active constraints and bounds.
    """

    u: Array
    values: Array
    violation: Array
    residual: Array
    goals: tuple[tuple[Array, Array], ...]
    active: tuple[Array, ...]


def polish(
    evaluator: Evaluates,
    start: Array,
    scale: Array,
    *,
    chosen: tuple[int, ...] | None = None,
    iterations: int = ITERATIONS,
) -> Polished:
    """Return designs improved to stationarity from `start` (n, k) in the unit box.

    scale: range of each objective over the front. chosen: improve these objectives only (all by default).
    """
    batch = _Batch(evaluator, start, scale, chosen)
    for _ in range(iterations):
        if not batch.advance():
            break
    return batch.result()


class _Batch:
    """Designs under polish: where they stand, their rows, and which still move."""

    def __init__(self, evaluator: Evaluates, start: Array, scale: Array, chosen: tuple[int, ...] | None) -> None:
        self.evaluator = evaluator
        self.scale = scale
        self.chosen = tuple(range(len(scale))) if chosen is None else chosen
        self.u = np.clip(start, 0.0, 1.0)
        self.goals, self.limits = self._evaluate(self.u)
        self.open = np.full(len(start), start.shape[1] > 0)
        self.stalls = np.zeros(len(start), dtype=np.int64)
        self.radius = np.full(len(start), 0.25)

    def advance(self) -> bool:
        """Take one step with every open design; return whether any was open."""
        weights: dict[int, tuple[Array, Array]] = {}
        for row in np.flatnonzero(self.open).tolist():
            residual, weights[row] = _state(self.u[row], _at(self.goals, row), _at(self.limits, row), self.chosen)
            if residual < CONVERGED and np.max(self.limits.values[row], initial=0.0) <= _GRAIN:
                self.open[row] = False
                del weights[row]
        if not weights:
            return False
        rows = np.array(list(weights))
        hessians = self._hessians(rows, list(weights.values()))
        steps = np.array(
            [
                _step(self.u[row], _at(self.goals, row), _at(self.limits, row), hessian, self.radius[row], self.chosen)
                for row, hessian in zip(rows.tolist(), hessians, strict=True)
            ]
        )
        self._search(rows, steps)
        return True

    def result(self) -> Polished:
        """Return where the designs stand."""
        n, m = len(self.u), len(self.scale)
        residual = np.zeros(n)
        pieces, active = [], []
        for row in range(n):
            here, edge = _at(self.goals, row), _at(self.limits, row)
            columns = _active_pieces(here, tuple(range(m)))
            pieces.append((here.owner[columns].astype(np.float64), here.gradients[columns]))
            active.append(np.concatenate([edge.gradients[edge.values > -ACTIVE], _box(self.u[row])]))
            wanted = _active_pieces(here, self.chosen)
            residual[row], _, _ = multipliers(here.gradients[wanted], active[-1])
        violation = self.limits.values.max(axis=1, initial=0.0)
        return Polished(self.u, _greatest(self.goals, m), violation, residual, tuple(pieces), tuple(active))

    def _evaluate(self, u: Array) -> tuple[Rows, Rows]:
        goals, limits = self.evaluator.exact(u)
        factor = 1.0 / self.scale[goals.owner]
        return Rows(goals.values * factor, goals.gradients * factor[:, None], goals.labels, goals.owner), limits

    def _hessians(self, rows: NDArray[np.int64], weights: list[tuple[Array, Array]]) -> Array:
        """Return the Hessians (n, k, k) of the Lagrangians with fixed multipliers, made positive definite."""
        u = self.u[rows]
        n, k = u.shape
        hessians = np.zeros((n, k, k))
        for column in range(k):
            step = np.where(u[:, column] < 0.5, _DIFFERENCE, -_DIFFERENCE)
            moved = u.copy()
            moved[:, column] += step
            moved = np.where(self.evaluator.valid(moved)[:, None], moved, u)
            goals, limits = self._evaluate(moved)
            for i, (row, (goal_weight, limit_weight)) in enumerate(zip(rows.tolist(), weights, strict=True)):
                change = _difference(_at(self.goals, row), _at(goals, i), goal_weight)
                change = change + _difference(_at(self.limits, row), _at(limits, i), limit_weight)
                hessians[i, column] = change / step[i]
        hessians = 0.5 * (hessians + hessians.transpose(0, 2, 1))
        hessians[~np.isfinite(hessians).all(axis=(1, 2))] = np.eye(k)
        values, vectors = np.linalg.eigh(hessians)
        return np.asarray(np.einsum("nij,nj,nkj->nik", vectors, np.clip(np.abs(values), _CURVATURE, 1e8), vectors))

    def _search(self, rows: NDArray[np.int64], steps: Array) -> None:
        """Halve steps until the merit goes down: sum of losses, plus penalised greatest loss and violation."""
        m, chosen = len(self.scale), list(self.chosen)
        before = _greatest(self.goals, m)
        violation = _beyond(self.limits.values.max(axis=1, initial=0.0))
        pending = np.arange(len(rows))
        length = 1.0
        for _ in range(_HALVINGS):
            at = rows[pending]
            trial = np.clip(self.u[at] + length * steps[pending], 0.0, 1.0)
            valid = self.evaluator.valid(trial)
            trial = np.where(valid[:, None], trial, self.u[at])
            goals, limits = self._evaluate(trial)
            change = (_greatest(goals, m) - before[at])[:, chosen]
            worse = _beyond(limits.values.max(axis=1, initial=0.0)) - violation[at]
            merit = change.sum(axis=1) + _LOSS * _beyond(change).sum(axis=1) + _VIOLATION * worse
            moved = np.abs(trial - self.u[at]).max(axis=1)
            accepted = valid & (merit < 0.0)
            for i in np.flatnonzero(accepted).tolist():
                row = int(at[i])
                self.u[row] = trial[i]
                self.goals.put(row, goals, i)
                self.limits.put(row, limits, i)
                full = length == 1.0
                self.radius[row] = min(0.5, max(self.radius[row] * full, 2.0 * moved[i], 1e-6))
                self.stalls[row] = self.stalls[row] + 1 if merit[i] > -_STALLED else 0
            pending = pending[~accepted]
            if not len(pending):
                break
            length *= 0.5
        # Nothing along the step helps any more: rounding, or a kink that was not seen; the residual will tell.
        self.open[rows[pending]] = False
        self.open &= self.stalls < 2


def _greatest(rows: Rows, count: int) -> Array:
    """Return the greatest piece of each owner, (n, count)."""
    return np.stack([rows.values[:, rows.owner == owner].max(axis=1) for owner in range(count)], axis=1)


def _at(rows: Rows, row: int) -> Rows:
    return Rows(rows.values[row], rows.gradients[row], rows.labels[row], rows.owner)


def _box(u: Array) -> Array:
    """Return the gradients of the box's active bounds."""
    edge = np.eye(len(u))
    return np.concatenate([-edge[u < ACTIVE], edge[u > 1.0 - ACTIVE]])


def _active_pieces(goals: Rows, chosen: tuple[int, ...]) -> NDArray[np.int64]:
    """Return the pieces that tie for the greatest of each chosen objective."""
    pieces = []
    for owner in chosen:
        columns = np.flatnonzero(goals.owner == owner)
        values = goals.values[columns]
        pieces.append(columns[values >= values.max() - ACTIVE])
    return np.concatenate(pieces)


def _state(u: Array, goals: Rows, limits: Rows, chosen: tuple[int, ...]) -> tuple[float, tuple[Array, Array]]:
    """Return residual of Benson's problem and multipliers of all goal rows and all limit rows."""
    pieces = _active_pieces(goals, chosen)
    near = np.flatnonzero(limits.values > -ACTIVE)
    edges = np.concatenate([limits.gradients[near], _box(u)])
    residual, convex, pushing = strict_multipliers(goals.gradients[pieces], goals.owner[pieces], edges)
    weight, push = np.zeros(len(goals.owner)), np.zeros(len(limits.owner))
    weight[pieces], push[near] = np.minimum(convex, _LOSS), np.minimum(pushing[: len(near)], _VIOLATION)
    return residual, (weight, push)


def _difference(here: Rows, there: Rows, weight: Array) -> Array:
    """Return the weighted change of gradients, each piece matched by its label: peaks may swap their order."""
    total = np.zeros(here.gradients.shape[1])
    for index in np.flatnonzero(weight > 0.0):
        same = np.flatnonzero((here.owner == here.owner[index]) & np.isfinite(there.values))
        apart = np.abs(there.labels[same] - here.labels[index])
        apart = np.minimum(apart, np.abs(apart - 2.0 * np.pi))
        # Rows of one owner with equal labels (lower and upper bound) keep their place.
        nearest = same[np.lexsort((np.abs(same - index), np.round(apart, 3)))[0]]
        total = total + weight[index] * (there.gradients[nearest] - here.gradients[index])
    return total


def _step(u: Array, goals: Rows, limits: Rows, hessian: Array, radius: float, chosen: tuple[int, ...]) -> Array:
    """Solve the quadratic programme as a least-distance problem by non-negative least squares.

    With B = L L' and x = (L' d, t + 1, K v + 1, C w + 1) it reads: min |x|^2 / 2 subject to G x >= h (Lawson and
    Hanson, "Solving Least Squares Problems", 1974, ch. 23.4).
    """
    k, count = len(u), len(chosen)
    size = k + 2 * count + 1
    low, high = np.maximum(-u, -radius), np.minimum(1.0 - u, radius)
    blocks, bounds = [], []  # rows a z <= b for z = (d, t, v, w)

    def demand(bound: Array, *parts: tuple[int, Array]) -> None:
        block = np.zeros((len(bound), size))
        for column, part in parts:
            block[:, column : column + part.shape[1]] = part
        blocks.append(block)
        bounds.append(bound)

    for place, owner in enumerate(chosen):
        columns = np.flatnonzero((goals.owner == owner) & np.isfinite(goals.values))
        top = goals.values[columns].max()
        # Pieces far below cannot become the greatest within the radius; dropping them keeps the problem small.
        columns = columns[goals.values[columns] > top - 1.0]
        demand(top - goals.values[columns], (0, goals.gradients[columns]), (k + place, -np.ones((len(columns), 1))))
    one, none = np.eye(count), np.zeros(count)
    demand(none, (k, one), (k + count, -one))
    demand(none, (k + count, -one))
    near = np.flatnonzero(np.isfinite(limits.values))
    demand(-limits.values[near], (0, limits.gradients[near]), (size - 1, -np.ones((len(near), 1))))
    demand(np.zeros(1), (size - 1, -np.ones((1, 1))))
    demand(high, (0, np.eye(k)))
    demand(-low, (0, -np.eye(k)))
    rows = np.concatenate(blocks)
    scale = np.zeros((size, size))  # z = scale x + shift
    scale[:k, :k] = np.linalg.inv(np.linalg.cholesky(hessian)).T
    weights = np.concatenate([np.ones(count), np.full(count, _LOSS), [_VIOLATION]])
    scale[k:, k:] = np.diag(1.0 / weights)
    shift = np.concatenate([np.zeros(k), -1.0 / weights])
    g, h = -rows @ scale, rows @ shift - np.concatenate(bounds)
    lengths = np.linalg.norm(g, axis=1)
    lengths[lengths == 0.0] = 1.0
    matrix = np.vstack([(g / lengths[:, None]).T, h / lengths])
    target = np.zeros(size + 1)
    target[-1] = 1.0
    try:
        dual, _ = nnls(matrix, target, maxiter=50 * matrix.shape[1])
    except RuntimeError:
        return np.zeros(k)
    rest = matrix @ dual - target
    if rest[-1] == 0.0:
        return np.zeros(k)
    return np.asarray(np.clip((scale @ (-rest[:-1] / rest[-1]))[:k], low, high))


def _beyond(excess: Array) -> Array:
    """Return what exceeds rounding."""
    return np.maximum(excess - _GRAIN, 0.0)
