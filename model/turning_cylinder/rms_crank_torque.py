"""Root mean square of the torque on a crank that turns a line, for many machines, with exact derivatives."""

import numpy as np

from ..arrays import Array, IntArray
from ..kernel.arithmetic import STEP
from ..quadrature import NODES, WEIGHTS, Samples, last_coefficients_magnitude, resolve_panels
from .crank_turn_state import PIECES
from .curve_peaks import LeverBatch
from .curves import Complexes

_ROUGH = 1e-9  # last coefficients of a resolved panel, as a fraction of the greatest torque
_DEEPEST = 10
_TURN = 2.0 * np.pi


def rms_torque(batch: LeverBatch, *, gradients: bool = False) -> tuple[Array, Array]:
    """Return the RMS torque (n,) over a turn, N m, and its derivatives (n, v) by the variables."""
    count = batch.lever_count
    lever, piece = np.repeat(np.arange(count), PIECES), np.tile(np.arange(float(PIECES)), count)
    size, (torque, square) = np.zeros(count), batch.curve_codes(("torque_up", "torque_over_place"))

    def values(table: Complexes, code: int, lever: IntArray, piece: Array, place: Array) -> Complexes:
        return batch.curve_values(table, lever, np.full(len(lever), code), place, piece + 0.5)

    def sample(low: Array, width: Array, lever: IntArray, piece: Array) -> Samples:
        curve = values(batch.number_tables[0], torque, lever, piece, low[:, None] + width[:, None] * NODES).real
        np.maximum.at(size, lever, np.abs(curve).max(axis=1))
        return last_coefficients_magnitude(curve) > _ROUGH * size[lever], []

    low, width, lever, piece = resolve_panels(sample, piece, np.ones(len(piece)), lever, piece, deepest=_DEEPEST)
    places, weights = low[:, None] + width[:, None] * NODES, width[:, None] * WEIGHTS / _TURN

    def mean_square(table: Complexes) -> Complexes:
        total = np.zeros(count, dtype=np.complex128)
        np.add.at(total, lever, (weights * values(table, square, lever, piece, places)).sum(axis=1))
        return total

    rms = np.sqrt(mean_square(batch.number_tables[0]).real)
    slopes = [mean_square(table).imag / STEP for table in batch.number_tables[1:]] if gradients else []
    if not slopes:
        return rms, np.zeros((count, 0))
    half = np.divide(0.5, rms, out=np.zeros(count), where=rms > 0.0)
    return rms, np.stack(slopes, axis=-1) * half[:, None]
