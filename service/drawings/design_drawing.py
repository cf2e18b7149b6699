"""The drawing of a design that rotates fully or swings."""

from __future__ import annotations

from typing import Any

from ...objectives.kinds import System
from ..designs.stored_designs import StoredDesign
from .linkage_drawing import CRANK_ANGLE, linkage_drawing
from .shapes import Drawing
from .swing_drawing import swing_drawing


def design_drawing(
    stored: StoredDesign, *, name: str, design: str = "", crank_angle: float | None = None, system: System = "metric"
) -> Drawing:
    """Return a design at true scale: see `linkage_drawing`, and `swing_drawing` for a swinging crank.

    crank_angle: crank angle of the drawing, rad; their default if None. system: system of units in texts.
    """
    texts: dict[str, Any] = {"name": name, "design": design, "system": system}
    if stored.part.motion is not None:
        return swing_drawing(stored.mechanism, stored.linkage, stored.part.motion, **texts, crank_angle=crank_angle)
    angle = CRANK_ANGLE if crank_angle is None else crank_angle
    return linkage_drawing(stored.mechanism, stored.linkage, **texts, crank_angle=angle)
