"""Case 5: the feeder, with the offset of the mirror image, and the paper's experiment."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from ...model.arrays import Array
from ...model.classical.approximations import (
    drive_torque_equation_48,
    rotating_and_reciprocating_masses,
    series_acceleration,
    series_torque,
)
from ...model.linkage.linkage import Linkage
from ...model.machine.links_and_joints import RigidLink
from ...model.machine.mechanism import Mechanism
from ...model.signals.peaks import find_peaks
from ...model.signals.signals import Signal
from .printed_values import Numbers

CRANK, ROD, SPEED = 0.040, 0.064, 251.0
OFFSETS = (0.0, 0.010, 0.020)
MACHINE = Mechanism(speed=SPEED, crank=RigidLink(mass=0.2), rod=RigidLink(mass=0.5), slider_mass=0.8)
EXPERIMENT, EXPERIMENT_SPEED = Linkage(0.0381, 0.1524), 20.994
_RPM = 2.0 * math.pi / 60.0
_TURN = 2.0 * math.pi


def feeder_linkage(offset: float) -> Linkage:
    """Return the feeder for the paper's offset, m."""
    return Linkage(CRANK, ROD, -offset)


def rotating_and_reciprocating_mass() -> tuple[float, float]:
    """Return the rotating and the reciprocating mass, kg, with both links split in half as in the paper."""
    return rotating_and_reciprocating_masses(MACHINE, feeder_linkage(0.020))


def exact_torque(offset: float, crank_angle: Array) -> Array:
    """Return the drive torque against the inertia of the reciprocating mass, N m. By virtual work: m3 x_t x_tt / w."""
    at = feeder_linkage(offset).at(crank_angle, speed=SPEED)
    torque: Array = rotating_and_reciprocating_mass()[1] * at.slider_velocity * at.slider_acceleration / SPEED
    return torque


def formula_torque(offset: float, crank_angle: Array, *, as_equation_20: bool = False) -> Array:
    """Return the drive torque T = k F_i tan(alpha), N m, in one of its two readings."""
    rotating, reciprocating = rotating_and_reciprocating_mass()
    torque: Array = drive_torque_equation_48(
        feeder_linkage(offset),
        crank_angle,
        speed=SPEED,
        rotating_mass=rotating,
        reciprocating_mass=reciprocating,
        as_equation_20=as_equation_20,
    )
    return torque


def computed_values() -> Numbers:
    """Return the values of the model and those of the paper's formulas, by key."""
    feeder, half = feeder_linkage(0.020), feeder_linkage(0.010)
    inner, outer = (float(angle) for angle in feeder.dead_centre_angles)
    forward = (outer - inner) % _TURN
    rotating, reciprocating = rotating_and_reciprocating_mass()
    exact = {
        "speed": 2400.0 * _RPM,
        "rod": 3.2 * 20.0,
        "greatest_crank_to_offset": 3.2 - 1.0,
        "stroke": 1e3 * float(feeder.stroke),
        "stroke_10": 1e3 * float(half.stroke),
        "excess_angle": math.degrees(forward) - 180.0,
        "forward_angle": math.degrees(forward),
        "return_angle": 360.0 - math.degrees(forward),
        "inner_dead_centre": math.degrees(inner),
        "outer_dead_centre": math.degrees(outer),
        "forward_time": forward / SPEED,
        "return_time": (_TURN - forward) / SPEED,
        "period": _TURN / SPEED,
        "cycles": (0.06 - 0.01) * SPEED / _TURN,
        "time_ratio": float(feeder.time_ratio),
        "time_ratio_10": float(half.time_ratio),
        "least_transmission_angle": math.degrees(float(feeder.least_transmission_angle)),
        "greatest_rod_angle": 90.0 - math.degrees(float(feeder.least_transmission_angle)),
        "rotating_mass": rotating,
        "reciprocating_mass": reciprocating,
        **_greatest_torques(),
    }
    ends = EXPERIMENT.at([math.pi, 0.0], speed=EXPERIMENT_SPEED).slider_acceleration
    series = series_acceleration(EXPERIMENT, [math.pi, 0.0], speed=EXPERIMENT_SPEED)
    exact |= {
        "experiment_speed": 200.0 * _RPM,
        "experiment_max": float(ends[0]),
        "experiment_min": float(ends[1]),
        "experiment_series_max": float(series[0]),
        "experiment_series_min": float(series[1]),
    }
    centred, at = feeder_linkage(0.0), feeder.at(math.radians(30.0), speed=SPEED)
    sixty = math.radians(60.0)
    exact |= {
        "series_acceleration_0": float(centred.at(0.0, speed=SPEED).slider_acceleration),
        "series_acceleration_60": float(centred.at(sixty, speed=SPEED).slider_acceleration),
        "series_torque_60": float(exact_torque(0.0, np.array(sixty))),
        "equation_10": 1e3 * (CRANK + ROD - float(at.slider_position)),
        "equation_13": -float(at.slider_velocity),
        "equation_20": float(at.slider_acceleration),
        "equation_20_mended": float(at.slider_acceleration),
        "equation_22": -math.degrees(float(at.rod_angle)),
        "equation_27": -float(at.rod_velocity),
        "equation_30": -float(at.rod_acceleration),
        "equation_42b": -reciprocating * float(at.slider_acceleration),
    }
    printed = {
        "series_acceleration_0": float(series_acceleration(centred, 0.0, speed=SPEED)),
        "series_acceleration_60": float(series_acceleration(centred, sixty, speed=SPEED)),
        "series_torque_60": float(series_torque(centred, sixty, speed=SPEED, reciprocating_mass=reciprocating)),
        **values_of_printed_formulas(math.radians(30.0), 0.020),
    }
    return Numbers(exact, printed)


def values_of_printed_formulas(t: float, e: float) -> dict[str, float]:
    """Return the values of the paper's equations as printed, in its own notation; lengths in m."""
    k, c, w, m3 = CRANK, ROD, SPEED, rotating_and_reciprocating_mass()[1]
    sine, cosine = math.sin(t), math.cos(t)
    h = e + k * sine
    square_of_cosine = c**2 - h**2

    def equation_20(first: float, second: float) -> float:
        term = w**2 * k * (k * math.cos(2.0 * t) - e * sine) / math.pow(square_of_cosine, first)
        return -(w**2) * k * cosine - term - (w * k * cosine * h) ** 2 / math.pow(square_of_cosine, second)

    return {
        "equation_10": 1e3 * ((k + c) - k * cosine + square_of_cosine**0.5),
        "equation_13": w * k * sine + w * k * cosine * h / square_of_cosine**0.5,
        "equation_20": equation_20(1.5, 2.5),
        "equation_20_mended": equation_20(0.5, 1.5),
        "equation_22": math.degrees(math.asin(e / c + k / c * sine)),
        "equation_27": w * k * cosine / square_of_cosine**0.5,
        "equation_30": -(w**2) * k * sine / square_of_cosine**0.5 - (w * k * cosine) ** 2 * h / square_of_cosine**1.5,
        "equation_42b": m3
        * (
            w**2 * k * cosine
            + w**2 * k * (k - 2.0 * k * sine**2 - sine) / square_of_cosine**0.5
            - (w * k * cosine * h) ** 2 / square_of_cosine**1.5
        ),
    }


def _greatest_torques() -> dict[str, float]:
    """Return the peak torques, N m: exact ones and those by the paper's formula."""
    torques: dict[str, float] = {}
    _, reciprocating = rotating_and_reciprocating_mass()
    machine = Mechanism(speed=SPEED, slider_mass=reciprocating)  # as in the paper, with all moving mass on the slider
    for offset in OFFSETS:
        name = f"{1e3 * offset:.0f}"
        designs = np.array([[CRANK, ROD, -offset]])
        torques[f"torque_{name}"] = float(find_peaks(machine, Signal.TORQUE, designs).values[0, 0])
        torques[f"formula_s_{name}"] = _greatest_magnitude(partial(formula_torque, offset), 0.0, _TURN)
        torques[f"formula_20_{name}"] = _greatest_magnitude(
            partial(formula_torque, offset, as_equation_20=True), 0.0, _TURN
        )
    for offset in OFFSETS[1:]:
        inner, outer = (float(angle) for angle in feeder_linkage(offset).dead_centre_angles)
        strokes = {
            "forward": (inner, inner + (outer - inner) % _TURN),
            "return": (outer, outer + (inner - outer) % _TURN),
        }
        for stroke, ends in strokes.items():
            torques[f"{stroke}_torque_{1e3 * offset:.0f}"] = _greatest_magnitude(partial(exact_torque, offset), *ends)
    return torques


def _greatest_magnitude(curve: Callable[[Array], Array], start: float, end: float) -> float:
    """Return the greatest magnitude of a smooth curve over an interval: sampled, then refined between samples."""
    from scipy.optimize import minimize_scalar

    angles = np.linspace(start, end, 2001)
    best = int(np.argmax(np.abs(curve(angles))))
    low, high = float(angles[max(best - 1, 0)]), float(angles[min(best + 1, len(angles) - 1)])
    minimum = minimize_scalar(
        lambda t: -float(np.abs(curve(np.array(t)))),
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-11},
    )
    return float(np.abs(curve(np.array(minimum.x))))
