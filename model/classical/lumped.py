"""Two-mass model of the rod: one point mass at the crank pin and one at the slider pin.

With the mass centre at distance a from the crank pin and b = l - a from the slider pin: m b / l at the crank pin, m a /
l at the slider pin. Mass and mass centre are preserved. The inertia about the mass centre becomes m a b, so the model
is exact for a rod whose inertia equals m a b. Any other split (half and half, as in Eqs. 31 to 36 of M. Obaseki and P.
B. Alfred, "Modeling and Investigating the Effect of Offset Distance on Slider-Crank Mechanism", 2020) also moves the
mass centre, unless it happens to match.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.links import Bar, Link, RigidLink
from ..machine.mechanism import Mechanism


@dataclass(frozen=True)
class MassProperties:
    """Mass (kg), mass centre along and across the link (m) and inertia about the mass centre (kg m^2)."""

    mass: float
    centre: float
    centre_across: float
    inertia: float


def link_mass_properties(link: Link, length: float) -> MassProperties:
    """Return the mass properties of a link with a given length between pin centres, m."""
    if isinstance(link, Bar):
        return MassProperties(link.mass(length), 0.5 * length, 0.0, link.principal_inertias(length)[0])
    centre = 0.5 * length if link.centre is None else link.centre
    inertia = link.mass * length**2 / 12.0 if link.inertia is None else link.inertia
    return MassProperties(link.mass, centre, link.centre_across, inertia)


def rod_mass_share_at_crank_pin(mechanism: Mechanism, linkage: Linkage) -> float:
    """Return the fraction of the rod's mass lumped at the crank pin, b / l.

    Raises `InputError` for a mass centre that is not between the pins: one mass would be negative.
    """
    length = float(linkage.rod)
    share = 1.0 - link_mass_properties(mechanism.rod, length).centre / length
    if not 0.0 <= share <= 1.0:
        raise InputError(
            "the two-mass model needs the rod's mass centre between the pins; got "
            f"{1e3 * length * (1.0 - share):g} mm from the crank pin of a rod of {1e3 * length:g} mm; use the "
            "exact model"
        )
    return share


def mechanism_with_lumped_rod(
    mechanism: Mechanism, linkage: Linkage, *, crank_pin_share: float | None = None
) -> Mechanism:
    """Return one linkage's mechanism with a massless rod, its mass being lumped at the crank pin and the slider.

    crank_pin_share: fraction of the rod's mass lumped at the crank pin; b / l if None. The distance of the mass centre
    from the rod axis is lost.
    """
    share = rod_mass_share_at_crank_pin(mechanism, linkage) if crank_pin_share is None else crank_pin_share
    if not 0.0 <= share <= 1.0:
        raise InputError(f"the crank pin's share of the mass must be from 0 to 1; got {share:g}")
    radius = float(linkage.crank)
    rod = link_mass_properties(mechanism.rod, float(linkage.rod)).mass
    crank, added = link_mass_properties(mechanism.crank, radius), share * rod
    total = crank.mass + added
    centre = (crank.mass * crank.centre + added * radius) / total if total > 0.0 else 0.0
    centre_across = crank.mass * crank.centre_across / total if total > 0.0 else 0.0
    inertia = (
        crank.inertia
        + crank.mass * ((crank.centre - centre) ** 2 + (crank.centre_across - centre_across) ** 2)
        + added * ((radius - centre) ** 2 + centre_across**2)
    )
    return replace(
        mechanism,
        crank=RigidLink(mass=total, centre=centre, centre_across=centre_across, inertia=inertia),
        rod=RigidLink(mass=0.0, inertia=0.0),
        slider_mass=mechanism.slider_mass + (1.0 - share) * rod,
    )


def rotating_and_reciprocating_masses(
    mechanism: Mechanism, linkage: Linkage, *, crank_pin_share: float | None = None
) -> tuple[float, float]:
    """Return the rotating mass at the crank pin, crank included, and the reciprocating mass, kg.

    The crank contributes its first moment, m centre / r (Eq. 35 of the paper); its counterweight does not count.
    """
    length, radius = float(linkage.rod), float(linkage.crank)
    share = rod_mass_share_at_crank_pin(mechanism, linkage) if crank_pin_share is None else crank_pin_share
    rod = link_mass_properties(mechanism.rod, length).mass
    crank = link_mass_properties(mechanism.crank, radius)
    return crank.mass * crank.centre / radius + share * rod, mechanism.slider_mass + (1.0 - share) * rod
