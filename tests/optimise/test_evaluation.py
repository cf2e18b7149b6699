"""The quick and the exact evaluation of a problem agree, with the quantities and with differences."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.force_transmission import TRANSMISSION_ANGLE
from slidercrank.optimise.problem.constraint_violation import FEASIBLE, constraints_with_floors, minimised_values
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint, Objective
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.piece_rows import Rows
from tests.optimise.independent import Array, excess, objectives, value
from tests.optimise.problems import Bounds, degrees, problem

FREE: dict[str, Bounds] = {
    "stroke": (0.15, 0.25),
    "transmission_angle": (degrees(25.0), None),
    "peak_torque": (None, 40.0),
    "rms_torque": (2.0, 30.0),
    "footprint": (0.02, 0.3),
    "rod_to_offset": (2.0, None),
}
WANTED = problem(
    {
        "peak_torque": "minimise",
        "time_ratio": 1.15,
        "transmission_angle": "maximise",
        "peak_slider_speed": "maximise",
        "footprint": 0.08,
    },
    FREE,
    offset=(-0.15, 0.15),
)
ELIMINATED = problem({"peak_torque": "minimise"}, {"stroke": 0.2, "peak_torque": (None, 40.0)}, crank=(0.08, 0.11))


def points(evaluator: Evaluator, count: int) -> Array:
    u = np.random.default_rng(11).random((count, evaluator.dimension))
    return u[evaluator.can_evaluate(u)]


def greatest(rows: Rows, owner: int) -> Array:
    return np.asarray(rows.values[:, rows.owner == owner].max(axis=1))


@pytest.mark.parametrize("wanted", [WANTED, ELIMINATED], ids=["free", "eliminated"])
def test_screened_designs_are_those_that_are_feasible(wanted: Problem) -> None:
    for branch in elimination_branches(wanted):
        evaluator = Evaluator(wanted, branch)
        u = np.random.default_rng(12).random((3000, evaluator.dimension))
        designs, values, violation = evaluator.screen_designs_objectives_violation(u)
        good = violation <= FEASIBLE
        assert 10 <= good.sum() < len(u)
        assert np.isfinite(values[good]).all()
        assert np.isnan(values[~good]).all()
        # Screened peaks are exact but where they sit on the kink of a load that changes at the dead centres.
        assert values[good] == pytest.approx(objectives(wanted, designs[good]), rel=2e-3, abs=1e-12)
        for constraint in wanted.constraints:
            assert excess(constraint, value(wanted, constraint.quantity, designs[good])).max() <= 2e-3
        assert good.sum() >= 0.99 * sum(
            np.logical_and.reduce(
                [excess(c, value(wanted, c.quantity, designs[turns])) <= 0.0 for c in wanted.constraints]
            ).sum()
            for turns in [np.isfinite(violation) & (violation <= 0.0)]
        )


@pytest.mark.parametrize("wanted", [WANTED, ELIMINATED], ids=["free", "eliminated"])
def test_exact_rows_are_objectives_and_relative_violations(wanted: Problem) -> None:
    for branch in elimination_branches(wanted):
        evaluator = Evaluator(wanted, branch)
        u = points(evaluator, 300)
        designs = branch.designs_at_points(u)
        goals, limits = evaluator.objective_and_constraint_rows(u)
        expected = objectives(wanted, designs)
        for column in range(len(wanted.objectives)):
            assert greatest(goals, column) == pytest.approx(expected[:, column], rel=1e-9, abs=1e-12)
        for owner, constraint in enumerate(evaluator.constraints):
            violation = excess(constraint, value(wanted, constraint.quantity, designs))
            assert greatest(limits, owner) == pytest.approx(violation, rel=1e-9, abs=1e-10)


@pytest.mark.parametrize("wanted", [WANTED, ELIMINATED], ids=["free", "eliminated"])
def test_slopes_of_all_rows_match_differences(wanted: Problem) -> None:
    """Fourth-order differences; rows whose pieces swap places between the points are left out."""
    for branch in elimination_branches(wanted):
        evaluator = Evaluator(wanted, branch)
        u = points(evaluator, 150)
        u = u[((u > 0.01) & (u < 0.99)).all(axis=1)]
        step = 1e-4
        for column in range(evaluator.dimension):
            move = np.zeros(evaluator.dimension)
            move[column] = step
            around = [u + n * move for n in (-2, -1, 0, 1, 2)]
            keep = np.all([evaluator.can_evaluate(points) for points in around], axis=0)
            rows = [evaluator.objective_and_constraint_rows(points[keep]) for points in around]
            for which in (0, 1):
                values = [np.where(np.isfinite(row[which].values), row[which].values, np.nan) for row in rows]
                slope = (8.0 * (values[3] - values[1]) - (values[4] - values[0])) / (12.0 * step)
                here = rows[2][which]
                steady = np.isfinite(slope) & np.isfinite(values[2])
                for row in rows:
                    steady &= np.abs(row[which].labels - here.labels) < 0.05
                wrong = np.abs(here.gradients[:, :, column] - slope) > 1e-5 * (1.0 + np.abs(slope) + np.abs(values[2]))
                # A piece may end within the step, where its neighbour takes its place under nearly the same label.
                assert steady.sum() >= 100
                assert (steady & wrong).sum() <= 0.01 * steady.sum()


def test_a_footprint_is_maximised_and_bounded_below_through_its_greatest_form() -> None:
    """It is the greater of two forms: with an offset longer than the crank the second one."""
    wanted = problem({"footprint": "maximise"}, {"footprint": (0.05, None)}, crank=(0.02, 0.05), offset=(0.06, 0.15))
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    u = points(evaluator, 50)
    area = value(wanted, "footprint", evaluator.branch.designs_at_points(u))
    goals, limits = evaluator.objective_and_constraint_rows(u)
    assert greatest(goals, 0) == pytest.approx(-area, rel=1e-12)
    assert greatest(limits, [c.quantity for c in evaluator.constraints].index("footprint")) == pytest.approx(
        (0.05 - area) / 0.05, rel=1e-12, abs=1e-12
    )


def test_ties_of_a_peak_are_rows_of_their_own() -> None:
    """Two equal forces half a turn apart, without masses: the peaks of the two strokes tie without offset."""
    pushing = Mechanism(loads=(StrokeForce(outward=-100.0, inward=100.0),))
    wanted = problem({"peak_torque": "minimise"}, offset=0.0, mechanism=pushing)
    goals, _ = Evaluator(wanted, elimination_branches(wanted)[0]).objective_and_constraint_rows(np.array([[0.5, 0.3]]))
    values = np.sort(goals.values[0])[::-1]
    assert values[0] == pytest.approx(values[1], rel=1e-12)


def test_an_infinite_quantity_makes_rows_without_slope() -> None:
    """Without offset the rod is infinitely many offsets long: a lower bound holds, an upper one does not."""
    for bounds, expected in (((3.2, None), -np.inf), ((None, 8.0), np.inf)):
        for offset in ((0.0, 0.1), (-0.1, 0.0)):
            wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.2, "rod_to_offset": bounds}, offset=offset)
            evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
            u = np.full((1, 2), 0.5)
            u[0, evaluator.branch.free.index("offset")] = 0.0
            _, limits = evaluator.objective_and_constraint_rows(u)
            owner = [c.quantity for c in evaluator.constraints].index("rod_to_offset")
            assert greatest(limits, owner)[0] == expected
            assert np.isfinite(limits.gradients).all()


@pytest.mark.parametrize("bounds", [(1.0, None), (None, 1.0)], ids=["least", "greatest"])
@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_what_is_not_a_number_meets_no_limit_and_is_no_optimum(bounds: Bounds, speed: float) -> None:
    # The guide locks every design here: there is no mean power, and its NaN has the sign of the speed.
    wanted = problem({"mean_power": "minimise"}, {"mean_torque": bounds})
    machine = replace(wanted.mechanism, speed=speed, friction=Friction(guide=20.0))
    wanted = replace(wanted, mechanism=machine)
    (evaluator, *_) = (Evaluator(wanted, branch) for branch in elimination_branches(wanted))
    u = points(evaluator, 20)
    goals, limits = evaluator.objective_and_constraint_rows(u)
    for rows, owner in ((goals, 0), (limits, [c.quantity for c in evaluator.constraints].index("mean_torque"))):
        assert (greatest(rows, owner) == np.inf).all()


def test_near_zero_offset_slopes_are_those_of_its_sheet() -> None:
    """The transmission angle has a kink at zero offset: along either branch it falls with |offset|."""
    for offset in ((0.0, 0.1), (-0.1, 0.0)):
        wanted = problem({"transmission_angle": "maximise"}, crank=0.1, rod=0.3, offset=offset)
        goals, _ = Evaluator(wanted, elimination_branches(wanted)[0]).objective_and_constraint_rows(np.zeros((1, 1)))
        # d mu / d a = -1 / sqrt(l^2 - r^2) for a range of 0.1 m; the objective is -mu.
        assert goals.gradients[0, 0, 0] == pytest.approx(0.1 / math.sqrt(0.3**2 - 0.1**2), rel=1e-12)


def test_the_transmission_angle_has_a_floor_where_none_is_set() -> None:
    def floor(bounds: Bounds | None) -> Constraint:
        held: dict[str, Bounds] = {} if bounds is None else {"transmission_angle": bounds}
        found = constraints_with_floors(problem({"peak_torque": "minimise"}, held))
        return next(constraint for constraint in found if constraint.quantity == "transmission_angle")

    assert floor(None).lower == pytest.approx(TRANSMISSION_ANGLE.floor)
    assert floor(None).upper is None
    assert floor((degrees(5.0), None)).lower == degrees(5.0)
    assert floor((None, degrees(60.0))).lower == pytest.approx(TRANSMISSION_ANGLE.floor)
    assert floor((None, degrees(60.0))).upper == degrees(60.0)
    assert floor((None, degrees(8.0))).lower == pytest.approx(degrees(4.0))
    assert floor(degrees(3.0)).equality


def test_objectives_are_minimised_as_they_are_negated_or_as_distances() -> None:
    values = np.array([1.0, 3.0])
    assert minimised_values(Objective(quantity="stroke", sense="minimise"), values).tolist() == [1.0, 3.0]
    assert minimised_values(Objective(quantity="stroke", sense="maximise"), values).tolist() == [-1.0, -3.0]
    assert minimised_values(Objective(quantity="stroke", sense="target", target=2.5), values).tolist() == [1.5, 0.5]


def test_a_band_lets_in_what_violates_by_less() -> None:
    wanted = problem({"peak_torque": "minimise"}, {"stroke": (0.2, 0.201), "peak_slider_speed": 4.0})
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    assert evaluator.loose
    u = points(evaluator, 4000)
    designs, values, violation = evaluator.screen_designs_objectives_violation(u, band=0.1)
    good = violation <= 0.1
    assert good.sum() >= 10
    assert np.isfinite(values[good]).all()
    for name, low, high in (("stroke", 0.18, 0.2211), ("peak_slider_speed", 3.6, 4.4)):
        assert value(wanted, name, designs[good]).min() >= low - 1e-9
        assert value(wanted, name, designs[good]).max() <= high + 1e-9


def test_a_bound_of_zero_is_absolute() -> None:
    """A relative violation has no meaning there: 1 N m of mean torque counts as one."""
    wanted = problem({"peak_torque": "minimise"}, {"mean_torque": (None, 0.0)})
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    u = points(evaluator, 20)
    _, limits = evaluator.objective_and_constraint_rows(u)
    owner = [c.quantity for c in evaluator.constraints].index("mean_torque")
    mean = value(wanted, "mean_torque", evaluator.branch.designs_at_points(u))
    assert greatest(limits, owner) == pytest.approx(mean, rel=1e-12)


def test_loads_that_cannot_be_screened_are_evaluated_exactly() -> None:
    table = AngleTable(angles=(0.0, 1.0, 3.0, 5.0), forces=(0.0, -50.0, -200.0, 0.0))
    wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.2}, mechanism=Mechanism(speed=3.0, loads=(table,)))
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    u = points(evaluator, 100)
    designs, values, violation = evaluator.screen_designs_objectives_violation(u)
    good = violation <= FEASIBLE
    assert values[good, 0] == pytest.approx(value(wanted, "peak_torque", designs[good]), rel=1e-12)


def test_evaluations_are_counted() -> None:
    wanted = problem({"peak_torque": "minimise"}, {"stroke": 0.2})
    evaluator = Evaluator(wanted, elimination_branches(wanted)[0])
    u = points(evaluator, 30)
    evaluator.screen_designs_objectives_violation(u)
    evaluator.objective_and_constraint_rows(u)
    assert evaluator.evaluations == 2 * len(u)


def test_the_cheapest_constraints_come_first() -> None:
    names = [constraint.quantity for constraint in Evaluator(WANTED, elimination_branches(WANTED)[0]).constraints]
    costly = [name in ("peak_torque", "rms_torque") for name in names]
    assert costly == sorted(costly)
    assert all(
        isinstance(constraint, Constraint)
        for constraint in Evaluator(WANTED, elimination_branches(WANTED)[0]).constraints
    )
