"""Static forces of one design over the cycle: what the loads alone need, without masses, gravity and friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Console

from ....model.classical.static_forces import static_forces
from ....model.cycle.cycle import cycle
from ....model.linkage.linkage import Linkage
from ....model.machine.friction import Friction
from ....model.machine.links import Counterweight, RigidLink
from ....model.machine.loads.load import Load
from ....model.machine.loads.stroke_force import StrokeForce
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import cycle_turns
from ....model.signals.signals import Signal
from ...figures.sheets import Line, Sheet, over_turn
from ...text.tables import print_table, table
from ..peaks import peak

_STEP = 30
_MOST_ADVANTAGE = 10.0  # beyond it the curve only says that a dead centre is near


def massless(mechanism: Mechanism, load: float | None = None) -> Mechanism:
    """Return the mechanism without masses, gravity and friction; with a constant load, N outward, if given.

    Without loads of its own and without one given, the load is 1 N towards the crank pivot.
    """
    own = _own(mechanism)
    constant = -1.0 if load is None and not own else load
    return replace(
        mechanism,
        acceleration=0.0,
        crank=RigidLink(mass=0.0),
        rod=RigidLink(mass=0.0),
        counterweight=Counterweight(mass=0.0, radius=0.0),
        slider_mass=0.0,
        gravity=(0.0, 0.0),
        friction=Friction(),
        loads=own if constant is None else (StrokeForce(outward=constant, inward=constant),),
    )


def _own(mechanism: Mechanism) -> tuple[Load, ...]:
    """Return the loads on the slider, of which the polygons are."""
    return tuple(load for load in mechanism.loads if not load.on_crank)


def numbers(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> dict[str, Any]:
    """Return peaks over the cycle, continuous in the crank angle, and the forces every 30 deg.

    load: on the slider, N outward; those of the mechanism if None, and 1 N towards the crank if it has none.
    """
    machine = massless(mechanism, load)
    linkage = Linkage(linkage.crank, linkage.rod, linkage.offset, mechanism.branch)
    torque, guide = peak(machine, Signal.TORQUE, linkage), peak(machine, Signal.GUIDE_FORCE, linkage)
    rod = peak(machine, Signal.SLIDER_PIN_FORCE, linkage)
    rate = peak(replace(machine, speed=1.0), Signal.SLIDER_SPEED, linkage)
    degrees = np.arange(0, 360 * cycle_turns(machine), _STEP)
    loads = cycle(machine, linkage, np.radians(degrees)).load
    at = static_forces(linkage, np.radians(degrees), load=loads)
    advantage = [value if math.isfinite(value) else None for value in at.mechanical_advantage.tolist()]
    own = load is None and bool(_own(mechanism))
    return {
        "load": "loads of the job" if own else f"{-1.0 if load is None else load:g} N, constant, positive outward",
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
        # Adding zero makes a negative zero a plain one.
        "rod_force_N": (at.rod_force + 0.0).tolist(),
        "guide_reaction_N": (at.guide_reaction + 0.0).tolist(),
        "crank_torque_Nm": (at.crank_torque + 0.0).tolist(),
        "mechanical_advantage": advantage,
    }


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the peaks and the forces every 30 deg."""
    console.print(f"Static forces, without masses and friction ({numbers['load']})", style="bold", soft_wrap=True)
    columns = {
        ">crank angle,\ndeg": "crank_angle_deg",
        ">load,\nN": "load_N",
        ">rod force,\nN": "rod_force_N",
        ">guide,\nN": "guide_reaction_N",
        ">crank torque,\nN m": "crank_torque_Nm",
        ">mechanical\nadvantage": "mechanical_advantage",
    }
    rows = table(*columns, ruled=True)
    for row in zip(*(numbers[key] for key in columns.values()), strict=True):
        rows.add_row(*("unbounded" if value is None else f"{value:.4g}" for value in row))
    print_table(console, rows)
    for what, key, unit in (
        ("rod force", "peak_rod_force_N", " N"),
        ("guide reaction", "peak_guide_reaction_N", " N"),
        ("crank torque", "peak_crank_torque_Nm", " N m"),
    ):
        at = numbers[f"{key.rpartition('_')[0]}_angle_deg"]
        console.print(f"greatest {what} {numbers[key]:.6g}{unit} at {at:.2f} deg", soft_wrap=True)
    console.print(
        f"least mechanical advantage {numbers['least_mechanical_advantage']:.6g} at "
        f"{numbers['least_mechanical_advantage_angle_deg']:.2f} deg (slider load over tangential crank pin force)",
        soft_wrap=True,
    )


def figure(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> Sheet:
    """Return forces, torque and mechanical advantage over the cycle; load as in `numbers`."""
    machine = massless(mechanism, load)
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
        over_turn("forces, N", *forces),
        over_turn("crank torque, N m", Line("", degrees, at.crank_torque)),
        over_turn(f"mechanical advantage, up to {_MOST_ADVANTAGE:g}", Line("", degrees, advantage)),
    )
    return Sheet("Static forces", f"{linkage.label}; without masses and friction", panels, width=8.0)
