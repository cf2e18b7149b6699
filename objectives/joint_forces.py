"""Joint forces: the greatest reactions at crank pivot, crank pin, slider pin and guide over the cycle."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import FORCE
from .needs import LOADED, PIVOT_LOADED
from .quantity import Group

_SECTION = "8. Dynamics"

PEAK_PIVOT_FORCE = CyclePeak(
    name="peak_pivot_force",
    title="peak pivot force",
    kind=FORCE,
    signal=Signal.PIVOT_FORCE,
    place=140,
    group=Group.FORCES,
    sentence="The greatest force in the bearing of the crank in the frame within a turn.",
    advice="It sizes the main bearing.",
    formula="max |P|, P = A + dynamic and weight forces of the crank",
    section=_SECTION,
    picture="pivot force",
    needs=(PIVOT_LOADED,),
    on_sheet=True,
)
PEAK_CRANK_PIN_FORCE = CyclePeak(
    name="peak_crank_pin_force",
    title="peak crank pin force",
    kind=FORCE,
    signal=Signal.CRANK_PIN_FORCE,
    place=150,
    group=Group.FORCES,
    sentence="The greatest force in the joint of crank and rod within a turn.",
    formula="max |A|, A = B + dynamic and weight forces of the rod",
    section=_SECTION,
    picture="crank pin force",
    needs=(LOADED,),
    on_sheet=True,
)
PEAK_SLIDER_PIN_FORCE = CyclePeak(
    name="peak_slider_pin_force",
    title="peak slider pin force",
    kind=FORCE,
    signal=Signal.SLIDER_PIN_FORCE,
    place=160,
    group=Group.FORCES,
    sentence="The greatest force in the joint of rod and slider within a turn.",
    formula="max |B|, with B_x = m_s (acceleration - g_x) - F",
    section=_SECTION,
    picture="slider pin force",
    needs=(LOADED,),
    on_sheet=True,
)
PEAK_GUIDE_FORCE = CyclePeak(
    name="peak_guide_force",
    title="peak guide force",
    kind=FORCE,
    signal=Signal.GUIDE_FORCE,
    place=170,
    group=Group.FORCES,
    sentence="The greatest force of the guide on the slider, normal to the slider line: what wears the guide.",
    advice="A small transmission angle makes it large.",
    formula="max |N|, N = -B_y - m_s g_y",
    section=_SECTION,
    picture="guide force",
    needs=(LOADED,),
    on_sheet=True,
)
