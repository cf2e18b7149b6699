"""Root mean square of the torque on a crank that turns a line, for many machines, with exact derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..kernel.arithmetic import STEP
from ..quadrature import NODES, WEIGHTS, Samples, last_coefficients_magnitude, resolve
from .peaks import LeverBatch
from .states import LeverNumbers
from .turn import PIECES, turn_state

_ROUGH = 1e-9  # last coefficients of a resolved panel, as a fraction of the greatest torque
_DEEPEST = 10
_TURN = 2.0 * np.pi


def rms_torque(batch: LeverBatch, *, gradients: bool = False) -> tuple[Array, Array]:
    """Return the root mean square (n,) of the torque over a turn, N m, and its derivatives (n, v) by the variables."""
    count = batch.count
    lever, piece = np.repeat(np.arange(count), PIECES), np.tile(np.arange(float(PIECES)), count)
    size = np.zeros(count)

    def sample(low: Array, width: Array, lever: Any, piece: Array) -> Samples:
        torque = _torque(batch.plain, lever, piece, low[:, None] + width[:, None] * NODES)[0]
        np.maximum.at(size, lever, np.abs(torque).max(axis=1))
        return last_coefficients_magnitude(torque) > _ROUGH * size[lever], []

    low, width, lever, piece = resolve(sample, piece, np.ones(len(piece)), lever, piece, deepest=_DEEPEST)
    places, weights = low[:, None] + width[:, None] * NODES, width[:, None] * WEIGHTS / _TURN

    def mean_square(c: LeverNumbers) -> Any:
        torque, stretch = _torque(c, lever, piece, places)
        total = np.zeros(count, dtype=torque.dtype)
        np.add.at(total, lever, (weights * torque * torque * stretch).sum(axis=1))
        return total

    rms = np.sqrt(mean_square(batch.plain))
    slopes = [mean_square(c).imag / STEP for c in batch.stepped] if gradients else []
    if not slopes:
        return rms, np.zeros((count, 0))
    half = np.divide(0.5, rms, out=np.zeros(count), where=rms > 0.0)
    return rms, np.stack(slopes, axis=-1) * half[:, None]


def _torque(numbers: LeverNumbers, lever: Any, piece: Array, place: Array) -> tuple[Any, Any]:
    """Return torque (p, k) and d(crank angle) / d(place) of machines at places in pieces of their turns."""
    state = turn_state(LeverNumbers(*(number[lever, None] for number in numbers)), place, piece[:, None] + 0.5)
    return state.torque, state.stretch
