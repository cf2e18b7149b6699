"""Quantities of a curve over the cycle: its maximum, its mean, or its root mean square."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..model.machine.loads.load import require_word
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import raw_number_at_slot
from ..model.signals.averages import signal_averages
from ..model.signals.fast_torque_and_error import ANGLES, screened_maxima, supports_screening
from ..model.signals.peaks import find_peaks
from ..model.signals.shaft_statistics import mean_speed_ratio
from ..model.signals.signal_inputs import has_load_change_at_dead_centres
from ..model.signals.signals import Signal
from .quantity import Array, Pieces, Quantity, Values, display_only_field


@dataclass(frozen=True, kw_only=True)
class CyclePeak(Quantity):
    """Maximum of `signal` over the cycle, or over one stroke.

    Exact over the continuous crank angle. `screen_peaks` is faster but less exact, for ranking thousands of designs.
    """

    signal: Signal
    during: str = "cycle"

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        peaks = find_peaks(mechanism, self.signal, dimensions, during=self.during, gradients=gradients, limit=1)
        return Values(
            peaks.values[:, 0] + 0.0, None if peaks.gradients is None else peaks.gradients[:, 0]
        )  # no negative zero

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the highest local peaks; see `Quantity`."""
        peaks = find_peaks(mechanism, self.signal, dimensions, during=self.during, gradients=True)
        assert peaks.gradients is not None
        return Pieces(peaks.values, peaks.gradients, peaks.angles)


_NEAR = 0.02
"""If the torque at a dead centre is within this fraction of the maximum, the exact search decides. The peak may then be
a kink there, or lie between it and the next sample. It missed no peak among 600,000 random machines with loads that
change at a dead centre."""


def screen_quantities(
    quantities: Iterable[Quantity],
    mechanism: Mechanism,
    dimensions: Array,
    *,
    gradients: bool = False,
    certain: bool = False,
    angles: int = ANGLES,
) -> dict[str, Values]:
    """Return the quantities that vectorised screening supports, by name, for designs (n, 3 + k).

    certain: whether a torque whose peak may be at a kink is left out, as NaN.
    """
    peaks = (item for item in quantities if isinstance(item, CyclePeak))
    quick = {peak.name: peak.signal for peak in peaks if supports_screening(mechanism, peak.signal, during=peak.during)}
    if not quick:
        return {}
    kinks = certain and Signal.TORQUE in quick.values() and has_load_change_at_dead_centres(mechanism)
    screened_signals = screened_maxima(
        mechanism, tuple(quick.values()), dimensions, gradients=gradients, still=kinks, angles=angles
    )
    for signal, item in zip(quick.values(), screened_signals, strict=True):
        if kinks and signal is Signal.TORQUE:
            item.values[item.still >= item.values * (1.0 - _NEAR)] = np.nan
    return {name: Values(item.values, item.gradients) for name, item in zip(quick, screened_signals, strict=True)}


def screen_peaks(
    quantities: Sequence[CyclePeak], mechanism: Mechanism, dimensions: Array, *, gradients: bool = False
) -> tuple[Values, ...]:
    """Return several quantities for designs (n, 3 + k) by vectorised screening, exact except for peaks at a kink."""
    screened_values = screen_quantities(quantities, mechanism, dimensions, gradients=gradients)
    return tuple(
        screened_values.get(q.name) or q.evaluate(mechanism, dimensions, gradients=gradients) for q in quantities
    )


Statistic = Literal["mean", "rms"]


@dataclass(frozen=True, kw_only=True)
class CycleAverage(Quantity):
    """Mean of a signal over the crank angle, or its root mean square over time.

    Heating and shaking depend on time; the mean of a torque over the crank angle is its work per angle. The torque
    keeps its sign. times_speed: whether the average is multiplied by the mean speed over time; for the mean torque this
    gives the mean power over time.
    """

    section: str = display_only_field("10. Motor and balance")
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
