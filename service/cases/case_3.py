"""Case 3: the in-line slider-crank. The report prints formulas only; both sides are evaluated for one example."""

import math

from ...model.classical.loop_equations import static_forces
from ...model.linkage.inverse_kinematics import crank_angle_at
from ...model.linkage.linkage import Linkage
from .printed_values import Numbers

LINKAGE = Linkage(0.050, 0.150)
ANGLE, SPEED, LOAD = math.radians(60.0), 10.0, -100.0


def computed_values() -> Numbers:
    """Return the values of the model and those of the report's formulas, by key."""
    at = LINKAGE.at(ANGLE, speed=SPEED)
    x = float(at.slider_position)
    forces = static_forces(LINKAGE, ANGLE, load=LOAD)
    second = float(crank_angle_at(LINKAGE, x, solution="outward"))
    exact = {
        "angle_1": 0.0,
        "angle_from_position": math.degrees(float(crank_angle_at(LINKAGE, x, solution="inward"))),
        "second_angle": math.degrees(second),
        "rod_angle": math.degrees(float(at.rod_angle)),
        "program_position": 1e3 * x,
        "rod_velocity": float(at.rod_velocity),
        "slider_velocity": 1e3 * float(at.slider_velocity),
        "program_crank_speed": SPEED,
        "rod_acceleration": float(at.rod_acceleration),
        "slider_acceleration": 1e3 * float(at.slider_acceleration),
        "rod_force": float(forces.rod_force),
        "guide_reaction": abs(float(forces.guide_reaction)),
        "crank_torque": float(forces.crank_torque),
        "crank_torque_size": float(forces.crank_torque),
        "mechanical_advantage": float(forces.mechanical_advantage),
    }
    return Numbers(exact, values_of_printed_formulas(x))


def values_of_printed_formulas(r1: float) -> dict[str, float]:
    """Return the values of the report's formulas in its own notation: r_1 position, r_2 crank, r_3 rod."""
    r2, r3, t2, w2, p = float(LINKAGE.crank), float(LINKAGE.rod), ANGLE, SPEED, -LOAD
    t3 = math.asin(-r2 * math.sin(t2) / r3)
    w3 = -r2 * w2 * math.cos(t2) / (r3 * math.cos(t3))
    a3 = (-r2 * w2**2 * math.sin(t2) - r3 * w3**2 * math.sin(t3)) / (r3 * math.cos(t3))
    n = r3 / r2
    return {
        "angle_from_position": math.degrees(math.acos((r3**2 - (r1**2 + r2**2)) / (-2.0 * r1 * r2))),
        "second_angle": 180.0 + math.degrees(t2),
        "rod_angle": math.degrees(t3),
        "program_position": 1e3 * (r2 * math.cos(t2) + r3 * math.cos(math.radians(t3))),
        "rod_velocity": w3,
        "slider_velocity": -1e3 * (r2 * w2 * math.sin(t2) + r3 * w3 * math.sin(t3)),
        "program_crank_speed": (r1 / r2 - 1.0) * 2.0 * n / (math.sin(2.0 * t2) + 2.0 * n * math.sin(t2)),
        "rod_acceleration": a3,
        "slider_acceleration": 1e3 * (-r2 * w2**2 * math.cos(t2) - r3 * a3 * math.sin(t3) - r3 * w3**2 * math.cos(t3)),
        "rod_force": p / math.cos(t3),
        "guide_reaction": abs(p * math.tan(t3)),
        "crank_torque": -p * r2 * (math.sin(t2) + math.cos(t2) * math.tan(t3)),
        "crank_torque_size": -p * r2 * (math.sin(t2) + math.cos(t2) * math.tan(abs(t3))),
    }
