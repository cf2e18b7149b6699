"""A joint with clearance: a journal loose in its bearing, and the contact force between them.

The normal force over the penetration d is Hertz's, with hysteresis damping that dissipates energy in every impact:

    F = K d^(3/2) (1 + h d' / d'_0),        F >= 0,

where d'_0 is the speed at which the impact began and h follows from the coefficient of restitution e:

- flores: h = 8 (1 - e) / (5 e). Flores, Machado, Silva and Martins, "On the continuous contact force models for soft
  materials in multibody dynamics", Multibody System Dynamics 25 (2011) 357-375. Suitable for every e.
- lankarani-nikravesh: h = 3 (1 - e^2) / 4. Lankarani and Nikravesh, "A contact force model with hysteresis damping
  for impact analysis of multibody systems", Journal of Mechanical Design 112 (1990) 369-376. Suitable for e near one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ..errors import InputError
from .loads.load import require_word

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
