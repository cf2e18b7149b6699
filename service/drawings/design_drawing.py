"""The drawing of a design, which turns through or swings."""

from __future__ import annotations

from ..designs.stored_designs import StoredDesign
from .linkage_drawing import CRANK_ANGLE, linkage_drawing
from .shapes import Drawing
from .swing_drawing import swing_drawing


def design_drawing(of: StoredDesign, *, name: str, design: str = "", crank_angle: float | None = None) -> Drawing:
    """Return a design at true scale: see `linkage_drawing`, and `swing_drawing` where its crank swings.

    crank_angle: where it is drawn, rad; where these draw it if None.
    """
    if of.part.motion is not None:
        swing = of.part.motion
        return swing_drawing(of.mechanism, of.linkage, swing, name=name, design=design, crank_angle=crank_angle)
    angle = CRANK_ANGLE if crank_angle is None else crank_angle
    return linkage_drawing(of.mechanism, of.linkage, name=name, design=design, crank_angle=angle)
