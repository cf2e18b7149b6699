"""Means and root mean squares over the cycle, mainly of the torque, with exact gradients.

Here the speed is constant, so the crank angle is proportional to time; with a profile see `shaft_averages`.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..dynamics.torque_with_friction import needs_friction_kernel
from ..kernel.batches import require_full_rotation
from ..machine.cylinders_and_turns import cycle_turns, has_cylinders_or_speed_profile, machines_of_turns
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from ..machine.work_absorption import may_do_work_over_a_turn
from .shaft_statistics import shaft_signal_averages
from .signal_inputs import cycle_window, signal_inputs
from .signals import Signal
from .turn_means import MeansTask, turn_means
from .two_turn_peaks import averages_of_both_turns


@dataclass(frozen=True)
class Averages:
    """Averages (3, n) of curves over the cycle, and their gradients (3, n, 3 + k) or None.

    Rows: mean over the crank angle, which is work per angle; RMS value over the crank angle, which matters for a
    flywheel; RMS value over time, which matters for heating. At constant speed the last two are the same. If friction
    locks a design, the mean is NaN and the RMS values are infinite.
    """

    values: Array
    gradients: Array | None

    @property
    def mean(self) -> Array:
        """Mean over the crank angle (n,)."""
        return np.asarray(self.values[0])

    @property
    def rms_over_angle(self) -> Array:
        """RMS value over the crank angle (n,)."""
        return np.asarray(self.values[1])

    @property
    def rms(self) -> Array:
        """RMS value over time (n,)."""
        return np.asarray(self.values[2])

    @property
    def mean_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the mean over the crank angle."""
        return None if self.gradients is None else np.asarray(self.gradients[0])

    @property
    def rms_over_angle_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the RMS value over the crank angle."""
        return None if self.gradients is None else np.asarray(self.gradients[1])

    @property
    def rms_gradients(self) -> Array | None:
        """Gradients (n, 3 + k) of the RMS value over time."""
        return None if self.gradients is None else np.asarray(self.gradients[2])


def torque_averages(mechanism: Mechanism, designs: Array, *, gradients: bool = False) -> Averages:
    """Return mean and RMS drive torque, N m, for designs (n, 3 + k), as `signal_averages` does."""
    return signal_averages(mechanism, Signal.TORQUE, designs, gradients=gradients)


def signal_averages(mechanism: Mechanism, kind: Signal, designs: Array, *, gradients: bool = False) -> Averages:
    """Return mean and RMS values of a signal for fully rotating designs (n, 3 + k): crank, rod, offset, m.

    The k additional columns are the values of the machine's variables. The torque keeps its sign; any other signal
    counts by its magnitude. The mean torque is exactly zero for a machine that absorbs no work over a turn.
    `shaft_statistics` describes how several cylinders and a speed profile are included.
    """
    averages = _batch_averages(mechanism, designs, kind, gradients)
    return Averages(averages.values.copy(), None if averages.gradients is None else averages.gradients.copy())


@memoise_by_batch
def _batch_averages(mechanism: Mechanism, designs: Array, kind: Signal, gradients: bool) -> Averages:
    """Return memoised averages: one batch is evaluated for mean and RMS torque, power, energy and more."""
    designs = require_full_rotation(designs)
    if has_cylinders_or_speed_profile(mechanism):
        return Averages(*shaft_signal_averages(mechanism, kind, designs, gradients=gradients))
    if kind.needs_forces and cycle_turns(mechanism) > 1:
        first, second = (
            signal_averages(half, kind, designs, gradients=gradients) for half in machines_of_turns(mechanism)
        )
        return Averages(*averages_of_both_turns(first, second))
    raw, loads = signal_inputs(mechanism, kind)
    rubbing = kind.needs_forces and needs_friction_kernel(mechanism)
    jumps = rubbing or (kind.needs_forces and any(load.has_steps for load in mechanism.with_largest_variables.loads))
    task = MeansTask(int(kind), loads, cycle_window(mechanism, kind), rubbing, jumps)
    means = turn_means(task, raw, mechanism, designs, squares=True, gradients=gradients)
    mean, rms = means.mean[:, 0], np.sqrt(means.square[:, 0])
    locks = np.isinf(mean)
    mean[locks], rms[locks] = np.nan, np.inf
    slopes = None
    if gradients:
        by_mean, by_rms = means.mean_slope[:, 0], means.square_slope[:, 0]
        by_rms = np.divide(by_rms, rms[:, None], out=np.zeros_like(by_rms), where=rms[:, None] > 0.0)
        slopes = np.stack([by_mean, by_rms, by_rms])
    if kind is Signal.TORQUE and not may_do_work_over_a_turn(
        mechanism
    ):  # exact, because cancelling terms leave no rounding error
        mean[:] = 0.0
        if slopes is not None:
            slopes[0] = 0.0
    return Averages(np.stack([mean, rms, rms]), slopes)
