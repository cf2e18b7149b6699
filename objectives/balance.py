"""Balance: how the moving masses act on the frame over the cycle, without gravity and load.

See `model.dynamics.inertia`. With several cylinders, the totals count; see `model.signals.shaft_statistics`.
"""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .cycle_peak import CyclePeak
from .kinds import FORCE, TORQUE
from .machine_needs import COUPLES, MASSES, MOTION, SHAKES, SWINGING_MASSES
from .quantity import Group

_peak = partial(CyclePeak, group=Group.FORCES, section="10. Motor and balance")
_rms = partial(CycleAverage, statistic="rms", group=Group.FORCES)

PEAK_SHAKING_FORCE = _peak(
    name="peak_shaking_force",
    kind=FORCE,
    signal=Signal.SHAKING_FORCE,
    place=240,
    sentence="The greatest force with which the moving links shake the frame within a turn.",
    advice="A counterweight on the crank reduces it, but not to zero: the slider remains unbalanced.",
    formula="max |F_s|, F_s = minus the rate of change of the momentum of all links",
    picture="shaking force",
    needs=(MOTION, MASSES, SHAKES),
)
RMS_SHAKING_FORCE = _rms(
    name="rms_shaking_force",
    title="RMS shaking force over time",
    short="RMS shaking force",
    kind=FORCE,
    signal=Signal.SHAKING_FORCE,
    place=250,
    sentence="The root mean square over time of the force with which the moving links shake the frame.",
    formula="sqrt(mean of |F_s|^2 over time)",
    picture="shaking force",
    needs=(MOTION, MASSES, SHAKES),
)
PEAK_SHAKING_MOMENT = _peak(
    name="peak_shaking_moment",
    kind=TORQUE,
    signal=Signal.SHAKING_MOMENT,
    place=260,
    sentence="The greatest moment about the crank pivot with which the moving links twist the frame within a turn.",
    formula="max |M_s|, M_s = minus the rate of change of the angular momentum of all links",
    picture="shaking moment",
    needs=(MOTION, MASSES, SWINGING_MASSES),
)
RMS_SHAKING_MOMENT = _rms(
    name="rms_shaking_moment",
    title="RMS shaking moment over time",
    short="RMS shaking moment",
    kind=TORQUE,
    signal=Signal.SHAKING_MOMENT,
    place=270,
    sentence="The root mean square over time of the moment with which the moving links twist the frame.",
    formula="sqrt(mean of M_s^2 over time)",
    picture="shaking moment",
    needs=(MOTION, MASSES, SWINGING_MASSES),
)
PEAK_ROCKING_COUPLE = _peak(
    name="peak_rocking_couple",
    kind=TORQUE,
    signal=Signal.ROCKING_COUPLE,
    place=275,
    sentence=(
        "The greatest couple about an axis across the shaft with which several cylinders rock the frame within a turn."
    ),
    advice="It depends on the positions of the cylinders along the shaft, measured from the shaft's zero.",
    formula="max |sum over the cylinders of (-z F_y, z F_x)|, z the place of a cylinder",
    picture="shaking force",
    needs=(MOTION, MASSES, COUPLES),
)
