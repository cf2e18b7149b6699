"""Work of the drive over a swing, and efficiency, for many designs with exact derivatives.

Gauss quadrature on the pieces between cuts, graded towards their ends, because near a dead point the drive grows as the
inverse square root of the distance from it. The nodes move with the cuts, so the complex step differentiates the
quadrature.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..kernel.arithmetic import STEP
from ..kernel.batches import run_in_chunks
from ..machine.mechanism import Mechanism
from ..quadrature import graded_gauss_nodes_and_weights
from .closure import swings_without_dead_point
from .swing import Swing
from .swing_batch import Pieces, SwingBatch
from .swing_states import DRIVE, RATE

_PANELS, _GRADED = 8, 1
_CHUNK = 64
_EQUAL = 1e-12
_EVEN = 1e-9
"""Relative to the work in one direction: what remains due to rounding if the other direction returns it."""


@dataclass(frozen=True)
class Work:
    """A result for n designs. values: (n,), NaN if a design cannot swing, inf if friction locks it.

    gradients: (n, v); None unless requested.
    """

    values: Array
    gradients: Array | None


def swing_work(mechanism: Mechanism, swing: Swing, designs: Array, *, gradients: bool = False) -> Work:
    """Return the work of the drive on the forward stroke, J, for designs (n, 3 + k)."""
    return _evaluate_swinging_designs(
        mechanism, swing, designs, gradients, lambda rows: _forward_work(mechanism, swing, rows, gradients)
    )


def net_work_of_loads(mechanism: Mechanism, swing: Swing, designs: Array) -> Array:
    """Return the net work (n,), J, of the loads over a swing and back.

    A drive without friction absorbs it. NaN if a design cannot swing.
    """

    def both_ways(rows: Array) -> tuple[Array, Array]:
        free = SwingBatch(mechanism, swing, rows, slopes=False, free=True)
        ways = [_work_one_way(free, free.pieces_of_stroke(back=back), False)[0] for back in (False, True)]
        total = np.add(*ways)
        return -np.where(np.abs(total) <= _EVEN * np.abs(ways[0]), 0.0, total), np.empty((len(rows), 0))

    return _evaluate_swinging_designs(mechanism, swing, designs, False, both_ways).values


def swing_efficiency(mechanism: Mechanism, swing: Swing, designs: Array, *, gradients: bool = False) -> Work:
    """Return the work without friction divided by the work in the slow forward stroke, (n,).

    Uses the return stroke if only that is driven; NaN if neither is driven.
    """
    return _evaluate_swinging_designs(
        mechanism, swing, designs, gradients, lambda rows: _efficiency_and_slopes(mechanism, swing, rows, gradients)
    )


def _evaluate_swinging_designs(
    mechanism: Mechanism, swing: Swing, designs: Array, gradients: bool, evaluate: Any
) -> Work:
    designs = np.ascontiguousarray(designs, dtype=np.float64)
    values = np.full(len(designs), np.nan)
    slopes = np.zeros((len(designs) if gradients else 0, designs.shape[1]))
    rows = np.flatnonzero(swings_without_dead_point(mechanism, swing, designs))

    def work(begin: int, end: int) -> None:
        rows_here = rows[begin:end]
        stuck = SwingBatch(mechanism, swing, designs[rows_here], slopes=False).may_lock()
        values[rows_here[stuck]] = np.inf
        rows_here = rows_here[~stuck]
        if len(rows_here):
            values[rows_here], slopes_here = evaluate(designs[rows_here])
            if gradients:
                slopes[rows_here] = slopes_here

    run_in_chunks(len(rows), work, size=_CHUNK)
    return Work(values, slopes if gradients else None)


def _forward_work(mechanism: Mechanism, swing: Swing, designs: Array, gradients: bool) -> tuple[Array, Array]:
    batch = SwingBatch(mechanism, swing, designs, slopes=gradients)
    values, slopes = _work_one_way(batch, batch.pieces_of_stroke(back=False), gradients)
    return values, batch.numbers.gradients_by_design_numbers(slopes[:, None])[:, 0] if gradients else slopes


def _efficiency_and_slopes(mechanism: Mechanism, swing: Swing, designs: Array, gradients: bool) -> tuple[Array, Array]:
    values, slope = np.full(len(designs), np.nan), np.zeros((len(designs), designs.shape[1] if gradients else 0))
    rubbing, free = (
        SwingBatch(mechanism, swing, designs, slopes=gradients, slow=True, free=is_free) for is_free in (False, True)
    )
    for back in (True, False):  # the forward stroke takes precedence
        spent, by_spent = _work_one_way(rubbing, rubbing.pieces_of_stroke(back=back), gradients)
        least, by_least = _work_one_way(free, free.pieces_of_stroke(back=back), gradients)
        driven = (least > 0.0) & (spent > 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.where(driven, least / spent, values)
            by_raw = (by_least - (least / spent)[:, None] * by_spent) / spent[:, None]
        if gradients:
            slope = np.where(driven[:, None], rubbing.numbers.gradients_by_design_numbers(by_raw[:, None])[:, 0], slope)
    return values, slope


def _work_one_way(batch: SwingBatch, pieces: Pieces, gradients: bool) -> tuple[Array, Array]:
    """Return the work over one stroke (n,) and its derivatives with respect to raw numbers (n, c)."""
    u, w = graded_gauss_nodes_and_weights(_PANELS, _GRADED)
    design, piece = np.nonzero(pieces.have_length)
    a, b, probe = pieces.cuts[design, piece], pieces.cuts[design, piece + 1], pieces.probe[design, piece]
    share = a[:, None] * (1.0 - u) + b[:, None] * u
    rows = np.broadcast_to(design[:, None], share.shape)
    side, back = np.broadcast_to(probe[:, None], share.shape), float(pieces.back)
    states = batch.states(rows, share, side, back)
    parts = (b - a)[:, None] * w * (states[..., DRIVE] * states[..., RATE]).real
    values, gross = np.zeros(batch.count), np.zeros(batch.count)
    np.add.at(values, design, parts.sum(axis=1))
    np.add.at(gross, design, np.abs(parts).sum(axis=1))
    slopes = np.zeros((batch.count, batch.columns if gradients else 0))
    if gradients:
        starts, ends = (
            batch.cut_slopes(pieces, design, piece, probe),
            batch.cut_slopes(pieces, design, piece + 1, probe),
        )
        for v in range(batch.columns):
            slip = starts[:, v : v + 1] * (1.0 - u) + ends[:, v : v + 1] * u
            states = batch.states(rows, share, side, back, STEP * slip, v)
            span = (b - a) + 1j * STEP * (ends[:, v] - starts[:, v])
            rates = (span[:, None] * w * states[..., DRIVE] * states[..., RATE]).imag / STEP
            np.add.at(slopes[:, v], design, rates.sum(axis=1))
    return np.where(np.abs(values) <= _EQUAL * gross, 0.0, values), slopes
