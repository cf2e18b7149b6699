"""Quantities that are a mean or a root mean square over the cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..model.machine.loads.load import require_word
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import raw_number_at_slot
from ..model.signals.averages import signal_averages
from ..model.signals.shaft_statistics import mean_speed_ratio
from ..model.signals.signals import Signal
from .quantity import Array, Quantity, Values, display_fact

Statistic = Literal["mean", "rms"]


@dataclass(frozen=True, kw_only=True)
class CycleAverage(Quantity):
    """Mean of a signal over the crank angle, or its root mean square over time.

    Heating and shaking depend on time; the mean of a torque over the crank angle is its work per angle. The torque
    keeps its sign. times_speed: whether the average is multiplied by the mean speed over time; for the mean torque this
    gives the mean power over time.
    """

    section: str = display_fact("10. Motor and balance")
    signal: Signal
    statistic: Statistic
    times_speed: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        require_word("statistic", self.statistic, Statistic)

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        averages = signal_averages(mechanism, self.signal, dimensions, gradients=gradients)
        values, slopes = (
            (averages.mean, averages.mean_gradients)
            if self.statistic == "mean"
            else (averages.rms, averages.rms_gradients)
        )
        if self.times_speed:
            share = mean_speed_ratio(mechanism)
            if not mechanism.varying:
                speed = mechanism.speed * share
                return Values(speed * values, None if slopes is None else speed * slopes)
            speeds, rates = raw_number_at_slot(mechanism, Raw.SPEED, dimensions, otherwise=mechanism.speed)
            speeds, rates = share * speeds, share * rates
            if slopes is not None:
                slopes = speeds[:, None] * slopes + rates * values[:, None]
            values = speeds * values
        return Values(values, slopes)
