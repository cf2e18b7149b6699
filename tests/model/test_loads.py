"""Loads on the slider: what each one is, at which place it acts, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.load import Entry, Load, Table
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism

LINKAGE = Linkage(0.05, 0.2, 0.03)
INNER, OUTER = (float(end) for end in LINKAGE.dead_centres)
AT_INNER, AT_OUTER = (float(angle) for angle in LINKAGE.dead_centre_angles)
# The outward stroke ends at the outer dead centre, counter-clockwise.
WRONG: Any = "down"
OUTWARD, INWARD = AT_OUTER - 0.9, AT_OUTER + 0.9


def load_at(angle: float, *loads: Load, speed: float = 1.0) -> float:
    return float(cycle(Mechanism(speed=speed, loads=loads), LINKAGE, angle).load[0])


def position_at(angle: float) -> float:
    return float(LINKAGE.at(angle).slider_position)


def test_stroke_force_changes_with_the_stroke_and_with_the_direction_of_rotation() -> None:
    load = StrokeForce(outward=-7.0, inward=3.0)
    assert load_at(OUTWARD, load) == -7.0
    assert load_at(INWARD, load) == 3.0
    assert load_at(OUTWARD, load, speed=-1.0) == 3.0
    assert load_at(INWARD, load, speed=-1.0) == -7.0


@pytest.mark.parametrize(
    ("spring", "rest"),
    [
        (Spring(stiffness=500.0, free_position=0.21), 0.21),
        (Spring(stiffness=500.0, free_position=0.03, datum="inner dead centre"), INNER + 0.03),
        (Spring(stiffness=500.0, free_position=0.03, datum="outer dead centre"), OUTER - 0.03),
    ],
    ids=["pivot", "inner", "outer"],
)
def test_spring_pulls_to_its_rest_point_from_either_side(spring: Spring, rest: float) -> None:
    for angle in (AT_OUTER, AT_INNER, 1.0, 4.0):
        expected = 500.0 * (rest - position_at(angle))
        assert load_at(angle, spring) == pytest.approx(expected, rel=0.0, abs=1e-12)


def test_viscous_load_opposes_the_velocity() -> None:
    velocity = float(LINKAGE.at(INWARD, speed=8.0).slider_velocity)
    assert velocity < 0.0
    assert load_at(INWARD, Viscous(coefficient=20.0), speed=8.0) == pytest.approx(-20.0 * velocity, rel=1e-13)
    assert load_at(INWARD, Viscous(coefficient=20.0), speed=-8.0) == pytest.approx(20.0 * velocity, rel=1e-13)


@pytest.mark.parametrize("angle", [OUTWARD, INWARD, 0.1, 3.0, 5.5])
def test_position_table_is_interpolated_and_constant_beyond_its_ends(angle: float) -> None:
    positions, forces = (0.02, 0.05, 0.06), (10.0, -40.0, 5.0)
    x = position_at(angle)
    for table, counted in (
        (PositionTable(positions=positions, forces=forces, datum="inner dead centre"), x - INNER),
        (PositionTable(positions=positions, forces=forces, datum="outer dead centre"), OUTER - x),
        (PositionTable(positions=tuple(0.16 + p for p in positions), forces=forces), x - 0.16),
    ):
        expected = np.interp(counted, positions, forces)
        # Slopes up to 2e3 N/m times rounding of the position.
        assert load_at(angle, table) == pytest.approx(expected, rel=0.0, abs=1e-11)


@pytest.mark.parametrize("angle", [-7.0, -0.2, 0.0, 0.5, 3.0, 6.2, 6.4, 20.0])
def test_angle_table_is_interpolated_and_periodic(angle: float) -> None:
    angles, forces = (0.5, 2.0, 5.9), (3.0, -6.0, 12.0)
    expected = np.interp(angle, angles, forces, period=2.0 * math.pi)
    assert load_at(angle, AngleTable(angles=angles, forces=forces)) == pytest.approx(expected, rel=0.0, abs=1e-12)
    turned = tuple(a - 4.0 * math.pi for a in angles)
    assert load_at(angle, AngleTable(angles=turned, forces=forces)) == pytest.approx(expected, rel=0.0, abs=1e-12)


@pytest.mark.parametrize("load", ["position", "angle"])
def test_table_acts_in_its_stroke_only(load: str) -> None:
    for during, there, not_there in (
        ("outward stroke", OUTWARD, INWARD),
        ("inward stroke", INWARD, OUTWARD),
    ):
        table: Any = (
            PositionTable(positions=(0.0, 1.0), forces=(9.0, 9.0), during=during)  # type: ignore[arg-type]
            if load == "position"
            else AngleTable(angles=(0.0, 1.0), forces=(9.0, 9.0), during=during)  # type: ignore[arg-type]
        )
        assert load_at(there, table) == 9.0
        assert load_at(not_there, table) == 0.0


def test_loads_add_up() -> None:
    loads = (
        StrokeForce(outward=-7.0, inward=3.0),
        Spring(stiffness=500.0),
        Spring(stiffness=20.0, datum="outer dead centre"),
        Viscous(coefficient=4.0),
        PositionTable(positions=(0.16, 0.3), forces=(0.0, 40.0)),
        AngleTable(angles=(0.0, 2.0), forces=(1.0, 2.0)),
    )
    total = sum(load_at(OUTWARD, load, speed=6.0) for load in loads)
    assert load_at(OUTWARD, *loads, speed=6.0) == pytest.approx(total, rel=1e-13)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: StrokeForce(outward=math.nan, inward=0.0), "outward of a StrokeForce must be finite; got nan"),
        (lambda: StrokeForce(outward=0.0, inward=math.inf), "inward of a StrokeForce must be finite; got inf"),
        (lambda: Spring(stiffness=math.nan), "stiffness of a Spring must be finite"),
        (lambda: Spring(stiffness=1.0, free_position=-math.inf), "free_position of a Spring must be finite"),
        (lambda: Viscous(coefficient=math.nan), "coefficient of a Viscous must be finite"),
        (
            lambda: PositionTable(positions=(0.0,), forces=(1.0,)),
            "as many forces as positions, at least two; got 1 positions and 1 forces",
        ),
        (
            lambda: PositionTable(positions=(0.0, 1.0), forces=(1.0, 2.0, 3.0)),
            "as many forces as positions, at least two; got 2 positions and 3 forces",
        ),
        (
            lambda: PositionTable(positions=(0.0, math.nan), forces=(1.0, 2.0)),
            "a table of positions and forces must be finite",
        ),
        (
            lambda: AngleTable(angles=(0.0, 1.0), forces=(1.0, math.inf)),
            "a table of angles and forces must be finite",
        ),
        (
            lambda: PositionTable(positions=(0.0, 2.0, 1.0), forces=(1.0, 2.0, 3.0)),
            "positions of a table must increase; got 1 after 2; sort the table",
        ),
        (
            lambda: AngleTable(angles=(0.0, 1.0, 0.5), forces=(1.0, 2.0, 3.0)),
            "angles of a table must increase; got 0.5 after 1; sort the table",
        ),
        (
            lambda: AngleTable(angles=(0.0, 2.5 * math.pi), forces=(1.0, 1.0)),
            "must span at most 360 deg; got 450 deg; for a cycle of two turns",
        ),
    ],
)
def test_wrong_load_is_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Spring(stiffness=1.0, datum=WRONG), "datum must be .*; got 'down'"),
        (lambda: PositionTable(positions=(0, 1), forces=(0, 1), datum=WRONG), "datum must be .*; got 'down'"),
        (lambda: PositionTable(positions=(0, 1), forces=(0, 1), during=WRONG), "during must be .*; got 'down'"),
        (lambda: AngleTable(angles=(0, 1), forces=(0, 1), during=WRONG), "during must be .*; got 'down'"),
    ],
)
def test_unknown_word_in_a_load_is_refused(make: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


def test_a_table_that_lies_beyond_its_dead_centre_is_refused() -> None:
    with pytest.raises(InputError, match=r"zero or more; got -12 mm to 0 mm, .* reverse the signs"):
        PositionTable(positions=(-0.012, 0.0), forces=(0.0, 2e4), datum="outer dead centre")
    PositionTable(positions=(-0.012, 0.0), forces=(0.0, 2e4))


def test_a_table_of_loads_is_told_by_one_of_its_keys() -> None:
    entries = (Entry("pull", "Stiffness", "force per distance", "5 N/mm"),)
    with pytest.raises(ValueError, match="identified by the key of one of its entries; got 'magnet'"):
        Table("magnet", "MagnetLoad", "magnet", "A magnet.", entries, {"pull": "5 N/mm"}, Spring)
