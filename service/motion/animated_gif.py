"""Animated GIF of a linkage: one revolution, two for a 720 deg cycle, or a swing."""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...model.cycle.gas_work import cylinder_loads, indicator_diagram
from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing
from ...objectives.kinds import System, metric_unit_in
from ...objectives.tables.swing_curves import curves_at_even_times
from ..designs.design_curves import lever_design_curves
from ..drawings.lever_parts import fixed_lever_shapes, lever_extent, moving_lever_shapes
from ..drawings.linkage_shapes import fixed_shapes, linkage_sizes, moving_shapes, pin_positions
from ..drawings.shapes import Shape
from ..drawings.swing_parts import fixed_swing_shapes, moving_swing_shapes, swing_sizes
from ..figures.shape_painting import paint_shapes, set_axes_to_rectangle
from ..figures.style import MUTED, SMALL, TEXT, add_axes, new_figure, write_text

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

FRAMES, MILLISECONDS = 60, 60
"""Frames per revolution or swing, and the duration of each: 3.6 s per revolution at any machine speed."""
_WIDTH, _TALLEST, _HEAD, _FOOT, _DOTS = 6.4, 6.0, 0.45, 0.35, 100  # inches; dots per inch
_COLOURS = 32
_WHITE = 246  # grey level up to 255; the fill of the slider is just below


def animated_gif(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    name: str,
    design: str = "",
    swing: Swing | None = None,
    system: System = "metric",
) -> bytes:
    """Return an animated GIF of one linkage, which rotates at even speed or swings by its motion law.

    name: name of the run. design: design label, such as "design 3". swing: swing of the crank instead of full rotation.
    system: unit system of the numbers shown. Raises `AssemblyError` for a linkage that does not rotate fully, or the
    errors of `require_swing`.
    """
    if swing is None:
        scene = _turn_scene(mechanism, linkage, system)
    else:
        scene = (_swing_scene if mechanism.lever is None else _lever_scene)(mechanism, linkage, swing, system)
    frames = _draw_frames(scene, f"{name}, {design}" if design else name)
    out = io.BytesIO()
    options: dict[str, Any] = {"append_images": frames[1:], "duration": MILLISECONDS, "loop": 0, "optimize": False}
    frames[0].save(out, format="GIF", save_all=True, disposal=1, **options)
    return out.getvalue()


@dataclass(frozen=True)
class _Scene:
    """Shapes of the animation: fixed ones, and those of each frame with its text. dashed: dashed shapes."""

    extent: tuple[float, float, float, float]
    size: float
    still: list[Shape]
    frames: list[tuple[list[Shape], str]]
    dashed: str


def _turn_scene(mechanism: Mechanism, linkage: Linkage, system: System) -> _Scene:
    look, turns = linkage_sizes(mechanism, linkage), cycle_turns(mechanism)
    turn = -1.0 if mechanism.speed < 0.0 else 1.0
    angles = turn * 2.0 * math.pi * np.arange(turns * FRAMES) / FRAMES
    gas = [indicator_diagram(mechanism, linkage, load, angles).pressure for _, load in cylinder_loads(mechanism)]
    frames = []
    for step, angle in enumerate(angles.tolist()):
        pin, slider = pin_positions(linkage, angle)
        degrees = round(math.degrees(angle)) % (360 * turns)
        bar, per_bar = metric_unit_in("bar", system)
        pressures = ", ".join(f"{1e-5 * per_bar * pressure[step]:.3g}" for pressure in gas)
        reading = f"crank angle {degrees}°, slider at {_length_text(slider[0], system)}"
        frames.append((moving_shapes(pin, slider, look), f"{reading}, {pressures} {bar}" if gas else reading))
    return _Scene(
        look.extent, look.longer_side, fixed_shapes(linkage, look, bearing_below=True), frames, "dead centres dashed"
    )


def _swing_scene(mechanism: Mechanism, linkage: Linkage, swing: Swing, system: System) -> _Scene:
    drawn = swing_sizes(mechanism, linkage, swing)
    ways = curves_at_even_times(mechanism, drawn.linkage, drawn.swing, FRAMES)
    frames = []
    for way, angle in (
        (way, angle)
        for way, of_way in zip(("forth", "back"), ways, strict=True)
        for angle in of_way.crank_angle.tolist()
    ):
        slider = pin_positions(drawn.linkage, angle)[1]
        reading = f"{way}, crank angle {round(math.degrees(angle))}°, slider at {_length_text(slider[0], system)}"
        frames.append((moving_swing_shapes(drawn, angle), reading))
    return _Scene(drawn.extent, drawn.look.longer_side, fixed_swing_shapes(drawn), frames, "ends of the swing dashed")


def _lever_scene(mechanism: Mechanism, linkage: Linkage, swing: Swing, system: System) -> _Scene:
    curves = lever_design_curves(mechanism, linkage, swing, FRAMES)
    placed, (machine, _) = lever_swing(mechanism, linkage, swing), lever_machine(mechanism, linkage, swing)
    angles, lengths, *_ = (column.values for column in curves.columns)
    frames = [
        (
            moving_lever_shapes(machine, placed, math.radians(angle)),
            f"crank angle {round(angle)}°, cylinder {_length_text(length, system)}",
        )
        for angle, length in zip(angles, lengths, strict=True)
    ]
    extent, ends = lever_extent(machine, placed), "fast stroke" if placed.of_full_turn else "swing"
    size = max(extent[2] - extent[0], extent[3] - extent[1])
    return _Scene(extent, size, fixed_lever_shapes(machine, placed), frames, f"ends of the {ends} dashed")


def _length_text(mm: float, system: System) -> str:
    unit, factor = metric_unit_in("mm", system)
    return f"{factor * mm:.5g} {unit}"


def _draw_frames(scene: _Scene, title: str) -> list[Picture]:
    from PIL import Image

    left, low, right, high = scene.extent
    margin = 0.03 * scene.size
    wide, tall = right - left + 2.0 * margin, high - low + 2.0 * margin
    height = min(_TALLEST, _WIDTH * tall / wide)
    figure = new_figure(_WIDTH, height + _HEAD + _FOOT)
    figure.set_dpi(_DOTS)
    axes = add_axes(figure, 0.0, _FOOT, _WIDTH, height)
    set_axes_to_rectangle(axes, left - margin, low - margin, right + margin, high + margin)
    write_text(figure, 0.15, height + _FOOT + 0.15, title[:90], fontsize=TEXT + 1.5, weight="bold")
    write_text(figure, 0.15, 0.12, scene.dashed, fontsize=SMALL, color=MUTED)
    paint_shapes(axes, scene.still)
    reading = figure.text(1.0 - 0.15 / _WIDTH, 0.12 / (height + _HEAD + _FOOT), "", fontsize=TEXT, ha="right")
    canvas = figure.canvas
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)  # type: ignore[attr-defined]
    pictures: list[Picture] = []
    palette = None
    for shapes, reading_text in scene.frames:
        reading.set_text(reading_text.replace("-", "−"))
        canvas.restore_region(still)  # type: ignore[attr-defined]
        for artist in (reading, *paint_shapes(axes, shapes)):
            figure.draw_artist(artist)
            if artist is not reading:
                artist.remove()
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[attr-defined]
        # One palette for all frames, so that fixed shapes do not flicker.
        palette = palette or _palette(picture)
        pictures.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    return pictures


def _palette(picture: Picture) -> Picture:
    """Return the colours of a picture, with near-white ones replaced by white."""
    from PIL import Image

    colours = picture.quantize(_COLOURS).getpalette() or []
    for first in range(0, len(colours), 3):
        if min(colours[first : first + 3]) > _WHITE:
            colours[first : first + 3] = [255, 255, 255]
    palette_image = Image.new("P", (1, 1))
    palette_image.putpalette(colours)
    return palette_image
