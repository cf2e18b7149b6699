"""Static forces of one design over the cycle: what the loads alone need, without masses, gravity and friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism

_STEP = 30


def massless(mechanism: Mechanism, load: float | None = None) -> Mechanism:
    """Return the mechanism without masses, gravity and friction; with a constant load, N outward, if given.

    Without loads of its own and without one given, the load is 1 N towards the crank pivot.
    """
    from ....model.machine.friction import Friction
    from ....model.machine.links import Counterweight, RigidLink
    from ....model.machine.loads.stroke_force import StrokeForce

    constant = -1.0 if load is None and not mechanism.loads else load
    return replace(
        mechanism,
        acceleration=0.0,
        crank=RigidLink(mass=0.0),
        rod=RigidLink(mass=0.0),
        counterweight=Counterweight(mass=0.0, radius=0.0),
        slider_mass=0.0,
        gravity=(0.0, 0.0),
        friction=Friction(),
        loads=mechanism.loads if constant is None else (StrokeForce(outward=constant, inward=constant),),
    )


def numbers(mechanism: Mechanism, linkage: Linkage, *, load: float | None = None) -> dict[str, Any]:
    """Return peaks over the cycle, continuous in the crank angle, and the forces every 30 deg.

    load: on the slider, N outward; those of the mechanism if None, and 1 N towards the crank if it has none.
    """
    import numpy as np

    from ....model.classical.static_forces import static_forces
    from ....model.cycle.cycle import cycle
    from ....model.linkage.linkage import Linkage
    from ....model.signals.peaks import find_peaks
    from ....model.signals.signals import Signal

    machine = massless(mechanism, load)
    linkage = Linkage(linkage.crank, linkage.rod, linkage.offset, mechanism.branch)
    designs = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])

    def peak(of: Mechanism, signal: Signal) -> tuple[float, float]:
        found = find_peaks(of, signal, designs, kept=1)
        return float(found.values[0, 0]), math.degrees(float(found.angles[0, 0]))

    torque, guide = peak(machine, Signal.TORQUE), peak(machine, Signal.GUIDE_FORCE)
    rod = peak(machine, Signal.SLIDER_PIN_FORCE)
    rate = peak(replace(machine, speed=1.0), Signal.SLIDER_SPEED)
    degrees = np.arange(0, 360, _STEP)
    loads = cycle(machine, linkage, np.radians(degrees)).load
    at = static_forces(linkage, np.radians(degrees), load=loads)
    advantage = [value if math.isfinite(value) else None for value in at.mechanical_advantage.tolist()]
    own = load is None and bool(mechanism.loads)
    return {
        "load": "loads of the job" if own else f"{-1.0 if load is None else load:g} N, constant, positive outward",
        "peak_rod_force_N": rod[0],
        "peak_rod_force_angle_deg": rod[1],
        "peak_guide_reaction_N": guide[0],
        "peak_guide_reaction_angle_deg": guide[1],
        "peak_crank_torque_Nm": torque[0],
        "peak_crank_torque_angle_deg": torque[1],
        "least_mechanical_advantage": float(linkage.crank) / rate[0],
        "least_mechanical_advantage_angle_deg": rate[1],
        "crank_angle_deg": [float(angle) for angle in degrees],
        "load_N": loads.tolist(),
        # Adding zero makes a negative zero a plain one.
        "rod_force_N": (at.rod_force + 0.0).tolist(),
        "guide_reaction_N": (at.guide_reaction + 0.0).tolist(),
        "crank_torque_Nm": (at.crank_torque + 0.0).tolist(),
        "mechanical_advantage": advantage,
    }
