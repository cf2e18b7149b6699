"""Refusals of a problem, in Python as in a job file."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.model.kinematics.target_motion import TargetMotion
from slidercrank.objectives.kinds import LENGTH
from slidercrank.objectives.motion_deviation import MotionDeviation
from slidercrank.objectives.torque_and_power import RMS_TORQUE
from slidercrank.optimise.front.choose_design import topsis_closeness
from slidercrank.optimise.problem.problem import Settings, Variant
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range
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
    with pytest.raises(InputError, match="must be a finite number in SI units; got nan"):
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


def test_either_spelling_of_a_sense_is_the_same_objective() -> None:
    for american, british in (("minimize", "minimise"), ("maximize", "maximise")):
        found = Objective(quantity="peak_torque", sense=american)  # type: ignore[arg-type]
        assert found == Objective(quantity="peak_torque", sense=british)  # type: ignore[arg-type]
        assert found.sense == british
    base = problem({"peak_torque": "minimise"}, {"stroke": 0.15}, samples=500)
    american_one = replace(base, objectives=(Objective(quantity="peak_torque", sense="minimize"),))  # type: ignore[arg-type]
    assert solve(american_one).dimensions.tolist() == solve(base).dimensions.tolist()


@pytest.mark.parametrize("sense", ["min", "Minimise", "", "best", None, 1, ["minimise"]])
def test_any_other_sense_is_refused_with_those_that_there_are(sense: object) -> None:
    with pytest.raises(InputError, match=r"must be 'minimise', 'minimize', 'maximise', 'maximize', 'target'; got"):
        Objective(quantity="peak_torque", sense=sense)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["", "peak torque", "Peak_torque", "peak-torque", None, 3, ("peak_torque",)])
def test_a_name_that_no_quantity_can_have_is_refused_at_once(name: object) -> None:
    with pytest.raises(InputError, match="the name of a quantity may only have lower-case letters"):
        Objective(quantity=name, sense="minimise")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="the name of a quantity may only have lower-case letters"):
        Constraint(quantity=name, lower=1.0)  # type: ignore[arg-type]


def test_an_unknown_quantity_of_a_choice_is_refused_at_construction() -> None:
    base = problem({"peak_torque": "minimise"})
    limit = Constraint(quantity="peak_torqe", upper=1.0)
    variant = Variant(
        labels=("a",), mechanism=base.mechanism, crank=base.crank, rod=base.rod, offset=base.offset, limits=(limit,)
    )
    with pytest.raises(InputError, match="did you mean peak_torque"):
        replace(base, choices=("motor",), variants=(variant,))


@pytest.mark.parametrize("value", ["20 mm", None, [0.1], 0.1j])
def test_what_is_no_number_is_refused_in_words(value: object) -> None:
    with pytest.raises(InputError, match="lower <= upper, both finite; got "):
        Range(lower=value, upper=0.2)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="must be a finite number in SI units; got"):
        Constraint(quantity="stroke", lower=0.1, upper=value if value is not None else "x")  # type: ignore[arg-type]
    with pytest.raises(
        InputError, match=r"must have a target if, and only if,|must be a finite number in SI units; got"
    ):
        Objective(quantity="stroke", sense="target", target=value)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [1.5, "100", True, math.nan])
def test_settings_are_whole_numbers(value: object) -> None:
    for name in ("designs", "samples", "seed"):
        with pytest.raises(InputError, match=f"{name} must be at least ., a whole number; got"):
            Settings(**{name: value})  # type: ignore[arg-type]
    with pytest.raises(InputError, match="designs must be at least 1, a whole number; got None"):
        Settings(designs=None)  # type: ignore[arg-type]


def test_words_of_other_parts_are_checked_too() -> None:
    """A word that is none of a `Literal` would be taken for the last of its words."""
    front = np.array([[0.0, 1.0], [1.0, 0.0]])
    with pytest.raises(InputError, match="normalisation must be 'range' or 'vector'; got 'Range'"):
        topsis_closeness(front, [1.0, 1.0], normalisation="Range")  # type: ignore[arg-type]
    target = TargetMotion(crank_angles=(0.0, 1.0, 2.0), positions=(0.1, 0.2, 0.3))
    with pytest.raises(InputError, match="measure must be 'greatest' or 'rms'; got 'RMS'"):
        MotionDeviation(name="x", title="x", kind=LENGTH, target=target, measure="RMS")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="statistic must be 'mean' or 'rms'; got 'peak'"):
        replace(RMS_TORQUE, statistic="peak")  # type: ignore[arg-type]


def test_a_target_belongs_to_the_sense_target_only() -> None:
    with pytest.raises(InputError, match="must have a target if, and only if,"):
        Objective(quantity="time_ratio", sense="target")
    with pytest.raises(InputError, match="must have a target if, and only if,"):
        Objective(quantity="time_ratio", sense="maximise", target=1.2)
    with pytest.raises(InputError, match="must be a finite number in SI units"):
        Objective(quantity="time_ratio", sense="target", target=math.inf)


def test_a_problem_needs_objectives_each_once() -> None:
    base = problem({"peak_torque": "minimise"}, {"stroke": (0.1, None)})
    with pytest.raises(InputError, match="at least one objective"):
        replace(base, objectives=())
    with pytest.raises(InputError, match="peak_torque may be given only once"):
        replace(base, objectives=base.objectives * 2)
    with pytest.raises(InputError, match="constraint on stroke may be given only once"):
        replace(base, constraints=base.constraints * 2)


def test_links_are_longer_than_zero() -> None:
    base = problem({"peak_torque": "minimise"})
    with pytest.raises(InputError, match="above zero"):
        replace(base, crank=Range(lower=0.0, upper=0.2))
    with pytest.raises(InputError, match="above zero"):
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
        solve(replace(problem({"peak_torque": "minimise"}), settings=Settings(method="guess")))


def test_lists_serve_as_tuples() -> None:
    given = problem({"peak_torque": "minimise", "stroke": "maximise"}, {"transmission_angle": (0.7, None)})
    names = ("objectives", "constraints", "own", "choices", "variants")
    lists: dict[str, Any] = {name: list(getattr(given, name)) for name in names}
    loose = replace(given, **lists)
    assert loose == given
    assert hash(loose) == hash(given)


def test_objectives_come_in_the_order_of_the_quantities_whatever_that_of_the_tables() -> None:
    tables: dict[str, object] = {
        "name": "order",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["60 mm", "250 mm"], "offset": ["0 mm", "50 mm"]},
    }
    wanted = ["2 * crank + rod", "peak_torque", "time_ratio"]
    ways = [sc.problem({**tables, "objectives": dict.fromkeys(order, "minimise")}) for order in (wanted, wanted[::-1])]
    assert ways[0] == ways[1]
    names = [objective.quantity for objective in ways[0].objectives]
    known = list(sc.quantities().index)
    assert names == [*sorted(wanted[1:], key=known.index), wanted[0]]
    design = [0.04, 0.1, 0.02]
    assert ways[0].evaluate(design).tolist() == [ways[0].analyse(design)[name] for name in names]


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"crank": (0.02, 0.06)}, "crank of a Problem must be Range; got (0.02, 0.06); change the problem with"),
        ({"rod": 0.1}, "rod of a Problem must be Range; got 0.1"),
        ({"constraints": ("stroke",)}, "constraints of a Problem must be a tuple of Constraint; got 'stroke'"),
        ({"objectives": ["stroke"]}, "objectives of a Problem must be a tuple of Objective; got 'stroke'"),
        ({"settings": {"designs": 3}}, "settings of a Problem must be Settings; got {'designs': 3}"),
        ({"mechanism": {"speed": 3.0}}, "mechanism of a Problem must be Mechanism; got {'speed': 3.0}"),
        ({"name": 3}, "name of a Problem must be str; got 3"),
    ],
)
def test_a_part_of_another_kind_is_refused_at_once(wrong: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        replace(problem({"peak_torque": "minimise"}), **wrong)


def test_the_table_of_quantities_has_every_key_that_jobs_may_name_and_what_it_needs() -> None:
    schema = sc.job_schema()["$defs"]
    known = sc.quantities()
    assert list(known.index) == list(schema["Objectives"]["properties"])
    assert set(schema["Constraints"]["properties"]) - set(known.index) == {"slow_stroke"}  # no quantity
    assert set(known.index[known["needs"] == ""]) >= {"stroke", "rod_to_offset", "transmission_angle"}
    assert known.loc["swing_energy", "needs"] == "it needs the table [motion]"
    assert known.loc["motion_deviation", "needs"] == "it needs the table [target_motion]"
    assert known.loc["position_error", "needs"] == "a position error needs tolerances"
    assert "material and pins" in str(known.loc["rod_stress", "needs"])
