"""Balance of one design: shaking force and moment on the frame, and the effect of the counterweight."""

from dataclasses import replace
from typing import Annotated, NamedTuple

import numpy as np

from ....model.arrays import Array
from ....model.cycle.multi_cylinder import MultiCylinderCurves, ShakingCurves, multi_cylinder_curves, shaking_curves
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.links_and_joints import Counterweight
from ....model.machine.mechanism import Mechanism
from ....model.signals.averages import signal_averages
from ....model.signals.signals import Signal
from ....objectives.kinds import FORCE, TORQUE
from ....objectives.machine_needs import MOTION
from ...figures.panel_figure import Line, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, NamedNumber, joined, named_number, number_list, remark_with_value
from ..peaks import Peak, lengths_row, peak
from ..record_types import Note, ShakingNumbers

Bare = Annotated[float | None, Note("null without a counterweight")]


class Shaking(ShakingNumbers):
    """Inertia force and moment on the frame, without gravity and loads; root mean squares are over time."""

    counterweight_kg: float
    counterweight_radius_mm: float
    peak_shaking_force_without_counterweight_N: Bare
    rms_shaking_force_without_counterweight_N: Bare
    peak_shaking_moment_without_counterweight_Nm: Bare
    rms_shaking_moment_without_counterweight_Nm: Bare


_CURVES = (("shaking_force", "N", Signal.SHAKING_FORCE), ("shaking_moment", "Nm", Signal.SHAKING_MOMENT))


def _without_counterweight(mechanism: Mechanism) -> Mechanism | None:
    """Return the mechanism without its counterweight; None if it has none."""
    if not mechanism.counterweight.mass > 0.0:
        return None
    return replace(mechanism, counterweight=Counterweight(mass=0.0, radius=0.0))


def numbers(mechanism: Mechanism, linkage: Linkage) -> Shaking:
    """Return peaks and root mean squares of shaking force and moment of one linkage, with and without counterweight.

    Root mean squares are over time. Inertia forces only: gravity and load are ignored (`model.dynamics.torque`).
    Values without counterweight are None if the machine has none. Raises `InputError` if the crank has no speed.
    """
    if not MOTION.is_met(mechanism):
        raise InputError(MOTION.missing)
    weight, bare = mechanism.counterweight, _without_counterweight(mechanism)
    force, moment = (_peak_and_rms_of_shaking(mechanism, signal, linkage) for *_, signal in _CURVES)
    force_bare, moment_bare = (
        None if bare is None else _peak_and_rms_of_shaking(bare, signal, linkage) for *_, signal in _CURVES
    )
    return {
        "counterweight_kg": weight.mass,
        "counterweight_radius_mm": 1e3 * weight.radius,
        "peak_shaking_force_N": force.peak.value,
        "peak_shaking_force_angle_deg": force.peak.degrees,
        "rms_shaking_force_N": force.rms,
        "peak_shaking_force_without_counterweight_N": None if force_bare is None else force_bare.peak.value,
        "rms_shaking_force_without_counterweight_N": None if force_bare is None else force_bare.rms,
        "peak_shaking_moment_Nm": moment.peak.value,
        "peak_shaking_moment_angle_deg": moment.peak.degrees,
        "rms_shaking_moment_Nm": moment.rms,
        "peak_shaking_moment_without_counterweight_Nm": None if moment_bare is None else moment_bare.peak.value,
        "rms_shaking_moment_without_counterweight_Nm": None if moment_bare is None else moment_bare.rms,
    }


class _Shaking(NamedTuple):
    peak: Peak
    rms: float


def _peak_and_rms_of_shaking(mechanism: Mechanism, signal: Signal, linkage: Linkage) -> _Shaking:
    rms = signal_averages(mechanism, signal, lengths_row(linkage)).rms[0]
    return _Shaking(peak(mechanism, signal, linkage), float(rms))


def _shaking_curves_of(mechanism: Mechanism, linkage: Linkage, theta: Array) -> ShakingCurves | MultiCylinderCurves:
    """Return the shaking of all cylinders at crank angles (n,), rad."""
    if mechanism.arrangement is not None:
        return multi_cylinder_curves(mechanism, linkage, theta)
    return shaking_curves(mechanism, linkage, theta)


def blocks(numbers: Shaking) -> list[Block]:
    """Return the answer in human-readable form."""
    lines: list[NamedNumber] = []
    for name, unit, _ in _CURVES:
        for statistic in ("peak", "rms"):
            bare_key = f"{statistic}_{name}_without_counterweight_{unit}"
            remarks = (
                "over time" if statistic == "rms" else "",
                remark_with_value(numbers, bare_key, "without counterweight"),
            )
            lines.append(named_number(numbers, f"{statistic}_{name}_{unit}", joined(remarks)))
    title = "Balance (inertia forces on the frame, without gravity and loads; moment about the crank pivot)"
    return number_list(title, lines)


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return shaking force and moment over the cycle, with and without the counterweight."""
    theta, bare = sampled_crank_angles(), _without_counterweight(mechanism)
    degrees, now = np.degrees(theta), _shaking_curves_of(mechanism, linkage, theta)
    size, moment = (
        [Line("as it is", degrees, np.hypot(now.force_x, now.force_y))],
        [Line("as it is", degrees, now.moment)],
    )
    if bare is not None:
        then = _shaking_curves_of(bare, linkage, theta)
        size.append(Line("without counterweight", degrees, np.hypot(then.force_x, then.force_y), 1))
        moment.append(Line("without counterweight", degrees, then.moment, 1))
    force_x, force_y = Line("along the slider line", degrees, now.force_x), Line("across", degrees, now.force_y, 1)
    panels = (
        crank_angle_panel("shaking force", *size, kind=FORCE),
        crank_angle_panel("its components", force_x, force_y, kind=FORCE),
        crank_angle_panel("shaking moment about the crank pivot", *moment, kind=TORQUE),
    )
    return PanelFigure("Shaking force and moment on the frame", "", panels, width=6.4, height=2.25, stacked=True)
