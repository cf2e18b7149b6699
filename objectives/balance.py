"""Balance: effect of the moving masses on the frame over the cycle, without gravity and load.

See `model.dynamics.inertia`; of several cylinders it is that of all, `model.signals.of_shaft`.
"""

from ..model.signals.signals import Signal
from .cycle_average import CycleAverage
from .cycle_peak import CyclePeak
from .kinds import FORCE, TORQUE
from .needs import COUPLES, MASSES, MOTION, SHAKES, SWINGING_MASSES
from .quantity import Group

_SECTION = "10. Motor and balance"

PEAK_SHAKING_FORCE = CyclePeak(
    name="peak_shaking_force",
    kind=FORCE,
    signal=Signal.SHAKING_FORCE,
    place=240,
    group=Group.FORCES,
    sentence="The greatest force with which the moving links shake the frame within a turn.",
    advice="A counterweight on the crank lowers it, never to zero: the slider remains.",
    formula="max |F_s|, F_s = minus the rate of change of the momentum of all links",
    section=_SECTION,
    picture="shaking force",
    needs=(MOTION, MASSES, SHAKES),
)
RMS_SHAKING_FORCE = CycleAverage(
    name="rms_shaking_force",
    title="RMS shaking force",
    kind=FORCE,
    signal=Signal.SHAKING_FORCE,
    which="rms",
    place=250,
    group=Group.FORCES,
    sentence="The root mean square, over a turn, of the force with which the moving links shake the frame.",
    formula="sqrt(mean of |F_s|^2 over the crank angle)",
    section=_SECTION,
    picture="shaking force",
    needs=(MOTION, MASSES, SHAKES),
)
PEAK_SHAKING_MOMENT = CyclePeak(
    name="peak_shaking_moment",
    kind=TORQUE,
    signal=Signal.SHAKING_MOMENT,
    place=260,
    group=Group.FORCES,
    sentence="The greatest moment about the crank pivot with which the moving links twist the frame within a turn.",
    formula="max |M_s|, M_s = minus the rate of change of the angular momentum of all links",
    section=_SECTION,
    picture="shaking moment",
    needs=(MOTION, MASSES, SWINGING_MASSES),
)
RMS_SHAKING_MOMENT = CycleAverage(
    name="rms_shaking_moment",
    title="RMS shaking moment",
    kind=TORQUE,
    signal=Signal.SHAKING_MOMENT,
    which="rms",
    place=270,
    group=Group.FORCES,
    sentence="The root mean square, over a turn, of the moment with which the moving links twist the frame.",
    formula="sqrt(mean of M_s^2 over the crank angle)",
    section=_SECTION,
    picture="shaking moment",
    needs=(MOTION, MASSES, SWINGING_MASSES),
)
PEAK_ROCKING_COUPLE = CyclePeak(
    name="peak_rocking_couple",
    title="peak rocking couple",
    kind=TORQUE,
    signal=Signal.ROCKING_COUPLE,
    place=275,
    group=Group.FORCES,
    sentence=(
        "The greatest couple about an axis across the shaft with which several cylinders rock the frame within a turn."
    ),
    advice="It comes from the places of the cylinders along the shaft, counted from the shaft's zero.",
    formula="max |sum over the cylinders of (-z F_y, z F_x)|, z the place of a cylinder",
    section=_SECTION,
    picture="shaking force",
    needs=(MOTION, MASSES, COUPLES),
)
