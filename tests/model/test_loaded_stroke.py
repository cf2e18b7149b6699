"""The loaded stroke: against work integrated over the crank angle with the loads of another formulation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.linkage.loaded_stroke import MORE, loaded_stroke
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from tests.model.virtual_work import path, slider_load

DESIGNS = np.array([[0.04, 0.1, 0.03], [0.04, 0.1, -0.03], [0.05, 0.2, 0.1]])
AT = 1000.0


def one(load: Load, *, speed: float = 1.0, branch: Branch = "open") -> list[str]:
    """Return the loaded strokes of the designs under a load."""
    return [str(name) for name in loaded_stroke(Mechanism(speed=speed, loads=(load,), branch=branch), DESIGNS)]


@pytest.mark.parametrize(
    ("load", "stroke"),
    [
        (StrokeForce(outward=-200.0, inward=0.0), "outward"),
        (StrokeForce(outward=0.0, inward=200.0), "inward"),
        (StrokeForce(outward=-200.0, inward=-200.0), "outward"),  # a weight that pulls inward is lifted outward
        (StrokeForce(outward=200.0, inward=200.0), "inward"),
        (StrokeForce(outward=-60.0, inward=60.0), "equal"),
        (StrokeForce(outward=200.0, inward=-200.0), "equal"),  # drives both strokes
        (StrokeForce(outward=-60.0, inward=80.0), "inward"),
        (StrokeForce(outward=-60.0, inward=60.0 * (1.0 + 0.5 * MORE)), "equal"),
        (Spring(stiffness=1e4), "equal"),
        (Viscous(coefficient=50.0), "equal"),
        (PositionTable(positions=(0.0, 0.02), forces=(-500.0, 0.0), datum="outer dead centre"), "equal"),
        (PositionTable(positions=(0.0, 0.02), forces=(-500.0, 0.0), during="outward stroke"), "equal"),
        (
            PositionTable(
                positions=(0.0, 0.02), forces=(-500.0, 0.0), datum="outer dead centre", during="outward stroke"
            ),
            "outward",
        ),
    ],
)
def test_the_loaded_stroke_is_the_one_that_the_load_resists(load: Load, stroke: str) -> None:
    for speed in (7.0, -7.0):
        for branch in ("open", "crossed"):
            assert one(load, speed=speed, branch=branch) == [stroke] * 3


def test_no_load_loads_no_stroke() -> None:
    assert loaded_stroke(Mechanism(speed=1.0), DESIGNS).tolist() == ["equal"] * 3
    assert loaded_stroke(Mechanism(speed=1.0), np.zeros((0, 3))).tolist() == []


def test_the_loaded_stroke_of_random_loads_is_that_of_the_greater_work() -> None:
    """The work is integrated over the crank angle with the forces of the tests' own model."""
    random = np.random.default_rng(3)
    told = []
    for _ in range(40):
        crank = random.uniform(0.02, 0.1, 4)
        offset = random.uniform(-0.1, 0.1, 4)
        rod = (crank + np.abs(offset)) * random.uniform(1.05, 3.0, 4)
        designs = np.stack([crank, rod, offset], axis=1)
        angles = np.sort(random.uniform(0.0, 6.0, 4))
        loads: tuple[Load, ...] = (
            StrokeForce(outward=random.uniform(-300.0, 100.0), inward=random.uniform(-100.0, 300.0)),
            AngleTable(angles=tuple(angles.tolist()), forces=tuple(random.uniform(-400.0, 400.0, 4).tolist())),
            PositionTable(
                positions=(0.0, 0.03, 0.08),
                forces=tuple(random.uniform(-400.0, 400.0, 3).tolist()),
                datum=random.choice(["crank pivot", "inner dead centre", "outer dead centre"]).item(),
                during=random.choice(["outward stroke", "inward stroke"]).item(),
            ),
        )
        branch: Branch = "open" if random.random() < 0.5 else "crossed"
        machine = Mechanism(speed=float(random.choice([-9.0, 9.0])), loads=loads, branch=branch)
        work = _work(machine, designs)
        high, low = work.max(axis=0), work.min(axis=0)
        clear = np.abs((high - low) / high - MORE) > 5e-3  # nearer to the bound the sums decide
        wanted = np.where(
            (high > 0.0) & (high - low > MORE * high), np.array(["outward", "inward"])[work.argmax(axis=0)], "equal"
        )
        found = loaded_stroke(machine, designs)
        assert found[clear].tolist() == wanted[clear].tolist()
        told += found[clear].tolist()
    assert {*told} == {"outward", "inward", "equal"}


def _work(machine: Mechanism, designs: np.ndarray) -> np.ndarray:
    """Return the work against the outward and the inward stroke (2, n)."""
    sign = 1.0 if machine.branch == "open" else -1.0
    theta = 2.0 * math.pi * (np.arange(20_000) + 0.5) / 20_000
    at = path(designs[:, None, :], theta, sign)
    force = slider_load(machine, designs[:, None, :], theta, at)
    slope = sign * at.x_1 * (1.0 if machine.speed > 0.0 else -1.0)
    power = -force * slope * (theta[1] - theta[0])
    return np.stack([np.where(slope > 0.0, power, 0.0).sum(axis=1), np.where(slope < 0.0, power, 0.0).sum(axis=1)])


def test_loads_that_vary_are_those_of_each_design() -> None:
    base = Mechanism(speed=1.0, loads=(StrokeForce(outward=-150.0, inward=0.0), StrokeForce(outward=0.0, inward=1.0)))
    varying = replace(base, varying=(Varying(name="return", sets=(("loads.1.inward", 1.0),), lower=50.0, upper=300.0),))
    designs = np.column_stack([DESIGNS, [100.0, 150.0, 200.0]])
    assert loaded_stroke(varying, designs).tolist() == ["outward", "equal", "inward"]


def test_the_direction_of_a_speed_that_varies_is_that_of_its_range() -> None:
    speed = Varying(name="speed", sets=(("speed", 1.0),), lower=-9.0, upper=-6.0)
    assert Mechanism(speed=7.0, varying=(speed,)).direction == -1.0
    assert Mechanism(speed=7.0).direction == 1.0
    assert Mechanism(speed=0.0).direction == 1.0
    assert Linkage(0.04, 0.1, 0.03).slow_stroke(direction=-1.0) == "outward"
