"""Balance of one design: shaking force and moment on the frame, and what the counterweight does to them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

CURVES = (("shaking_force", "N", "SHAKING_FORCE"), ("shaking_moment", "Nm", "SHAKING_MOMENT"))


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return peaks and root mean squares of shaking force and moment of one linkage, as it is and uncounterweighted.

    Inertia forces only: gravity and load are left out (`model.dynamics.inertia`). The values without counterweight are
    None if the machine has none.
    """
    import numpy as np

    from ....model.machine.links import Counterweight
    from ....model.signals.averages import average
    from ....model.signals.peaks import find_peaks
    from ....model.signals.signals import Signal

    design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
    weight = mechanism.counterweight
    has_weight = weight.mass > 0.0
    bare = replace(mechanism, counterweight=Counterweight(mass=0.0, radius=0.0))
    values: dict[str, Any] = {"counterweight_kg": weight.mass, "counterweight_radius_mm": 1e3 * weight.radius}
    for name, unit, signal in CURVES:
        kind = Signal[signal]
        peak = find_peaks(mechanism, kind, design, kept=1)
        values[f"peak_{name}_{unit}"] = float(peak.values[0, 0])
        values[f"peak_{name}_angle_deg"] = float(np.degrees(peak.angles[0, 0]))
        values[f"rms_{name}_{unit}"] = float(average(mechanism, kind, design).rms[0])
        without = find_peaks(bare, kind, design, kept=1).values[0, 0] if has_weight else None
        values[f"peak_{name}_without_counterweight_{unit}"] = None if without is None else float(without)
        without = average(bare, kind, design).rms[0] if has_weight else None
        values[f"rms_{name}_without_counterweight_{unit}"] = None if without is None else float(without)
    return values
