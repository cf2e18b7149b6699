"""Motor sizing of one design: torque, power and reflected inertia."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ...text.lines import plain

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

_SAMPLES = 2048


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return peak, RMS and mean torque, peak and mean power, and the range of the reflected inertia of one linkage.

    Torque and power are None where friction locks the linkage.
    """
    import numpy as np
    from scipy.optimize import minimize_scalar

    from ....model.cycle.shaking import shaking_curves
    from ....model.signals.averages import average, average_torque
    from ....model.signals.peaks import find_peaks
    from ....model.signals.signals import Signal

    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    torque = find_peaks(mechanism, Signal.TORQUE, design, kept=1)
    power = find_peaks(mechanism, Signal.POWER, design, kept=1)
    averages = average_torque(mechanism, design)
    greatest = find_peaks(mechanism, Signal.REFLECTED_INERTIA, design, kept=1)

    def inertia(angle: Any) -> Any:
        return shaking_curves(mechanism, linkage, angle).reflected_inertia

    turn = np.linspace(0.0, 2.0 * math.pi, _SAMPLES, endpoint=False)
    lowest, step = float(turn[np.argmin(inertia(turn))]), 2.0 * math.pi / _SAMPLES
    least = minimize_scalar(
        lambda angle: float(inertia(angle)[0]),
        bounds=(lowest - step, lowest + step),
        method="bounded",
        options={"xatol": 1e-10},
    )

    def degrees(angle: Any) -> float | None:
        return plain(np.degrees(angle) % 360.0)

    return {
        "peak_torque_Nm": plain(torque.values[0, 0]),
        "peak_torque_angle_deg": degrees(torque.angles[0, 0]),
        "rms_torque_Nm": plain(averages.rms[0]),
        "mean_torque_Nm": plain(averages.mean[0]),
        "peak_power_W": plain(power.values[0, 0]),
        "peak_power_angle_deg": degrees(power.angles[0, 0]),
        "mean_power_W": plain(mechanism.speed * averages.mean[0]),
        "greatest_reflected_inertia_kg_m2": float(greatest.values[0, 0]),
        "greatest_reflected_inertia_angle_deg": degrees(greatest.angles[0, 0]),
        "least_reflected_inertia_kg_m2": float(least.fun),
        "least_reflected_inertia_angle_deg": degrees(least.x),
        "mean_reflected_inertia_kg_m2": float(average(mechanism, Signal.REFLECTED_INERTIA, design).mean[0]),
    }
