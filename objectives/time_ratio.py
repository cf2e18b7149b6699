"""Time ratio: how much longer the slower stroke takes than the faster one, at constant crank speed."""

from ..model.kinematics.closed_forms import ClosedForm
from .closed_form import ClosedFormQuantity
from .quantity import RATIO

TIME_RATIO = ClosedFormQuantity("time_ratio", "time_ratio", "time ratio", RATIO, (ClosedForm.TIME_RATIO,))
