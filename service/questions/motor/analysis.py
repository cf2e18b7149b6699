"""Motor sizing of one design: torque, power and reflected inertia."""

import math
from dataclasses import replace
from typing import Annotated, Any

import numpy as np
from scipy.optimize import minimize_scalar

from ....model.arrays import Array
from ....model.cycle.crank_speed import crank_speed_and_acceleration
from ....model.cycle.cycle import breakpoints, cycle
from ....model.cycle.multi_cylinder import multi_cylinder_curves, shaking_curves
from ....model.cycle.self_locking import locking_margin
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import TURN, cycle_turns, machine_of_each_cylinder
from ....model.machine.links_and_joints import Friction
from ....model.machine.mechanism import Mechanism
from ....model.signals.averages import signal_averages, torque_averages
from ....model.signals.motor_curves import MotorCurve, motor_averages, motor_curve
from ....model.signals.panel_polynomials import index_of_first_maximum, wrap_into_cycle
from ....model.signals.shaft_statistics import mean_speed_ratio
from ....model.signals.signals import Signal
from ....objectives.kinds import INERTIA, POWER, TORQUE
from ....objectives.machine_needs import SPEED
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, named_number, number_list
from ...text.tables import finite_or_none
from ..peaks import lengths_row, peak
from ..record_types import Note, NullIfLocked, PeakAngle, Record

Moving = Annotated[float | None, Note("null where friction locks or may jam the linkage, and without a crank speed")]


class Motor(Record):
    """Torque, power and inertia that a motor must drive; with several cylinders, totals."""

    peak_torque_Nm: NullIfLocked
    peak_torque_angle_deg: PeakAngle
    rms_torque_Nm: Annotated[float | None, Note("over time; null where friction locks or may jam the linkage")]
    mean_torque_Nm: Annotated[float | None, Note("over the crank angle; null where friction locks the linkage")]
    peak_power_W: Moving
    peak_power_angle_deg: PeakAngle
    mean_power_W: Moving
    greatest_reflected_inertia_kg_m2: float
    greatest_reflected_inertia_angle_deg: PeakAngle
    least_reflected_inertia_kg_m2: float
    least_reflected_inertia_angle_deg: PeakAngle
    mean_reflected_inertia_kg_m2: float
    """Mean over the crank angle."""


_SAMPLES = 2048
_MOST_DIPS = 64  # more minima than 24 cylinders have; with constant inertia every sample is one


def numbers(mechanism: Mechanism, linkage: Linkage) -> Motor:
    """Return peak, RMS and mean torque, peak and mean power, and the range of the reflected inertia of one linkage.

    RMS torque and mean power are over time, mean torque and mean inertia over the crank angle. Torque and power are
    None if friction locks the linkage; power is also None if there is no speed. For several cylinders the values are
    totals.
    """
    design = lengths_row(linkage)
    signals = (Signal.TORQUE, Signal.POWER, Signal.REFLECTED_INERTIA)
    torque, power, greatest = (peak(mechanism, signal, linkage) for signal in signals)
    averages, moves = torque_averages(mechanism, design), SPEED.is_met(mechanism)

    least, least_angle = _least_reflected_inertia(mechanism, linkage)
    mean_power = mean_speed_ratio(mechanism) * mechanism.speed * averages.mean[0]
    return {
        "peak_torque_Nm": finite_or_none(torque.value),
        "peak_torque_angle_deg": finite_or_none(torque.degrees),
        "rms_torque_Nm": finite_or_none(averages.rms[0]),
        "mean_torque_Nm": finite_or_none(averages.mean[0]),
        "peak_power_W": finite_or_none(power.value) if moves else None,
        "peak_power_angle_deg": finite_or_none(power.degrees) if moves else None,
        "mean_power_W": finite_or_none(mean_power) if moves else None,
        "greatest_reflected_inertia_kg_m2": greatest.value,
        "greatest_reflected_inertia_angle_deg": greatest.degrees,
        "least_reflected_inertia_kg_m2": least,
        "least_reflected_inertia_angle_deg": math.degrees(least_angle),
        "mean_reflected_inertia_kg_m2": float(signal_averages(mechanism, Signal.REFLECTED_INERTIA, design).mean[0]),
    }


def _least_reflected_inertia(mechanism: Mechanism, linkage: Linkage) -> tuple[float, float]:
    """Return the minimum of the moving inertia and its crank angle, rad; the first of equal minima."""
    angles_sampled = np.linspace(0.0, TURN, _SAMPLES, endpoint=False)
    values, step = _reflected_inertia(mechanism, linkage, angles_sampled), TURN / _SAMPLES
    dips = np.flatnonzero((values <= np.roll(values, 1)) & (values <= np.roll(values, -1)))
    size, rise = values.max(), np.abs(values - np.roll(values, 1)).max()
    minima = [
        minimize_scalar(
            lambda angle: float(_reflected_inertia(mechanism, linkage, angle)[0]),
            bounds=(lowest - step, lowest + step),
            method="bounded",
            options={"xatol": 1e-10},
        )
        for lowest in angles_sampled[dips[values[dips] <= values.min() + rise]].tolist()[:_MOST_DIPS]
    ]
    heights, angles = (np.array(part) for part in zip(*((size - at.fun, at.x) for at in minima), strict=True))
    first = minima[int(index_of_first_maximum(heights, angles, TURN))]
    return float(min(at.fun for at in minima)), wrap_into_cycle(float(first.x), TURN)


def _reflected_inertia(mechanism: Mechanism, linkage: Linkage, angle: Any) -> Any:
    """Return the moving inertia of all cylinders at crank angles (n,), rad."""
    curves = (
        shaking_curves(cylinder.mechanism, linkage, angle + cylinder.lead)
        for cylinder in machine_of_each_cylinder(mechanism)
    )
    return sum(cylinder.reflected_inertia for cylinder in curves)


def blocks(numbers: Motor) -> list[Block]:
    """Return the answer in human-readable form."""
    remarks = {
        "rms_torque_Nm": "over time; determines motor heating",
        "mean_torque_Nm": "over the crank angle",
        "mean_power_W": "over time",
        "mean_reflected_inertia_kg_m2": "over the crank angle",
    }
    if numbers["peak_power_W"] is None and numbers["peak_torque_Nm"] is not None:
        remarks |= dict.fromkeys(("peak_power_W", "mean_power_W"), SPEED.rule)
    is_defined = numbers["peak_torque_Nm"] is not None
    title = "Motor" if is_defined else "Motor: friction locks or jams the linkage, so the torque is undefined"
    keys = [key for key in numbers if not key.endswith("_angle_deg")]
    return number_list(title, [named_number(numbers, key, remarks.get(key, "")) for key in keys])


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return torque, power and reflected inertia over the cycle; torque and power are absent where friction locks."""
    design = lengths_row(linkage)
    locks = not locking_margin(mechanism.friction, design)[0][0] > 0.0
    turns = cycle_turns(mechanism)
    theta = sampled_crank_angles(
        breakpoints(replace(mechanism, friction=Friction()) if locks else mechanism, linkage), turns=turns
    )
    degrees = np.degrees(theta)
    several = mechanism.arrangement is not None
    torque = (multi_cylinder_curves if several else cycle)(mechanism, linkage, theta).torque
    averages = torque_averages(mechanism, design)
    rms, mean = float(averages.rms[0]), float(averages.mean[0] * mechanism.speed * mean_speed_ratio(mechanism))
    inertia = Line("inertia", degrees, _reflected_inertia(mechanism, linkage, theta))
    usual = float(signal_averages(mechanism, Signal.REFLECTED_INERTIA, design).mean[0])
    power = Line("power", degrees, torque * crank_speed_and_acceleration(mechanism, theta)[0])
    levels = (None, None) if locks else (("RMS over time", rms), ("mean over time", mean))
    panels = (
        crank_angle_panel("drive torque", Line("torque", degrees, torque), kind=TORQUE, level=levels[0]),
        crank_angle_panel("power", power, kind=POWER, level=levels[1]),
        crank_angle_panel("reflected inertia", inertia, kind=INERTIA, level=("mean", usual)),
        *([_motor_torque_panel(mechanism, linkage, theta)] if mechanism.drive and not locks else []),
    )
    return PanelFigure("Motor torque and power over the cycle", "", panels, width=6.4, height=2.25, stacked=True)


def _motor_torque_panel(mechanism: Mechanism, linkage: Linkage, theta: Array) -> Panel:
    design = lengths_row(linkage)
    line = Line("motor torque", np.degrees(theta), motor_curve(mechanism, design, theta, MotorCurve.TORQUE))
    rms = float(motor_averages(mechanism, design, MotorCurve.TORQUE, False).rms[0])
    return crank_angle_panel("motor torque", line, kind=TORQUE, level=("RMS over time", rms))
