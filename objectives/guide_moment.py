"""Guide moment: moment of the slider pin's force that tilts the slider in its guide."""

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import TORQUE
from .machine_needs import LOADED, Need
from .quantity import Group

GUIDE_MOMENT = CyclePeak(
    name="guide_moment",
    title="peak guide moment",
    kind=TORQUE,
    signal=Signal.GUIDE_MOMENT,
    place=171,
    group=Group.FORCES,
    sentence=(
        "The greatest moment of the guide force about the centre of a guide that is part of the frame, within a turn: "
        "it presses the ends of the guide."
    ),
    advice="About a guide that moves with the slider the lever is constant, and the guide force says as much.",
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
