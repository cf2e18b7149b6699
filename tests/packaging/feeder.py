"""The numbers of the worked example in docs/theory.md, computed by the code."""

from __future__ import annotations

import math

import numpy as np

from slidercrank.model.classical.loop_equations import static_forces
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import shaking_curves
from slidercrank.model.cycle.self_locking import locking_margin
from slidercrank.model.kinematics import geometry
from slidercrank.model.kinematics.position import motion
from slidercrank.model.linkage.inverse_kinematics import crank_angle_at, crank_from_stroke
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.model.signals.averages import signal_averages, torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.tolerance.exact_worst_case import first_order_position_errors, position_deviation_extremes

FEEDER = Linkage(0.040, 0.064, -0.020)
ANGLE = math.radians(30.0)
MACHINE = Mechanism(
    speed=251.0,
    crank=RigidLink(mass=0.2),
    rod=RigidLink(mass=0.5),
    slider_mass=0.8,
    tolerances=Tolerances(
        crank=Tolerance(absolute=0.05e-3),
        rod=Tolerance(absolute=0.1e-3),
        offset=Tolerance(absolute=0.05e-3),
        crank_angle=Tolerance(absolute=math.radians(0.1)),
    ),
)
PIN = Pin(radius=0.010, coefficient=0.1)
_DESIGN = np.array([[0.040, 0.064, -0.020]])


def numbers() -> dict[str, float]:
    """Return the numbers by the names and in the units of the page's table."""
    return {**_closed_forms(), **_kinematics(), **_forces(), **_cycle(), **_errors()}


def _closed_forms() -> dict[str, float]:
    inner, outer = (math.degrees(angle) for angle in FEEDER.dead_centre_angles)
    friction = Friction(guide=0.1, crank_pivot=PIN, crank_pin=PIN, slider_pin=PIN)
    return {
        "inner dead centre, position": 1e3 * float(FEEDER.dead_centres[0]),
        "outer dead centre, position": 1e3 * float(FEEDER.dead_centres[1]),
        "inner dead centre, crank angle": inner,
        "outer dead centre, crank angle": outer,
        "stroke": 1e3 * float(FEEDER.stroke),
        "excess angle, magnitude": math.degrees(geometry.excess_stroke_angle(0.040, 0.064, 0.020)),
        "time ratio": float(FEEDER.time_ratio),
        "least transmission angle": math.degrees(float(FEEDER.least_transmission_angle)),
        "crank from this stroke": 1e3 * float(crank_from_stroke(FEEDER.stroke, rod=0.064, offset=-0.020)),
        "self-locking margin with friction": math.degrees(float(locking_margin(friction, _DESIGN)[0][0])),
    }


def _kinematics() -> dict[str, float]:
    m = motion(math.sin(ANGLE), math.cos(ANGLE), 0.040, 0.064, -0.020, 1.0)
    at = FEEDER.at(ANGLE, speed=251.0)
    return {
        "rod across": 1e3 * float(m.l_sin),
        "rod along": 1e3 * float(m.l_cos),
        "rod angle": math.degrees(float(at.rod_angle)),
        "transmission angle": math.degrees(float(at.transmission_angle)),
        "slider position": 1e3 * float(m.x),
        "rod angle, first derivative": float(m.rod_1),
        "rod angle, second derivative": float(m.rod_2),
        "slider position, first derivative": 1e3 * float(m.x_1),
        "slider position, second derivative": 1e3 * float(m.x_2),
        "slider velocity": float(at.slider_velocity),
        "slider acceleration": float(at.slider_acceleration),
        "crank angle recovered from the position": math.degrees(float(crank_angle_at(FEEDER, m.x, solution="inward"))),
    }


def _forces() -> dict[str, float]:
    at = cycle(MACHINE, FEEDER, [ANGLE])
    shaking = shaking_curves(MACHINE, FEEDER, ANGLE)
    static = static_forces(FEEDER, ANGLE, load=-500.0)
    return {
        "reflected inertia": 1e3 * float(shaking.reflected_inertia[0]),
        "drive torque": float(at.torque[0]),
        "force of rod on slider, x": float(at.slider_pin_x[0]),
        "force of rod on slider, y": float(at.slider_pin_y[0]),
        "force of guide on slider": float(at.guide[0]),
        "shaking moment": float(shaking.moment[0]),
        "static rod force for a load of -500 N": float(static.rod_force),
        "static guide force for this load": float(static.guide_reaction),
        "static crank torque for this load": float(static.crank_torque),
    }


def _cycle() -> dict[str, float]:
    def peak(kind: Signal, mechanism: Mechanism = MACHINE) -> tuple[float, float]:
        found = find_peaks(mechanism, kind, _DESIGN, limit=1)
        return float(found.values[0, 0]), math.degrees(float(found.angles[0, 0]))

    torque, angle = peak(Signal.TORQUE)
    slopes = find_peaks(MACHINE, Signal.TORQUE, _DESIGN, limit=1, gradients=True).gradients
    assert slopes is not None
    return {
        "peak torque": torque,
        "peak torque at crank angle": angle,
        "peak torque per mm of rod": 1e-3 * float(slopes[0, 0, 1]),
        "RMS torque over time": float(torque_averages(MACHINE, _DESIGN).rms[0]),
        "peak torque, mass of 1.05 kg on the slider alone": peak(
            Signal.TORQUE, Mechanism(speed=251.0, slider_mass=1.05)
        )[0],
        "peak power": 1e-3 * peak(Signal.POWER)[0],
        "peak shaking force": peak(Signal.SHAKING_FORCE)[0],
        "RMS shaking force over time": float(signal_averages(MACHINE, Signal.SHAKING_FORCE, _DESIGN).rms[0]),
    }


def _errors() -> dict[str, float]:
    influences = FEEDER.error_influences(ANGLE)
    first = first_order_position_errors(MACHINE, FEEDER, [ANGLE])
    exact = position_deviation_extremes(MACHINE, FEEDER, [ANGLE])
    return {
        "influence of the crank": float(influences.crank),
        "influence of the rod": float(influences.rod),
        "influence of the offset": float(influences.offset),
        "influence of the crank angle": 1e3 * float(influences.crank_angle) * math.radians(1.0),
        "position error, worst case": 1e3 * float(first.worst_case[0]),
        "position error, exact worst case": 1e3 * float(exact.largest_magnitude[0]),
        "bound on the first-order error": 1e3 * float(first.remainder[0]),
        "position error, root-sum-square": 1e3 * float(first.root_sum_square[0]),
        "worst case, greatest over the cycle": 1e3
        * float(find_peaks(MACHINE, Signal.POSITION_ERROR, _DESIGN, limit=1).values[0, 0]),
    }
