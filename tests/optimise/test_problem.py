"""What a problem refuses, in Python as in a job file."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.problem import Constraint, Objective, Range, Settings
from slidercrank.optimise.solve import solve
from tests.optimise.problems import problem


@pytest.mark.parametrize(("lower", "upper"), [(1.0, 0.5), (math.nan, 1.0), (0.0, math.inf)])
def test_a_range_has_two_finite_ends_in_order(lower: float, upper: float) -> None:
    with pytest.raises(InputError, match="lower <= upper, both finite; got"):
        Range(lower=lower, upper=upper)


def test_a_range_of_one_value_is_fixed() -> None:
    assert Range(lower=0.1, upper=0.1).fixed
    assert not Range(lower=0.1, upper=0.2).fixed


def test_a_constraint_needs_a_finite_bound_in_order() -> None:
    with pytest.raises(InputError, match="needs a lower bound, an upper bound or a value"):
        Constraint(quantity="stroke")
    with pytest.raises(InputError, match="must be finite; got nan"):
        Constraint(quantity="stroke", lower=math.nan)
    with pytest.raises(InputError, match=r"is empty: min 2 exceeds max 1"):
        Constraint(quantity="stroke", lower=2.0, upper=1.0)
    assert Constraint(quantity="stroke", lower=1.0, upper=1.0).equality
    assert not Constraint(quantity="stroke", lower=1.0).equality


def test_an_unknown_quantity_is_named_with_the_nearest_one() -> None:
    with pytest.raises(InputError, match="did you mean peak_torque"):
        problem({"peak_torqe": "minimise"})
    with pytest.raises(InputError, match="no quantity is called"):
        problem({"peak_torque": "minimise"}, {"strok": (1.0, None)})


def test_a_target_belongs_to_the_sense_target_only() -> None:
    with pytest.raises(InputError, match="needs a target exactly when"):
        Objective(quantity="time_ratio", sense="target")
    with pytest.raises(InputError, match="needs a target exactly when"):
        Objective(quantity="time_ratio", sense="maximise", target=1.2)
    with pytest.raises(InputError, match="must be finite"):
        Objective(quantity="time_ratio", sense="target", target=math.inf)


def test_a_problem_needs_objectives_each_once() -> None:
    base = problem({"peak_torque": "minimise"}, {"stroke": (0.1, None)})
    with pytest.raises(InputError, match="at least one objective"):
        replace(base, objectives=())
    with pytest.raises(InputError, match="peak_torque is given twice"):
        replace(base, objectives=base.objectives * 2)
    with pytest.raises(InputError, match="constraint on stroke is given twice"):
        replace(base, constraints=base.constraints * 2)


def test_links_are_longer_than_zero() -> None:
    base = problem({"peak_torque": "minimise"})
    with pytest.raises(InputError, match="longer than zero"):
        replace(base, crank=Range(lower=0.0, upper=0.2))
    with pytest.raises(InputError, match="longer than zero"):
        replace(base, rod=Range(lower=0.0, upper=0.2))


def test_rod_to_offset_is_not_maximised_where_the_offset_may_vanish() -> None:
    for offset in ((0.0, 0.1), (-0.1, 0.0), (-0.1, 0.1)):
        with pytest.raises(InputError, match="grows without bound"):
            problem({"rod_to_offset": "maximise"}, offset=offset)
    front = solve(problem({"rod_to_offset": "maximise"}, offset=(0.05, 0.1)))
    assert front.dimensions[0].tolist()[1:] == [0.6, 0.05]


@pytest.mark.parametrize(("name", "value"), [("designs", 0), ("samples", 0), ("evaluations", 0), ("seed", -1)])
def test_settings_are_within_their_limits(name: str, value: int) -> None:
    values: dict[str, int] = {name: value}
    with pytest.raises(InputError, match=f"{name} must be at least"):
        Settings(**values)  # type: ignore[arg-type]


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(InputError, match=r"must be one of auto, slsqp, .*; got 'guess'"):
        Settings(method="guess")
