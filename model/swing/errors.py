"""Sources of the error of the driven side at a crank angle of a swing."""

from __future__ import annotations

from dataclasses import dataclass

from ..linkage.linkage import Linkage
from ..linkage.single import one_linkage
from ..machine.mechanism import Mechanism
from ..tolerance.sources import SOURCES, limits
from .swing import Swing


@dataclass(frozen=True)
class Share:
    """A source of an error. limit: how far it may be off, m, the crank angle rad. error: what it adds, m or rad."""

    source: str
    limit: float
    error: float


def error_shares(mechanism: Mechanism, linkage: Linkage, swing: Swing, crank_angle: float) -> tuple[Share, ...]:
    """Return the share of each source in the worst case of the driven side at a crank angle, rad.

    Where the crank drives, |dx/di| T_i of the slider's position; where the slider does, that over |x'|, of the crank
    angle, with the actuator among the sources. Sources without tolerance are left out.
    """
    own = one_linkage(mechanism, linkage)
    i, reach = own.error_influences(crank_angle), limits(mechanism, own)
    crank, rod, offset, turn = (abs(float(each)) for each in (i.crank, i.rod, i.offset, i.crank_angle))
    rates = (crank, rod, offset, turn, rod, rod, rod, offset)
    found = [
        Share(name, float(limit), rate * float(limit)) for name, limit, rate in zip(SOURCES, reach, rates, strict=True)
    ]
    if swing.driver == "slider":
        found = [each for each in found if each.source != "crank angle"]
        found.append(Share("actuator", swing.actuator_tolerance, swing.actuator_tolerance))
        found = [Share(each.source, each.limit, each.error / turn) for each in found]
    return tuple(each for each in found if each.limit)
