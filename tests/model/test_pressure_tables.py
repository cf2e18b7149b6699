"""Tables over crank angle from a dead centre, and of pressures: force, gradients, running, refusals, job file."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.linkage.loaded_stroke import loaded_stroke
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.crank_equation import CrankEquation
from slidercrank.optimise.job import parse_job

Array = NDArray[np.float64]
TURN = 2.0 * math.pi


def random_case(seed: int) -> tuple[Mechanism, AngleTable, Array]:
    """Return a machine with one table from a dead centre, the table, and designs (3, 3) that turn fully."""
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(-0.5, TURN - 0.6, random.integers(2, 9)))
    table = AngleTable(
        angles=tuple(angles),
        forces=tuple(random.uniform(-900.0, 900.0, len(angles))),
        datum=random.choice(["inner dead centre", "outer dead centre"]),
        during=random.choice(["cycle", "outward stroke"]),
    )
    machine = Mechanism(
        speed=random.choice([-20.0, 30.0]), loads=(table,), branch=random.choice(["open", "crossed"]), slider_mass=0.3
    )
    crank, offset = random.uniform(0.02, 0.06, 3), random.uniform(-0.04, 0.04, 3)
    rod = (crank + np.abs(offset)) * random.uniform(1.1, 4.0, 3)
    return machine, table, np.column_stack([crank, rod, offset])


@pytest.mark.parametrize("seed", range(12))
def test_angles_count_from_the_dead_centre_in_the_sense_of_rotation(seed: int) -> None:
    machine, table, designs = random_case(seed)
    theta = np.random.default_rng(seed).uniform(0.0, TURN, 300)
    for crank, rod, offset in designs:
        linkage = Linkage(crank, rod, offset, machine.branch)
        datum = float(linkage.dead_centre_angles[0 if table.datum == "inner dead centre" else 1])
        found = cycle(machine, linkage, theta)
        wanted = np.interp(machine.direction * (theta - datum), table.angles, table.forces, period=TURN)
        outward = found.slider_velocity * np.sign(found.slider_position) > 0.0
        wanted = np.where(outward | (table.during == "cycle"), wanted, 0.0)
        assert np.abs(found.load - wanted).max() <= 1e-10 * np.abs(table.forces).max()


@pytest.mark.parametrize("seed", range(6))
def test_gradients_of_peaks_and_means_follow_the_datum(seed: int) -> None:
    machine, table, designs = random_case(seed)
    machine = replace(machine, loads=(replace(table, during="cycle"),))
    averages = torque_averages(machine, designs, gradients=True)
    peaks = find_peaks(machine, Signal.TORQUE, designs, gradients=True)
    assert averages.mean_gradients is not None
    assert peaks.gradients is not None
    size = np.abs(peaks.gradients[:, 0]).max(axis=1)
    for column in range(3):
        step = 1e-7 * np.eye(3)[column]
        ends = [designs + step, designs - step]
        means = [torque_averages(machine, end).mean for end in ends]
        slope = (means[0] - means[1]) / 2e-7
        assert np.abs(averages.mean_gradients[:, column] - slope).max() <= 1e-5 * size.max()
        tops = [find_peaks(machine, Signal.TORQUE, end).values[:, 0] for end in ends]
        assert np.abs(peaks.gradients[:, 0, column] - (tops[0] - tops[1]) / 2e-7).max() <= 1e-5 * size.max()


@pytest.mark.parametrize("seed", range(6))
def test_the_crank_under_a_motor_feels_the_same_load(seed: int) -> None:
    machine, _, designs = random_case(seed)
    linkage = Linkage(designs[0, 0], designs[0, 1], designs[0, 2], machine.branch)
    equation = CrankEquation(replace(machine, drive=Drive(motor=ConstantTorque(torque=1.0))), linkage)
    for stretch in equation.spans_in_passing_order(machine.direction):
        theta = np.linspace(stretch.low, stretch.high, 7)[1:-1]
        load = cycle(machine, linkage, theta)
        power = load.load * load.slider_velocity * np.sign(load.slider_position) / machine.speed
        assert np.abs(stretch.terms_at(theta).load - power).max() <= 1e-10 * np.abs(power).max() + 1e-12


def test_the_loaded_stroke_counts_from_the_dead_centre() -> None:
    """A force against the outward stroke for the 150 deg after the inner dead centre, whichever way the crank turns."""
    table = AngleTable(angles=(0.0, 0.1, 2.6, 2.7), forces=(0.0, -500.0, -500.0, 0.0), datum="inner dead centre")
    designs = np.array([[0.03, 0.1, 0.01], [0.03, 0.1, -0.02]])
    for speed in (10.0, -10.0):
        for branch in ("open", "crossed"):
            found = loaded_stroke(Mechanism(speed=speed, loads=(table,), branch=branch), designs)
            assert found.tolist() == ["outward", "outward"]


JOB: dict[str, Any] = {
    "name": "cylinder",
    "mechanism": {"speed": "900 rpm"},
    "variables": {"crank": ["20 mm", "40 mm"], "rod": ["80 mm", "200 mm"], "offset": "0 mm"},
    "objectives": {"peak_torque": "minimise"},
}
OVER_ANGLE = {"pressure_angles": ["0 deg", "40 deg", "300 deg"], "bore": "100 mm", "pressures": ["8 bar", "1 bar", 2e5]}
OVER_POSITION = {"pressure_positions": ["0 mm", "20 mm"], "bore": "100 mm", "pressures": ["8 bar", "1 bar"]}
AREA = 0.25 * math.pi * 0.1**2


def built(table: dict[str, Any]) -> Any:
    return parse_job({**JOB, "load": [table]}).mechanism.loads[0]


def test_pressures_of_a_job_file_push_the_piston_away_from_its_head() -> None:
    found = built(OVER_ANGLE)
    assert isinstance(found, AngleTable)
    assert found.datum == "outer dead centre"
    assert found.angles == pytest.approx([0.0, math.radians(40.0), math.radians(300.0)])
    assert found.forces == pytest.approx([-AREA * (p - 101_325.0) for p in (8e5, 1e5, 2e5)], rel=1e-12)
    other = {**OVER_POSITION, "head": "inner dead centre", "back_pressure": 0, "piston_rod": "60 mm", "during": "cycle"}
    found = built(other)
    assert isinstance(found, PositionTable)
    assert (found.datum, found.positions) == ("inner dead centre", (0.0, 0.02))
    assert found.forces == pytest.approx([0.64 * AREA * p for p in (8e5, 1e5)], rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (
            {"pressures": ["8 bar", "-0.2 bar", "1 bar"]},
            'pressures.*at or above vacuum, 0; got "-0.2 bar"; add the ambient pressure, about 1.01325 bar, to a gauge',
        ),
        ({"back_pressure": "-1 bar"}, 'back_pressure.*at or above vacuum, 0; got "-1 bar"'),
        (
            {"pressure_angles": ["40 deg", "40 deg", "40 deg"]},
            'must increase, except for two equal ones at a step; got "40 deg" three times',
        ),
        ({"bore": "0 mm"}, "bore: must be positive"),
        ({"piston_rod": "100 mm"}, "thinner than the bore; got 100 mm"),
        (
            {"pressure_angles": ["0 deg", "40 deg", "720 deg"]},
            "at most 360 deg; got 720 deg; for a cycle of two turns",
        ),
        ({"pressure_angles": ["0 deg", "40 deg", "30 deg"]}, "must increase; got"),
        ({"pressures": ["1 bar", "2 bar"]}, "got 2 pressures at 3 points"),
    ],
)
def test_a_wrong_table_of_pressures_is_refused_at_its_key(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        built({**OVER_ANGLE, **wrong})


def test_tables_of_more_than_a_turn_are_refused_with_what_they_need() -> None:
    degrees, forces = (0.0, 180.0, 720.0), (5.0, 1.0, 5.0)
    with pytest.raises(InputError, match="for a cycle of two turns, set cycle"):
        AngleTable(angles=tuple(np.radians(degrees).tolist()), forces=forces)
