"""Joint forces: maximum reactions at the pins and the guide over the cycle, and the moment on the guide."""

from __future__ import annotations

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import FORCE, TORQUE
from .machine_needs import LOADED, PIVOT_LOADED, Need
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
            "it needs the position of the guide; got none; add for example "
            '[mechanism] slider = { mass = "0.8 kg", guide_distance = "150 mm" }',
            consequence="undefined",
        ),
    ),
)
