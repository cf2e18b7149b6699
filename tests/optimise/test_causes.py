"""Quantities that lack a cause - speed, masses, tolerances, friction - are refused with a remedy, or finite."""

from __future__ import annotations

import copy
import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.model.machine.links_and_joints import Friction, RigidLink
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism, Tolerances
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.robust.quantity import RobustQuantity
from slidercrank.objectives.tables.all_quantities import analyse
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.contradictory_problems import idle_constraint_warnings, require_nonzero_quantities
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range
from slidercrank.optimise.solve import solve
from tests.model.cases import fitted
from tests.optimise.test_always_zero_quantities import job

DESIGNS = np.array([[0.05, 0.2, 0.03], [0.03, 0.11, -0.02], [0.06, 0.25, 0.01]])
CAUSES = ("speed", "masses", "heavy crank", "gravity", "tolerances", "friction", "viscous load")


def machine(*causes: str) -> Mechanism:
    has = dict.fromkeys(CAUSES, False) | dict.fromkeys(causes, True)
    return Mechanism(
        speed=20.0 if has["speed"] else 0.0,
        crank=RigidLink(mass=0.5 if has["heavy crank"] else 0.0),
        rod=RigidLink(mass=0.8 if has["masses"] else 0.0),
        slider_mass=2.0 if has["masses"] else 0.0,
        gravity=(0.0, -9.81 if has["gravity"] else 0.0),
        tolerances=tolerances() if has["tolerances"] else Tolerances(),
        friction=Friction(guide=0.1) if has["friction"] else Friction(),
        loads=(Viscous(coefficient=30.0),) if has["viscous load"] else (),
    )


def tolerances() -> Tolerances:
    return parse_job(job("peak_torque")).mechanism.tolerances


def problem(mechanism: Mechanism, name: str, *constraints: Constraint) -> Problem:
    ends: dict[str, Any] = {
        "crank": Range(lower=0.03, upper=0.06),
        "rod": Range(lower=0.11, upper=0.3),
        "offset": Range(lower=0.01, upper=0.03),
    }
    objective = Objective(quantity=name, sense="minimise")
    return Problem(name="p", mechanism=mechanism, objectives=(objective,), constraints=constraints, **ends)


def refusal(given: Mechanism, name: str) -> str:
    """Return why a quantity is refused as an objective; empty if it is not."""
    try:
        require_nonzero_quantities(problem(given, name))
    except InputError as error:
        return str(error)
    return ""


@pytest.mark.slow
def test_every_quantity_without_some_cause_is_refused_with_its_remedy_or_finite_and_not_zero() -> None:
    refused = dict.fromkeys(QUANTITIES, 0)
    for mask in itertools.product((False, True), repeat=len(CAUSES)):
        given = machine(*itertools.compress(CAUSES, mask))
        table = analyse(given, DESIGNS)
        for name, quantity in QUANTITIES.items():
            said = refusal(given, name)
            if said:
                assert said.startswith(f"objectives.{name}: ")
                assert "; got " in said
                assert "for example, add" in said or "or add the load" in said
                refused[name] += 1
                continue
            found = quantity.evaluate(given, DESIGNS, gradients=True)
            assert found.gradients is not None
            assert np.isfinite(found.values).all(), name
            assert np.isfinite(found.gradients).all(), name
            assert np.isfinite(table[quantity.field]).all(), name
            assert np.abs(found.values).max() > 1e-9 * np.abs(DESIGNS).max(), name
    closed = {"time_ratio", "transmission_angle", "stroke", "rod_to_offset", "rod_to_crank", "footprint"}
    closed |= {"envelope_length", "envelope_height", "crank_angle_ratio"}
    closed |= {"outward_to_inward_time_ratio", "inward_to_outward_time_ratio"}
    assert {name for name, count in refused.items() if not count} == closed
    for name, quantity in QUANTITIES.items():  # the remedies, followed
        require_nonzero_quantities(problem(fitted(quantity, machine(*CAUSES)), name))


@pytest.mark.parametrize("name", ["position_error", "position_error_rss", "self_locking_margin"])
def test_an_undefined_quantity_is_refused_where_the_problem_is_made(name: str) -> None:
    bare, whole = machine("speed", "masses"), machine(*CAUSES)
    with pytest.raises(InputError, match=f"objectives.{name}: .* got none; for example, add"):
        problem(bare, name)
    limit = Constraint(quantity=name, upper=0.001)
    with pytest.raises(InputError, match=f"constraints.{name}: .* got none; for example, add"):
        problem(bare, "stroke", limit)
    own = (RobustQuantity(inner=QUANTITIES[name], side="high"),)
    with pytest.raises(InputError, match=f"objectives.{name}_robust: "):
        replace(problem(bare, "stroke"), own=own, objectives=(Objective(quantity=own[0].name, sense="minimise"),))
    kept = problem(whole, name, limit)
    ends: dict[str, Any] = {"crank": kept.crank, "rod": kept.rod, "offset": kept.offset}
    variants = tuple(Variant(labels=(str(n),), mechanism=of, **ends) for n, of in enumerate((whole, bare)))
    with pytest.raises(InputError, match="got none"):
        replace(kept, choices=("machine",), variants=variants)
    assert replace(kept, choices=("machine",), variants=variants[:1]).part(0).mechanism is whole


@pytest.mark.parametrize(
    ("bound", "said"),
    [
        ({"max": "-1e-15 N m"}, "max -1e-15 N m"),
        ({"min": "1e-15 N m"}, "min 1e-15 N m"),
        ({"equals": "3 N m"}, "equals 3 N m"),
        ({"min": "1 N m", "max": "2 N m"}, "min 1 N m"),
    ],
)
def test_a_requirement_that_zero_does_not_meet_is_refused_where_every_design_has_zero(
    bound: dict[str, str], said: str
) -> None:
    data = job("peak_torque") | {"constraints": {"mean_torque": bound}}
    with pytest.raises(JobError, match=f"constraints.mean_torque: {said} excludes zero, and it is zero for every"):
        parse_job(data)
    worked = copy.deepcopy(data) | {"load": [{"viscous": "20 N s/m"}]}
    stated = parse_job(worked)
    with pytest.raises(InputError, match=r"constraints.mean_torque: .* excludes zero"):
        solve(replace(stated, mechanism=replace(stated.mechanism, loads=())))


@pytest.mark.filterwarnings("ignore:requirements must be in SI")  # 1e9 of whatever
def test_a_rule_on_what_is_zero_for_every_design_is_told_to_leave_none_out() -> None:
    idle = 0
    for causes in ((), ("speed",), ("speed", "masses"), ("speed", "heavy crank"), ("gravity", "masses"), CAUSES):
        given = machine(*causes)
        for name in QUANTITIES:
            if QUANTITIES[name].undefined_because((given,)):
                continue
            told = idle_constraint_warnings(problem(given, "stroke", Constraint(quantity=name, upper=1e9)))
            why = refusal(given, name).removeprefix(f"objectives.{name}: ")
            assert len(told) == bool(why)
            assert all(sentence.startswith(f"constraints.{name} excludes no design: ") for sentence in told)
            assert all(sentence.endswith(why) for sentence in told)
            idle += len(told)
    assert idle > 20


@pytest.mark.parametrize("bound", [{"max": "0 N m"}, {"min": "-1 N m", "max": "1e-9 N m"}, {"min": "0 N m"}])
def test_a_requirement_that_zero_meets_is_kept(bound: dict[str, str]) -> None:
    assert len(parse_job(job("peak_torque") | {"constraints": {"mean_torque": bound}}).constraints) == 1
