"""Drawing as DXF, for CAD: AutoCAD 2000 format, units millimetres, real dimension entities."""

from __future__ import annotations

import io
import math
import re
import struct
from typing import TYPE_CHECKING, Any

from ...model.optional_packages import NamingExtra
from ..designs.length_with_tolerance import decimals_of_tolerance
from .shapes import Arc, Circle, Dashes, Dimension, Drawing, Label, Line, Outline, Shape, Wedge

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.layouts.base import BaseLayout

_NON_ASCII = re.compile(r"[^\x00-\x7f]")
_VERSION = "R2000"  # readable by all programs, and the first version with units
_MILLIMETRES = 4
_STYLE = "SLIDERCRANK"
# Name, description, and pattern relative to the size of the drawing: total, then dash, gap, dash ...
_DASHES: dict[Dashes, tuple[str, str, tuple[float, ...]]] = {
    "continuous": ("CONTINUOUS", "", ()),
    "dashed": ("DASHED", "Dashed __ __ __ __", (0.016, 0.010, -0.006)),
    "centre": ("CENTER", "Center ____ _ ____ _", (0.038, 0.024, -0.005, 0.004, -0.005)),
    "phantom": ("PHANTOM", "Phantom ____ _ _ ____", (0.039, 0.016, -0.005, 0.004, -0.005, 0.004, -0.005)),
}
_ANCHORS = {"start": 0, "middle": 1, "end": 2}  # horizontal alignment on the baseline


def dxf_file(drawing: Drawing) -> bytes:
    """Return the drawing as the content of a DXF file, with non-ASCII characters escaped so that any encoding works."""
    out = io.StringIO()
    dxf_document(drawing).write(out)
    return _NON_ASCII.sub(_escape, out.getvalue()).encode("ascii")


def _escape(character: re.Match[str]) -> str:
    """Return a character as DXF escapes it in every encoding: \\U+00B1 for a plus-minus sign."""
    return "".join(f"\\U+{unit:04X}" for (unit,) in struct.iter_unpack(">H", character[0].encode("utf-16-be")))


def dxf_document(drawing: Drawing) -> Document:
    """Return the drawing as an ezdxf document."""
    with NamingExtra("DXF files need"):
        from ezdxf.filemanagement import new

    dxf = new(_VERSION, units=_MILLIMETRES)
    left, bottom, right, top = drawing.bounds
    dxf.header["$MEASUREMENT"] = 1  # metric line types
    dxf.header["$LUNITS"] = 2  # decimal
    for name, description, pattern in _DASHES.values():
        if pattern:
            dxf.linetypes.add(name, [drawing.size * part for part in pattern], description=description)
    for layer in drawing.layers:
        dxf_layer = dxf.layers.add(
            layer.name,
            color=layer.number,
            linetype=_DASHES[layer.dashes][0],
            lineweight=round(100.0 * layer.weight),
        )
        dxf_layer.description = layer.title
    _create_dimension_style(dxf, drawing)
    space = dxf.modelspace()
    for shape in drawing.shapes:
        _add_shape(dxf, space, shape)
    space.reset_extents((left, bottom, 0.0), (right, top, 0.0))
    space.reset_limits((left, bottom), (right, top))
    height = 1.05 * max(top - bottom, 0.6 * (right - left))
    dxf.set_modelspace_vport(height, (0.5 * (left + right), 0.5 * (bottom + top)))
    return dxf


def _create_dimension_style(document: Document, drawing: Drawing) -> None:
    """Create the style with which CAD redraws the dimensions as they are drawn here."""
    height = next((shape.height for shape in drawing.shapes if isinstance(shape, Dimension)), 2.5)
    # Enough decimals for five digits of the size; DXF allows at most eight.
    decimals = min(8, max(0, 4 - math.floor(math.log10(drawing.size))))
    values = {
        "dimtxt": height, "dimasz": 1.2 * height, "dimexo": 0.4 * height, "dimexe": 0.6 * height,
        "dimgap": 0.4 * height, "dimscale": 1.0, "dimtad": 1, "dimtih": 0, "dimtoh": 0, "dimdec": decimals,
        "dimzin": 8, "dimdsep": ord("."), "dimlunit": 2,
    }  # fmt: skip
    document.dimstyles.new(_STYLE, dxfattribs=values)


def _add_shape(document: Document, space: BaseLayout, shape: Shape) -> None:
    attributes: dict[str, Any] = {"layer": shape.layer.name}
    if isinstance(shape, Line):
        space.add_line(shape.start, shape.end, dxfattribs=attributes)
    elif isinstance(shape, Circle):
        space.add_circle(shape.centre, shape.radius, dxfattribs=attributes)
    elif isinstance(shape, Arc):
        space.add_arc(shape.centre, shape.radius, shape.start, shape.end, dxfattribs=attributes)
    elif isinstance(shape, Outline):
        corners = [(x, y, bulge) for (x, y), bulge in zip(shape.corners, shape.bulges, strict=True)]
        space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=attributes)
    elif isinstance(shape, Wedge):
        space.add_solid(shape.corners, dxfattribs=attributes)
    elif isinstance(shape, Label):
        _add_label(space, shape, attributes)
    else:
        _add_dimension(document, space, shape, attributes)


def _add_label(space: BaseLayout, shape: Label, attributes: dict[str, Any]) -> None:
    # Remove characters that would end the line or act as control codes.
    plain = " ".join(shape.text.replace("%%", "% %").split()).replace("^", "^ ")
    text = space.add_text(plain, height=shape.height, rotation=shape.angle, dxfattribs=attributes)
    text.dxf.insert = shape.position
    if shape.anchor != "start":
        text.dxf.halign, text.dxf.align_point = _ANCHORS[shape.anchor], shape.position


def _add_dimension(document: Document, space: BaseLayout, shape: Dimension, attributes: dict[str, Any]) -> None:
    """Add a dimension with graphics drawn here: those of ezdxf depend on installed fonts."""
    block = document.blocks.new_anonymous_block(type_char="D")
    for part in shape.parts:
        _add_shape(document, block, part)
    label = next(part for part in shape.parts if isinstance(part, Label))
    styled = space.add_linear_dim(
        base=shape.through,
        p1=shape.start,
        p2=shape.end,
        angle=shape.angle,
        dimstyle=_STYLE,
        override=_tolerance_settings(shape),
        dxfattribs=attributes,
    )
    styled.commit()
    entity = styled.dimension
    entity.dxf.geometry = block.name
    entity.dxf.text_midpoint = label.position
    entity.dxf.actual_measurement = shape.length


def _tolerance_settings(shape: Dimension) -> dict[str, Any]:
    """Return the settings with which CAD writes a tolerance as it is written here."""
    if not shape.tolerance:
        return {}
    decimals = decimals_of_tolerance(shape.tolerance)
    equal = {"dimtol": 1, "dimtp": shape.tolerance, "dimtm": shape.tolerance, "dimtfac": 1.0}
    return equal | {"dimdec": decimals, "dimtdec": decimals, "dimzin": 0}
