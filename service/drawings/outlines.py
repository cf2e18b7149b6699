"""Sizes and positions of the drawn parts of a design, mm, for clients that draw it."""

import cmath
import math
from dataclasses import dataclass

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing, movable_lever_linkage
from .lever_parts import barrel_length, centre_of_lever, lever_extent
from .linkage_shapes import Barrel, linkage_sizes
from .shapes import Point
from .swing_parts import Cylinder, half_body_side, swing_sizes


@dataclass(frozen=True)
class LeverOutlines:
    """Lever with its cylinder.

    frame_angle: direction from its pivot to the cylinder's. pin_angle: from the lever to its pin. start, end: lever
    angles of the swing, all in deg. barrel: length of the drawn barrel, mm.
    """

    frame_angle: float
    pin_angle: float
    start: float
    end: float
    barrel: float


@dataclass(frozen=True)
class Outlines:
    """Drawn parts of a design, mm.

    extent: left, bottom, right and top of all parts over their motion. slider: length and height of the slider or
    piston. barrels: barrels of the machine's cylinders. actuator: actuator of a driven slider. body: mass centre of the
    body on a swinging crank, along and across the crank. body_side: side of the square that represents it. lever: None
    for a crank with rod and slider; a lever has no slider, and the body lies along and across the line to its pin.
    """

    extent: tuple[float, float, float, float]
    slider: tuple[float, float]
    barrels: tuple[Barrel, ...]
    actuator: Cylinder | None
    body: Point | None
    body_side: float
    lever: LeverOutlines | None = None


def outlines(mechanism: Mechanism, linkage: Linkage, swing: Swing | None) -> Outlines:
    """Return the drawn parts of a design that rotates fully or swings.

    Raises the errors of `linkage_sizes`, `swing_sizes` and `movable_lever_linkage`.
    """
    if swing is None:
        look = linkage_sizes(mechanism, linkage)
        return Outlines(look.extent, (1.5 * look.slider_size, look.block), look.barrels, None, None, 0.0)
    if mechanism.lever is not None:
        return _outlines_of_lever(mechanism, linkage, swing)
    drawn = swing_sizes(mechanism, linkage, swing)
    slider = (1.5 * drawn.look.slider_size, drawn.look.block)
    return Outlines(
        drawn.extent, slider, drawn.look.barrels, drawn.cylinder, drawn.body, 2.0 * half_body_side(drawn.look)
    )


def _outlines_of_lever(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Outlines:
    placed = lever_swing(mechanism, linkage, swing)
    machine, _ = lever_machine(mechanism, movable_lever_linkage(mechanism, linkage, swing), swing)
    sizes, body = machine.sizes, None
    if machine.lever.mass:
        centre = centre_of_lever(machine) * cmath.exp(-1j * sizes.pin_angle)
        body = 1e3 * centre.real, 1e3 * centre.imag
    frame, pin, start, end = map(math.degrees, (sizes.frame_angle, sizes.pin_angle, placed.start, placed.end))
    lever = LeverOutlines(frame, pin, start, end, 1e3 * barrel_length(machine, placed))
    side = 0.08 * max(1e3 * sizes.crank, 1e3 * sizes.frame)
    return Outlines(lever_extent(machine, placed), (0.0, 0.0), (), None, body, side, lever)
