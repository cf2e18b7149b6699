"""Design at true scale, fully rotating or swinging: one position, with end positions, paths and dimensions."""

import math
from collections.abc import Mapping
from typing import Any

from ...model.errors import InputError
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...objectives.kinds import System, metric_unit_in
from ..designs.length_with_tolerance import tolerances_of
from ..designs.stored_designs import StoredDesign
from . import layers as on
from .dimensions import Lettering, aligned_dimension, dimension_along_angle
from .lever_drawing import lever_drawing
from .linkage_shapes import (
    LinkageSizes,
    fixed_shapes,
    lengths_in_words,
    linkage_sizes,
    moving_shapes,
    pin_positions,
    widths_in_words,
)
from .shapes import Anchor, Arc, Dimension, Drawing, Label, Line, Point, Shape
from .swing_parts import SwingSizes, fixed_swing_shapes, half_body_side, moving_swing_shapes, swing_sizes
from .titles import TEXT, TRUE_SCALE, with_title

CRANK_ANGLE = math.radians(60.0)
"""Default crank angle of a drawing, rad."""


def design_drawing(
    stored: StoredDesign, *, name: str, design: str = "", crank_angle: float | None = None, system: System = "metric"
) -> Drawing:
    """Return a design at true scale; see `linkage_drawing`, `swing_drawing` and `lever_drawing`.

    crank_angle: crank angle of the drawing, rad; None for the default. system: unit system of texts.
    """
    texts: dict[str, Any] = {"name": name, "design": design, "system": system}
    if stored.part.motion is not None:
        draw = swing_drawing if stored.mechanism.lever is None else lever_drawing
        return draw(stored.mechanism, stored.linkage, stored.part.motion, **texts, crank_angle=crank_angle)
    angle = CRANK_ANGLE if crank_angle is None else crank_angle
    return linkage_drawing(stored.mechanism, stored.linkage, **texts, crank_angle=angle)


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
    other widths, pins and slider are schematic, in proportion. name: name of the run. design: design label in the
    title, such as "design 3". crank_angle: crank angle of the drawing, rad. system: unit system of texts. Raises
    `AssemblyError` for a linkage that does not rotate fully.
    """
    look = linkage_sizes(mechanism, linkage)
    size, tolerances = look.longer_side, tolerances_of(mechanism, linkage)
    pin, slider = pin_positions(linkage, crank_angle)
    shapes: list[Shape] = [
        *fixed_shapes(linkage, look, bearing_below=pin[1] >= 0.0),
        *moving_shapes(pin, slider, look),
        *_stroke_dimensions(pin, slider, look, Lettering(TEXT * size, system), tolerances),
    ]
    title = f"{name}, {design}" if design else name
    layers = on.GAS_LAYERS if look.barrels else on.LAYERS
    return with_title(
        layers, shapes, look.extent, size, title, _turn_notes(linkage, crank_angle, look, tolerances, system)
    )


def swing_drawing(
    mechanism: Mechanism,
    linkage: Linkage,
    swing: Swing,
    *,
    name: str,
    design: str = "",
    crank_angle: float | None = None,
    system: System = "metric",
) -> Drawing:
    """Return one swinging linkage at true scale, mm: crank pivot at (0, 0), slider line at y = offset.

    Pivots, ends of the swing, paths of the pins and dimensions are exact. crank_angle: crank angle of the drawing,
    within the swing, to which full revolutions may be added; None for half-way. name, design: as for `linkage_drawing`.
    Raises `InputError` for a crank angle outside the swing, and the errors of `require_swing`.
    """
    drawn = swing_sizes(mechanism, linkage, swing)
    angle = _angle_in_swing(drawn.swing, crank_angle)
    pin, slider = pin_positions(drawn.linkage, angle)
    letters, tolerances = Lettering(TEXT * drawn.look.longer_side, system), tolerances_of(mechanism, drawn.linkage)
    shapes: list[Shape] = [
        *fixed_swing_shapes(drawn),
        *moving_swing_shapes(drawn, angle),
        *_swing_dimensions(drawn, angle, pin, slider, letters, tolerances),
    ]
    notes = _swing_notes(drawn, angle, tolerances, system)
    return with_title(
        on.SWING_LAYERS, shapes, drawn.extent, drawn.look.longer_side, f"{name}, {design}" if design else name, notes
    )


def _angle_in_swing(swing: Swing, angle: float | None) -> float:
    """Return a crank angle shifted by full revolutions into a swing."""
    if angle is None:
        return 0.5 * (swing.start + swing.end)
    angles = [at for near in (0.0, 1e-9, -1e-9) for at in swing.equal_angles_within_swing(angle + near)]
    if not angles:
        start, end, requested = (math.degrees(at) for at in (swing.start, swing.end, angle))
        raise InputError(
            f"the crank angle of a drawing must be within the swing, from {start:.6g} to {end:.6g} deg; got "
            f"{requested:.6g} deg; give one in between, or none for the middle"
        )
    return angles[0]


def _stroke_dimensions(
    pin: Point, slider: Point, look: LinkageSizes, letters: Lettering, tolerances: Mapping[str, float]
) -> list[Shape]:
    """Return the skeleton and the dimension lines of a rotating linkage, with the stroke dimension outside."""
    side = -1.0 if pin[1] >= 0.0 else 1.0  # away from crank and rod
    outside = max(look.crank + 0.5 * look.crank_width, side * look.offset + 0.72 * look.block)
    through = (look.inner[0], side * (outside + 3.0 * letters.height))
    stroke = dimension_along_angle("stroke", look.inner, look.outer, through, 0.0, look=letters)
    return _skeleton_and_dimensions(pin, slider, look, stroke, letters, tolerances, left=look.extent[0])


def _swing_dimensions(
    drawn: SwingSizes, angle: float, pin: Point, slider: Point, letters: Lettering, tolerances: Mapping[str, float]
) -> list[Shape]:
    """Return the skeleton and the dimension lines of a swing, with travel outside and angle inside."""
    look, swing, height, bend = drawn.look, drawn.swing, letters.height, _side_outside_bend(pin, slider)
    left, low, _, high = drawn.extent
    through = (look.inner[0], low - 3.0 * height if drawn.is_bearing_below else high + 3.0 * height)
    travel = dimension_along_angle("travel", look.inner, look.outer, through, 0.0, look=letters)
    body = -math.inf if drawn.body is None else bend * drawn.body[1] + half_body_side(look)
    first, last = sorted(math.degrees(at) for at in (swing.start, swing.end))
    arc = Arc(on.DIMENSIONS, (0.0, 0.0), 0.45 * look.crank, first, last)
    share = 0.25 if bend > 0.0 else 0.75  # on the side opposite the crank's own dimension
    place, arc_end = arc.point_at(first + share * (last - first)), arc.point_at(math.degrees(angle))
    anchor: Anchor = "start" if place[0] > arc_end[0] else "end"  # the text runs away from the crank
    text = Label(on.DIMENSIONS, f"{last - first:.6g} deg", place, height, anchor=anchor)
    return [*_skeleton_and_dimensions(pin, slider, look, travel, letters, tolerances, left=left, body=body), arc, text]


def _skeleton_and_dimensions(
    pin: Point,
    slider: Point,
    look: LinkageSizes,
    travel: Dimension,
    letters: Lettering,
    tolerances: Mapping[str, float],
    *,
    left: float,
    body: float = -math.inf,
) -> list[Shape]:
    """Return the skeleton, the dimension lines for crank and rod, the travel, and the offset at the left.

    left: left end of the drawing. body: outer edge of a body on the crank, on the side of the crank's dimension.
    """
    height, bend = letters.height, _side_outside_bend(pin, slider)
    crank_side, rod_side = max(0.5 * look.crank_width, body) + 2.2 * height, 0.5 * look.rod_width + 2.2 * height
    crank, rod, offset = (tolerances.get(name, 0.0) for name in DIMENSIONS)
    shapes: list[Shape] = [
        Line(on.SKELETON, (0.0, 0.0), pin),
        Line(on.SKELETON, pin, slider),
        aligned_dimension("crank", (0.0, 0.0), pin, bend * crank_side, letters, crank),
        aligned_dimension("rod", pin, slider, bend * rod_side, letters, rod),
        travel,
    ]
    if look.offset:
        ends, through = ((left, 0.0), (left, look.offset)), (left - 3.0 * height, 0.0)
        shapes.append(dimension_along_angle("offset", *ends, through, 90.0, look=letters, tolerance=offset))
    return shapes


def _side_outside_bend(pin: Point, slider: Point) -> float:
    """Return the side of the crank and the rod, 1 for the left, that lies outside the bend between them."""
    return -1.0 if pin[0] * (slider[1] - pin[1]) - pin[1] * (slider[0] - pin[0]) > 0.0 else 1.0


def _turn_notes(
    linkage: Linkage, angle: float, look: LinkageSizes, tolerances: Mapping[str, float], system: System
) -> tuple[str, ...]:
    inner, outer = (f"{math.degrees(item):.6g}" for item in map(float, linkage.dead_centre_angles))
    return (
        f"{lengths_in_words(linkage, tolerances, system, stroke=True)}.",
        f"Drawn at crank angle {math.degrees(angle):.6g} deg; "
        f"dead centres at {inner} deg (inner) and {outer} deg (outer).",
        f"{TRUE_SCALE[system]}; pivots are exact.",
        widths_in_words(look),
        *(["Bore and clearance of the cylinder are those of the job."] if look.barrels else []),
    )


def _swing_notes(drawn: SwingSizes, angle: float, tolerances: Mapping[str, float], system: System) -> tuple[str, ...]:
    look, swing = drawn.look, drawn.swing
    unit, factor = metric_unit_in("mm", system)
    start, end, drawn_angle = (f"{math.degrees(at):.6g}" for at in (swing.start, swing.end, angle))
    driven = "The crank is driven." if drawn.cylinder is None else "It is driven; the cylinder is schematic."
    return (
        f"{lengths_in_words(drawn.linkage, tolerances, system)}.",
        f"Swings from {start} to {end} deg; drawn at {drawn_angle} deg, both ends dashed.",
        f"The slider goes from {factor * look.inner[0]:.5g} to {factor * look.outer[0]:.5g} {unit}. {driven}",
        f"{TRUE_SCALE[system]}; pivots are exact.",
        widths_in_words(look),
        *(() if drawn.body is None else ("The schematic square on the crank is centred on its mass centre.",)),
    )
