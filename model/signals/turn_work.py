"""Work on the load, and each joint's force times its sliding speed, as means over the crank angle.

Over one turn, per radian and in the sense of rotation, with phi' = d phi / d theta:

- load: -F dx/dtheta, the work done against the load on the slider;
- guide: |N| |x'|; crank pivot: |P|; crank pin: |A| (1 - phi'); slider pin: |B| |phi'|.

Friction heat is the coefficient of friction times the guide's mean, plus the radius of a friction circle times each
pin's mean. A pin's radius times its mean is force times sliding distance. The magnitudes have sharp bends where a force
is close to zero, with or without friction. Panels are therefore halved until the last Legendre coefficients of each
curve and its derivatives have died out for the mean. Forces jump with the load, so cuts that move with the design add
the jump times their own motion.
"""

from dataclasses import dataclass

from ..arrays import Array
from ..dynamics.segments import CycleWindow
from ..dynamics.torque_with_friction import needs_friction_kernel
from ..kernel.batches import require_full_rotation
from ..machine.cylinders_and_turns import cycle_turns, has_cylinders_or_speed_profile, machines_of_turns
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from .shaft_statistics import shaft_turn_work
from .signal_inputs import signal_inputs
from .signals import Signal
from .turn_means import WORK, MeansTask, turn_means

LOAD, GUIDE, CRANK_PIVOT, CRANK_PIN, SLIDER_PIN = range(5)
"""Indices of the curves."""
_WATCH = CycleWindow(0, 0.0, 1.0, True, True)  # |x'|, |phi'|: kinks at the dead centres and where the rod reverses


@dataclass(frozen=True)
class TurnWork:
    """Means over the crank angle for n designs, N m (pins: N). mean: (n, 5). gradients: (n, 5, 3 + k) or None.

    If friction locks a design, all means are infinite.
    """

    mean: Array
    gradients: Array | None


@memoise_by_batch
def turn_work(mechanism: Mechanism, designs: Array, *, gradients: bool = False) -> TurnWork:
    """Return the means for fully rotating designs (n, 3 + k): crank, rod, offset, m, then the machine's variables.

    For a two-turn cycle they cover both turns; for several cylinders they are sums.
    """
    designs = require_full_rotation(designs)
    if has_cylinders_or_speed_profile(mechanism):
        return TurnWork(*shaft_turn_work(mechanism, designs, gradients=gradients))
    if cycle_turns(mechanism) > 1:
        first, second = (turn_work(half, designs, gradients=gradients) for half in machines_of_turns(mechanism))
        slopes = None
        if first.gradients is not None and second.gradients is not None:
            slopes = 0.5 * (first.gradients + second.gradients)
        return TurnWork(0.5 * (first.mean + second.mean), slopes)
    raw, loads = signal_inputs(mechanism, Signal.CRANK_PIN_FORCE)
    task = MeansTask(WORK, loads, _WATCH, needs_friction_kernel(mechanism), gradients)
    means = turn_means(task, raw, mechanism, designs, squares=False, gradients=gradients)
    return TurnWork(means.mean, means.mean_slope if gradients else None)
