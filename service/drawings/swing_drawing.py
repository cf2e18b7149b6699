"""Drawing of a swinging linkage: within its swing, at both ends, with its drive and dimensions."""

from __future__ import annotations

import math

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...objectives.kinds import System, metric_unit_in
from ..designs.toleranced import tolerances_of
from . import layers as on
from .dimensions import Lettering, aligned, dimension
from .linkage_shapes import lengths_in_words, pin_positions
from .shapes import Anchor, Arc, Drawing, Label, Line, Shape
from .swing_parts import SwingLook, half_body, swing_look, swing_moving, swing_scenery
from .titles import TEXT, TRUE_SCALE, with_title


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
    within the swing up to full revolutions; half-way if None. name, design: as for `linkage_drawing`. Raises
    `InputError` for a crank angle outside, and the errors of `require_swing`.
    """
    drawn = swing_look(mechanism, linkage, swing)
    angle = _angle_in_swing(drawn.swing, crank_angle)
    pin, slider = pin_positions(drawn.linkage, angle)
    letters = Lettering(TEXT * drawn.look.size, system)
    shapes: list[Shape] = [
        *swing_scenery(drawn),
        *swing_moving(drawn, angle),
        Line(on.SKELETON, (0.0, 0.0), pin),
        Line(on.SKELETON, pin, slider),
        *_dimensions(drawn, angle, mechanism, letters),
    ]
    notes = _notes(drawn, angle, system)
    return with_title(
        on.SWING_LAYERS, shapes, drawn.extent, drawn.look.size, f"{name}, {design}" if design else name, notes
    )


def _angle_in_swing(swing: Swing, angle: float | None) -> float:
    """Return a crank angle shifted by full revolutions into a swing."""
    if angle is None:
        return 0.5 * (swing.start + swing.end)
    angles = [at for near in (0.0, 1e-9, -1e-9) for at in swing.occurrences(angle + near)]
    if not angles:
        start, end, requested = (math.degrees(at) for at in (swing.start, swing.end, angle))
        raise InputError(
            f"the crank angle of a drawing must be within the swing, from {start:.6g} to {end:.6g} deg; got "
            f"{requested:.6g} deg; give one in between, or none for the middle"
        )
    return angles[0]


def _dimensions(drawn: SwingLook, angle: float, mechanism: Mechanism, letters: Lettering) -> list[Shape]:
    """Return the dimension lines: crank and rod beside the links, offset at the left, travel outside, angle within."""
    look, swing, height = drawn.look, drawn.swing, letters.height
    (left, low, _, high), (pin, slider) = drawn.extent, pin_positions(drawn.linkage, angle)
    tolerances = tolerances_of(mechanism, drawn.linkage)
    rod = (slider[0] - pin[0], slider[1] - pin[1])
    bend = -1.0 if pin[0] * rod[1] - pin[1] * rod[0] > 0.0 else 1.0  # on the outside, as of a linkage that turns
    y = low - 3.0 * height if drawn.bearing_below else high + 3.0 * height
    half_width = 0.5 * look.crank_width
    if drawn.body is not None:
        half_width = max(half_width, bend * drawn.body[1] + half_body(look))
    shapes: list[Shape] = [
        aligned("crank", (0.0, 0.0), pin, bend * (half_width + 2.2 * height), letters, tolerances.get("crank", 0.0)),
        aligned("rod", pin, slider, bend * (0.5 * look.rod_width + 2.2 * height), letters, tolerances.get("rod", 0.0)),
        dimension("travel", look.inner, look.outer, (look.inner[0], y), 0.0, look=letters),
    ]
    if look.offset:
        x, tolerance = left - 3.0 * height, tolerances.get("offset", 0.0)
        ends = ((left, 0.0), (left, look.offset))
        shapes.append(dimension("offset", *ends, (x, 0.0), 90.0, look=letters, tolerance=tolerance))
    first, last = sorted(math.degrees(at) for at in (swing.start, swing.end))
    arc = Arc(on.DIMENSIONS, (0.0, 0.0), 0.45 * look.crank, first, last)
    share = 0.25 if bend > 0.0 else 0.75  # on the side of the crank that its own dimension is not on
    place, arc_end = arc.point_at(first + share * (last - first)), arc.point_at(math.degrees(angle))
    anchor: Anchor = "start" if place[0] > arc_end[0] else "end"  # the words run away from the crank
    text = Label(on.DIMENSIONS, f"{last - first:.6g} deg", place, height, anchor=anchor)
    return [*shapes, arc, text]


def _notes(drawn: SwingLook, angle: float, system: System) -> tuple[str, ...]:
    look, swing = drawn.look, drawn.swing
    unit, factor = metric_unit_in("mm", system)
    start, end, drawn_angle = (f"{math.degrees(at):.6g}" for at in (swing.start, swing.end, angle))
    widths = "Link widths are to scale; slider and pins are schematic."
    driven = "The crank is driven." if drawn.cylinder is None else "It is driven; the cylinder is schematic."
    return (
        f"{lengths_in_words(drawn.linkage, system)}.",
        f"Swings from {start} to {end} deg; drawn at {drawn_angle} deg, both ends dashed.",
        f"The slider goes from {factor * look.inner[0]:.7g} to {factor * look.outer[0]:.7g} {unit}. {driven}",
        f"{TRUE_SCALE[system]}; pivots are exact.",
        widths if look.has_sections else "Link widths, slider and pins are schematic.",
        *(() if drawn.body is None else ("The schematic square on the crank is centred on its mass centre.",)),
    )
