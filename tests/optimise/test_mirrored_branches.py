"""Mirror images of a design are delivered once, unless something tells them apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.search.candidates import FrontCandidates, Polished, object_array
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.mirrored_branches import drop_mirrored_branches
from slidercrank.optimise.solve import solve
from tests.optimise.methods.asking import asking
from tests.optimise.problems import MACHINE, problem

pytestmark = pytest.mark.usefixtures("little")

BARE = replace(MACHINE, gravity=(0.0, 0.0), loads=())
SPRING = Spring(stiffness=500.0, free_position=0.2)
WANTED: dict[str, Any] = {"peak_torque": "minimise", "time_ratio": "maximise"}


def either(machine: Mechanism, offset: tuple[float, float] = (-0.1, 0.1)) -> Problem:
    """Return a problem with offsets of either sign."""
    return problem(WANTED, {"stroke": (0.15, 0.25)}, offset=offset, mechanism=machine, designs=10, samples=256)


SAME = {
    "nothing": BARE,
    "gravity along the slider": replace(BARE, gravity=(-9.81, 0.0)),
    "a spring": replace(BARE, loads=(SPRING,)),
    "a constant force": replace(BARE, loads=(StrokeForce(outward=-50.0, inward=-50.0),)),
    "a table over the position": replace(BARE, loads=(PositionTable(positions=(0.0, 0.5), forces=(0.0, 90.0)),)),
}
APART = {
    "gravity": replace(BARE, gravity=(0.0, -9.81)),
    "a stroke's force": replace(BARE, loads=(StrokeForce(outward=-50.0, inward=0.0),)),
    "damping": replace(BARE, loads=(SPRING, Viscous(coefficient=30.0))),
    "a table over the angle": replace(BARE, loads=(AngleTable(angles=(0.1, 0.2), forces=(0.0, 1e-3)),)),
    "a stroke's table": replace(
        BARE, loads=(PositionTable(positions=(0.0, 0.5), forces=(0.0, 90.0), during="inward stroke"),)
    ),
    "friction": replace(BARE, friction=Friction(guide=0.1)),
    "acceleration": replace(BARE, acceleration=3.0),
}


@pytest.mark.parametrize("name", SAME)
def test_designs_that_are_equal_in_everything_are_delivered_once(name: str) -> None:
    """The values at the mirrored offset are computed, for the claim itself."""
    given = either(SAME[name])
    front = solve(given)
    assert (front.dimensions[:, 2] >= 0.0).all()
    mirrored = front.dimensions * [1.0, 1.0, -1.0]
    for column, name_of in enumerate(WANTED):
        values = given.quantity(name_of).evaluate(given.mechanism, mirrored).values
        assert values == pytest.approx(np.abs(front.values[:, column]), rel=1e-8)


@pytest.mark.parametrize("name", APART)
def test_both_sides_are_searched_where_something_tells_them_apart(name: str) -> None:
    given = either(APART[name])
    assert {branch.sign for branch in drop_mirrored_branches(given, elimination_branches(given))} == {-1.0, 1.0}


def test_the_side_with_the_wider_range_has_all() -> None:
    given = either(BARE, (-0.1, 0.05))
    (only,) = drop_mirrored_branches(given, elimination_branches(given))
    assert only.sign == -1.0
    assert only.bounds["offset"].upper == 0.1


def test_ranges_that_do_not_include_each_other_are_both_searched() -> None:
    given = either(BARE)
    near, far = (problem(WANTED, offset=ends).offset for ends in ((0.02, 0.06), (-0.08, -0.04)))
    variants = tuple(
        Variant(labels=(), mechanism=BARE, crank=given.crank, rod=given.rod, offset=offset) for offset in (near, far)
    )
    both = replace(given, variants=variants)
    assert len(drop_mirrored_branches(both, elimination_branches(both))) == 2
    twin = replace(variants[0], offset=problem(WANTED, offset=(-0.06, -0.02)).offset)
    twins = replace(given, variants=(twin, variants[0]))
    assert [branch.sign for branch in drop_mirrored_branches(twins, elimination_branches(twins))] == [1.0]
    labelled = replace(
        twins, choices=("side",), variants=tuple(replace(v, labels=(str(v.offset),)) for v in (twin, variants[0]))
    )
    assert len(drop_mirrored_branches(labelled, elimination_branches(labelled))) == 2


@pytest.mark.parametrize("method", ["sobol", "nsga2"])
def test_other_methods_deliver_no_twins_either(method: str) -> None:
    front = solve(asking(either(BARE), method, evaluations=300))
    assert (front.dimensions[:, 2] >= 0.0).all()


def finished(values: list[list[float]], *, residual: list[float] | None = None) -> FrontCandidates:
    """Return finished designs with these objectives, range one."""
    given = np.array(values)
    n, m = given.shape
    found = FrontCandidates.without_designs(np.ones(m))
    nothing = object_array((np.zeros(0), np.zeros((0, 3))) for _ in range(n))
    still = np.zeros(n) if residual is None else np.array(residual)
    part = Polished(
        np.full((n, 3), 0.5), given, np.zeros(n), still, nothing, object_array(np.zeros((0, 3)) for _ in range(n))
    )
    found.add_feasible(0, part)
    return found


def test_a_design_that_is_best_by_rounding_does_not_stay_beside_one_that_is_better_elsewhere() -> None:
    """722 W and 1444 W at the same time ratio."""
    values = [[0.0, 0.722, 0.3], [-1e-11, 1.444, 0.3 - 1e-11], [1.0, 0.1, 0.0], [0.5, 0.4, 1.3]]
    assert finished(values).nondominated_rows().tolist() == [0, 2, 3]
    assert finished(values, residual=[1e-3, 0.0, 0.0, 0.0]).nondominated_rows().tolist() == [0, 2, 3]


@pytest.mark.parametrize("seed", range(5))
def test_no_finished_design_is_as_good_as_another_one_and_better(seed: int) -> None:
    """Random designs, each with images that differ by rounding in some objectives and by a lot in others."""
    random = np.random.default_rng(seed)
    values = random.random((60, 3))
    images = values + random.choice([0.0, 1e-11, -1e-11, 3e-10, 0.4], values.shape)
    union = np.concatenate([values, images, images + 1e-12 * random.standard_normal(values.shape)])
    kept = union[finished(union.tolist()).nondominated_rows()]
    near = 1e-9 * np.ptp(kept, axis=0)
    for row in kept:
        assert ((kept <= row + near).all(axis=1)).sum() == 1
    for row in union:  # nothing is lost: each has one that is kept and that is as good to within what the polish leaves
        assert (kept <= row + 2e-7).all(axis=1).any()
