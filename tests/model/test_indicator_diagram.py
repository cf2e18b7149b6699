"""The indicator diagram: its area is the indicated work, its pressures those of the load, its events breakpoints."""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import breakpoints, cycle
from slidercrank.model.cycle.gas_work import indicator_diagram, valve_events
from slidercrank.model.machine.loads.cylinder import Cylinder
from slidercrank.objectives.registry import QUANTITIES
from tests.model.test_cylinder import random_case, turning


@pytest.mark.parametrize("seed", range(15))
def test_the_diagram_encloses_the_indicated_work_and_gives_the_load(seed: int) -> None:
    """Trapezia of 20,000 angles: to 1e-6 of the greatest pressure times the volume."""
    machine, design = random_case(seed)
    (load,) = machine.loads
    assert isinstance(load, Cylinder)
    linkage = turning(machine, design)
    theta = np.linspace(0.0, 2.0 * math.pi, 20_001)
    found = indicator_diagram(machine, linkage, load, theta)
    area = 0.5 * np.sum((found.pressure[1:] + found.pressure[:-1]) * np.diff(found.volume)) * machine.direction
    wanted = QUANTITIES["indicated_work"].evaluate(machine, design).values[0]
    assert area == pytest.approx(wanted, abs=1e-6 * load.high * np.ptp(found.volume))
    swept = QUANTITIES["displacement_volume"].evaluate(machine, design).values[0]
    assert np.ptp(found.volume) == pytest.approx(swept, rel=1e-6)
    sign = -1.0 if load.head == "outer dead centre" else 1.0
    inside = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, 200)
    pressure = indicator_diagram(machine, linkage, load, inside).pressure
    push = sign * load.area * (pressure - load.back_pressure)
    assert cycle(machine, linkage, inside).load == pytest.approx(push, rel=1e-9, abs=1e-9 * load.high * load.area)


@pytest.mark.parametrize("seed", range(15))
def test_valve_events_are_breakpoints_of_the_torque(seed: int) -> None:
    machine, design = random_case(seed)
    (load,) = machine.loads
    assert isinstance(load, Cylinder)
    linkage = turning(machine, design)
    events = [angle for angle in valve_events(machine, linkage, load) if angle is not None]
    dead = np.mod(linkage.dead_centre_angles, 2.0 * math.pi)
    assert sorted([*events, *dead]) == pytest.approx(list(breakpoints(machine, linkage)), abs=1e-9)
