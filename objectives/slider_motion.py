"""Slider motion: maximum speed, acceleration and jerk over the cycle."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import ACCELERATION, JERK
from .kinds import SPEED as VELOCITY
from .machine_needs import MOTION, SPEED
from .quantity import Group

_peak = partial(CyclePeak, group=Group.MOTION, section="3. Kinematics")
PEAK_SLIDER_SPEED = _peak(
    name="peak_slider_speed",
    kind=VELOCITY,
    signal=Signal.SLIDER_SPEED,
    place=180,
    sentence="The highest slider speed within a turn, in either direction.",
    advice="It grows with the stroke and in proportion to the crank speed.",
    formula="max |x' omega| with x' = -r sin(theta - phi) / cos(phi)",
    picture="speed",
    needs=(SPEED,),
    on_datasheet=True,
)
PEAK_SLIDER_ACCELERATION = _peak(
    name="peak_slider_acceleration",
    kind=ACCELERATION,
    signal=Signal.SLIDER_ACCELERATION,
    place=190,
    sentence="The greatest acceleration of the slider within a turn, from which its inertia force follows.",
    advice="It grows with the square of the crank speed.",
    formula="max |x'' omega^2 + x' alpha|",
    picture="acceleration",
    needs=(MOTION,),
    on_datasheet=True,
)
PEAK_SLIDER_JERK = _peak(
    name="peak_slider_jerk",
    kind=JERK,
    signal=Signal.SLIDER_JERK,
    place=195,
    sentence="The greatest jerk of the slider within a turn: how fast its acceleration changes.",
    advice="It grows with the cube of the crank speed; high jerk makes the machine shake and its joints knock.",
    formula="max |x''' omega^3 + 3 x'' omega alpha|",
    picture="acceleration",
    needs=(SPEED,),
)
