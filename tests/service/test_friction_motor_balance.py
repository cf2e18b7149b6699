"""Numbers and figures of friction, motor and balance: what the model gives, and nothing where it is not defined."""

from __future__ import annotations

import io
import json
import math
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import shaking_curves
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Counterweight, Friction, Pin, RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.service.questions.balance import analysis as balance
from slidercrank.service.questions.discovery import TOPICS as DECLARED
from slidercrank.service.questions.friction import analysis as friction
from slidercrank.service.questions.motor import analysis as motor
from slidercrank.service.render.terminal import print_blocks

LINKAGE = Linkage(0.04, 0.1, 0.02)
PIN = Pin(radius=0.01, coefficient=0.08)
MACHINE = Mechanism(
    speed=-30.0,
    rod=RigidLink(mass=0.5),
    slider_mass=0.8,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-500.0, inward=20.0),),
    counterweight=Counterweight(mass=0.5, radius=0.03, angle=math.pi),
    friction=Friction(guide=0.15, crank_pivot=PIN, crank_pin=PIN, slider_pin=PIN),
)
LOCKED = replace(MACHINE, friction=Friction(guide=1.5))
TOPICS = (friction, motor, balance)


def printed_text(topic: ModuleType, numbers: Any) -> str:
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=140), topic.blocks(numbers))
    return stream.getvalue()


@pytest.mark.parametrize("machine", [MACHINE, LOCKED, replace(MACHINE, friction=Friction())])
@pytest.mark.parametrize("topic", TOPICS)
def test_numbers_are_fit_for_json_and_can_be_shown(topic: ModuleType, machine: Mechanism) -> None:
    numbers: Any = topic.numbers(machine, LINKAGE)
    assert json.loads(json.dumps(numbers, allow_nan=False)) == numbers
    assert 4 <= len(printed_text(topic, numbers).splitlines()) <= 20


@pytest.mark.parametrize("topic", TOPICS)
def test_numbers_under_the_keys_of_quantities_are_those_quantities(topic: ModuleType) -> None:
    numbers: Any = topic.numbers(MACHINE, LINKAGE)
    design = np.array([[0.04, 0.1, 0.02]])
    shared = [quantity for quantity in QUANTITIES.values() if quantity.field in numbers]
    assert len(shared) >= 4
    for quantity in shared:
        value = float(quantity.evaluate(MACHINE, design).values[0]) * quantity.unit.factor
        assert numbers[quantity.field] == pytest.approx(value, rel=1e-12), quantity.name


def test_friction_says_where_the_work_goes() -> None:
    numbers: Any = friction.numbers(MACHINE, LINKAGE)
    assert numbers["verdict"] == "drives"
    assert numbers["locked_angles_deg"] == []
    assert numbers["input_work_J"] == pytest.approx(numbers["useful_work_J"] + numbers["friction_heat_J"], rel=1e-10)
    assert numbers["efficiency"] == pytest.approx(numbers["useful_work_J"] / numbers["input_work_J"], rel=1e-10)
    stroke = float(LINKAGE.stroke)
    assert numbers["useful_work_J"] == pytest.approx(500.0 * stroke + 20.0 * stroke, rel=1e-10)
    assert "drives at every crank angle" in printed_text(friction, numbers)


def test_a_linkage_that_locks_has_no_torque_no_work_and_no_efficiency() -> None:
    numbers: Any = friction.numbers(LOCKED, LINKAGE)
    assert numbers["verdict"] != "drives"
    assert numbers["self_locking_margin_deg"] < 0.0
    ((start, end),) = numbers["locked_angles_deg"]
    for angle in (start, end):
        at = float(LINKAGE.at(math.radians(angle)).transmission_angle)
        assert math.degrees(at) == pytest.approx(math.degrees(math.atan(1.5)), rel=1e-9)
    for key in ("peak_torque_Nm", "mean_torque_Nm", "peak_guide_force_N", "input_work_J", "efficiency"):
        assert numbers[key] is None
    assert "undefined" in printed_text(friction, numbers)
    numbers = motor.numbers(LOCKED, LINKAGE)
    for key in ("peak_torque_Nm", "rms_torque_Nm", "mean_torque_Nm", "peak_power_W", "mean_power_W"):
        assert numbers[key] is None
    assert numbers["greatest_reflected_inertia_kg_m2"] > numbers["least_reflected_inertia_kg_m2"] > 0.0


def test_reflected_inertia_lies_between_its_least_and_greatest() -> None:
    numbers: Any = motor.numbers(MACHINE, LINKAGE)
    theta = np.linspace(0.0, 2.0 * math.pi, 20_000)
    inertia = shaking_curves(MACHINE, LINKAGE, theta).reflected_inertia
    assert numbers["least_reflected_inertia_kg_m2"] == pytest.approx(inertia.min(), rel=1e-6)
    assert numbers["greatest_reflected_inertia_kg_m2"] == pytest.approx(inertia.max(), rel=1e-6)
    assert numbers["least_reflected_inertia_kg_m2"] <= inertia.min()


def test_counterweight_is_compared_with_none() -> None:
    numbers: Any = balance.numbers(MACHINE, LINKAGE)
    assert numbers["peak_shaking_force_N"] < numbers["peak_shaking_force_without_counterweight_N"]
    bare: Any = balance.numbers(replace(MACHINE, counterweight=Counterweight(mass=0.0, radius=0.0)), LINKAGE)
    assert bare["peak_shaking_force_N"] == numbers["peak_shaking_force_without_counterweight_N"]
    assert bare["peak_shaking_force_without_counterweight_N"] is None


@pytest.mark.parametrize("machine", [MACHINE, LOCKED])
def test_curves_of_the_figures_are_those_of_the_model(machine: Mechanism) -> None:
    data = friction.figure(machine, LINKAGE)
    theta = np.radians(data.panels[0].lines[0].x)
    expected, smooth = cycle(machine, LINKAGE, theta), cycle(replace(machine, friction=Friction()), LINKAGE, theta)
    # The angles are back from degrees, a rounding error off: not compared within it of a jump.
    calm = np.abs(np.diff(theta, prepend=-1.0)) > 1e-6
    calm &= np.abs(np.diff(theta, append=7.0)) > 1e-6
    for line, values in zip(
        [*data.panels[0].lines, *data.panels[1].lines],
        [expected.torque, smooth.torque, expected.guide, smooth.guide],
        strict=True,
    ):
        np.testing.assert_allclose(line.y[calm], values[calm], rtol=1e-9, atol=1e-9 * np.nanmax(np.abs(values)))
    assert len(data.panels[0].shaded) == (machine is LOCKED)
    assert np.isnan(data.panels[0].lines[0].y).any() == (machine is LOCKED)
    power = motor.figure(machine, LINKAGE)
    np.testing.assert_array_equal(power.panels[1].lines[0].y, -30.0 * power.panels[0].lines[0].y)
    shaken = balance.figure(machine, LINKAGE)
    curves = shaking_curves(machine, LINKAGE, np.radians(shaken.panels[0].lines[0].x))
    np.testing.assert_allclose(shaken.panels[2].lines[0].y, curves.moment, rtol=0, atol=1e-9)
    x, y = (line.y for line in shaken.panels[1].lines)
    np.testing.assert_allclose(shaken.panels[0].lines[0].y, np.hypot(x, y), rtol=1e-14)


@pytest.mark.parametrize("topic", ["friction", "motor", "balance"])
@pytest.mark.parametrize("machine", [MACHINE, LOCKED])
def test_figures_are_written(topic: str, machine: Mechanism, tmp_path: Path) -> None:
    file = DECLARED[topic].bind_to_design(machine, LINKAGE).draw(tmp_path)
    assert file.read_bytes().startswith(b"\x89PNG")
    assert file.stat().st_size > 10_000
