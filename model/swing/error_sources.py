"""Sources of the error at the driven side for a crank angle in a swing."""

from __future__ import annotations

from dataclasses import dataclass

from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_linkage, require_slider
from ..machine.mechanism import Mechanism
from ..tolerance.error_sources import SOURCES, limits_of_sources
from .swing import Swing


@dataclass(frozen=True)
class ErrorShare:
    """A source of an error. limit: its tolerance, m, or rad for the crank angle. error: its contribution, m or rad."""

    source: str
    limit: float
    error: float


def error_shares(mechanism: Mechanism, linkage: Linkage, swing: Swing, crank_angle: float) -> tuple[ErrorShare, ...]:
    """Return each source's contribution to the worst case at the driven side, for a crank angle, rad.

    If the crank drives: |dx/di| T_i for the slider position. If the slider drives: the same divided by |x'| for the
    crank angle, with the actuator among the sources. Sources without tolerance are left out.
    """
    require_slider(mechanism)
    checked = require_single_linkage(mechanism, linkage)
    i, source_limits = checked.error_influences(crank_angle), limits_of_sources(mechanism, checked)
    crank, rod, offset, turn = (abs(float(share)) for share in (i.crank, i.rod, i.offset, i.crank_angle))
    rates = (crank, rod, offset, turn, rod, rod, rod, offset)
    shares = [
        ErrorShare(name, float(limit), rate * float(limit))
        for name, limit, rate in zip(SOURCES, source_limits, rates, strict=True)
    ]
    if swing.driver == "slider":
        shares = [share for share in shares if share.source != "crank angle"]
        shares.append(ErrorShare("actuator", swing.actuator_tolerance, swing.actuator_tolerance))
        shares = [ErrorShare(share.source, share.limit, share.error / turn) for share in shares]
    return tuple(share for share in shares if share.limit)
