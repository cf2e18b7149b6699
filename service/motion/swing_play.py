"""The motion of a linkage that swings, forth and back by its law of motion."""

from __future__ import annotations

import math

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ..designs.cycle_table import CurveColumn
from ..designs.swing_curves import at_even_times, motion_and_drive, tolerated
from ..drawings.parts import lengths_in_words
from ..drawings.shapes import Shape
from ..drawings.swing_parts import body_shapes, cylinder_parts, swing_look, swing_scenery
from .play import ANGLES, SHOWN, Play, Words, links_of, places

_WORDS = Words(
    control="Forth and back",
    times="swings a minute",
    over="the swing, forth and back",
    note="Both ends of the swing are dashed in the drawing; a dotted line in the curves is where it turns back. "
    + SHOWN.format("slider, pins, the cylinder and the body on the crank are for show"),
)
_LEFT_OUT = ("crank_angle", "load")


def play_of_swing(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Play:
    """Return the motion of a linkage that swings. Raises what `require_swing` raises."""
    of = swing_look(mechanism, linkage, swing)
    ways = at_even_times(mechanism, of.linkage, of.swing, ANGLES)
    angles = np.concatenate([way.crank_angle for way in ways])
    at = of.linkage.at(angles)
    columns = [
        CurveColumn(
            curve.field, curve.title, curve.kind.metric.symbol, np.concatenate([curve.of(way) for way in ways]).tolist()
        )
        for curve in motion_and_drive(of.swing)
        if curve.name not in _LEFT_OUT and (curve.attribute != "driven_error" or tolerated(mechanism, of.swing))
    ]
    moving = links_of(of.look)
    if of.body is not None:
        moving["crank"] = [*moving["crank"], *body_shapes(of.body, of.look, 0.0)]
    pushed: dict[str, list[Shape]] = {}
    if of.cylinder is not None:
        rod, barrel = cylinder_parts(of.cylinder, of.look)
        pushed = {"push": [rod], "barrel": [barrel]}
    timed = of.swing.duration
    start, end = (math.degrees(angle) for angle in (of.swing.start, of.swing.end))
    how = "slowly" if timed is None else f"{of.swing.law} law, {timed:g} s per stroke"
    return Play(
        summary=f"{lengths_in_words(of.linkage, digits=6)}; from {start:.6g} to {end:.6g} deg, "
        f"the {of.swing.driver} driven, {how}",
        record={
            **places(of.look, at.slider_position, at.rod_angle),
            "angles": [round(math.degrees(angle), 9) for angle in angles],
            "direction": 1,
            "perSecond": 0.0 if timed is None else 0.5 / timed,
        },
        columns=columns,
        marks=(0.5 * ANGLES,),
        still=swing_scenery(of),
        moving={**pushed, **moving},
        extent=of.extent,
        size=of.look.size,
        words=_WORDS,
    )
