"""Proportions of the linkage: stroke, rod to offset, rod to crank, footprint."""

from ..model.kinematics.closed_forms import ClosedForm
from .closed_form import ClosedFormQuantity
from .quantity import MILLIMETRE, RATIO, SQUARE_METRE

STROKE = ClosedFormQuantity("stroke", "stroke_mm", "stroke", MILLIMETRE, (ClosedForm.STROKE,))
ROD_TO_OFFSET = ClosedFormQuantity(
    "rod_to_offset", "rod_to_offset", "rod to offset", RATIO, (ClosedForm.ROD_TO_OFFSET,)
)
ROD_TO_CRANK = ClosedFormQuantity("rod_to_crank", "rod_to_crank", "rod to crank", RATIO, (ClosedForm.ROD_TO_CRANK,))
FOOTPRINT = ClosedFormQuantity(
    "footprint",
    "footprint_m2",
    "footprint",
    SQUARE_METRE,
    (ClosedForm.FOOTPRINT_OF_CRANK, ClosedForm.FOOTPRINT_OF_OFFSET),
)
