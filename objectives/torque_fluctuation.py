"""Torque fluctuation: root mean square deviation of the drive torque from its mean, over the crank angle."""

from __future__ import annotations

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.signals.averages import torque_averages
from .kinds import TORQUE
from .machine_needs import DRIVEN
from .quantity import Array, Group, Quantity, Values

_ROUNDING = 4e-15


class TorqueFluctuation(Quantity):
    """sqrt(rms^2 - mean^2) of the drive torque, both over the crank angle.

    Infinite where friction locks the linkage.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        averages = torque_averages(mechanism, dimensions, gradients=gradients)
        locks = np.isinf(averages.rms_over_angle)
        mean, rms = np.where(locks, 0.0, averages.mean), np.where(locks, 1.0, averages.rms_over_angle)
        difference = rms - np.abs(mean)
        difference = np.where(difference > _ROUNDING * rms, difference, 0.0)  # for a constant torque
        values = np.sqrt(difference * (rms + np.abs(mean)))
        slopes = None
        if averages.mean_gradients is not None and averages.rms_over_angle_gradients is not None:
            per = np.where(values > 0.0, 1.0 / np.where(values > 0.0, values, 1.0), 0.0)
            slopes = (rms * per)[:, None] * averages.rms_over_angle_gradients
            slopes = slopes - (mean * per)[:, None] * averages.mean_gradients
            slopes = np.where(locks[:, None], 0.0, slopes)
        return Values(np.where(locks, np.inf, values), slopes)


TORQUE_FLUCTUATION = TorqueFluctuation(
    name="torque_fluctuation",
    title="torque fluctuation over the crank angle",
    short="torque fluctuation",
    kind=TORQUE,
    place=85,
    group=Group.DRIVE,
    sentence="The root mean square over the crank angle of the drive torque's deviation from its mean.",
    advice="A flywheel evens it out. At constant speed it equals the RMS torque if a turn takes no work.",
    formula="sqrt(mean of (T - mean of T)^2 over the crank angle)",
    section="10. Motor and balance",
    picture="torque",
    needs=(DRIVEN,),
    plain=True,
)
