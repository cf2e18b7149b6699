"""Static forces of one design over the cycle: loads only, without masses, gravity and friction."""

import math
from dataclasses import replace
from typing import Annotated

import numpy as np

from ....model.classical.loop_equations import static_forces
from ....model.cycle.cycle import cycle
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns
from ....model.machine.links_and_joints import Counterweight, Friction, RigidLink
from ....model.machine.loads.load import Load
from ....model.machine.loads.stroke_force import StrokeForce
from ....model.machine.mechanism import Mechanism
from ....model.signals.signals import Signal
from ....objectives.kinds import ANGLE, FORCE, TORQUE
from ...figures.panel_figure import Line, PanelFigure, crank_angle_panel
from ...render.blocks import (
    Block,
    Table,
    Text,
    column,
    dimensions_text,
    heading,
    joined,
    sentence,
    value_from_record,
    values_from_record,
    words,
)
from ..peaks import peak
from ..record_types import Note, PeakAngle, Record


class StaticForces(Record):
    """Forces of the loads only: peaks over the cycle, and lists at crank angles every 30 deg."""

    load: str
    """Loads on the slider."""
    peak_rod_force_N: float
    peak_rod_force_angle_deg: PeakAngle
    peak_guide_reaction_N: float
    peak_guide_reaction_angle_deg: PeakAngle
    peak_crank_torque_Nm: float
    peak_crank_torque_angle_deg: PeakAngle
    least_mechanical_advantage: float
    """Ratio of slider load to tangential crank pin force."""
    least_mechanical_advantage_angle_deg: PeakAngle
    crank_angle_deg: list[float]
    load_N: list[float]
    rod_force_N: list[float]
    guide_reaction_N: list[float]
    crank_torque_Nm: list[float]
    mechanical_advantage: list[Annotated[float | None, Note("null at a dead centre, where it is unbounded")]]


_JOB_LOADS = "loads of the job"
_STEP = 30
_MOST_ADVANTAGE = 10.0  # larger values show only that a dead centre is near


def massless_mechanism(mechanism: Mechanism, load: float | None = None) -> Mechanism:
    """Return the mechanism without masses, gravity and friction, optionally with a constant load, N outward.

    If there are neither loads nor a given load, the load is 1 N towards the crank pivot.
    """
    slider_loads = _slider_loads(mechanism)
    constant = -1.0 if load is None and not slider_loads else load
    return replace(
        mechanism,
        acceleration=0.0,
        crank=RigidLink(mass=0.0),
        rod=RigidLink(mass=0.0),
        counterweight=Counterweight(mass=0.0, radius=0.0),
        slider_mass=0.0,
        gravity=(0.0, 0.0),
        friction=Friction(),
        loads=slider_loads if constant is None else (StrokeForce(outward=constant, inward=constant),),
    )


def _slider_loads(mechanism: Mechanism) -> tuple[Load, ...]:
    """Return the loads that act on the slider at rest."""
    return tuple(load for load in mechanism.loads if not load.on_crank and not load.is_moving_mass)


def numbers(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> StaticForces:
    """Return peaks over the continuous cycle, and the forces every 30 deg.

    load: load on the slider, N outward; None for the loads of the mechanism or, if it has none, 1 N towards the crank.
    """
    machine = massless_mechanism(mechanism, load)
    linkage = Linkage(linkage.crank, linkage.rod, linkage.offset, mechanism.branch)
    torque, guide = peak(machine, Signal.TORQUE, linkage), peak(machine, Signal.GUIDE_FORCE, linkage)
    rod = peak(machine, Signal.SLIDER_PIN_FORCE, linkage)
    rate = peak(replace(machine, speed=1.0), Signal.SLIDER_SPEED, linkage)
    degrees = np.arange(0, 360 * cycle_turns(machine), _STEP)
    loads = cycle(machine, linkage, np.radians(degrees)).load
    at = static_forces(linkage, np.radians(degrees), load=loads)
    advantage = [value if math.isfinite(value) else None for value in at.mechanical_advantage.tolist()]
    uses_job_loads = load is None and bool(_slider_loads(mechanism))
    return {
        "load": _JOB_LOADS if uses_job_loads else f"{-1.0 if load is None else load:g} N, constant, positive outward",
        "peak_rod_force_N": rod.value,
        "peak_rod_force_angle_deg": rod.degrees,
        "peak_guide_reaction_N": guide.value,
        "peak_guide_reaction_angle_deg": guide.degrees,
        "peak_crank_torque_Nm": torque.value,
        "peak_crank_torque_angle_deg": torque.degrees,
        "least_mechanical_advantage": float(linkage.crank) / rate.value,
        "least_mechanical_advantage_angle_deg": rate.degrees,
        "crank_angle_deg": [float(angle) for angle in degrees],
        "load_N": loads.tolist(),
        # Adding zero turns a negative zero into a positive one.
        "rod_force_N": (at.rod_force + 0.0).tolist(),
        "guide_reaction_N": (at.guide_reaction + 0.0).tolist(),
        "crank_torque_Nm": (at.crank_torque + 0.0).tolist(),
        "mechanical_advantage": advantage,
    }


def blocks(numbers: StaticForces) -> list[Block]:
    """Return the forces every 30 deg and the peaks, in human-readable form."""
    columns = {
        "crank_angle_deg": column("crank angle", ANGLE),
        "load_N": column("load", FORCE),
        "rod_force_N": column("rod force", FORCE),
        "guide_reaction_N": column("guide", FORCE),
        "crank_torque_Nm": column("crank torque", TORQUE),
        "mechanical_advantage": column("mechanical\nadvantage"),
    }
    rows = zip(*(values_from_record(numbers, key, digits=4, missing="unbounded") for key in columns), strict=True)
    result_blocks: list[Block] = [
        heading("Static forces, without masses and friction ({load})", load=_load_text(numbers)),
        Table(tuple(columns.values()), tuple(rows), ruled=True),
    ]
    for force, key in (
        ("rod force", "peak_rod_force_N"),
        ("guide reaction", "peak_guide_reaction_N"),
        ("crank torque", "peak_crank_torque_Nm"),
    ):
        at = value_from_record(numbers, f"{key.rpartition('_')[0]}_angle_deg", decimals=2)
        result_blocks.append(
            sentence(f"greatest {force} {{value}} at {{at}}", value=value_from_record(numbers, key), at=at)
        )
    least = sentence(
        "least mechanical advantage {value} at {at} (slider load over tangential crank pin force)",
        value=value_from_record(numbers, "least_mechanical_advantage"),
        at=value_from_record(numbers, "least_mechanical_advantage_angle_deg", decimals=2),
    )
    return [*result_blocks, least]


def _load_text(numbers: StaticForces) -> Text:
    if numbers["load"] == _JOB_LOADS:
        return _JOB_LOADS
    return words("{load}, constant, positive outward", load=values_from_record(numbers, "load_N")[0])


def figure(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> PanelFigure:
    """Return forces, torque and mechanical advantage over the cycle; load as in `numbers`."""
    machine = massless_mechanism(mechanism, load)
    turns = cycle_turns(machine)
    theta = np.linspace(0.0, turns * 2.0 * math.pi, turns * 720 + 1)
    at = static_forces(linkage, theta, load=cycle(machine, linkage, theta).load)
    degrees = np.degrees(theta)
    advantage = np.where(at.mechanical_advantage <= _MOST_ADVANTAGE, at.mechanical_advantage, np.nan)
    forces = (
        Line("load, outward", degrees, at.load, 3),
        Line("rod, compression", degrees, at.rod_force),
        Line("guide", degrees, at.guide_reaction, 1),
    )
    panels = (
        crank_angle_panel("forces", *forces, kind=FORCE),
        crank_angle_panel("crank torque", Line("", degrees, at.crank_torque), kind=TORQUE),
        crank_angle_panel(f"mechanical advantage, up to {_MOST_ADVANTAGE:g}", Line("", degrees, advantage)),
    )
    return PanelFigure(
        "Static forces", joined([dimensions_text(linkage), "without masses and friction"], "; "), panels, width=8.0
    )
