"""All quantities by name."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from ..model.errors import InputError
from .average_torque import MEAN_TORQUE, RMS_TORQUE
from .balance import PEAK_SHAKING_FORCE, PEAK_SHAKING_MOMENT, RMS_SHAKING_FORCE, RMS_SHAKING_MOMENT
from .joint_forces import PEAK_CRANK_PIN_FORCE, PEAK_GUIDE_FORCE, PEAK_PIVOT_FORCE, PEAK_SLIDER_PIN_FORCE
from .motor import MEAN_POWER, PEAK_POWER, PEAK_REFLECTED_INERTIA
from .peak_torque import PEAK_TORQUE, PEAK_TORQUE_INWARD, PEAK_TORQUE_OUTWARD
from .position_error import POSITION_ERROR, POSITION_ERROR_RSS
from .proportions import FOOTPRINT, ROD_TO_CRANK, ROD_TO_OFFSET, STROKE
from .quantity import Quantity
from .self_locking import SELF_LOCKING_MARGIN
from .slider_motion import PEAK_SLIDER_ACCELERATION, PEAK_SLIDER_SPEED
from .time_ratio import TIME_RATIO
from .transmission_angle import TRANSMISSION_ANGLE

_ALL: tuple[Quantity, ...] = (
    TIME_RATIO,
    PEAK_TORQUE,
    TRANSMISSION_ANGLE,
    POSITION_ERROR,
    PEAK_TORQUE_OUTWARD,
    PEAK_TORQUE_INWARD,
    RMS_TORQUE,
    MEAN_TORQUE,
    POSITION_ERROR_RSS,
    STROKE,
    ROD_TO_OFFSET,
    ROD_TO_CRANK,
    FOOTPRINT,
    PEAK_PIVOT_FORCE,
    PEAK_CRANK_PIN_FORCE,
    PEAK_SLIDER_PIN_FORCE,
    PEAK_GUIDE_FORCE,
    PEAK_SLIDER_SPEED,
    PEAK_SLIDER_ACCELERATION,
    SELF_LOCKING_MARGIN,
    PEAK_POWER,
    MEAN_POWER,
    PEAK_REFLECTED_INERTIA,
    PEAK_SHAKING_FORCE,
    RMS_SHAKING_FORCE,
    PEAK_SHAKING_MOMENT,
    RMS_SHAKING_MOMENT,
)
QUANTITIES: dict[str, Quantity] = {quantity.name: quantity for quantity in _ALL}


def quantity(name: str, own: Iterable[Quantity] = ()) -> Quantity:
    """Return the quantity of a name; raise `InputError` with the nearest names otherwise.

    own: quantities that a problem has beside those that every one has. Where there is a problem, ask it: it has its own
    (`Problem.quantity`).
    """
    known = QUANTITIES | {of.name: of for of in own}
    if name not in known:
        near = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {near[0]}?" if near else f"choose from {', '.join(known)}"
        raise InputError(f"no quantity is called {name!r}; {hint}")
    return known[name]
