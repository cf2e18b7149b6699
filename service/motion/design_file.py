"""Files of one design: its drawing for CAD, its animation, its cycle as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...objectives.kinds import System
    from ..designs.stored_designs import StoredDesign

ENDINGS = {"dxf": (".dxf",), "svg": (".svg",), "motion": (".html", ".htm"), "gif": (".gif",), "cycle": (".csv",)}
"""Allowed file endings, by type of content."""


def design_file(kind: str, stored: StoredDesign, angle: float | None, units: System, **named: str) -> bytes:
    """Return a file of one design, of a type in `ENDINGS`.

    angle: crank angle in drawings, rad; None for the default. named: job and design, for titles.
    """
    if kind == "cycle":
        from ..designs.design_curves import design_csv

        return design_csv(stored, units).encode()
    if kind == "motion":
        from .player_page import player_page

        return player_page(stored.mechanism, stored.linkage, swing=stored.part.motion, system=units, **named)
    if kind == "gif":
        from .animated_gif import animated_gif

        return animated_gif(stored.mechanism, stored.linkage, swing=stored.part.motion, system=units, **named)
    from ..drawings.design_drawing import design_drawing

    system: System = units if kind == "svg" else "metric"  # a DXF declares mm, and CAD converts it
    drawing = design_drawing(stored, name=named["name"], design=named["design"], crank_angle=angle, system=system)
    if kind == "svg":
        from ..drawings.svg import svg_file

        return svg_file(drawing)
    from ..drawings.dxf import dxf_file

    return dxf_file(drawing)
