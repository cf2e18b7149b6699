"""Drawing as an SVG file, true to scale when printed at 100 %, with a group for each layer."""

import math
from xml.sax.saxutils import escape, quoteattr

from .shapes import (
    Arc,
    Circle,
    Dashes,
    Dimension,
    Drawing,
    Label,
    Layer,
    Line,
    Outline,
    Point,
    Shape,
    Wedge,
    outline_sides,
)

_MARGIN = 0.03  # relative to the size of the drawing
_LINE = 0.004  # width of a line with weight 0.5, relative to that size
_DASHES: dict[Dashes, tuple[float, ...]] = {
    "continuous": (),
    "dashed": (0.010, 0.006),
    "centre": (0.024, 0.005, 0.004, 0.005),
    "phantom": (0.016, 0.005, 0.004, 0.005, 0.004, 0.005),
}


def svg_file(drawing: Drawing) -> bytes:
    """Return the drawing as the content of an SVG file."""
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{svg_text(drawing)}'.encode()


def svg_text(drawing: Drawing) -> str:
    """Return the drawing as an SVG element; lengths in mm."""
    left, bottom, right, top = drawing.bounds
    margin = _MARGIN * drawing.size
    left, bottom, right, top = left - margin, bottom - margin, right + margin, top + margin
    width, height = _exact_text(right - left), _exact_text(top - bottom)
    frame = f"{_exact_text(left)} {_exact_text(-top)} {width} {height}"
    lines = [
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
        f'width="{width}mm" height="{height}mm" viewBox="{frame}" font-family="Arial, Helvetica, sans-serif">',
        f"<title>{escape(drawing.title)}</title>",
        f"<desc>{escape(' '.join(drawing.notes))}</desc>",
        f'<rect x="{_exact_text(left)}" y="{_exact_text(-top)}" width="{width}" height="{height}" fill="#ffffff"/>',
    ]
    for layer in drawing.layers:
        lines.append(opening_tag(layer, drawing.size))
        lines += [f"  {line}" for shape in drawing.shapes_on_layer(layer.name) for line in svg_elements(shape)]
        lines.append("</g>")
    return "\n".join([*lines, "</svg>", ""])


def opening_tag(layer: Layer, size: float) -> str:
    """Return the opening tag for a layer's group. size: size of the drawing."""
    attributes = {
        "id": layer.name,
        "inkscape:groupmode": "layer",
        "inkscape:label": layer.name,
        "fill": "none",
        "stroke": layer.ink,
        "stroke-width": _exact_text(2.0 * layer.weight * _LINE * size),
        "stroke-linejoin": "round",
    }
    if _DASHES[layer.dashes]:
        attributes["stroke-dasharray"] = " ".join(_exact_text(part * size) for part in _DASHES[layer.dashes])
    return f"<g {' '.join(f'{name}={quoteattr(value)}' for name, value in attributes.items())}>"


def svg_elements(shape: Shape) -> list[str]:
    """Return the elements that show a shape."""
    if isinstance(shape, Line):
        return [f'<path d="M{_point_text(shape.start)}L{_point_text(shape.end)}"/>']
    if isinstance(shape, Circle):
        x, y = shape.centre
        return [f'<circle cx="{_exact_text(x)}" cy="{_exact_text(-y)}" r="{_exact_text(shape.radius)}"/>']
    if isinstance(shape, Arc):
        # Counter-clockwise is opposite to the flag, because y points downward here.
        start, end = _point_text(shape.point_at(shape.start)), _point_text(shape.point_at(shape.end))
        radius, large = _exact_text(shape.radius), int(shape.end - shape.start > 180.0)
        return [f'<path d="M{start}A{radius} {radius} 0 {large} 0 {end}"/>']
    if isinstance(shape, Outline):
        return [f'<path d="{_outline_svg(shape)}"/>']
    if isinstance(shape, Wedge):
        corners = "L".join(_point_text(corner) for corner in shape.corners)
        return [f'<path d="M{corners}Z" fill="{shape.layer.ink}" stroke="none"/>']
    if isinstance(shape, Label):
        return [_label_svg(shape)]
    if isinstance(shape, Dimension):
        inner = [f"  {line}" for part in shape.parts for line in svg_elements(part)]
        return [f'<g id="{shape.name}">', *inner, "</g>"]
    raise AssertionError(shape)


def _outline_svg(shape: Outline) -> str:
    parts = [f"M{_point_text(shape.corners[0])}"]
    for start, end, bulge in outline_sides(shape):
        if not bulge:
            parts.append(f"L{_point_text(end)}")
            continue
        # The angle of an arc is 4 atan(bulge); y points downward here, so left becomes right.
        radius = 0.5 * math.dist(start, end) / math.sin(2.0 * math.atan(abs(bulge)))
        parts.append(f"A{_exact_text(radius)} {_exact_text(radius)} 0 0 {int(bulge < 0.0)} {_point_text(end)}")
    return "".join(parts) + "Z"


def _label_svg(shape: Label) -> str:
    x, y = _exact_text(shape.position[0]), _exact_text(-shape.position[1])
    turned = f' transform="rotate({_exact_text(-shape.angle)} {x} {y})"' if shape.angle else ""
    # Capitals are 0.716 times as high as the font size.
    size = _exact_text(shape.height / 0.716)
    return (
        f'<text x="{x}" y="{y}" font-size="{size}" text-anchor="{shape.anchor}" fill="{shape.layer.ink}" '
        f'stroke="none"{turned}>{escape(shape.text)}</text>'
    )


def _point_text(point: Point) -> str:
    return f"{_exact_text(point[0])},{_exact_text(-point[1])}"


def _exact_text(value: float) -> str:
    """Return a number at full precision."""
    return repr(value + 0.0).removesuffix(".0")
