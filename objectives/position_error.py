"""Position error: slider displacement due to tolerances, maximum over the cycle or over part of the stroke."""

from functools import partial

from ..model.signals.signals import Signal
from .cycle_peak import CyclePeak
from .kinds import LENGTH
from .machine_needs import TOLERANCES
from .quantity import Group

_SOURCE = "R. Chetana and T. V. Vineeth Kumar, Analysis of Position Error in Offset Slider Crank Mechanism, Eq. (3)"

_error = partial(
    CyclePeak,
    kind=LENGTH,
    group=Group.ACCURACY,
    section="12. Position error",
    source=_SOURCE,
    picture="position error",
    needs=(TOLERANCES,),
    about_tolerances=True,
)
POSITION_ERROR = _error(
    name="position_error",
    title="position error, worst case",
    short="position error",
    signal=Signal.POSITION_ERROR,
    place=40,
    sentence=(
        "The greatest error of the slider position over the cycle, with crank, rod, offset and crank angle at their "
        "tolerances in the worst combination."
    ),
    advice="It depends on lengths and tolerances, not on masses, loads or speed; without tolerances it is undefined.",
    formula="max over theta of the sum of |dx/di| T_i, for i = crank, rod, offset, crank angle",
    example="0.3 mm",
    offered=("objective",),
    on_datasheet=True,
)
POSITION_ERROR_RSS = _error(
    name="position_error_rss",
    title="position error, root sum square",
    signal=Signal.POSITION_ERROR_RSS,
    place=90,
    sentence=("The position error to expect if the deviations are independent: the root of the sum of their squares."),
    advice="With the four tolerances alone it is at least half of the worst case, and never exceeds it.",
    formula="max over theta of sqrt(sum of (dx/di T_i)^2)",
    example="0.2 mm",
)
