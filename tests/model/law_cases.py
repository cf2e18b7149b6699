"""Random machines for motion laws: every load that a law takes, either branch and direction, with a rotor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.motion_law.law_turn import LawTurn
from tests.model.cases import linkage_of, random_designs, random_machine


def random_case(seed: int) -> tuple[Mechanism, Linkage]:
    """Return a machine whose kinetic energy is of the size of the work of its loads, and a linkage."""
    random = np.random.default_rng([41, seed])
    machine = random_machine(random)
    taken = [load for load in machine.loads if not isinstance(load, Viscous | Drag)]
    chosen = tuple(load for load in taken if random.random() < 0.5) or (taken[0],)
    if seed % 5 == 4:
        gas = Compressor(bore=0.04, low=1e5, high=5e5, clearance=0.08, compression_exponent=1.3, expansion_exponent=1.2)
        chosen += (gas,)
    machine = replace(machine, loads=chosen, acceleration=0.0)
    linkage = linkage_of(random_designs(1, seed=seed, least_margin=0.05)[0], machine.branch)
    size = float(np.abs(LawTurn(machine, linkage).terms.load).max())
    inertia = random.uniform(0.2, 2.0) * size / machine.speed**2
    return replace(machine, drive=Drive(motor=ConstantTorque(torque=0.0), motor_inertia=inertia)), linkage
