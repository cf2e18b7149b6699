"""A design as the equations of motion use it: masses, moments and forces that follow from raw numbers.

Because `derive_design` is also compiled for complex numbers, any raw number (`raw`) can be a design variable with an
exact derivative.
"""

import math
from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic, inverse, magnitude, root
from ..kinematics.geometry import inner_crank_angle, inner_dead_centre, outer_crank_angle, outer_dead_centre
from .loads.engine import burning_stroke_fraction
from .loads.load import Enters
from .raw_machine_vector import LOAD_SLOTS, Raw

_CRANK, _ROD, _OFFSET, _BRANCH = int(Raw.CRANK), int(Raw.ROD), int(Raw.OFFSET), int(Raw.BRANCH)
_CRANK_LINK, _ROD_LINK = int(Raw.CRANK_WIDTH), int(Raw.ROD_WIDTH)
_COUNTERWEIGHT, _TOLERANCES = int(Raw.COUNTERWEIGHT_MASS), int(Raw.CRANK_TOLERANCE)
_END, _GUIDE_DISTANCE, _SLIDER_MASS = int(Raw.END), int(Raw.GUIDE_DISTANCE), int(Raw.SLIDER_MASS)
_STROKE_FORCE, _SPRING, _VISCOUS = int(Enters.STROKE_FORCE), int(Enters.SPRING), int(Enters.VISCOUS)
_ADDED_MASS, _ANGLE_TABLE = int(Enters.ADDED_MASS), int(Enters.ANGLE_TABLE)
_CYLINDER, _BURNING_CYLINDER = int(Enters.CYLINDER), int(Enters.BURNING_CYLINDER)
_CRANK_TORQUE, _FORMULA = int(Enters.CRANK_TORQUE), int(Enters.FORMULA)


class Design(NamedTuple):
    """Numbers of one design (scalars) or of many (arrays) for the equations of motion. SI.

    Mass moments are about the crank pivot (crank) or the crank pin (rod), in the link's own axes; rod_along and
    rod_across are per rod length, kg.
    outward_force, inward_force: sums of the stroke forces. stiffness, spring_force: sums of k and of k x_rest.
    viscous: sum of the coefficients. moving_mass: slider with all added masses, which resist its acceleration but have
    no weight, kg. *_error: tolerance of crank, rod, offset, crank angle; the rod's includes the clearances of the pins,
    the offset's the clearance of the guide (see `position_error`). rod_error_rss, offset_error_rss: the same summed as
    squares. guide_friction: coefficient. *_circle: radius of a pin's friction circle, radius times coefficient, m.
    guide_distance: distance of the guide's centre from the slider pin at its outer dead centre, outward, m.
    """

    r: Any
    l: Any
    e: Any
    branch: Any
    speed: Any
    acceleration: Any
    slider_mass: Any
    gravity_x: Any
    gravity_y: Any
    crank_mass: Any
    crank_along: Any
    crank_across: Any
    crank_inertia: Any
    rod_mass: Any
    rod_along: Any
    rod_across: Any
    rod_inertia: Any
    crank_error: Any
    rod_error: Any
    offset_error: Any
    angle_error: Any
    inner: Any
    outer: Any
    outward_force: Any
    inward_force: Any
    stiffness: Any
    spring_force: Any
    viscous: Any
    moving_mass: Any
    rod_error_rss: Any
    offset_error_rss: Any
    guide_friction: Any
    crank_pivot_circle: Any
    crank_pin_circle: Any
    slider_pin_circle: Any
    guide_distance: Any


DESIGN = len(Design._fields)
"""Rows in a derived block before those for the loads."""
LOAD_ROWS, AREA = 10, 2
"""Rows for each load: sign and origin of a table's or a cylinder's own coordinate, or the two numbers in a formula.
From AREA on, a cylinder adds piston area, height of the clearance, low and high pressure, exponents of compression and
expansion, back pressure, and end of burning from the top. A torque on the crank has the numbers in its slots."""
_OUTWARD = Design._fields.index("outward_force")
_MOVING_MASS = Design._fields.index("moving_mass")
_RUBBING = Design._fields.index("guide_friction")
_ROD_RSS, _OFFSET_RSS = Design._fields.index("rod_error_rss"), Design._fields.index("offset_error_rss")

# Written out when the module is loaded, because numba does not accept an array column as a tuple.
design_at: Any = analytic(eval(f"lambda block, j: Design({', '.join(f'block[{row}, j]' for row in range(DESIGN))})"))
"""Column j of a derived block as a `Design`; from Python `j` may be a slice."""


@analytic
def link_properties(
    length: Any,
    width: Any,
    depth: Any,
    density: Any,
    mass: Any,
    centre: Any,
    centre_share: Any,
    centre_across: Any,
    inertia: Any,
    inertia_share: Any,
) -> Any:
    """Return mass, first moments along and across, and inertia about the link's origin.

    The sum of a round-ended bar and a rigid body with its centre at `centre + centre_share length`, `centre_across` off
    the axis, and central inertia `inertia + inertia_share mass length^2`; either may be absent (zero). Half-disc of
    radius R: centroid 4 R / (3 pi) from its diameter, polar moment about the disc's centre m R^2 / 2.
    """
    web = density * depth * width * length
    cap = density * depth * width * width * (math.pi / 8.0)
    radius = 0.5 * width
    centroid = radius * (4.0 / (3.0 * math.pi))
    centre_along = centre + centre_share * length
    return (
        web + 2.0 * cap + mass,
        (0.5 * web + cap) * length + mass * centre_along,
        mass * centre_across,
        web * (length * length * (1.0 / 3.0) + width * width * (1.0 / 12.0))
        + cap * (radius * radius + length * length + 2.0 * length * centroid)
        + inertia
        + mass * (inertia_share * length * length + centre_along * centre_along + centre_across * centre_across),
    )


@analytic
def _derive_crank(raw: Any, out: Any) -> None:
    c, w, t = _CRANK_LINK, _COUNTERWEIGHT, _TOLERANCES
    for j in range(raw.shape[1]):
        m, first_along, first_across, inertia = link_properties(
            raw[_CRANK, j],
            raw[c, j],
            raw[c + 1, j],
            raw[c + 2, j],
            raw[c + 3, j],
            raw[c + 4, j],
            raw[c + 5, j],
            raw[c + 6, j],
            raw[c + 7, j],
            raw[c + 8, j],
        )
        weight, x, y = raw[w, j], raw[w + 1, j], raw[w + 2, j]
        out[9, j] = m + weight
        out[10, j] = first_along + weight * x
        out[11, j] = first_across + weight * y
        out[12, j] = inertia + raw[w + 3, j] + weight * (x * x + y * y)
        out[17, j] = raw[t, j] + raw[t + 1, j] * raw[_CRANK, j]


@analytic
def _derive_rod(raw: Any, out: Any) -> None:
    c, t = _ROD_LINK, _TOLERANCES
    for j in range(raw.shape[1]):
        l = raw[_ROD, j]
        m, first_along, first_across, inertia = link_properties(
            l,
            raw[c, j],
            raw[c + 1, j],
            raw[c + 2, j],
            raw[c + 3, j],
            raw[c + 4, j],
            raw[c + 5, j],
            raw[c + 6, j],
            raw[c + 7, j],
            raw[c + 8, j],
        )
        out[13, j] = m
        out[14, j] = first_along / l
        out[15, j] = first_across / l
        out[16, j] = inertia
        rod = raw[t + 2, j] + raw[t + 3, j] * l
        pivot, pin, end = raw[t + 7, j], raw[t + 8, j], raw[t + 9, j]
        out[18, j] = rod + (pivot + pin + end)
        out[_ROD_RSS, j] = root(rod * rod + (pivot * pivot + pin * pin + end * end))


@analytic
def _derive_offset(raw: Any, out: Any) -> None:
    t = _TOLERANCES
    for j in range(raw.shape[1]):
        offset, guide = raw[t + 4, j] + raw[t + 5, j] * magnitude(raw[_OFFSET, j]), raw[t + 10, j]
        out[19, j] = offset + guide
        out[_OFFSET_RSS, j] = root(offset * offset + guide * guide)


@analytic
def _derive_load(raw: Any, kind: Any, datum: Any, p: Any, q: Any, j: Any, out: Any) -> None:
    """Fill the rows of a load from q with numbers from row p, and add its contributions to the sums."""
    if datum == 0:
        sign, origin = 1.0, 0.0 * raw[_CRANK, j]  # not from a dead centre, which a swing need not have
    elif datum == 1:
        sign, origin = 1.0, 1.0 * out[21, j]
    else:
        sign, origin = -1.0, 1.0 * out[22, j]
    if kind == _ANGLE_TABLE and datum > 0:
        crank, rod, offset = raw[_CRANK, j], raw[_ROD, j], raw[_OFFSET, j]
        at = inner_crank_angle(crank, rod, offset) if datum == 1 else outer_crank_angle(crank, rod, offset)
        # The crossed branch is the mirror image about the y axis.
        sign, origin = 1.0, at if raw[_BRANCH, j].real > 0.0 else math.pi - at
    out[q, j] = sign
    out[q + 1, j] = origin
    if kind == _STROKE_FORCE:
        out[_OUTWARD, j] += raw[p, j]
        out[_OUTWARD + 1, j] += raw[p + 1, j]
    elif kind == _SPRING:
        out[_OUTWARD + 2, j] += raw[p + 2, j]
        out[_OUTWARD + 3, j] += raw[p + 2, j] * (origin + sign * raw[p + 3, j])
    elif kind == _VISCOUS:
        out[_OUTWARD + 4, j] += raw[p + 2, j]
    elif kind == _ADDED_MASS:
        out[_MOVING_MASS, j] += raw[p + 2, j]
    elif kind in (_CYLINDER, _BURNING_CYLINDER):
        bore, rod = raw[p + 2, j], raw[p + 3, j]
        area = (math.pi / 4.0) * (bore * bore - rod * rod)
        out[q + AREA, j] = area
        out[q + AREA + 1, j] = raw[p + 4, j] * (out[22, j] - out[21, j]) + raw[p + 5, j] * inverse(area)
        for i in range(5):
            out[q + AREA + 2 + i, j] = raw[p + 6 + i, j]
        if kind == _BURNING_CYLINDER:
            clearance, low, high, exponent = raw[p + 4, j], raw[p + 6, j], raw[p + 7, j], raw[p + 8, j]
            share = burning_stroke_fraction(clearance, low, high, exponent, raw[p + 11, j], raw[p + 12, j])
            out[q + AREA + 7, j] = share * (out[22, j] - out[21, j])
    elif kind == _CRANK_TORQUE:
        for i in range(4):
            out[q + AREA + i, j] = raw[p + 2 + i, j]
    elif kind >= _FORMULA:
        out[q, j], out[q + 1, j] = raw[p + 2, j], raw[p + 3, j]


@analytic
def derive_design(raw: Any, kind: Any, datum: Any, out: Any, moved: Any = -1) -> None:
    """Fill `out` (DESIGN + LOAD_ROWS k, n) from raw numbers (END + LOAD_SLOTS k, n), real or complex.

    moved: the only raw number that has changed since `out` was filled; a changed dimension needs less work.
    """
    for i in range(9):
        for j in range(raw.shape[1]):
            out[i, j] = raw[i, j]
    if moved != _ROD and moved != _OFFSET:
        _derive_crank(raw, out)
    if moved != _CRANK and moved != _OFFSET:
        _derive_rod(raw, out)
    if moved != _CRANK and moved != _ROD:
        _derive_offset(raw, out)
    for j in range(raw.shape[1]):
        out[21, j] = inner_dead_centre(raw[_CRANK, j], raw[_ROD, j], raw[_OFFSET, j])
        out[22, j] = outer_dead_centre(raw[_CRANK, j], raw[_ROD, j], raw[_OFFSET, j])
    if moved < 0 or moved > _OFFSET:
        f = _TOLERANCES + 11
        for j in range(raw.shape[1]):
            out[20, j] = raw[_TOLERANCES + 6, j]
            out[_RUBBING, j] = raw[f, j]
            out[_RUBBING + 4, j] = raw[_GUIDE_DISTANCE, j]
            for i in range(3):
                out[_RUBBING + 1 + i, j] = raw[f + 1 + 2 * i, j] * raw[f + 2 + 2 * i, j]
    for i in range(_OUTWARD, _OUTWARD + 5):
        for j in range(raw.shape[1]):
            out[i, j] = 0.0
    for j in range(raw.shape[1]):
        out[_MOVING_MASS, j] = raw[_SLIDER_MASS, j]
    for k in range(kind.shape[0]):
        p = _END + LOAD_SLOTS * k
        q = DESIGN + LOAD_ROWS * k
        for j in range(raw.shape[1]):
            _derive_load(raw, kind[k], datum[k], p, q, j, out)
