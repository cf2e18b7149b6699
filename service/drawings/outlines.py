"""Sizes and positions of the drawn parts of a design, mm, for clients that draw it."""

from __future__ import annotations

from dataclasses import dataclass

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from .linkage_shapes import Barrel, linkage_sizes
from .shapes import Point
from .swing_parts import Cylinder, half_body_side, swing_sizes


@dataclass(frozen=True)
class Outlines:
    """Drawn parts of a design, mm.

    extent: left, bottom, right and top of all parts over their motion. slider: length and height of the slider or
    piston. barrels: barrels of the machine's cylinders. actuator: actuator of a driven slider. body: mass centre of the
    body on a swinging crank, along and across the crank. body_side: side of the square that represents it.
    """

    extent: tuple[float, float, float, float]
    slider: tuple[float, float]
    barrels: tuple[Barrel, ...]
    actuator: Cylinder | None
    body: Point | None
    body_side: float


def outlines(mechanism: Mechanism, linkage: Linkage, swing: Swing | None) -> Outlines:
    """Return the drawn parts of a design that rotates fully or swings.

    Raises the errors of `linkage_sizes` and `swing_sizes`.
    """
    if swing is None:
        look = linkage_sizes(mechanism, linkage)
        return Outlines(look.extent, (1.5 * look.slider_size, look.block), look.barrels, None, None, 0.0)
    drawn = swing_sizes(mechanism, linkage, swing)
    slider = (1.5 * drawn.look.slider_size, drawn.look.block)
    return Outlines(
        drawn.extent, slider, drawn.look.barrels, drawn.cylinder, drawn.body, 2.0 * half_body_side(drawn.look)
    )
