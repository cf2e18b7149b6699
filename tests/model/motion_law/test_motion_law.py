"""Motion laws against definitions: differences, energy, forward integration, and laws known in closed form."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction, RigidLink
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.motion_law.law_turn import LawTurn
from slidercrank.model.motion_law.motion_law import CamTable, MotionLaw, cam_table_of_turn
from slidercrank.model.transient.crank_equation import CrankEquation
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from tests.model.law_cases import random_case

TURN = 2.0 * np.pi
BARE = Mechanism(speed=20.0, crank=RigidLink(mass=0.4, inertia=2e-3), rod=RigidLink(mass=0.5), slider_mass=0.8)
LINKAGE = Linkage(0.05, 0.2, 0.03)


@cache
def random_law(seed: int) -> MotionLaw:
    """Return a law of a random smooth torque that keeps at least a third of the mean kinetic energy."""
    machine, linkage = random_case(seed)
    turn = LawTurn(machine, linkage)
    random = np.random.default_rng(seed)
    size = float(np.abs(turn.terms.load).max())
    waves = random.uniform(-0.3, 0.3, (2, 3)) * size
    phases = np.arange(1, 4)[:, None] * turn.passed
    law = MotionLaw.from_torque_made_periodic(turn, waves[0] @ np.cos(phases) + waves[1] @ np.sin(phases), 0.0)
    mean = 0.5 * float(turn.terms.inertia.mean()) * machine.speed**2
    return replace(law, start_energy=mean / 3.0 - float(law.node_energies.min()))


@pytest.fixture(params=range(8))
def law(request: pytest.FixtureRequest) -> MotionLaw:
    return random_law(request.param)


def test_the_torque_of_the_speed_profile_evaluation_is_that_of_the_law(law: MotionLaw) -> None:
    angle = np.random.default_rng(1).uniform(0.0, TURN, 2000)
    curves = cycle(
        law.turn.machine, law.turn.linkage, angle, speed=law.speed_at(angle), acceleration=law.acceleration_at(angle)
    )
    size = np.abs(law.torque).max() + np.abs(law.turn.terms.load).max()
    np.testing.assert_allclose(curves.torque, law.torque_at(angle), rtol=0.0, atol=1e-9 * size)


def test_the_acceleration_is_the_speed_times_its_slope(law: MotionLaw) -> None:
    angle = np.random.default_rng(2).uniform(0.0, TURN, 300)
    step = 1e-6
    inside = law.turn.locate_in_cells(angle - step)[0] == law.turn.locate_in_cells(angle + step)[0]
    slope = (law.speed_at(angle + step) - law.speed_at(angle - step)) / (2.0 * step)
    found, size = law.acceleration_at(angle), np.abs(law.acceleration_at(angle)).max()
    assert inside.sum() > 200
    np.testing.assert_allclose(found[inside], (law.speed_at(angle) * slope)[inside], rtol=0.0, atol=1e-5 * size)


def test_the_drive_does_the_work_that_the_loads_take(law: MotionLaw) -> None:
    judged = speed_profile_cycle(law.turn.machine, law.turn.linkage, law.crank_motion)
    scale = TURN * float(np.abs(law.turn.terms.load).max())
    assert judged.work == pytest.approx(law.turn.work_absorbed_by_loads, abs=1e-10 * scale)
    assert judged.period == pytest.approx(law.period, rel=1e-10)
    assert judged.rms_torque == pytest.approx(law.rms_torque, rel=1e-8)
    assert judged.peaks["torque"].value == pytest.approx(np.abs(law.torque).max(), rel=1e-9)


def test_forward_dynamics_under_the_torque_of_the_law_give_the_law(law: MotionLaw) -> None:
    equation = CrankEquation(law.turn.machine, law.turn.linkage)
    reached, way = None, law.turn.way
    for span in equation.spans_in_passing_order(way):
        first, last = (span.low, span.high) if way > 0.0 else (span.high, span.low)
        reached = float(law.speed_at(np.array([first]))[0]) ** 2 if reached is None else reached

        def rate(angle: float, square: Any, span: Any = span) -> Any:
            terms = span.terms_at(np.array([angle]))
            static = terms.required_torque(0.0, 0.0) + terms.spin * square
            return 2.0 * (law.torque_at(np.array([angle])) - static) / terms.inertia

        run = solve_ivp(rate, (first, last), [reached], rtol=1e-10, atol=0.0, max_step=0.02)
        reached = float(run.y[0, -1])
        inner = run.t[1:-1]
        np.testing.assert_allclose(np.sqrt(run.y[0, 1:-1]), np.abs(law.speed_at(inner)), rtol=1e-6)


def test_times_are_integrals_of_the_inverse_speed_and_are_inverted(law: MotionLaw) -> None:
    turn = law.turn
    angle = turn.start + turn.way * np.array([0.3, 2.0, 4.4, 6.0])
    for each, time in zip(angle, law.time_at(angle), strict=True):
        knots = turn.start + turn.way * turn.passed[(turn.passed < abs(each - turn.start))]
        ends = [*knots, each]
        parts = (
            quad(lambda at: 1.0 / float(law.speed_at(np.array([at]))[0]), a, b, epsrel=1e-11)[0]
            for a, b in pairwise(ends)
        )
        assert time == pytest.approx(sum(parts), rel=1e-9)
    np.testing.assert_allclose(law.angle_at(law.time_at(angle)), angle, atol=1e-10)


def test_without_loads_a_constant_kinetic_energy_needs_no_torque() -> None:
    turn = LawTurn(replace(BARE, gravity=(0.0, 0.0)), LINKAGE)
    law = MotionLaw.from_torque_made_periodic(turn, np.zeros(len(turn.width)), 3.0)
    judged = speed_profile_cycle(turn.machine, LINKAGE, law.crank_motion)
    assert judged.fluctuation > 0.1
    constant = speed_profile_cycle(turn.machine, LINKAGE).peaks["torque"].value
    assert judged.peaks["torque"].value < 1e-10 * constant
    angle = np.linspace(0.0, TURN, 50)
    np.testing.assert_allclose(0.5 * turn.inertia_at(angle) * law.speed_at(angle) ** 2, 3.0, rtol=1e-12)


def read_back(table: CamTable, time: np.ndarray[Any, Any]) -> tuple[np.ndarray[Any, Any], ...]:
    """Return angle, speed and acceleration by the polynomial of degree 5 between points, as the format says."""
    at = np.clip(np.searchsorted(table.time, time, side="right") - 1, 0, len(table.time) - 2)
    span = table.time[at + 1] - table.time[at]
    u = (time - table.time[at]) / span
    rows = []
    for end in (0, 1):
        rows += [values[at + end] for values in (table.crank_angle, table.speed, table.acceleration)]
    p0, v0, a0, p1, v1, a1 = rows
    d, v0, v1, a0, a1 = p1 - p0, v0 * span, v1 * span, a0 * span**2, a1 * span**2
    c3 = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1
    c4 = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1
    c5 = 6.0 * d - 3.0 * (v0 + v1) - 0.5 * a0 + 0.5 * a1
    angle = p0 + u * (v0 + u * (0.5 * a0 + u * (c3 + u * (c4 + u * c5))))
    speed = (v0 + u * (a0 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / span
    acceleration = (a0 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / span**2
    return angle, speed, acceleration


def test_the_cam_table_gives_the_torque_to_a_thousandth(law: MotionLaw) -> None:
    table = cam_table_of_turn(law)
    assert len(table.time) > 1000
    assert np.all(np.diff(table.time) >= 0.0)
    assert table.time[-1] == pytest.approx(law.period)
    assert table.crank_angle[-1] - table.crank_angle[0] == pytest.approx(law.turn.way * TURN)
    random = np.random.default_rng(3)
    time = random.uniform(0.0, law.period, 5000)
    angle, speed, acceleration = read_back(table, time)
    np.testing.assert_allclose(np.mod(angle - law.angle_at(time) + 1.0, TURN), 1.0, atol=1e-7)
    curves = cycle(law.turn.machine, law.turn.linkage, angle, speed=speed, acceleration=acceleration)
    error = np.abs(curves.torque - law.torque_at(angle))
    assert error.max() < 1e-3 * np.abs(law.torque).max()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"loads": (Viscous(coefficient=3.0),)}, "accepts only loads that do not depend on the speed"),
        ({"loads": (Drag(drag=3.0),)}, "accepts only loads that do not depend on the speed"),
        ({"friction": Friction(guide=0.1)}, "without friction in the joints"),
        ({"arrangement": Arrangement(phases=(0.0, np.pi))}, "one cylinder"),
        ({"crank": RigidLink(mass=0.0), "rod": RigidLink(mass=0.0)}, "needs inertia at every angle"),
    ],
)
def test_machines_without_such_an_equation_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        LawTurn(replace(BARE, **changes), LINKAGE)
