"""A lever and its turning cylinder at true scale, with dimensions, both ends of the swing and the pin's path."""

import math

from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.cylinder_and_pin_forces import LeverMachine, LeverSwing
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing, movable_lever_linkage
from ...objectives.kinds import System, metric_unit_in
from ..designs.length_with_tolerance import tolerances_of
from . import layers as on
from .dimensions import Lettering, aligned_dimension
from .lever_parts import lever_extent, lever_shapes, usual_angle
from .shapes import Drawing, Line, Point, Shape
from .titles import TEXT, TRUE_SCALE, with_title


def lever_drawing(
    mechanism: Mechanism,
    linkage: Linkage,
    swing: Swing,
    *,
    name: str,
    design: str = "",
    crank_angle: float | None = None,
    system: System = "metric",
) -> Drawing:
    """Return one lever with its cylinder at true scale, mm: the lever's pivot at (0, 0).

    Pivots, pins, both ends of the swing and dimensions are exact. crank_angle: lever angle of the drawing, rad, within
    the swing, or any in a full turn; `usual_angle` if None. name, design: as for `design_drawing.linkage_drawing`.
    Raises `InputError` for an angle outside, and the errors of `movable_lever_linkage`.
    """
    machine, _ = lever_machine(mechanism, linkage, swing)
    placed = lever_swing(mechanism, linkage, swing)
    movable_lever_linkage(mechanism, linkage, swing)
    angle, extent = _angle_in_swing(placed, crank_angle), lever_extent(machine, placed)
    size = max(extent[2] - extent[0], extent[3] - extent[1])
    tolerances = tolerances_of(mechanism, linkage)
    letters = Lettering(TEXT * size, system)
    shapes = [*lever_shapes(machine, placed, angle), *_skeleton_and_dimensions(machine, angle, letters, tolerances)]
    title = f"{name}, {design}" if design else name
    return with_title(on.SWING_LAYERS, shapes, extent, size, title, _drawing_notes(machine, placed, angle, system))


def _angle_in_swing(swing: LeverSwing, angle: float | None) -> float:
    if angle is None:
        return usual_angle(swing)
    if swing.of_full_turn:
        return angle
    low, high = sorted((swing.start, swing.end))
    turned = angle + 2.0 * math.pi * math.ceil((low - angle) / (2.0 * math.pi) - 1e-9)
    if turned <= high + 1e-9:
        return min(max(turned, low), high)
    start, end, requested = (f"{math.degrees(at):.6g}" for at in (swing.start, swing.end, angle))
    raise InputError(
        f"the lever angle of a drawing must be within the swing, from {start} to {end} deg; got {requested} deg; give "
        "one in between, or none for the middle"
    )


def _skeleton_and_dimensions(
    machine: LeverMachine, angle: float, letters: Lettering, tolerances: dict[str, float]
) -> list[Shape]:
    """Return the skeleton, and the dimensions of lever and frame on either side of the angle between them."""
    sizes = machine.sizes
    pin = _point_at_angle(1e3 * sizes.crank, angle + sizes.pin_angle)
    pivot = _point_at_angle(1e3 * sizes.frame, sizes.frame_angle)
    side = 1.0 if math.sin(float(sizes.angle_from_frame_to_crank(angle))) > 0.0 else -1.0
    away, origin = 4.0 * letters.height, (0.0, 0.0)
    return [
        Line(on.SKELETON, origin, pin),
        Line(on.SKELETON, pivot, pin),
        aligned_dimension("crank", origin, pin, side * away, letters, tolerances.get("crank", 0.0)),
        aligned_dimension("rod", origin, pivot, -side * away, letters, tolerances.get("rod", 0.0)),
    ]


def _drawing_notes(machine: LeverMachine, swing: LeverSwing, angle: float, system: System) -> tuple[str, ...]:
    sizes, (unit, factor) = machine.sizes, metric_unit_in("mm", system)
    crank, frame, offset = (f"{1e3 * factor * size:.7g} {unit}" for size in (sizes.crank, sizes.frame, sizes.offset))
    if swing.of_full_turn:
        drawn = f"The crank rotates fully; drawn at {math.degrees(angle):.6g} deg, both ends of the fast stroke dashed."
        return (
            f"Crank {crank}, frame (rod) {frame} at {math.degrees(sizes.frame_angle):.6g} deg, offset {offset}.",
            *(drawn, f"{TRUE_SCALE[system]}; pivots are exact.", "Widths of crank and arm are schematic."),
        )
    lengths = (float(sizes.cylinder_length(end)) for end in (swing.start, swing.end))
    first, last = (f"{1e3 * factor * length:.7g}" for length in lengths)
    start, end, drawn = (f"{math.degrees(at):.6g}" for at in (swing.start, swing.end, angle))
    return (
        f"Crank {crank}, frame (rod) {frame} at {math.degrees(sizes.frame_angle):.6g} deg, offset {offset}.",
        f"The lever swings from {start} to {end} deg; drawn at {drawn} deg, both ends dashed.",
        f"The cylinder is {first} {unit} long at the start and {last} {unit} at the end.",
        f"{TRUE_SCALE[system]}; pivots are exact.",
        "Widths of lever and cylinder are schematic.",
    )


def _point_at_angle(length: float, angle: float) -> Point:
    return length * math.cos(angle), length * math.sin(angle)
