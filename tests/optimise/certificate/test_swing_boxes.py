"""Bounds over boxes of designs that swing hold every design of the box, as the compiled model computes it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorque
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.swing.swing import Swing
from slidercrank.objectives.tables.swing_columns import swing_quantities
from slidercrank.optimise.certificate.box_conditions import unbounded_reason
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Objective, Sense
from tests.case_count import in_turn
from tests.optimise import problems
from tests.optimise.certificate.test_box_bounds import assert_close_to_designs, check
from tests.optimise.problems import degrees, problem

LOADED = replace(
    problems.MACHINE,
    speed=0.0,
    crank=RigidLink(mass=3.0, centre=0.05, centre_across=0.02, inertia=0.02),
    gravity=(3.0, -9.0),
    loads=(
        StrokeForce(outward=-300.0, inward=40.0),
        Spring(stiffness=900.0, free_position=0.05),
        Viscous(coefficient=12.0),
        Drag(drag=40.0),
        PositionTable(positions=(0.0, 0.2, 0.3), forces=(400.0, 50.0, 90.0)),
        AngleTable(angles=(0.3, 2.0, 4.0), forces=(0.0, 200.0, -100.0), during="inward stroke"),
        CrankTorque(torque=3.0, resistance=2.0, crank_stiffness=1.5, free_angle=0.4),
    ),
)
STEPPED = replace(LOADED, loads=(PositionTable(positions=(0.0, 0.25, 0.25), forces=(0.0, -400.0, 100.0)),))
POINTS = ((0.0, 0.0), (0.3, 0.2), (0.6, 0.7), (1.0, 1.0))
SWINGS: dict[str, Swing] = {
    "slow": Swing(start=degrees(20.0), end=degrees(110.0)),
    "slow, back first": Swing(start=degrees(150.0), end=degrees(40.0)),
    "harmonic": Swing(start=degrees(20.0), end=degrees(110.0), law="harmonic", duration=0.5),
    "dead centre": Swing(start=degrees(-60.0), end=degrees(50.0), law="trapezoid", duration=0.4),
    "table": Swing(start=degrees(20.0), end=degrees(110.0), law="table", duration=0.4, points=POINTS),
    "places": Swing(start=0.30, end=0.22, stated_for="slider", law="cycloidal", duration=0.3),
    "places, right": Swing(start=0.24, end=0.31, stated_for="slider", side="right", law="polynomial", duration=0.3),
}


def swinging(machine: Mechanism, swing: Swing, offset: tuple[float, float] = (0.01, 0.1)) -> Problem:
    """Return a problem with every quantity of a swing that has a bound, in its sense."""
    given = problem({"crank_mass": "minimise"}, offset=offset, crank=(0.05, 0.12), rod=(0.15, 0.3))
    given = replace(given, mechanism=machine, motion=swing)
    senses: tuple[Sense, ...] = ("minimise", "maximise")
    wishes = [Objective(quantity=of.name, sense=sense) for of in swing_quantities(swing) for sense in senses]
    known = [wish for wish in wishes if not given.quantity(wish.quantity).undefined_because([machine])]
    found = {wish.quantity: wish for wish in known if not unbounded_reason(given, wish)}
    return replace(given, objectives=tuple(found.values()))


DRIVEN = [
    (name, driver) for name in SWINGS for driver in ("crank", "slider") if (name, driver) != ("dead centre", "slider")
]
"""Every swing and its driver; a slider drives no crank over a dead point."""


@pytest.mark.slow
@pytest.mark.parametrize(("driven", "machine", "width"), in_turn(4, DRIVEN, ("loaded", "stepped"), (0.1, 0.004)))
def test_no_sample_of_a_swing_is_better_than_its_box(driven: tuple[str, Any], machine: str, width: float) -> None:
    name, driver = driven
    swing = replace(SWINGS[name], driver=driver, actuator_tolerance=1e-4 if driver == "slider" else 0.0)
    given = swinging({"loaded": LOADED, "stepped": STEPPED}[machine], swing)
    assert len(given.objectives) >= 6
    assert check(given, width, count=120, inside=6) > 20


@pytest.mark.slow
@pytest.mark.parametrize(("name", "driver"), DRIVEN)
def test_a_box_of_one_design_is_bounded_by_the_design_that_swings(name: str, driver: Any) -> None:
    assert_close_to_designs(swinging(LOADED, replace(SWINGS[name], driver=driver)), 200, 1e-3)
