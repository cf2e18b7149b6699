"""Machines that take no work over a turn: judged by their parts, compared with the mean torque of random ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.machine.work_absorption import may_do_work_over_a_turn
from slidercrank.model.signals.averages import torque_averages
from tests.model.cases import SMOOTH, random_designs
from tests.model.virtual_work import drive_torque

BARE = replace(SMOOTH, acceleration=0.0, loads=())
AT, FORCE = (0.0, 0.05, 0.1), (20.0, -30.0, 10.0)
TABLE = PositionTable(positions=AT, forces=FORCE, datum="inner dead centre")
IDLE: tuple[tuple[Load, ...], ...] = (
    (),
    (StrokeForce(outward=-200.0, inward=-200.0),),
    # In decimals these add up to nothing; as doubles, to 6e-17.
    (StrokeForce(outward=0.1, inward=0.0), StrokeForce(outward=0.2, inward=0.0), StrokeForce(outward=-0.3, inward=0.0)),
    (Spring(stiffness=900.0, free_position=0.1, datum="outer dead centre"),),
    (TABLE,),
    (replace(TABLE, during="outward stroke"), replace(TABLE, during="inward stroke")),
    (AngleTable(angles=(0.0, 1.0), forces=(50.0, 50.0)),),
)
WORKING: tuple[tuple[Load, ...], ...] = (
    (StrokeForce(outward=-200.0, inward=0.0),),
    (Viscous(coefficient=1e-3),),
    (replace(TABLE, during="outward stroke"),),
    (AngleTable(angles=(0.0, 1.0), forces=(50.0, 20.0)),),
    (AngleTable(angles=(0.0, 1.0), forces=(50.0, 50.0), during="outward stroke"),),
)


def mean_and_size(machine: Mechanism) -> tuple[float, float]:
    """Return the greatest mean torque of random designs by virtual work on many angles, and the greatest torque."""
    angles = np.linspace(0.0, 2.0 * np.pi, 40_000, endpoint=False) + 1e-6
    torque = np.array([drive_torque(machine, design, angles) for design in random_designs(4, seed=7, least_margin=0.1)])
    return float(np.abs(torque.mean(axis=1)).max()), float(np.abs(torque).max())


@pytest.mark.parametrize("loads", IDLE)
def test_loads_that_store_what_they_take_do_no_work_over_a_turn(loads: tuple[Load, ...]) -> None:
    machine = replace(BARE, loads=loads)
    assert not may_do_work_over_a_turn(machine)
    mean, size = mean_and_size(machine)
    assert mean < 1e-6 * size
    found = torque_averages(machine, random_designs(20, seed=8, least_margin=0.1), gradients=True)
    assert not found.mean.any()
    assert found.mean_gradients is not None
    assert not found.mean_gradients.any()
    assert (found.rms > 0.0).all()


@pytest.mark.parametrize("loads", WORKING)
def test_loads_that_do_not_give_it_back_work(loads: tuple[Load, ...]) -> None:
    machine = replace(BARE, loads=loads)
    assert may_do_work_over_a_turn(machine)
    assert torque_averages(machine, random_designs(20, seed=8, least_margin=0.1)).mean.all()


def test_friction_and_acceleration_work_and_a_crank_at_rest_moves_no_damper() -> None:
    assert may_do_work_over_a_turn(replace(BARE, acceleration=1.0))
    assert may_do_work_over_a_turn(replace(BARE, friction=Friction(guide=0.1)))
    assert may_do_work_over_a_turn(replace(BARE, friction=Friction(slider_pin=Pin(radius=0.01, coefficient=0.1))))
    assert not may_do_work_over_a_turn(replace(BARE, speed=0.0, loads=(Viscous(coefficient=10.0),)))


def test_a_machine_works_if_it_does_for_some_value_of_what_varies() -> None:
    def varied(*sets: tuple[str, float]) -> Mechanism:
        item = Varying(name="push", sets=sets, lower=-150.0, upper=200.0)
        return replace(BARE, loads=(StrokeForce(outward=200.0, inward=200.0),), varying=(item,))

    assert may_do_work_over_a_turn(varied(("loads.0.outward", 1.0)))
    assert not may_do_work_over_a_turn(varied(("loads.0.outward", 1.0), ("loads.0.inward", 1.0)))
