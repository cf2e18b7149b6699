"""Sizes and places of the parts of a design as drawings show them, mm: for who draws it elsewhere."""

from __future__ import annotations

from dataclasses import dataclass

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from .parts import Barrel, look_of
from .shapes import Point
from .swing_parts import Cylinder, half_body, swing_look


@dataclass(frozen=True)
class Outlines:
    """Parts of a design as it is drawn, mm.

    extent: left, bottom, right and top of what stands or moves. slider: its length and height; those of the piston
    where it is one. barrels: of the cylinders of the machine. actuator: of a slider that is driven. body: mass centre
    of the body on a crank that swings, along the crank and across it. body_side: of the square that stands for it.
    """

    extent: tuple[float, float, float, float]
    slider: tuple[float, float]
    barrels: tuple[Barrel, ...]
    actuator: Cylinder | None
    body: Point | None
    body_side: float


def outlines(mechanism: Mechanism, linkage: Linkage, swing: Swing | None) -> Outlines:
    """Return the parts of a design that turns through, or swings. Raises as `look_of` and `swing_look` do."""
    if swing is None:
        look = look_of(mechanism, linkage)
        return Outlines(look.extent, (1.5 * look.slider_size, look.block), look.barrels, None, None, 0.0)
    drawn = swing_look(mechanism, linkage, swing)
    slider = (1.5 * drawn.look.slider_size, drawn.look.block)
    return Outlines(drawn.extent, slider, drawn.look.barrels, drawn.cylinder, drawn.body, 2.0 * half_body(drawn.look))
