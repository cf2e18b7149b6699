"""The sketch of docs/glossary.md: a linkage to scale with the terms of the machine."""

from __future__ import annotations

import math
from pathlib import Path

from slidercrank.model.linkage.linkage import Linkage

LINKAGE = Linkage(crank=0.115, rod=0.330, offset=0.045)
CRANK_ANGLE = math.radians(62.0)
_SCALE = 1050.0  # px/m
_ORIGIN = (215.0, 200.0)  # px, of the crank pivot
_SIZE = (820, 340)  # px
_STYLE = """
    text { font-family: "DejaVu Sans", Arial, sans-serif; font-size: 15px; fill: #111; }
    .link { stroke: #111; stroke-width: 8; stroke-linecap: round; }
    .hint { stroke: #666; stroke-width: 1.2; fill: none; }
    .dash { stroke: #666; stroke-width: 1.2; fill: none; stroke-dasharray: 6 5; }
    .arrow { stroke: #111; stroke-width: 1.5; fill: none; marker-end: url(#tip); }
    .size { stroke: #111; stroke-width: 1.5; fill: none; marker-start: url(#tip); marker-end: url(#tip); }
    .pin { fill: #fff; stroke: #111; stroke-width: 2.5; }
    .slider { fill: #dbe7f0; stroke: #111; stroke-width: 2; }
    .guide { stroke: #111; stroke-width: 2.5; }
"""

Point = tuple[float, float]


def sketch() -> str:
    """Return the sketch as SVG."""
    pivot, crank_pin, slider_pin = _joints()
    inner, outer = (_pixel(float(position), float(LINKAGE.offset)) for position in LINKAGE.dead_centres)
    parts = [
        _line("dash", (60.0, slider_pin[1]), (800.0, slider_pin[1])),
        _line("dash", (60.0, pivot[1]), (420.0, pivot[1])),
        f'<circle class="dash" cx="{pivot[0]:.2f}" cy="{pivot[1]:.2f}" r="{float(LINKAGE.crank) * _SCALE:.2f}"/>',
        *(_line("guide", (inner[0] - 40.0, y), (outer[0] + 40.0, y)) for y in (slider_pin[1] - 23, slider_pin[1] + 23)),
        f'<rect class="slider" x="{slider_pin[0] - 42:.2f}" y="{slider_pin[1] - 21:.2f}" width="84" height="42"/>',
        _line("link", pivot, crank_pin, name="crank"),
        _line("link", crank_pin, slider_pin, name="rod"),
        *(
            _pin(name, at)
            for name, at in (("crank-pivot", pivot), ("crank-pin", crank_pin), ("slider-pin", slider_pin))
        ),
        *_dimensions(pivot, crank_pin, slider_pin, inner, outer),
        *_terms(pivot, crank_pin, slider_pin, inner, outer),
    ]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{_SIZE[0]}" height="{_SIZE[1]}" '
            f'viewBox="0 0 {_SIZE[0]} {_SIZE[1]}" role="img">',
            "<title>Terms of the slider-crank</title>",
            "<desc>An offset slider-crank with the names of its parts, angles and distances.</desc>",
            f"<style>{_STYLE}</style>",
            '<defs><marker id="tip" orient="auto-start-reverse" markerUnits="userSpaceOnUse" markerWidth="12" '
            'markerHeight="10" refX="11" refY="5" viewBox="0 0 12 10">'
            '<path d="M0,0 L12,5 L0,10 z" fill="#111"/></marker></defs>',
            f'<rect width="{_SIZE[0]}" height="{_SIZE[1]}" fill="#fff"/>',
            *parts,
            "</svg>\n",
        ]
    )


def draw(folder: Path) -> None:
    """Write the sketch into a folder."""
    (folder / "glossary.svg").write_text(sketch(), encoding="utf-8")


def _joints() -> tuple[Point, Point, Point]:
    """Return crank pivot, crank pin and slider pin, px."""
    crank = float(LINKAGE.crank)
    pin = crank * math.cos(CRANK_ANGLE), crank * math.sin(CRANK_ANGLE)
    slider = float(LINKAGE.at(CRANK_ANGLE).slider_position), float(LINKAGE.offset)
    return _pixel(0.0, 0.0), _pixel(*pin), _pixel(*slider)


def _dimensions(pivot: Point, crank_pin: Point, slider_pin: Point, inner: Point, outer: Point) -> list[str]:
    """Return the arrows of offset, stroke, crank angle and transmission angle."""
    rod_angle = math.atan2(crank_pin[1] - slider_pin[1], crank_pin[0] - slider_pin[0])  # seen from the slider pin
    below = slider_pin[1] + 110.0
    return [
        _line("size", (84.0, pivot[1]), (84.0, slider_pin[1]), name="offset"),
        _line("hint", inner, (inner[0], below + 8.0)),
        _line("hint", outer, (outer[0], below + 8.0)),
        _line("size", (inner[0], below), (outer[0], below), name="stroke"),
        _arc("arrow", pivot, 52.0, 0.0, -CRANK_ANGLE),
        _line("dash", slider_pin, (slider_pin[0], slider_pin[1] - 120.0)),
        _arc("size", slider_pin, 100.0, rod_angle, -0.5 * math.pi),
        _line("arrow", (slider_pin[0] + 110.0, slider_pin[1]), (slider_pin[0] + 46.0, slider_pin[1])),
    ]


def _terms(pivot: Point, crank_pin: Point, slider_pin: Point, inner: Point, outer: Point) -> list[str]:
    """Return the terms where they belong."""
    crank = (0.5 * (pivot[0] + crank_pin[0]), 0.5 * (pivot[1] + crank_pin[1]))
    rod = (0.5 * (crank_pin[0] + slider_pin[0]), 0.5 * (crank_pin[1] + slider_pin[1]))
    return [
        _term("crank pivot", pivot[0], pivot[1] + 30, anchor="middle"),
        _term("crank pin", crank_pin[0] - 2, crank_pin[1] - 22, anchor="middle"),
        _term("crank", crank[0] - 14, crank[1] + 2, anchor="end"),
        _term("connecting rod", rod[0] - 20, rod[1] - 24, anchor="middle"),
        _term("slider pin", slider_pin[0] + 52, slider_pin[1] - 42),
        _line("hint", (slider_pin[0] + 50, slider_pin[1] - 44), (slider_pin[0] + 7, slider_pin[1] - 7)),
        _term("slider", slider_pin[0], slider_pin[1] + 46, anchor="middle"),
        _term("guide", outer[0] + 48, slider_pin[1] + 28),
        _term("load", slider_pin[0] + 116, slider_pin[1] - 8),
        _term("offset", 24, 0.5 * (pivot[1] + slider_pin[1]) + 5),
        _term("crank angle", pivot[0] + 58, pivot[1] - 16),
        _term("transmission angle", slider_pin[0] + 8, slider_pin[1] - 108),
        _term("stroke", 0.5 * (inner[0] + outer[0]), slider_pin[1] + 102, anchor="middle"),
        _term("inner dead centre", inner[0], slider_pin[1] + 138, anchor="middle"),
        _term("outer dead centre", outer[0], slider_pin[1] + 138, anchor="middle"),
        _term("inward", 0.5 * (inner[0] + outer[0]) - 14, slider_pin[1] + 170, anchor="end"),
        _line("arrow", (0.5 * (inner[0] + outer[0]) - 76, slider_pin[1] + 165), (inner[0] - 20, slider_pin[1] + 165)),
        _term("outward", 0.5 * (inner[0] + outer[0]) + 14, slider_pin[1] + 170),
        _line("arrow", (0.5 * (inner[0] + outer[0]) + 84, slider_pin[1] + 165), (outer[0] + 20, slider_pin[1] + 165)),
    ]


def _pixel(x: float, y: float) -> Point:
    return _ORIGIN[0] + _SCALE * x, _ORIGIN[1] - _SCALE * y


def _line(kind: str, start: Point, end: Point, *, name: str = "") -> str:
    label = f'id="{name}" ' if name else ""
    x1, y1, x2, y2 = (*start, *end)
    return f'<line {label}class="{kind}" x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"/>'


def _arc(kind: str, centre: Point, radius: float, start: float, end: float) -> str:
    """Return an arc of less than half a turn; angles are clockwise from +x, as on the screen."""
    (x1, y1), (x2, y2) = (
        (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)) for angle in (start, end)
    )
    sweep = int(math.sin(end - start) > 0.0)
    return f'<path class="{kind}" d="M{x1:.2f},{y1:.2f} A{radius:g},{radius:g} 0 0 {sweep} {x2:.2f},{y2:.2f}"/>'


def _pin(name: str, centre: Point) -> str:
    return f'<circle id="{name}" class="pin" cx="{centre[0]:.2f}" cy="{centre[1]:.2f}" r="8"/>'


def _term(text: str, x: float, y: float, *, anchor: str = "start") -> str:
    return f'<text text-anchor="{anchor}" x="{x:.2f}" y="{y:.2f}">{text}</text>'
