"""The counterweight of least shaking, and the shaking before and after it, as numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....optimise.sizing.counterweight import Balance, Shaking


def balance_numbers(found: Balance, measure: str) -> dict[str, Any]:
    """Return a balance ready for JSON; the angle of the counterweight is from the crank's direction."""
    import numpy as np

    rod = found.rod
    weighs = rod is not None and rod.mass > 0.0
    return {
        "measure": measure,
        "counterweight_moment_kg_m": found.moment,
        "counterweight_angle_deg": float(np.degrees(found.angle)),
        "counterweight_radius_mm": 1e3 * found.radius,
        "counterweight_kg": found.mass,
        "rod_balance": None
        if rod is None
        else {
            "mass_kg": rod.mass,
            "moment_along_kg_m": rod.along,
            "moment_across_kg_m": rod.across,
            "inertia_kg_m2": rod.inertia,
            "centre_along_mm": 1e3 * rod.along / rod.mass if weighs else None,
            "centre_across_mm": 1e3 * rod.across / rod.mass if weighs else None,
        },
        "before": _shaking(found.shaking_before),
        "after": _shaking(found.shaking_after),
        "objective_N": found.objective,
        "least_possible_N": found.bound,
        "saving_N_per_kg": found.saving * found.radius,
        "rounds": found.rounds,
        "converged": found.converged,
    }


def _shaking(shaking: Shaking) -> dict[str, float]:
    import numpy as np

    return {
        "peak_shaking_force_N": shaking.peak_force,
        "peak_shaking_force_angle_deg": float(np.degrees(shaking.peak_force_angle)),
        "rms_shaking_force_N": shaking.rms_force,
        "peak_shaking_moment_Nm": shaking.peak_moment,
        "peak_shaking_moment_angle_deg": float(np.degrees(shaking.peak_moment_angle)),
        "rms_shaking_moment_Nm": shaking.rms_moment,
    }
