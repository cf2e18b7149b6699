"""Number of sampled angles a turn that the peak search needs: the origin of `model.signals.peaks.ANGLES`."""

from __future__ import annotations

import numpy as np

from slidercrank.model.signals.fast_torque_and_error import screened_maxima
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal

from .machines import MECHANISM, random_designs
from .report import Row

_ANGLES = (16, 24, 32, 48, 64, 96)


def accuracy(count: int = 1_000) -> list[Row]:
    """Return the greatest relative error of peak torque by number of angles; reference: 4,096 angles, refined."""
    designs = random_designs(count, seed=3)
    exact = find_peaks(MECHANISM, Signal.TORQUE, designs, limit=1, angles=4096).values[:, 0]
    rows = []
    for angles in _ANGLES:
        peaks = find_peaks(MECHANISM, Signal.TORQUE, designs, limit=1, angles=angles).values[:, 0]
        rows.append(Row(f"peak search, {angles} angles", [float(np.max(np.abs(peaks / exact - 1.0)))]))
        quick = screened_maxima(MECHANISM, (Signal.TORQUE,), designs, angles=angles)[0].values
        rows.append(Row(f"screening, {angles} angles", [float(np.max(np.abs(quick / exact - 1.0)))]))
    return rows
