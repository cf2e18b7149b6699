"""Start-up and flywheel: the numbers are JSON and the model's, the figures show what the model gives."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.steady_running import steady_running
from slidercrank.service.figures.panel_figure import Panel, panel_in_units
from slidercrank.service.questions.discovery import TOPICS
from slidercrank.service.questions.flywheel import analysis as flywheel
from slidercrank.service.questions.start_up import analysis as start_up
from slidercrank.service.render.terminal import print_blocks
from tests.model.cases import STROKES

LINKAGE = Linkage(0.05, 0.2, 0.03)
DRIVE = Drive(motor=LinearMotor(stall_torque=60.0, no_load_speed=40.0), flywheel=0.2)
MACHINE = replace(STROKES, drive=DRIVE)
STUCK = replace(MACHINE, loads=(StrokeForce(outward=-9e4, inward=9e4),))
RUNAWAY = replace(MACHINE, drive=Drive(motor=ConstantTorque(torque=30.0), flywheel=2.0))


def printed_text(topic: ModuleType, numbers: Any) -> str:
    assert json.loads(json.dumps(numbers, allow_nan=False)) == numbers
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=100), topic.blocks(numbers))
    assert 2 < len(stream.getvalue().splitlines()) <= 20
    return stream.getvalue()


def test_the_start_is_told_with_its_steady_running() -> None:
    numbers: Any = start_up.numbers(MACHINE, LINKAGE)
    running = steady_running(MACHINE, LINKAGE)
    assert numbers["verdict"] == "steady"
    assert numbers["steady"]["mean_speed_rpm"] == pytest.approx(running.mean_speed * 30.0 / np.pi, rel=1e-12)
    assert numbers["steady"]["mean_power_W"] == pytest.approx(running.work / running.period, rel=1e-12)
    assert numbers["why_not_steady"] is None
    gained = numbers["kinetic_energy_gained_J"] + numbers["potential_energy_gained_J"]
    assert gained == pytest.approx(numbers["motor_work_J"] - numbers["load_work_J"], rel=1e-8)
    text = printed_text(start_up, numbers)
    assert "runs steadily" in text
    assert "coefficient of speed fluctuation" in text


def test_a_motor_that_cannot_start_is_told_as_such() -> None:
    text: Any = printed_text(start_up, start_up.numbers(STUCK, LINKAGE))
    assert "cannot overcome the load" in text
    assert "No steady running" in text


def test_a_start_can_be_cancelled() -> None:
    numbers: Any = start_up.numbers(MACHINE, LINKAGE, cancelled=lambda: True)
    assert numbers["verdict"] == "cancelled"


@pytest.mark.slow
def test_the_flywheel_is_told_for_the_wanted_and_for_other_fluctuations() -> None:
    numbers: Any = flywheel.numbers(MACHINE, LINKAGE, fluctuation=0.05)
    assert numbers["flywheel_kgm2"] == design_flywheel(MACHINE, LINKAGE, 0.05).inertia
    assert numbers["steady"]["fluctuation"] == pytest.approx(0.05, rel=1e-9)
    assert numbers["flywheels_kgm2"] == sorted(numbers["flywheels_kgm2"])
    assert numbers["fluctuations"][2] == 0.05
    assert numbers["flywheels_kgm2"][2] == numbers["flywheel_kgm2"]
    assert "Flywheel on the crank shaft" in printed_text(flywheel, numbers)
    assert "constant torque" in flywheel.numbers(STROKES, LINKAGE)["motor"]


@pytest.mark.parametrize(
    ("speed", "least", "words"),
    [
        (10.0 * np.pi, 3.0163774, "without one it is 6.329 (least speed 3.016 rpm)."),
        (np.pi, 0.0, "the crank nearly stops"),
    ],
)
def test_without_a_flywheel_a_crank_that_nearly_stops_has_its_numbers(speed: float, least: float, words: str) -> None:
    machine = Mechanism(
        speed=speed,
        crank=RigidLink(mass=0.5),
        rod=RigidLink(mass=0.8),
        slider_mass=2.0,
        gravity=(0.0, -9.81),
        loads=(StrokeForce(outward=-200.0, inward=-200.0),),
    )
    linkage = Linkage(0.05, 0.16, 0.05)
    numbers: Any = flywheel.numbers(machine, linkage)
    assert numbers["fluctuation_without_flywheel"] == pytest.approx(6.3286239 if least else 63.3867047, rel=1e-7)
    assert numbers["least_speed_without_flywheel_rpm"] == pytest.approx(least, rel=1e-7)
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=400), flywheel.blocks(numbers))
    assert words in stream.getvalue()


@pytest.mark.parametrize("slider", [50.0, 0.0])
def test_a_machine_without_inertia_has_a_flywheel_and_the_reason_why_it_has_no_speeds_without(slider: float) -> None:
    machine = Mechanism(speed=2.5, slider_mass=slider, loads=(StrokeForce(outward=0.0, inward=900.0),))
    numbers: Any = flywheel.numbers(machine, Linkage(0.06, 0.3, 0.0), fluctuation=0.4)
    assert numbers["flywheel_kgm2"] == pytest.approx(numbers["classical_estimate_kgm2"], rel=0.1)
    assert numbers["fluctuation_without_flywheel"] is numbers["least_speed_without_flywheel_rpm"] is None
    assert numbers["reason_without_flywheel"].startswith("the crank needs inertia at every angle")
    json.dumps(numbers, allow_nan=False)
    stream = io.StringIO()
    print_blocks(Console(file=stream, width=400), flywheel.blocks(numbers))
    assert "without one steady running was not reached: the crank needs inertia" in stream.getvalue()


def test_a_start_needs_a_drive_and_a_flywheel_a_motor_that_runs_steadily() -> None:
    with pytest.raises(InputError, match=r"add a \[drive\]"):
        start_up.numbers(STROKES, LINKAGE)
    with pytest.raises(InputError, match="torque or a load that changes with speed"):
        flywheel.numbers(RUNAWAY, LINKAGE)


def drawn_panels(topic: ModuleType, machine: Mechanism, folder: Path, **options: float) -> tuple[Panel, ...]:
    """Return the panels of a topic's figure, which is drawn too."""
    file = TOPICS[topic.__name__.split(".")[-2]].bind_to_design(machine, LINKAGE, options).draw(folder)
    assert file.stat().st_size > 10_000
    return tuple(panel_in_units(panel, "metric") for panel in topic.figure(machine, LINKAGE, **options).panels)


def test_the_figure_of_the_start_shows_the_model(tmp_path: Path) -> None:
    speed, turning, torque, _ = drawn_panels(start_up, MACHINE, tmp_path)
    run, running, _ = start_up.simulate_start(MACHINE, LINKAGE)
    assert running is not None
    np.testing.assert_array_equal(speed.lines[0].x, run.time)
    np.testing.assert_array_equal(torque.lines[0].y, run.motor_torque)
    np.testing.assert_allclose(speed.lines[0].y * np.pi / 30.0, run.speed, rtol=1e-14)
    assert np.all(np.diff(turning.lines[0].x) >= 0.0)
    assert turning.lines[0].y.max() == pytest.approx(running.speed.max() * 30.0 / np.pi, rel=1e-14)
    assert turning.note == f"fluctuation {running.fluctuation:.3g}"
    assert len(drawn_panels(start_up, STUCK, tmp_path)) == 2


@pytest.mark.parametrize("machine", [MACHINE, STROKES], ids=["motor", "constant torque"])
def test_the_figure_of_the_flywheel_shows_the_model(machine: Mechanism, tmp_path: Path) -> None:
    fluctuations, speeds = drawn_panels(flywheel, machine, tmp_path, fluctuation=0.04)
    exact, _, chosen = fluctuations.lines
    assert chosen.y == pytest.approx([0.04], rel=1e-9)
    middle = len(exact.x) // 2
    assert np.interp(chosen.x, exact.x, exact.y) == pytest.approx([0.04], rel=1e-2)
    assert exact.x[middle] == pytest.approx(chosen.x[0], rel=0.5)
    assert np.all(np.diff(exact.y) < 0.0)
    speed, half = speeds.lines
    assert np.ptp(half.y) > 1.5 * np.ptp(speed.y)


def test_the_heat_of_friction_is_told_of_a_start_with_friction_alone() -> None:
    rubbing = replace(MACHINE, friction=Friction(guide=0.1, crank_pin=Pin(radius=0.01, coefficient=0.08)))
    numbers: Any = start_up.numbers(rubbing, LINKAGE, turns=3)
    assert numbers["friction_work_J"] > 4.0
    gained = numbers["kinetic_energy_gained_J"] + numbers["potential_energy_gained_J"]
    spent = numbers["load_work_J"] + numbers["friction_work_J"]
    assert gained == pytest.approx(numbers["motor_work_J"] - spent, rel=1e-6)
    assert "friction heat" in printed_text(start_up, numbers)
    smooth: Any = start_up.numbers(MACHINE, LINKAGE, turns=3)
    assert smooth["friction_work_J"] == 0.0
    assert "friction heat" not in printed_text(start_up, smooth)
