"""Friction of one design: self-locking, what friction adds to torque and forces, where the work of a turn goes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...text.lines import plain

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return verdict, torque with and without friction, energies of a turn and efficiency of one linkage.

    What is not defined is None: torques and energies of a linkage that locks, the efficiency if the load takes no net
    work.
    """
    import numpy as np

    from ....model.cycle.efficiency import energies
    from ....model.cycle.locked_angles import verdict
    from ....model.machine.friction import Friction
    from ....model.signals.averages import average_torque
    from ....model.signals.peaks import find_peaks
    from ....model.signals.signals import Signal

    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    friction = mechanism.friction
    found = verdict(mechanism, linkage)
    smooth = replace(mechanism, friction=Friction())
    circles = friction.crank_pin.circle + friction.slider_pin.circle
    pins = circles / float(linkage.rod)

    def peak(of: Mechanism, kind: Signal) -> float | None:
        return plain(find_peaks(of, kind, design, kept=1).values[0, 0])

    values: dict[str, Any] = {
        "verdict": "drives" if found.holds is None and not found.locks else _word(found.holds),
        "self_locking_margin_deg": plain(math.degrees(found.margin)),
        "least_transmission_angle_deg": math.degrees(float(linkage.least_transmission_angle)),
        "guide_friction_angle_deg": math.degrees(math.atan(friction.guide)),
        "pin_friction_angle_deg": math.degrees(math.asin(pins)) if pins < 1.0 else None,
        "locked_angles_deg": [[math.degrees(a) % 360.0, math.degrees(b) % 360.0] for a, b in found.locked],
        "peak_torque_Nm": peak(mechanism, Signal.TORQUE),
        "peak_torque_without_friction_Nm": peak(smooth, Signal.TORQUE),
        "mean_torque_Nm": plain(average_torque(mechanism, design).mean[0]),
        "mean_torque_without_friction_Nm": plain(average_torque(smooth, design).mean[0]),
        "peak_guide_force_N": peak(mechanism, Signal.GUIDE_FORCE),
        "peak_guide_force_without_friction_N": peak(smooth, Signal.GUIDE_FORCE),
    }
    work = None if found.locks else energies(mechanism, linkage)
    for key, name in (
        ("input_work_J", "input"),
        ("useful_work_J", "useful"),
        ("friction_heat_J", "heat"),
        ("guide_heat_J", "guide_heat"),
        ("crank_pivot_heat_J", "crank_pivot_heat"),
        ("crank_pin_heat_J", "crank_pin_heat"),
        ("slider_pin_heat_J", "slider_pin_heat"),
        ("efficiency", "efficiency"),
    ):
        values[key] = None if work is None else getattr(work, name)
    return values


def _word(holds: float | None) -> str:
    if holds is None:  # a single angle, at a margin of exactly zero
        return "may jam"
    return "locks" if holds == 1.0 else "may jam" if holds == 0.0 else "locks or may jam"
