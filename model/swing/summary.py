"""A swing in numbers: drive, holding forces, energies, transmission angle and error at the driven side.

Sources of the error at the driven side for a crank angle in a swing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_linkage, require_slider
from ..machine.clearance import Friction
from ..machine.mechanism import Mechanism
from ..tolerance.error_distributions import SOURCES, limits_of_sources
from .swing import Swing, require_swing, swing_between_crank_angles, without_inertia
from .swing_cycle import SwingCycle, SwingPoint


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


@dataclass(frozen=True)
class SwingSummary:
    """One linkage over a swing, SI and radians.

    driver_ends: crank angles or slider positions. swing_angle, travel: magnitudes of the motion of crank and slider.
    peak_drive: maximum magnitude of the driver's torque or force, in either stroke. drive_start, drive_end: drive at
    each end on the forward and on the return stroke, without inertia. With negligible friction, both hold the linkage
    at rest; with friction, any force between them does. holds: whether friction alone holds the linkage at rest
    throughout the swing. energy_forward, energy_back: energy from the driver on the forward and return strokes, J.
    stored: energy in the slow forward stroke without friction, J. efficiency: energy without friction divided by energy
    with friction, on the slow forward stroke, otherwise the slow return stroke; None if neither is driven. peak_power:
    W, None for a slow swing. least_transmission: minimum transmission angle at the driven side.
    position_error: maximum over the swing, None without tolerances. If friction may lock the linkage, `locked` is the
    first such place, and peaks and energies are NaN.
    """

    swing: Swing
    linkage: Linkage
    crank_angles: tuple[float, float]
    slider_positions: tuple[float, float]
    peak_drive: SwingPoint
    drive_start: tuple[float, float]
    drive_end: tuple[float, float]
    holds: bool
    energy_forward: float
    energy_back: float
    stored: float
    efficiency: float | None
    peak_power: SwingPoint | None
    least_transmission: SwingPoint
    position_error: SwingPoint | None
    locked: SwingPoint | None

    @property
    def swing_angle(self) -> float:
        """Crank rotation in one stroke."""
        return abs(self.crank_angles[1] - self.crank_angles[0])

    @property
    def travel(self) -> float:
        """Distance between the slider positions at both ends; if the crank drives, the slider may pass them."""
        return abs(self.slider_positions[1] - self.slider_positions[0])


def summarise(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> SwingSummary:
    """Return the numbers for a swing. Peaks are over the continuous crank angle; energies are integrals between kinks.

    Raises the errors of `require_swing`.
    """
    checked = require_swing(mechanism, linkage, swing)
    swing = swing_between_crank_angles(mechanism, checked, swing)
    cycle = SwingCycle(mechanism, checked, swing)
    ends = np.array([0.0, 1.0])
    slow = SwingCycle(mechanism, checked, without_inertia(swing))
    still = slow.curves(ends), slow.curves(ends, back=True)
    free = SwingCycle(replace(mechanism, friction=Friction()), checked, slow.swing)
    locked = cycle.first_locked()
    peak = cycle.greatest("drive")
    power = None if swing.duration is None else cycle.greatest("power")
    if locked is not None:  # near that place the drive grows without bound
        peak, power = locked, None if power is None else locked
    tolerances = mechanism.tolerances.are_stated or swing.actuator_tolerance > 0.0
    return SwingSummary(
        swing=swing,
        linkage=checked,
        crank_angles=(swing.start, swing.end),
        slider_positions=(float(still[0].slider_position[0]), float(still[0].slider_position[1])),
        peak_drive=peak,
        drive_start=(float(still[0].drive[0]), float(still[1].drive[1])),
        drive_end=(float(still[0].drive[1]), float(still[1].drive[0])),
        holds=slow.friction_holds(),
        energy_forward=cycle.driver_work(back=False),
        energy_back=cycle.driver_work(back=True),
        stored=free.driver_work(back=False),
        efficiency=None if locked else _drive_efficiency(slow, free),
        peak_power=power,
        least_transmission=cycle.least("driven_angle"),
        position_error=cycle.greatest("driven_error") if tolerances else None,
        locked=locked,
    )


def _drive_efficiency(slow: SwingCycle, free: SwingCycle) -> float | None:
    """Return the energy without friction divided by that with friction, for the first driven stroke."""
    for back in (False, True):
        least, spent = free.driver_work(back=back), slow.driver_work(back=back)
        if least > 0.0 and spent > 0.0:
            return least / spent
    return None
