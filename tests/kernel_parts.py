"""What a test run needs compiled, in parts that take about as long."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.self_locking import locking_margin
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.solve import solve
from tests.model.cases import SMOOTH, random_designs, random_friction, random_machine
from tests.optimise.problems import problem

_DESIGNS = random_designs(4, seed=1, least_margin=0.5)
_CRANK, _ROD, _OFFSET = _DESIGNS[0].tolist()


def smooth() -> None:
    """Evaluate every quantity of a machine without friction."""
    for quantity in QUANTITIES.values():
        quantity.evaluate(SMOOTH, _DESIGNS, gradients=True)


def rubbing() -> None:
    """Evaluate every quantity of a machine with friction."""
    random = np.random.default_rng(9)
    machine = dataclasses.replace(random_machine(random), friction=random_friction(random))
    for quantity in reversed(QUANTITIES.values()):
        quantity.evaluate(machine, _DESIGNS, gradients=True)
    locking_margin(random_friction(random), _DESIGNS)
    cycle(machine, Linkage(_CRANK, _ROD, _OFFSET, machine.branch), np.linspace(0.0, 6.0, 8))


def search() -> None:
    """Solve a small job."""
    cycle(SMOOTH, Linkage(_CRANK, _ROD, _OFFSET, SMOOTH.branch), np.linspace(0.0, 6.0, 8))
    solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, {"stroke": 0.2}, designs=6, samples=128))


PARTS: tuple[Callable[[], None], ...] = (rubbing, smooth, search)
