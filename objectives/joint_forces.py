"""Joint forces: the greatest reactions at crank pivot, crank pin, slider pin and guide over the cycle."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import FORCE
from .machine_needs import LOADED, PIVOT_LOADED
from .quantity import Group

_force = partial(CyclePeak, kind=FORCE, group=Group.FORCES, section="8. Dynamics", on_datasheet=True)
PEAK_PIVOT_FORCE = _force(
    name="peak_pivot_force",
    signal=Signal.PIVOT_FORCE,
    place=140,
    sentence="The greatest force in the bearing of the crank in the frame within a turn.",
    advice="It sizes the main bearing.",
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
    sentence="The greatest guide force on the slider, normal to the slider line: what wears the guide.",
    advice="A small transmission angle makes it large.",
    formula="max |N|, N = -B_y - m_s g_y",
    picture="guide force",
    needs=(LOADED,),
)
