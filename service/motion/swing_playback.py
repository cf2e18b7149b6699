"""Motion of a swinging linkage, back and forth by its motion law."""

from __future__ import annotations

import math

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ..designs.cycle_table import CurveColumn
from ..designs.swing_curves import curves_at_even_times, has_position_error, motion_and_drive
from ..drawings.linkage_shapes import lengths_in_words
from ..drawings.shapes import Shape
from ..drawings.swing_parts import body_shapes, cylinder_parts, swing_look, swing_scenery
from .playback import ANGLES, EXACT_PARTS, Playback, PlayerText, moving_link_shapes, place_record

_WORDS = PlayerText(
    control="Back and forth",
    times="swings a minute",
    span_name="the swing, back and forth",
    note="Both ends of the swing are dashed in the drawing; a dotted line in the curves is where it turns back. "
    + EXACT_PARTS.format("slider, pins, the cylinder and the body on the crank are for show"),
)
_LEFT_OUT = ("crank_angle", "load")


def swing_playback(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Playback:
    """Return the motion of a swinging linkage. Raises the errors of `require_swing`."""
    drawn = swing_look(mechanism, linkage, swing)
    ways = curves_at_even_times(mechanism, drawn.linkage, drawn.swing, ANGLES)
    angles = np.concatenate([way.crank_angle for way in ways])
    at = drawn.linkage.at(angles)
    columns = [
        CurveColumn(
            curve.field,
            curve.title,
            curve.kind.metric.symbol,
            np.concatenate([curve.values_in(way) for way in ways]).tolist(),
        )
        for curve in motion_and_drive(drawn.swing)
        if curve.name not in _LEFT_OUT
        and (curve.attribute != "driven_error" or has_position_error(mechanism, drawn.swing))
    ]
    moving = moving_link_shapes(drawn.look)
    if drawn.body is not None:
        moving["crank"] = [*moving["crank"], *body_shapes(drawn.body, drawn.look, 0.0)]
    pushed: dict[str, list[Shape]] = {}
    if drawn.cylinder is not None:
        rod, barrel = cylinder_parts(drawn.cylinder, drawn.look)
        pushed = {"push": [rod], "barrel": [barrel]}
    timed = drawn.swing.duration
    start, end = (math.degrees(angle) for angle in (drawn.swing.start, drawn.swing.end))
    how = "slowly" if timed is None else f"{drawn.swing.law} law, {timed:g} s per stroke"
    return Playback(
        summary=f"{lengths_in_words(drawn.linkage, digits=6)}; from {start:.6g} to {end:.6g} deg, "
        f"the {drawn.swing.driver} driven, {how}",
        record={
            **place_record(drawn.look, at.slider_position, at.rod_angle),
            "angles": [round(math.degrees(angle), 9) for angle in angles],
            "direction": 1,
            "perSecond": 0.0 if timed is None else 0.5 / timed,
        },
        columns=columns,
        marks=(0.5 * ANGLES,),
        still=swing_scenery(drawn),
        moving={**pushed, **moving},
        extent=drawn.extent,
        size=drawn.look.size,
        words=_WORDS,
    )
