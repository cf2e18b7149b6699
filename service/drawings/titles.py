"""Title and notes below a drawing."""

from collections.abc import Sequence

from ...objectives.kinds import System
from . import layers as on
from .shapes import Drawing, Label, Layer, Shape

TEXT = 0.022
"""Text height of dimensions, relative to the size of the drawing."""
TRUE_SCALE: dict[System, str] = {
    "metric": "Dimensions in millimetres",
    "inch": "Dimensions in inches",
}


def with_title(
    layers: tuple[Layer, ...],
    shapes: Sequence[Shape],
    extent: tuple[float, float, float, float],
    size: float,
    title: str,
    notes: tuple[str, ...],
) -> Drawing:
    """Return the drawing of shapes with title and notes below them. extent: left, bottom, right, top; mm."""
    left, low, _, _ = extent
    y = min(Drawing((), tuple(shapes), size, "", ()).bounds[1], low) - 0.06 * size
    words = [
        Label(on.NOTES, title, (left, y), 1.2 * TEXT * size),
        *(
            Label(on.NOTES, note, (left, y - (1.5 * line + 0.3) * TEXT * size), 0.75 * TEXT * size)
            for line, note in enumerate(notes, 1)
        ),
    ]
    return Drawing(layers, (*shapes, *words), size, title, notes)
