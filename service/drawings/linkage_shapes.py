"""Shapes of a linkage in one position, and of its fixed surroundings: in mm, on their layers."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ...model.cycle.gas_work import cylinder_loads
from ...model.linkage.dimensions import DIMENSIONS
from ...model.linkage.linkage import Linkage
from ...model.machine.links_and_joints import Bar
from ...model.machine.mechanism import Mechanism
from ...objectives.kinds import LENGTH, System, metric_unit_in
from ..designs.length_with_tolerance import format_length
from . import layers as on
from .shapes import Circle, Layer, Line, Outline, Point, Shape

_MM = 1e3
_FEET = 200  # maximum number of hatch lines along a rail


@dataclass(frozen=True)
class Barrel:
    """Cylinder on the slider line, mm: bore, and positions of its open end and its head."""

    bore: float
    foot: float
    head: float


@dataclass(frozen=True)
class LinkageSizes:
    """Sizes of a drawn linkage, mm. crank, rod, offset: its dimensions.

    inner, outer: slider pins at the dead centres, or at the ends of a swing. slider_range: minimum and maximum slider
    position. extent: approximate left, bottom, right and top of the moving parts. crank_width, rod_width: widths of the
    links. block: height of the slider; the bore for a piston. slider_size: two thirds of its length. pins: radii
    of crank pivot, crank pin and slider pin. barrels: barrels of cylinders. has_sections: whether a link has a section,
    so that its width is true. has_pins: whether the pins are true; everything else is schematic.
    """

    crank: float
    rod: float
    offset: float
    inner: Point
    outer: Point
    slider_range: tuple[float, float]
    extent: tuple[float, float, float, float]
    crank_width: float
    rod_width: float
    block: float
    slider_size: float
    pins: tuple[float, float, float]
    has_sections: bool
    has_pins: bool
    barrels: tuple[Barrel, ...] = ()

    @property
    def longer_side(self) -> float:
        """Longer side of the extent."""
        left, low, right, high = self.extent
        return max(right - left, high - low)


def linkage_sizes(mechanism: Mechanism, linkage: Linkage) -> LinkageSizes:
    """Return the drawn sizes for a machine's linkage.

    Raises `AssemblyError` for a linkage that does not rotate fully.
    """
    inner, outer = (_MM * float(x) for x in linkage.dead_centres)
    r = _MM * float(linkage.crank)
    look = linkage_sizes_between(
        mechanism, linkage, (inner, outer), (min(inner, outer), max(inner, outer)), (-r, -r, r, r)
    )
    return _with_slider_as_piston(mechanism, look)


def _with_slider_as_piston(mechanism: Mechanism, look: LinkageSizes) -> LinkageSizes:
    """Return a linkage with its slider drawn as the piston of a machine's cylinders.

    Bore and clearance are true to scale; the piston length is schematic.
    """
    gas = [load for _, load in cylinder_loads(mechanism)]
    if not gas:
        return look
    half, barrels = 0.75 * look.slider_size, []
    for load in gas:
        ends = (look.inner[0], look.outer[0])
        foot, top = ends if load.head == "outer dead centre" else ends[::-1]
        way = math.copysign(1.0, top - foot)
        height = load.clearance * abs(top - foot) + _MM * load.clearance_volume / load.area
        barrels.append(Barrel(_MM * load.bore, foot - way * half, top + way * (half + height)))
    bore, (left, low, right, high) = max(barrel.bore for barrel in barrels), look.extent
    extent = (
        min(left, *(barrel.head for barrel in barrels)),
        min(low, look.offset - 0.72 * bore),
        max(right, *(barrel.head for barrel in barrels)),
        max(high, look.offset + 0.72 * bore),
    )
    return replace(look, block=bore, barrels=tuple(barrels), extent=extent)


def linkage_sizes_between(
    mechanism: Mechanism,
    linkage: Linkage,
    ends: tuple[float, float],
    slider_range: tuple[float, float],
    swept: tuple[float, float, float, float],
) -> LinkageSizes:
    """Return the drawn sizes of a linkage whose slider moves between two positions, mm; see `LinkageSizes`.

    swept: left, bottom, right and top of the path of the crank's axis.
    """
    r, l, e = (_MM * float(value) for value in (linkage.crank, linkage.rod, linkage.offset))
    described = (mechanism.crank, mechanism.rod)
    usual = min(0.05 * (l + r), 0.5 * r)
    crank, rod = (_MM * link.width if isinstance(link, Bar) else usual for link in described)
    block = max(0.16 * (r + max(r, abs(e))), 0.05 * (max(map(abs, slider_range)) + r))
    usual_pin, strength = min(0.28 * min(crank, rod), 0.25 * block, 0.25 * r), mechanism.strength
    pins = (usual_pin, usual_pin, usual_pin)
    if strength is not None:
        pins = (0.5e3 * strength.crank_pivot, 0.5e3 * strength.crank_pin, 0.5e3 * strength.slider_pin)
    half = 0.5 * crank
    extent = (
        min(swept[0] - half, slider_range[0] - 0.95 * block),
        min(swept[1] - half, e - 0.72 * block),
        max(swept[2] + half, slider_range[1] + 0.95 * block),
        max(swept[3] + half, e + 0.72 * block),
    )
    has_sections = any(isinstance(link, Bar) for link in described)
    return LinkageSizes(
        *(r, l, e, (ends[0], e), (ends[1], e), slider_range, extent, crank, rod, block, block),
        pins=pins,
        has_sections=has_sections,
        has_pins=strength is not None,
    )


def lengths_in_words(
    linkage: Linkage, tolerances: Mapping[str, float], system: System = "metric", *, stroke: bool = False
) -> str:
    """Return the dimensions of a linkage, its stroke on request, and its branch, as text.

    tolerances: those of the dimensions, mm, which set their decimals.
    """
    names, unit = (*DIMENSIONS, *(["stroke"] if stroke else [])), LENGTH.display_unit(system)
    factor = metric_unit_in("mm", system)[1]
    lengths = [
        format_length(unit.factor * float(getattr(linkage, name)), factor * tolerances.get(name, 0.0)).partition(" ")[0]
        for name in names
    ]
    texts = (f"{name} {length} {unit.symbol}" for name, length in zip(names, lengths, strict=True))
    return f"{', '.join(texts)}; {linkage.branch} branch"


def widths_in_words(look: LinkageSizes) -> str:
    """Return which parts are to scale and which are schematic."""
    parts = {"link widths": look.has_sections, "pins": look.has_pins, "slider": False}
    true, schematic = (" and ".join(name for name, known in parts.items() if known is state) for state in (True, False))
    text = f"{true} are to scale; the {schematic} {'are' if ' and ' in schematic else 'is'} schematic." if true else ""
    return text.capitalize() or "Link widths, slider and pins are schematic."


def pin_positions(linkage: Linkage, angle: float) -> tuple[Point, Point]:
    """Return the positions of crank pin and slider pin at a crank angle, rad."""
    r, x = _MM * float(linkage.crank), _MM * float(linkage.at(angle).slider_position)
    return (r * math.cos(angle), r * math.sin(angle)), (x, _MM * float(linkage.offset))


def moving_shapes(pin: Point, slider: Point, look: LinkageSizes) -> list[Shape]:
    """Return slider, rod and crank with their pins, for given positions of the crank pin and the slider pin."""
    drawn = link_shapes((on.SLIDER, on.ROD, on.CRANK), pin, slider, look)
    return [*drawn, *map(Circle, [on.PINS] * 3, ((0.0, 0.0), pin, slider), look.pins)]


def fixed_shapes(linkage: Linkage, look: LinkageSizes, *, bearing_below: bool) -> list[Shape]:
    """Return axes, paths, both dead centres, guide and bearing.

    bearing_below: whether the bearing stands below the pivot.
    """
    paths = (Circle(on.PATHS, (0.0, 0.0), look.crank), Line(on.PATHS, look.inner, look.outer))
    ghosts: list[Shape] = []
    for layer, angle, end in zip(
        (on.INNER, on.OUTER), linkage.dead_centre_angles, (look.inner, look.outer), strict=True
    ):
        pin = (look.crank * math.cos(angle), look.crank * math.sin(angle))
        ghosts += link_shapes((layer,) * 3, pin, end, look)
        ghosts += [Circle(layer, pin, 0.6 * look.pins[1]), Circle(layer, end, 0.6 * look.pins[2])]
    walls = [line for barrel in look.barrels for line in _barrel_shapes(barrel, look.offset)]
    return [
        *centre_lines(look),
        *paths,
        *ghosts,
        *guide_rails(look),
        *crank_bearing(look, is_below_pivot=bearing_below),
        *walls,
    ]


def _barrel_shapes(barrel: Barrel, offset: float) -> list[Shape]:
    """Return bore and head of a cylinder."""
    low, high = offset - 0.5 * barrel.bore, offset + 0.5 * barrel.bore
    corners = ((barrel.foot, low), (barrel.head, low), (barrel.head, high), (barrel.foot, high))
    return [Line(on.CYLINDER, start, end) for start, end in itertools.pairwise(corners)]


def centre_lines(look: LinkageSizes) -> list[Shape]:
    """Return the slider line, and its parallel through the crank pivot."""
    left, _, right, _ = look.extent
    ends = (left - 0.03 * look.longer_side, right + 0.03 * look.longer_side)
    return [Line(on.AXES, (ends[0], y), (ends[1], y)) for y in dict.fromkeys((0.0, look.offset))]


def round_ended_bar(layer: Layer, start: Point, end: Point, width: float) -> Outline:
    """Return a round-ended outline around two pivots."""
    length = math.dist(start, end)
    x, y = (0.5 * width * (end[0] - start[0]) / length, 0.5 * width * (end[1] - start[1]) / length)
    corners = (
        (start[0] + y, start[1] - x),
        (end[0] + y, end[1] - x),
        (end[0] - y, end[1] + x),
        (start[0] - y, start[1] + x),
    )
    return Outline(layer, corners, (0.0, 1.0, 0.0, 1.0))


def slider_block(layer: Layer, pin: Point, look: LinkageSizes) -> Outline:
    """Return the outline of a slider around its pin."""
    x, y = 0.75 * look.slider_size, 0.5 * look.block
    corners = tuple((pin[0] + u * x, pin[1] + v * y) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return Outline(layer, corners, (0.0, 0.0, 0.0, 0.0))


def link_shapes(layers: tuple[Layer, Layer, Layer], pin: Point, slider: Point, look: LinkageSizes) -> list[Shape]:
    """Return slider, rod and crank, each on its layer."""
    return [
        slider_block(layers[0], slider, look),
        round_ended_bar(layers[1], pin, slider, look.rod_width),
        round_ended_bar(layers[2], (0.0, 0.0), pin, look.crank_width),
    ]


def guide_rails(look: LinkageSizes) -> list[Shape]:
    """Return the hatched guide of the slider."""
    shapes: list[Shape] = []
    start, end = look.slider_range[0] - 0.95 * look.slider_size, look.slider_range[1] + 0.95 * look.slider_size
    for side in (-1.0, 1.0):
        y = look.offset + side * 0.52 * look.block
        shapes.append(Line(on.FRAME, (start, y), (end, y)))
        pitch = max(0.2 * look.slider_size, (end - start) / _FEET)
        shapes += [
            Line(on.FRAME, (start + k * pitch, y), (start + (k - 1) * pitch, y + side * pitch))
            for k in range(1, int((end - start) / pitch) + 1)
        ]
    return shapes


def crank_bearing(look: LinkageSizes, *, is_below_pivot: bool) -> list[Shape]:
    """Return the bearing of the crank pivot. is_below_pivot: whether the bearing stands below the pivot."""
    return pivot_bearing((0.0, 0.0), 1.5 * max(look.pins[0], 0.3 * look.crank_width), is_below=is_below_pivot)


def pivot_bearing(pivot: Point, foot: float, *, is_below: bool) -> list[Shape]:
    """Return the stand of a fixed pivot. foot: half the distance between its feet on the ground, mm."""
    x, y = pivot[0], pivot[1] + (-2.0 * foot if is_below else 2.0 * foot)
    legs = [Line(on.FRAME, pivot, (x + side, y)) for side in (-foot, foot)]
    return [*legs, Line(on.FRAME, (x - 1.8 * foot, y), (x + 1.8 * foot, y))]
