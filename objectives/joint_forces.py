"""Forces over the cycle: reactions at pins and guide, the moment on the guide, and shaking force and moment.

Shaking is how the moving masses act on the frame, without gravity and load; see `model.dynamics.torque`. With several
cylinders, the totals are used; see `model.signals.shaft_statistics`.
"""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CycleAverage, CyclePeak
from .kinds import FORCE, TORQUE
from .machine_needs import COUPLES, LOADED, MASSES, MOTION, PIVOT_LOADED, SHAKES, SWINGING_MASSES, Need
from .quantity import Group

_force = partial(CyclePeak, kind=FORCE, group=Group.FORCES, section="8. Dynamics", on_datasheet=True)
PEAK_PIVOT_FORCE = _force(
    name="peak_pivot_force",
    signal=Signal.PIVOT_FORCE,
    place=140,
    sentence="The greatest force in the crank's bearing in the frame within a turn.",
    advice="It determines the size of the main bearing.",
    formula="max |P|, P = A + dynamic and weight forces of the crank",
    picture="pivot force",
    needs=(PIVOT_LOADED,),
)
PEAK_CRANK_PIN_FORCE = _force(
    name="peak_crank_pin_force",
    signal=Signal.CRANK_PIN_FORCE,
    place=150,
    sentence="The greatest force in the joint of crank and rod within a turn.",
    formula="max |A|, A = B + dynamic and weight forces of the rod",
    picture="crank pin force",
    needs=(LOADED,),
)
PEAK_SLIDER_PIN_FORCE = _force(
    name="peak_slider_pin_force",
    signal=Signal.SLIDER_PIN_FORCE,
    place=160,
    sentence="The greatest force in the joint of rod and slider within a turn.",
    formula="max |B|, with B_x = m_s (acceleration - g_x) - F",
    picture="slider pin force",
    needs=(LOADED,),
)
PEAK_GUIDE_FORCE = _force(
    name="peak_guide_force",
    signal=Signal.GUIDE_FORCE,
    place=170,
    sentence="The greatest guide force on the slider, normal to the slider line, which wears the guide.",
    advice="A small transmission angle increases it.",
    formula="max |N|, N = -B_y - m_s g_y",
    picture="guide force",
    needs=(LOADED,),
)


GUIDE_MOMENT = CyclePeak(
    name="guide_moment",
    title="peak guide moment",
    kind=TORQUE,
    signal=Signal.GUIDE_MOMENT,
    place=171,
    group=Group.FORCES,
    sentence=(
        "The greatest moment of the guide force about the centre of a guide that is part of the frame, within a "
        "turn, which loads the ends of the guide."
    ),
    advice="For a guide that moves with the slider, the lever arm is constant and the guide force suffices.",
    formula="max |N (x_g - x)|, x_g = x_out + distance of the guide's centre",
    section="8. Dynamics",
    picture="guide force",
    needs=(
        LOADED,
        Need(
            lambda machine: machine.slider.guide is not None,
            "it needs the position of the guide; got none; for example, add "
            '[mechanism] slider = { mass = "0.8 kg", guide_distance = "150 mm" }',
            consequence="undefined",
        ),
    ),
)


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
    formula="max |sum over the cylinders of (-z F_y, z F_x)|, z the position of a cylinder",
    picture="shaking force",
    needs=(MOTION, MASSES, COUPLES),
)
