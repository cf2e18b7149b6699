"""Links with their mass properties, joints with clearance and a contact force, and joints with Coulomb friction.

The normal force over the penetration d is Hertz's, with hysteresis damping that dissipates energy in every impact:

    F = K d^(3/2) (1 + h d' / d'_0),        F >= 0,

where d'_0 is the speed at which the impact began and h follows from the coefficient of restitution e:

- flores: h = 8 (1 - e) / (5 e). Flores, Machado, Silva and Martins, "On the continuous contact force models for soft
  materials in multibody dynamics", Multibody System Dynamics 25 (2011) 357-375. Suitable for every e.
- lankarani-nikravesh: h = 3 (1 - e^2) / 4. Lankarani and Nikravesh, "A contact force model with hysteresis damping
  for impact analysis of multibody systems", Journal of Mechanical Design 112 (1990) 369-376. Suitable for e near one.

In the guide the friction force is the coefficient times the magnitude of the guide force, against the slider's
velocity. In a pin the friction moment is coefficient times radius times the magnitude of the pin force, against the
relative rotation of the parts. The line of action of the pin force passes the pin's centre at a distance equal
to coefficient times radius, the radius of the pin's *friction circle*.
Crank and rod are described along their own axis: the origin is at the crank pivot (crank) or at the crank pin (rod),
and the length is that between pin centres. The properties of a `Bar` follow from its length: a longer crank is heavier.
"""

import math
from dataclasses import dataclass
from typing import Literal

from ..checks import require_numbers
from ..errors import InputError
from .loads.load import require_word


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


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A pin in its bearing. radius: m. coefficient: friction moment divided by radius times force."""

    radius: float = 0.0
    coefficient: float = 0.0

    def __post_init__(self) -> None:
        require_numbers(self, "radius", "coefficient", phrase="the {} of a pin", least=0.0)

    @property
    def friction_circle_radius(self) -> float:
        """Radius of the friction circle, m: coefficient times radius."""
        return self.coefficient * self.radius


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Friction in a machine; none unless given.

    guide: coefficient of friction of the slider in its guide. crank_pivot: pin between frame and crank. crank_pin: pin
    between crank and rod. slider_pin: pin between rod and slider.

    The guide carries a single normal force N at the slider pin and rubs with mu |N|; the guide absorbs the moment of
    the slider pin's friction without additional friction. If a joint does not move (the slider at a dead centre,
    everything at zero crank speed), friction acts against the motion that follows in the crank's sense of rotation. A
    crank at zero speed is assumed to turn counter-clockwise, as for loads that change with the stroke.
    """

    guide: float = 0.0
    crank_pivot: Pin = Pin()
    crank_pin: Pin = Pin()
    slider_pin: Pin = Pin()

    def __post_init__(self) -> None:
        require_numbers(self, "guide", phrase="the {}'s coefficient of friction", least=0.0)

    @property
    def acts(self) -> bool:
        """Whether any joint has friction."""
        return self.guide > 0.0 or any(
            pin.friction_circle_radius > 0.0 for pin in (self.crank_pivot, self.crank_pin, self.slider_pin)
        )


def require_frictionless(friction: Friction, subject: str) -> None:
    """Raise an error for friction if an analysis ignores it. subject: the analysis, as the subject of a sentence."""
    if friction.acts:
        raise InputError(
            f"{subject} only takes joints and guide without friction; got friction that has an effect; leave "
            "[friction] out"
        )


Joint = Literal["crank pivot", "crank pin", "slider pin"]
Law = Literal["flores", "lankarani-nikravesh"]


@dataclass(frozen=True, kw_only=True)
class Clearance:
    """One pin joint with clearance; the other two are ideal.

    joint: the loose joint. The journal is on the crank (crank pivot, crank pin) or on the slider (slider pin). radius:
    radial clearance, radius of the bearing minus radius of the journal, m. journal_radius: m. restitution: e, ratio of
    the speeds after and before an impact, above 0 and at most 1. friction: coefficient between journal and bearing,
    with the tangential force mu F v / sqrt(v^2 + slip_speed^2) against the sliding velocity v. slip_speed: m/s, below
    which friction fades; the default is small compared with the sliding speed of any rotating pin. law: damping law,
    see above. elastic_modulus, poisson: modulus, Pa, and Poisson's ratio of journal and bearing; steel by default.
    stiffness: K, N/m^1.5; Hertz's if None. slow_impact: impact speed below which the damping stays constant, m/s. It
    keeps the damping finite where a contact begins softly, and lets e approach one for slow impacts. Below it, this is
    the law of Hunt and Crossley (Journal of Applied Mechanics 42 (1975) 440-445).
    """

    joint: Joint
    radius: float
    journal_radius: float
    restitution: float = 0.9
    friction: float = 0.0
    law: Law = "flores"
    elastic_modulus: float = 207e9
    poisson: float = 0.3
    stiffness: float | None = None
    slow_impact: float = 0.01
    slip_speed: float = 1e-3

    def __post_init__(self) -> None:
        require_word("joint", self.joint, Joint)
        require_word("law", self.law, Law)
        for name in ("radius", "journal_radius", "elastic_modulus", "stiffness", "slow_impact", "slip_speed"):
            value = getattr(self, name)
            if value is not None and not 0.0 < value < math.inf:
                raise InputError(f"{name} of a clearance must be positive and finite; got {value:g}")
        if self.radius >= self.journal_radius:
            raise InputError(
                "a radial clearance must be less than the radius of the journal; "
                f"got {1e3 * self.radius:g} mm and {1e3 * self.journal_radius:g} mm; check the units"
            )
        if not 0.0 < self.restitution <= 1.0:
            raise InputError(
                f"restitution must be above 0 and at most 1; got {self.restitution:g}; steel on steel has about 0.9"
            )
        if not 0.0 <= self.friction < math.inf:
            raise InputError(f"friction of a clearance must be zero or more and finite; got {self.friction:g}")
        if not 0.0 <= self.poisson <= 0.5:
            raise InputError(f"poisson must be from 0 to 0.5; got {self.poisson:g}; steel has 0.3")

    @property
    def bearing_radius(self) -> float:
        """Radius of the bearing, m."""
        return self.journal_radius + self.radius

    @property
    def contact_stiffness(self) -> float:
        """K, N/m^1.5: as given, or Hertz's for bodies of radii R_j and -R_b made from the same material.

        K = (2/3) E / (1 - nu^2) sqrt(R_j R_b / (R_b - R_j)): two spheres, as is usual for joints with clearance. A long
        journal has line contact and is stiffer; state its stiffness if known.
        """
        if self.stiffness is not None:
            return self.stiffness
        modulus = self.elastic_modulus / (1.0 - self.poisson**2)
        return 2.0 / 3.0 * modulus * math.sqrt(self.journal_radius * self.bearing_radius / self.radius)

    @property
    def hysteresis(self) -> float:
        """h, ratio of damping to elastic force at the beginning of an impact."""
        e = self.restitution
        return 1.6 * (1.0 - e) / e if self.law == "flores" else 0.75 * (1.0 - e * e)
