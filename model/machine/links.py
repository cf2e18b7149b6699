"""Mass properties of the links: by section, or by mass, inertia and mass centre.

Crank and rod are described along their own axis: the origin is at the crank pivot (crank) or at the crank pin (rod),
and the length is that between pin centres. The properties of a `Bar` follow from its length: a longer crank is heavier.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..checks import require_numbers


@dataclass(frozen=True, kw_only=True)
class Bar:
    """A round-ended bar with rectangular section, whose ends are half-discs around the pin centres.

    mass = density depth (L width + pi width^2 / 4) for centre distance L.

    width: size in the plane of motion, m. depth: size normal to it, m. density: kg/m^3.
    """

    width: float
    depth: float
    density: float

    def __post_init__(self) -> None:
        require_numbers(self, "width", "depth", "density", phrase="the {} of a bar", above=0.0)

    def mass(self, length: float) -> float:
        """Return the mass, kg, for a centre distance, m."""
        return self.density * self.depth * (length * self.width + 0.25 * math.pi * self.width**2)

    def principal_inertias(self, length: float) -> tuple[float, float, float]:
        """Return the moments of inertia about the mass centre, kg m^2.

        They are about the normal to the plane of motion, about the in-plane axis across the bar, and about the bar's
        own axis.
        """
        w, d = self.width, self.depth
        body = self.density * d * w * length
        disc = self.density * d * 0.25 * math.pi * w**2
        # Second moments over x (along), y (across in plane), z (depth); the half-discs sit at +-(L/2 + 4 R / 3 pi).
        radius = 0.5 * w
        about_width = body * length**2 / 12.0 + disc * (
            0.25 * length**2 + length * 4.0 * radius / (3.0 * math.pi) + 0.25 * radius**2
        )
        about_axis = body * w**2 / 12.0 + disc * 0.25 * radius**2
        about_depth = (body + disc) * d**2 / 12.0
        return about_width + about_axis, about_width + about_depth, about_axis + about_depth


@dataclass(frozen=True, kw_only=True)
class RigidLink:
    """A link given by its mass properties.

    mass: kg.
    centre: distance of the mass centre from the link's origin along the link, m; half the length if None.
    centre_across: distance of the mass centre from the link's axis, m, positive to the left of origin -> far pin.
    inertia: inertia about the mass centre, kg m^2; that of a slender uniform rod, mass length^2 / 12, if None.
    """

    mass: float
    centre: float | None = None
    centre_across: float = 0.0
    inertia: float | None = None

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "inertia", phrase="the {} of a link", least=0.0)
        require_numbers(self, "centre", "centre_across", phrase="the {} of a link")


Link = Bar | RigidLink


@dataclass(frozen=True, kw_only=True)
class Counterweight:
    """A mass fixed to the crank.

    mass: kg. radius: distance of its mass centre from the crank pivot, m. angle: angle of its mass centre from the
    crank's direction, rad (pi: opposite to the crank pin). inertia: inertia about its own mass centre, kg m^2.
    """

    mass: float
    radius: float
    angle: float = math.pi
    inertia: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "mass", "radius", "inertia", phrase="the {} of the counterweight", least=0.0)
        require_numbers(self, "angle", phrase="the {} of the counterweight")
