"""The warning about driving loads, against the integral of F dx + M d theta of an independent model."""

from __future__ import annotations

import math
import re
from copy import deepcopy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputWarning
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.problem_from_tables import problem as stated
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.driving_load_warnings import (
    driving_load_warnings,
    front_driving_load_warnings,
    net_work,
)
from slidercrank.optimise.search.stroke_warnings import sampled_designs
from slidercrank.optimise.solve import solve
from tests.model.test_load_text import random_load
from tests.model.virtual_work import crank_torque, path, slider_load

_SIZE = 2000.0
"""N, of the loads of a random machine together."""
PUSH = {
    "positions": ["0 mm", "60 mm"],
    "forces": ["350 N", "350 N"],
    "measured_from": "outer dead centre",
    "during": "outward stroke",
}
PRESS = {"force": "350 N", "opposes": "outward stroke"}
ENGINE = {"bore": "54 mm", "compression_ratio": 8, "intake": "1 bar", "peak_pressure": "40 bar"}
COMPRESSOR = {"bore": "70 mm", "suction": "1 bar", "discharge": "8 bar", "clearance": 0.05}
JOB: dict[str, Any] = {
    "name": "Pusher",
    "mechanism": {"speed": "90 rpm", "slider": {"mass": "4 kg"}},
    "load": [PUSH],
    "variables": {"crank": ["20 mm", "100 mm"], "rod": ["200 mm", "400 mm"], "offset": ["0 mm", "50 mm"]},
    "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
    "optimiser": {"designs": 4, "samples": 256},
}
SWING = {
    "motion": {"kind": "swing", "from": "20 deg", "to": "140 deg", "driver": "crank"},
    "objectives": {"peak_actuator_torque": "minimise"},
}


def problem(*load: dict[str, Any], **tables: Any) -> Problem:
    """Return the problem of the job with these loads and other tables."""
    return parse_job(deepcopy(JOB) | {"load": list(load)} | tables)


def integral(machine: Mechanism, design: Any, angles: Any) -> float:
    """Return the work of the loads, J, over small steps of crank angle, by their edges in order of motion."""
    theta, step = 0.5 * (angles[1:] + angles[:-1]), np.diff(angles)
    at = path(design, theta, 1.0 if machine.branch == "open" else -1.0)
    sign = 1.0 if machine.branch == "open" else -1.0
    force = sign * slider_load(machine, design, theta, at)
    return float(np.sum((force * at.x_1 + crank_torque(machine, theta)) * step))


def random_machine(random: np.random.Generator) -> Mechanism:
    """Return a machine with one to three loads, some of them on the crank."""
    loads = [random_load(random) for _ in range(random.integers(1, 4))]
    if random.random() < 0.3:
        loads.append(CrankTorque(torque=random.uniform(-5.0, 5.0), resistance=random.uniform(0.0, 2.0)))
    if random.random() < 0.3:
        torques = tuple(random.uniform(-9.0, 9.0, 3).tolist())
        loads.append(CrankTorqueTable(angles=tuple(np.sort(random.uniform(0.0, 6.0, 3)).tolist()), forces=torques))
    branch = random.choice(["open", "crossed"]).item()
    return Mechanism(speed=float(random.choice([-9.0, 9.0])), branch=branch, loads=tuple(loads))


def random_designs(random: np.random.Generator, n: int) -> Any:
    """Return designs (n, 3) that rotate fully."""
    crank, offset = random.uniform(0.02, 0.1, n), random.uniform(-0.1, 0.1, n)
    return np.stack([crank, (crank + np.abs(offset)) * random.uniform(1.05, 3.0, n), offset], axis=1)


def test_the_net_work_of_random_loads_is_the_integral_over_a_turn() -> None:
    random, plain, signs = np.random.default_rng(7), problem(PRESS), []
    for _ in range(40):
        machine = random_machine(random)
        designs = random_designs(random, 2)
        found = net_work(replace(plain, mechanism=machine), designs)
        turn = np.linspace(0.0, math.copysign(2.0 * math.pi, machine.speed), 8001)
        for design, work in zip(designs, found, strict=True):
            wanted = integral(machine, design, turn)
            assert work == pytest.approx(wanted, rel=1e-3, abs=1e-4 * _SIZE * design[0])
            signs.append(np.sign(work))
    assert min(signs.count(sign) for sign in (-1.0, 0.0, 1.0)) > 3


def test_the_net_work_of_random_loads_is_the_integral_over_a_swing_and_back() -> None:
    random, plain = np.random.default_rng(8), problem(PRESS, **SWING)
    motion = plain.motion
    assert motion is not None
    there = np.linspace(motion.start, motion.end, 8001)
    signs = []
    for _ in range(25):
        turning = random_machine(random)
        loads = [
            replace(each, datum="crank pivot") if isinstance(each, PositionTable | Spring) else each
            for each in turning.loads
            if not isinstance(
                each, Viscous | Drag | CrankTorqueTable
            )  # the swing is slow; tables are tried as loads on the slider
        ]
        machine = Mechanism(speed=0.0, branch=turning.branch, loads=tuple(loads))
        designs = random_designs(random, 2)
        found = net_work(replace(plain, mechanism=machine), designs)
        for design, work in zip(designs, found, strict=True):
            forth = integral(replace(machine, speed=1.0), design, there)
            back = integral(replace(machine, speed=-1.0), design, there[::-1])
            assert work == pytest.approx(forth + back, abs=1e-4 * _SIZE * design[0])
            signs.append(np.sign(work))
    assert min(signs.count(sign) for sign in (-1.0, 0.0, 1.0)) > 3


def test_a_load_that_pushes_with_the_stroke_is_questioned_with_its_sentence_and_its_work() -> None:
    asked = problem(PUSH)
    (said,) = driving_load_warnings(asked)
    assert said.startswith("in every sampled design loads do more work on the machine than they absorb, by ")
    assert "load #1 (350 N outward, helps the outward stroke, from 60 mm before the outer dead centre to it;" in said
    least, greatest = map(float, re.findall(r"by ([\d.]+) to ([\d.]+) J", said)[0])
    turn = np.linspace(0.0, 2.0 * math.pi, 20_001)
    works = [integral(part.mechanism, design, turn) for part, designs in sampled_designs(asked) for design in designs]
    assert (least, greatest) == pytest.approx((min(works), max(works)), rel=1e-3)


@pytest.mark.parametrize("load", [[PUSH, {"force": "900 N", "opposes": "motion"}], [PRESS], [ENGINE], [COMPRESSOR]])
def test_loads_that_take_more_than_they_give_and_engines_are_not_questioned(load: list[dict[str, Any]]) -> None:
    assert driving_load_warnings(problem(*load)) == []


@pytest.mark.parametrize(
    "load",
    [
        {"force": "350 N", "helps": "outward stroke", "over": "last 60 mm"},
        {"force": "350 N", "helps": "motion"},
        {"pressure_angles": ["0 deg", "45 deg", "180 deg"], "pressures": ["30 bar", "5 bar", "1 bar"], "bore": "50 mm"},
        {"stiffness": "5 N/mm", "free_position": "20 mm", "measured_from": "inner dead centre"},
        {"force": "350 N", "direction": "outward"},
    ],
)
def test_what_is_stated_to_help_and_what_gives_back_what_it_takes_is_not_questioned(load: dict[str, Any]) -> None:
    assert driving_load_warnings(problem(load)) == []


def test_loads_beside_one_that_is_stated_to_drive_are_questioned_alone() -> None:
    (said,) = driving_load_warnings(problem(ENGINE, PUSH))
    assert "loads that are not declared as driving do more work" in said
    assert "load #2 (350 N" in said
    assert "load #1" not in said
    assert driving_load_warnings(problem(ENGINE, {"crank_torque": "-50 N m"})) == []


def test_a_job_that_requires_delivered_work_states_an_engine() -> None:
    assert driving_load_warnings(problem(PUSH, constraints={"delivered_work": {"min": "0 J"}})) == []
    assert driving_load_warnings(problem(PUSH, constraints={"delivered_work": {"max": "90 J"}})) != []


def test_a_torque_with_the_rotation_is_questioned_and_one_against_it_is_not() -> None:
    for speed, torque in (("90 rpm", "5 N m"), ("-90 rpm", "-5 N m")):
        (said,) = driving_load_warnings(problem({"crank_torque": torque}, mechanism={"speed": speed}))
        assert f"by {2.0 * math.pi * 5.0:.4g} J per cycle" in said
    for speed, torque in (("90 rpm", "-5 N m"), ("-90 rpm", "5 N m")):
        assert driving_load_warnings(problem({"crank_torque": torque}, mechanism={"speed": speed})) == []


def test_cylinders_on_one_crankshaft_give_the_sum_of_their_works() -> None:
    fixed = {"variables": {"crank": "40 mm", "rod": "200 mm", "offset": "10 mm"}}
    three = {"speed": "90 rpm", "cylinders": {"phases": ["0 deg", "120 deg", "240 deg"]}}
    works = []
    for tables in ({}, {"mechanism": three}):
        ((part, designs),) = sampled_designs(problem(PUSH, **fixed, **tables, objectives={"peak_torque": "minimise"}))
        works.append(net_work(part, designs)[0])
    assert works[1] == pytest.approx(3.0 * works[0], rel=1e-9)


def test_a_cycle_of_two_turns_counts_both() -> None:
    table = {
        "torque_angles": ["0 deg", "360 deg", "720 deg"],
        "torques": ["0 N m", "6 N m", "0 N m"],
        "cycle": "720 deg",
    }
    (said,) = driving_load_warnings(problem(table))
    assert f"by {3.0 * 4.0 * math.pi:.4g} J per cycle" in said


def test_a_load_in_part_of_the_designs_is_said_to_be_in_part() -> None:
    """The load of 350 N resists within 80 mm of the dead centre and helps beyond, in long strokes."""
    table = PUSH | {"positions": ["0 mm", "80 mm", "80 mm", "90 mm"], "forces": ["-350 N", "-350 N", "350 N", "350 N"]}
    (said,) = driving_load_warnings(problem(table))
    assert said.startswith("in some sampled designs loads do more work")


def test_a_swing_is_questioned_without_a_word_of_delivered_work() -> None:
    (said,) = driving_load_warnings(
        problem({"force": "350 N", "direction": "outward", "during": "outward stroke"}, **SWING)
    )
    assert "350 N outward, helps the outward stroke" in said
    assert "delivered" not in said
    assert driving_load_warnings(problem(PRESS, **SWING)) == []


def test_numbers_that_vary_count_in_every_design() -> None:
    varying = JOB["variables"] | {"load.1.force": ["100 N", "300 N"]}
    load = {"force": "200 N", "direction": "outward", "during": "outward stroke"}
    (said,) = driving_load_warnings(problem(load, variables=varying))
    least, greatest = map(float, re.findall(r"by ([\d.]+) to ([\d.]+) J", said)[0])
    assert least >= 100.0 * 0.04 * 0.99
    assert greatest > 250.0 * 0.1
    helping = problem({"force": "200 N", "helps": "outward stroke"}, variables=varying)
    assert driving_load_warnings(helping) == []
    assert isinstance(helping.mechanism.loads[0], StrokeForce)


@pytest.mark.slow
def test_the_front_has_the_warning_too() -> None:
    (said,) = front_driving_load_warnings(solve(problem(PUSH)))
    assert said.startswith("in every design loads do more work on the machine than they absorb")
    assert front_driving_load_warnings(solve(problem(PRESS))) == []


def test_python_warns_once_of_a_problem_whose_loads_drive_it() -> None:
    with pytest.warns(InputWarning, match="do more work on the machine than they absorb") as caught:
        asked = stated(deepcopy(JOB))
    asked.evaluate([[0.05, 0.3, 0.02]])
    assert len(caught) == 1
    assert caught[0].filename == __file__


CORNER = {
    "mechanism": {"speed": "120 rpm"},
    "variables": {"crank": ["20 mm", "60 mm"], "rod": ["60 mm", "200 mm"], "offset": ["0 mm", "30 mm"]},
    "objectives": {"peak_torque": "minimise"},
}


@pytest.mark.parametrize("sign", [1, -1])
def test_a_load_that_drives_the_longest_strokes_alone_is_questioned_for_these(sign: int) -> None:
    """The force is 100 N up to 130 mm and -150 kN beyond: the longest strokes reverse the sign."""
    forces = [f"{sign * force} N" for force in (100, 100, -150_000, -150_000)]
    load = PUSH | {"positions": ["0 mm", "130 mm", "130 mm", "200 mm"], "forces": forces}
    (said,) = driving_load_warnings(problem(load, constraints={"stroke": {"min": "50 mm"}}, **CORNER))
    assert said.startswith("in some sampled designs loads do more work")


def test_designs_that_the_stroke_excludes_are_not_questioned() -> None:
    load = PUSH | {"positions": ["0 mm", "60 mm", "60 mm", "200 mm"], "forces": ["100 N", "100 N", "-5 kN", "-5 kN"]}
    assert driving_load_warnings(problem(load, constraints={"stroke": {"min": "80 mm"}}, **CORNER)) == []


@pytest.mark.parametrize("half", ["0.5 mm", "0.001 mm"])
def test_the_work_of_a_stroke_within_a_narrow_range_is_that_of_the_range(half: str) -> None:
    (said,) = driving_load_warnings(problem(PUSH, constraints={"stroke": {"equals": f"100 mm +- {half}"}}, **CORNER))
    assert all(
        float(end) == pytest.approx(35.0, abs=0.19)
        for end in re.findall(r"by ([\d.]+)(?: to ([\d.]+))? J", said)[0]
        if end
    )
