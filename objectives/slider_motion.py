"""Slider motion: greatest speed and acceleration over the cycle."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import ACCELERATION
from .kinds import SPEED as VELOCITY
from .needs import MOTION, SPEED
from .quantity import Group

_SECTION = "3. Kinematics"

PEAK_SLIDER_SPEED = CyclePeak(
    name="peak_slider_speed",
    title="peak slider speed",
    kind=VELOCITY,
    signal=Signal.SLIDER_SPEED,
    place=180,
    group=Group.MOTION,
    sentence="The highest speed that the slider reaches within a turn, whichever way it goes.",
    advice="It grows with the stroke and in proportion to the crank speed.",
    formula="max |x' omega| with x' = -r sin(theta - phi) / cos(phi)",
    section=_SECTION,
    picture="speed",
    needs=(SPEED,),
    on_sheet=True,
)
PEAK_SLIDER_ACCELERATION = CyclePeak(
    name="peak_slider_acceleration",
    title="peak slider acceleration",
    kind=ACCELERATION,
    signal=Signal.SLIDER_ACCELERATION,
    place=190,
    group=Group.MOTION,
    sentence="The greatest acceleration of the slider within a turn, from which its inertia force follows.",
    advice="It grows with the square of the crank speed.",
    formula="max |x'' omega^2 + x' alpha|",
    section=_SECTION,
    picture="acceleration",
    needs=(MOTION,),
    on_sheet=True,
)
