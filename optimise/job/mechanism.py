"""The machine in a job file: links, masses, gravity, loads and tolerances, and their conversion to the model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Tag, model_validator

from ...model.errors import InputError
from ...model.machine.arrangement import MOST, Arrangement
from ...model.machine.links_and_joints import Bar, Counterweight, Link, RigidLink
from ...model.machine.mechanism import Branch, Clearances, DeadCentre, SliderDistances, Tolerances, Window
from ...objectives.units import quote
from .crank_speed import CrankSpeedPart
from .value_types import (
    Angle,
    AngleTolerance,
    Built,
    Checked,
    Clearance,
    Density,
    Fraction,
    Gravity,
    Inertia,
    Length,
    LengthTolerance,
    Mass,
    Part,
    PositiveLength,
    Radius,
    ToleranceOf,
    optional_entry,
    required_entry,
)

During = Literal["cycle", "outward stroke", "inward stroke"]


class SectionLink(Built[Link]):
    """A link as a round-ended bar with rectangular section: its mass and inertia follow from its length."""

    makes = Bar

    width: PositiveLength = required_entry("in the plane of motion", "30 mm")
    depth: PositiveLength = required_entry("normal to the plane", "20 mm")
    density: Density = required_entry("of the material", "7850 kg/m^3")


class MassLink(Built[Link]):
    """A link given by its mass properties, the same for every length."""

    makes = RigidLink

    mass: Mass = required_entry("of the link", "0.5 kg")
    inertia: Inertia | None = optional_entry(
        "about the mass centre; default mass length^2 / 12, a slender uniform rod", "0.0012 kg m^2"
    )
    centre: Length | None = optional_entry(
        "distance of the mass centre from the crank pivot (crank) or from the crank "
        "pin (rod), along the link; default half the length",
        "30 mm",
    )
    centre_across: Length = optional_entry(
        "distance of the mass centre from the link's axis, positive to the left", "2 mm", default=0.0
    )


_SECTION = frozenset(SectionLink.model_fields)
_MASS = frozenset(MassLink.model_fields)


def _require_one_link_form(value: object) -> object:
    """Reject a link that is not a table, or has both a section and mass properties."""
    if isinstance(value, Part):
        return value
    if not isinstance(value, Mapping):
        raise InputError(
            "must be a table, { width, depth, density } or { mass, ... }; "
            f"got {quote(value)}; the length of a link belongs in [variables]"
        )
    section, mass = sorted(_SECTION & set(value)), sorted(_MASS & set(value))
    if section and mass:
        raise InputError(
            "must be given by its section (width, depth, density) or by its mass (mass, inertia, "
            f"centre), not by both; got {', '.join(section + mass)}; leave out one of the two"
        )
    return value


def _link_form(value: object) -> str:
    if isinstance(value, Part):
        return "(by section)" if isinstance(value, SectionLink) else "(by mass)"
    return "(by section)" if isinstance(value, Mapping) and _SECTION & set(value) else "(by mass)"


AnyLink = Annotated[
    Annotated[SectionLink, Tag("(by section)")] | Annotated[MassLink, Tag("(by mass)")],
    Discriminator(_link_form),
    BeforeValidator(_require_one_link_form),
]


class CounterweightPart(Built[Counterweight]):
    """A mass fixed to the crank."""

    makes = Counterweight

    mass: Mass = required_entry("of the counterweight", "0.4 kg")
    radius: Radius = required_entry("from the crank pivot to its mass centre", "25 mm")
    angle: Angle = optional_entry(
        "of its mass centre from the crank's direction; 180 deg is opposite the pin", "180 deg", default=math.pi
    )
    inertia: Inertia = optional_entry("about its own mass centre", "0.0001 kg m^2", default=0.0)


class CylindersPart(Checked[Arrangement]):
    """Identical cylinders on one crankshaft; each is a machine as in this job."""

    makes = Arrangement

    phases: tuple[Angle, ...] = required_entry(
        "angle of the crank of each cylinder from the shaft's zero, counter-clockwise",
        ["0 deg", "180 deg"],
        max_length=MOST,
    )
    banks: tuple[Angle, ...] = optional_entry(
        "angle of each cylinder's slider line from +x, counter-clockwise; default: all zero",
        ["-45 deg", "45 deg"],
        default=(),
        max_length=MOST,
    )
    places: tuple[Length, ...] = optional_entry(
        "position of each cylinder along the shaft, for the rocking couple; default: all in one plane",
        ["-50 mm", "50 mm"],
        default=(),
        max_length=MOST,
    )


class SliderPart(Part):
    """The slider."""

    mass: Mass = required_entry("of the slider and everything that moves with it", "0.8 kg")
    dead_centre: DeadCentre = optional_entry("from which its distances are measured", "outer", default="outer")
    touch_distance: PositiveLength | None = optional_entry(
        "before the dead centre, where it meets the workpiece; touch_speed is the slider speed there", "10 mm"
    )
    dwell_distance: PositiveLength | None = optional_entry(
        "from the dead centre, within which the slider counts as at rest; dwell_angle is the crank angle of this dwell",
        "0.5 mm",
    )

    guide_distance: Length | None = optional_entry(
        "outward from its pin at the outer dead centre to the centre of its guide in the frame, for guide_moment",
        "150 mm",
    )

    @property
    def distances(self) -> SliderDistances:
        """The distances in the form that the model uses."""
        return SliderDistances(
            dead_centre=self.dead_centre,
            touch=self.touch_distance,
            dwell=self.dwell_distance,
            guide=self.guide_distance,
        )


class MechanismPart(CrankSpeedPart):
    """Drive and masses of the machine; lengths belong in [variables]."""

    crank: AnyLink | None = optional_entry("section or mass of the crank; default massless", {"mass": "0.2 kg"})
    rod: AnyLink | None = optional_entry(
        "section or mass of the connecting rod; default massless",
        {"width": "30 mm", "depth": "20 mm", "density": "7850 kg/m^3"},
    )
    counterweight: CounterweightPart | None = optional_entry(
        "counterweight, a mass fixed to the crank", {"mass": "0.4 kg", "radius": "25 mm"}
    )
    slider: SliderPart | None = optional_entry("slider; default massless", {"mass": "0.8 kg"})
    cylinders: CylindersPart | None = optional_entry(
        "several identical cylinders on one crankshaft; torque, power, work and shaking are totals",
        {"phases": ["0 deg", "180 deg"]},
    )
    gravity: Gravity | None = optional_entry("magnitude of gravity; default: none", "9.81 m/s^2")
    gravity_direction: Angle | None = optional_entry(
        "direction of gravity, counter-clockwise from +x (outward on the open branch, inward on the crossed branch); "
        "default 270 deg, across a level slider line",
        "270 deg",
    )
    branch: Branch = optional_entry(
        "open: the slider is on the side of +x, and outward is +x; crossed: the slider is on the side of "
        "-x, and outward is -x",
        "open",
        default="open",
    )

    inversion: Literal["turning cylinder"] | None = optional_entry(
        "turning cylinder: the rod is fixed as the frame; either a cylinder that turns about its end moves the "
        "crank, which is a lever, or a crank that rotates fully moves the cylinder or an arm; default: a slider-crank",
        "turning cylinder",
    )
    frame_angle: Angle | None = optional_entry(
        "for a turning cylinder: direction from the lever's pivot to the cylinder's, counter-clockwise from +x",
        "-60 deg",
    )
    pin_angle: Angle = optional_entry(
        "for a turning cylinder: angle from the line that gives the lever angle to the pin of the lever",
        "10 deg",
        default=0.0,
    )

    @model_validator(mode="after")
    def _require_gravity_with_direction(self) -> MechanismPart:
        if self.gravity_direction is not None and self.gravity is None:
            raise InputError(
                'gravity_direction needs gravity; got only a direction; add gravity = "9.81 m/s^2" or leave out '
                "gravity_direction"
            )
        return self

    @property
    def gravity_vector(self) -> tuple[float, float]:
        """Gravity along and across the slider line, m/s^2."""
        size = self.gravity or 0.0
        angle = 1.5 * math.pi if self.gravity_direction is None else self.gravity_direction
        # Rounding of pi would leave 1e-16 of gravity along an axis normal to it.
        axial, lateral = (0.0 if abs(part) < 1e-12 else size * part for part in (math.cos(angle), math.sin(angle)))
        return axial, lateral


def _require_ordered_ends(ends: tuple[float, float]) -> tuple[float, float]:
    if not 0.0 <= ends[0] < ends[1] <= 1.0:
        raise InputError(
            "must be [start, end] with 0 <= start < end <= 1, fractions of the stroke from the "
            f"inner dead centre; got [{ends[0]:g}, {ends[1]:g}]; the whole stroke is [0.0, 1.0]"
        )
    return ends


class ClearancesPart(Built[Clearances]):
    """Radial clearances of the joints: half the difference between bearing and pin diameters."""

    makes = Clearances

    crank_pivot: Clearance = optional_entry("of the bearing of the crank in the frame", "0.02 mm", default=0.0)
    crank_pin: Clearance = optional_entry("of the joint of crank and rod", "0.02 mm", default=0.0)
    slider_pin: Clearance = optional_entry("of the joint of rod and slider", "0.02 mm", default=0.0)
    guide: Clearance = optional_entry("of the slider, to either side of its line", "0.05 mm", default=0.0)


class TolerancesPart(Part):
    """Tolerances of dimensions and crank angle, and the part of the cycle where the error counts."""

    crank: LengthTolerance = optional_entry(
        "of the crank, as a length or a percentage", "0.05 mm", "0.1 %", default=0.0
    )
    rod: LengthTolerance = optional_entry("of the rod, as a length or a percentage", "0.05 mm", "0.1 %", default=0.0)
    offset: LengthTolerance = optional_entry(
        "of the offset, as a length or a percentage", "0.05 mm", "0.1 %", default=0.0
    )
    crank_angle: AngleTolerance = optional_entry("of the crank angle", "0.1 deg", default=0.0)
    clearances: ClearancesPart = optional_entry(
        "radial clearances of the joints", {"crank_pin": "0.02 mm"}, default=ClearancesPart()
    )
    during: During = optional_entry("the stroke in which the position error counts", "cycle", default="cycle")
    part_of_stroke: Annotated[tuple[Fraction, Fraction], AfterValidator(_require_ordered_ends)] = optional_entry(
        "part of the stroke in which the position error counts: fractions from the inner (0) to the outer dead centre "
        "(1)",
        [0.0, 0.25],
        default=(0.0, 1.0),
    )

    def build(self) -> Tolerances:
        """Return the tolerances in the form that the model uses."""
        return Tolerances(
            crank=ToleranceOf.build(self.crank),
            rod=ToleranceOf.build(self.rod),
            offset=ToleranceOf.build(self.offset),
            crank_angle=ToleranceOf.build(self.crank_angle),
            clearances=self.clearances.build(),
            window=Window(during=self.during, start=self.part_of_stroke[0], end=self.part_of_stroke[1]),
        )
