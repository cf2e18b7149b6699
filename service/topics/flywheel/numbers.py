"""The flywheel that a machine needs, in numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ....model.errors import InputError
from ..start_up.numbers import steady_numbers

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

FLUCTUATION = 0.02
"""Wanted unless asked otherwise: pumps and machine tools (1/30 to 1/50 in textbooks)."""
_RPM = 30.0 / math.pi
_TRIED = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)


def numbers(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION) -> dict[str, Any]:
    """Return the flywheel for a coefficient of speed fluctuation, and those for others, ready for JSON."""
    from ....model.transient.flywheel import design_flywheel

    found = design_flywheel(mechanism, linkage, fluctuation)
    table = [design_flywheel(mechanism, linkage, wanted) for wanted in _TRIED]
    bare = _without(mechanism, linkage)
    return {
        "motor": "constant torque" if mechanism.drive is None else type(mechanism.drive.motor).__name__,
        "wanted_fluctuation": fluctuation,
        "flywheel_kgm2": found.inertia,
        "classical_estimate_kgm2": found.estimate,
        "fluctuation_without_flywheel": None if bare is None else bare[0],
        "least_speed_without_flywheel_rpm": None if bare is None else _RPM * bare[1],
        "steady": steady_numbers(found.running),
        "fluctuations": list(_TRIED),
        "flywheels_kgm2": [design.inertia for design in table],
        "classical_estimates_kgm2": [design.estimate for design in table],
    }


def _without(mechanism: Mechanism, linkage: Linkage) -> tuple[float, float] | None:
    """Return fluctuation and least speed, rad/s, of the machine without a flywheel; None if no running is found."""
    from dataclasses import replace

    from ....model.transient.steady import Runner

    runner, drive = Runner(mechanism, linkage), mechanism.drive
    try:
        if drive is None:
            least, greatest = runner.speeds(0.0)
            return (greatest - least) / runner.speed, least
        running = runner.under(replace(drive, flywheel=0.0))
        return running.fluctuation, float(abs(running.speed).min())
    except InputError:
        return None
