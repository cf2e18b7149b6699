"""A linkage as a drawing: in one position, its dead centres, its paths and its dimensions."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import System
from ..designs.toleranced import tolerances_of
from . import layers as on
from .dimensions import Lettering, aligned, dimension
from .linkage_shapes import Look, fixed_shapes, lengths_in_words, look_of, moving_shapes, pin_positions
from .shapes import Drawing, Line, Point, Shape
from .titles import TEXT, TRUE_SCALE, with_title

CRANK_ANGLE = math.radians(60.0)
"""Crank angle at which a linkage is drawn unless asked otherwise, rad."""


def linkage_drawing(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    name: str,
    design: str = "",
    crank_angle: float = CRANK_ANGLE,
    system: System = "metric",
) -> Drawing:
    """Return one fully rotating linkage at true scale, mm: crank pivot at (0, 0), slider line at y = offset.

    Pivots, paths, dead centres and dimensions are exact. Links with a section in the machine have their true width;
    other widths, pins and slider are schematic, in proportion. name: name of the run. design: its design, "design 3",
    for the title. crank_angle: crank angle of the drawing, rad. system: system of units in texts. Raises
    `AssemblyError` for a linkage that does not rotate fully.
    """
    look = look_of(mechanism, linkage)
    size = look.size
    pin, slider = pin_positions(linkage, crank_angle)
    shapes: list[Shape] = [
        *fixed_shapes(linkage, look, bearing_below=pin[1] >= 0.0),
        *moving_shapes(pin, slider, look),
        Line(on.SKELETON, (0.0, 0.0), pin),
        Line(on.SKELETON, pin, slider),
        *_dimensions(pin, slider, look, tolerances_of(mechanism, linkage), Lettering(TEXT * size, system)),
    ]
    title = f"{name}, {design}" if design else name
    layers = on.GAS_LAYERS if look.barrels else on.LAYERS
    return with_title(layers, shapes, look.extent, size, title, _notes(linkage, crank_angle, look, system))


def _dimensions(
    pin: Point, slider: Point, look: Look, tolerances: Mapping[str, float], letters: Lettering
) -> list[Shape]:
    """Return the dimension lines: crank and rod beside the links, offset at the left, stroke outside."""
    e, left, height = look.offset, look.extent[0], letters.height
    side = -1.0 if pin[1] >= 0.0 else 1.0  # away from crank and rod
    rod = (slider[0] - pin[0], slider[1] - pin[1])
    # Crank and rod on the outside of the bend between them.
    bend = -1.0 if pin[0] * rod[1] - pin[1] * rod[0] > 0.0 else 1.0
    y = side * (max(look.crank + 0.5 * look.crank_width, side * e + 0.72 * look.block) + 3.0 * height)
    off = {name: tolerances.get(name, 0.0) for name in ("crank", "rod", "offset")}
    shapes: list[Shape] = [
        aligned("crank", (0.0, 0.0), pin, bend * (0.5 * look.crank_width + 2.2 * height), letters, off["crank"]),
        aligned("rod", pin, slider, bend * (0.5 * look.rod_width + 2.2 * height), letters, off["rod"]),
        dimension("stroke", look.inner, look.outer, (look.inner[0], y), 0.0, look=letters),
    ]
    if e:
        x = left - 3.0 * height
        shapes.append(
            dimension("offset", (left, 0.0), (left, e), (x, 0.0), 90.0, look=letters, tolerance=off["offset"])
        )
    return shapes


def _notes(linkage: Linkage, angle: float, look: Look, system: System) -> tuple[str, ...]:
    inner, outer = (f"{math.degrees(item):.6g}" for item in map(float, linkage.dead_centre_angles))
    widths = "Link widths are to scale; slider and pins are schematic."
    return (
        f"{lengths_in_words(linkage, system, stroke=True)}.",
        f"Drawn at crank angle {math.degrees(angle):.6g} deg; "
        f"dead centres at {inner} deg (inner) and {outer} deg (outer).",
        f"{TRUE_SCALE[system]}; pivots are exact.",
        widths if look.has_sections else "Link widths, slider and pins are schematic.",
        *(["Bore and clearance of the cylinder are those of the job."] if look.barrels else []),
    )
