"""Formulas in jobs: what they mean, how they are shown, what is refused."""

from __future__ import annotations

import copy
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.objectives.formula.quantity import FormulaQuantity
from slidercrank.optimise.job import job_schema, parse_job
from slidercrank.optimise.job.custom_quantities import declared_quantities
from slidercrank.optimise.job.model import job_type_with_quantities
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.solve import solve

pytestmark = pytest.mark.usefixtures("little")

FEEDER = tomllib.loads((Path(__file__).parents[2] / "runs" / "feeder.toml").read_text(encoding="utf-8"))
DESIGNS = np.array([[0.04, 0.1, 0.02], [0.03, 0.12, 0.04]])


def job(**tables: dict[str, Any]) -> dict[str, Any]:
    """Return the feeder with more entries in some of its tables."""
    found = copy.deepcopy(FEEDER)
    for name, more in tables.items():
        found[name] = found.get(name, {}) | more
    return found


def parsed(**tables: dict[str, Any]) -> Problem:
    return parse_job(job(**tables))


def values(problem: Problem, name: str) -> Any:
    return problem.evaluate(DESIGNS, [name])[:, 0]


def test_a_formula_is_a_quantity_of_the_problem_with_kind_column_and_title() -> None:
    problem = parsed(
        constraints={"offset-crank": {"max": "1 mm"}},
        objectives={"peak_torque_outward / peak_torque_inward": "minimise", "peak_torque / crank^2": "maximise"},
    )
    known = {of.name: of for of in problem.own}
    ratio = known["peak_torque_outward / peak_torque_inward"]
    clearance, product = known["offset - crank"], known["peak_torque / crank**2"]
    assert (clearance.name, clearance.field, clearance.unit.symbol) == ("offset - crank", "offset_minus_crank_mm", "mm")
    assert (ratio.field, ratio.kind.name_without_article) == ("peak_torque_outward_per_peak_torque_inward", "ratio")
    assert (product.unit.symbol, product.kind.name_without_article) == ("N/m", "stiffness")
    np.testing.assert_allclose(values(problem, "offset - crank"), [-0.02, 0.01], rtol=1e-13)
    sides = problem.evaluate(DESIGNS, ["peak_torque_outward", "peak_torque_inward"])
    np.testing.assert_allclose(values(problem, ratio.name), sides[:, 0] / sides[:, 1], rtol=1e-15)
    assert problem.constraints[-1].upper == 0.001
    assert pickle.loads(pickle.dumps(problem)) == problem


def test_a_product_without_a_kind_of_its_own_is_in_si_base_units() -> None:
    problem = parsed(objectives={"peak_torque * crank": "minimise"})
    assert problem.own[0].unit.symbol == "m^3 kg s^-2"
    assert problem.own[0].unit.factor == 1.0


def test_named_formulas_have_a_title_and_a_unit_and_may_name_each_other() -> None:
    problem = parsed(
        quantity={
            "room": {"formula": "clearance + 2 mm"},
            "clearance": {"formula": "offset - crank", "title": "clearance beside the crank", "unit": "cm"},
        },
        constraints={"room": {"min": "-3 cm"}},
    )
    room, clearance = problem.quantity("room"), problem.quantity("clearance")
    assert (clearance.title, clearance.field, room.field) == ("clearance beside the crank", "clearance_cm", "room_mm")
    np.testing.assert_allclose(values(problem, "room"), [-0.018, 0.012], rtol=1e-13)


def test_a_bound_may_be_a_formula() -> None:
    problem = parsed(
        constraints={"stroke": {"min": "80 mm", "max": "2.2 * crank"}, "peak_torque": {"max": "3*rms_torque"}}
    )
    asked = {item.quantity: (item.lower, item.upper) for item in problem.constraints}
    assert asked["stroke"] == (0.08, None)
    assert asked["stroke - 2.2 * crank"] == (None, 0.0)
    assert asked["peak_torque - 3 * rms_torque"] == (None, 0.0)


@pytest.mark.parametrize("value", ["1 foot", "3 inches", "0.2 m", "8e1 mm", "90 mm"])
def test_a_bound_with_a_unit_whose_name_is_like_a_quantity_s_stays_a_value(value: str) -> None:
    (found,) = [
        item for item in parsed(constraints={"stroke": {"max": value}}).constraints if item.quantity == "stroke"
    ]
    assert found.upper is not None


def test_varying_numbers_and_choices_take_formulas() -> None:
    options = [
        {"name": "short", "constraints": {"crank + rod": {"max": "150 mm"}}},
        {"name": "long", "constraints": {"crank + rod": {"min": "150 mm"}, "load.1.force * 80 mm": {"max": "150 N m"}}},
    ]
    tables = job(variables={"load": {"1": {"force": ["1 kN", "2 kN"]}}})
    problem = parse_job(tables | {"choice": [{"name": "size", "option": options}]})
    assert [limit.quantity for limit in problem.variants[1].limits] == ["crank + rod", "load.1.force * 80 mm"]
    designs = [[0.04, 0.1, 0.02, 1500.0]]
    assert problem.part(1).evaluate(designs, ["load.1.force * 80 mm"])[0, 0] == pytest.approx(120.0, rel=1e-14)


def test_a_job_with_formulas_that_was_read_is_a_job_again() -> None:
    tables = job(quantity={"a": {"formula": "2 * crank"}}, constraints={"a": {"max": "0.1 m"}, "rod": {"min": "a"}})
    known = job_type_with_quantities(declared_quantities(tables, allowed=False))
    again = known.model_validate(tables).model_dump(mode="json", exclude_none=True)
    assert parse_job(again) == parse_job(tables)


def test_the_schema_says_of_formulas_what_their_keys_are_like() -> None:
    parts = job_schema()["$defs"]
    for name in ("Constraints", "Objectives"):
        (pattern,) = parts[name]["patternProperties"]
        assert pattern.startswith("[^A-Za-z0-9_]")
        assert not any("formulas" in key for key in parts[name]["properties"])


@pytest.mark.parametrize(
    ("tables", "said"),
    [
        (
            {"constraints": {"offst - crank": {"min": "1 mm"}}},
            '"offst - crank": no .*"offst"; did you mean offset',
        ),
        (
            {"constraints": {"offset - crank": {"min": "1 N"}}},
            '"offset - crank".min: must be a length; got "1 N", which is a',
        ),
        ({"constraints": {"offset + peak_torque": {"min": 1}}}, "offset . peak_torque adds mm and N m; .*correct"),
        ({"constraints": {"min(crank, 1 N)": {"min": 1}}}, "compares mm and N"),
        ({"constraints": {"stroke / (offset - crank)": {"min": 1}}}, "got offset - crank as a divisor, .* zero within"),
        ({"constraints": {"stroke / mean_torque": {"min": 1}}}, "got mean_torque as a divisor, which may be zero"),
        ({"constraints": {"(offset - crank)**(-2)": {"min": 1}}}, "got offset - crank as a divisor"),
        ({"constraints": {"crank / 0": {"min": 1}}}, "got 0 as a divisor, which is zero for every design"),
        (
            {"quantity": {"a": {"formula": "b"}, "b": {"formula": "2*a"}}},
            "refer to themselves; got a by b by a; write one of them out",
        ),
        ({"constraints": {"+".join(["crank"] * 2000): {"min": 1}}}, "at most 500 characters; got 11999"),
        ({"constraints": {"(" * 100 + "crank": {"min": 1}}}, "at most 40 deep"),
        ({"constraints": {"crank" + "+ 1" * 110: {"min": 1}}}, "at most 100 operators and functions"),
        ({"constraints": {"rod": {"equals": "3.2 * ofset"}}}, 'constraints.rod.equals: .*"ofset"; did you mean offset'),
        ({"constraints": {"stroke": {"max": "2 * crank + 3 N"}}}, "constraints.stroke.max: .* adds mm and N"),
        ({"constraints": {"2 crank": {"max": 1}}}, "one of .* is missing between 2 and crank"),
        ({"constraints": {"sin(crank)": {"max": 1}}}, "sin needs an angle; got sin.crank. of mm; .* 1 rad"),
        ({"constraints": {"asin(crank)": {"max": 1}}}, "asin needs a ratio; .*divide"),
        (
            {"constraints": {"asin(2 + crank / rod)": {"max": 1}}},
            "the argument of asin must be from -1 to 1; .* always outside it",
        ),
        (
            {"constraints": {"__import__('os')": {"max": 1}}},
            "a function is one of sqrt, abs, .*__import__ is not one of them",
        ),
        ({"constraints": {"crank ** offset": {"max": 1}}}, "an exponent must be a ratio"),
        ({"constraints": {"crank ** time_ratio": {"max": 1}}}, "raised to a plain number"),
        ({"constraints": {"sqrt(crank)": {"max": 1}}}, "must have whole powers.* m.1/2"),
        ({"constraints": {"min(crank)": {"max": 1}}}, "min takes 2 to 20 arguments"),
        ({"constraints": {"crank + ": {"max": 1}}}, "missing at its end"),
        ({"constraints": {"motion_deviation + crank": {"max": 1}}}, "needs the table .target_motion."),
        (
            {"constraints": {"self_locking_margin * 2": {"max": 1}}},
            "self_locking_margin is not defined here: .*friction",
        ),
        ({"constraints": {"mechanism.slider.mass * 2": {"max": 1}}}, "let the number vary in .variables."),
        ({"constraints": {"offset - crank": {"min": "3 mm", "max": "1 mm"}}}, "min must not exceed max"),
        ({"constraints": {"offset - crank": {"mn": 1}}}, "unknown key .*; did you mean min|possible here: min, max"),
        ({"constraints": {"offset - crank": {"equals": True}}}, "must be a value with a unit"),
        ({"constraints": {"crank + rod": {"min": "1 m"}}}, "at most 2[0-9.]+ mm is possible; got min 1000 mm"),
        (
            {"objectives": {"offset - crank": "minimse"}},
            'objectives."offset - crank": must be "minimise".*did you mean',
        ),
        ({"quantity": {"crank": {"formula": "rod"}}}, "must be new; got .crank., which exists"),
        (
            {"quantity": {"x": {"formula": "rod", "unit": "N"}}},
            'quantity.x.unit: .*got "N" for a length; write it like "mm"',
        ),
        ({"quantity": {"x": {"formula": "rod", "function": "a:b"}}}, "must be of one kind; got function and formula"),
        ({"quantity": {"x": {"formula": "rod +"}}}, "quantity.x.formula: a number, a name"),
        ({"objectives": {"2 * 3": "maximise"}}, r'objectives."2 \* 3": .* is the same for every design; leave it out'),
        (
            {"quantity": {"x": {"formula": "40 mm"}, "y": {"formula": "2 * x"}}, "constraints": {"y": {"max": "1 m"}}},
            r"constraints.y: .*got 2 \* x, which is the same for every design",
        ),
    ],
)
def test_a_wrong_formula_is_refused_with_key_value_and_remedy(tables: dict[str, Any], said: str) -> None:
    with pytest.raises(JobError, match=said):
        parsed(**tables)


def test_formulas_are_allowed_where_functions_of_ones_own_are_not() -> None:
    tables = job(quantity={"a": {"formula": "2 * crank"}}, constraints={"a": {"max": "0.1 m"}})
    assert isinstance(parse_job(tables, allow_user_code=False).own[0], FormulaQuantity)
    tables["quantity"]["b"] = {"function": "mymodule:mine"}
    with pytest.raises(JobError, match="custom functions are not run here"):
        parse_job(tables, allow_user_code=False)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("objectives", "pieces"),
    [
        ({"peak_torque_outward + peak_torque_inward": "minimise", "time_ratio": "maximise"}, 2),
        ({"abs(peak_torque_outward - peak_torque_inward)": "minimise", "transmission_angle": "maximise"}, 2),
        (
            {"peak_torque_outward - peak_torque_inward": "maximise", "peak_guide_force + peak_pivot_force": "minimise"},
            2,
        ),
        ({"min(peak_torque_outward, 1.2 * peak_torque_inward)": "maximise", "position_error": "minimise"}, 2),
    ],
)
def test_formulas_with_kinks_are_polished_to_stationarity(objectives: dict[str, str], pieces: int) -> None:
    tables = copy.deepcopy(FEEDER) | {"objectives": objectives}
    tables["optimiser"] = {"designs": 30, "samples": 2048}
    front = solve(parse_job(tables))
    assert len(front) > 5
    assert set(front.designs["status"]) == {"stationary"}
    assert front.designs["residual"].max() < 1e-9
    formula = next(of for of in front.problem.own if isinstance(of, FormulaQuantity))
    assert formula.pieces(front.problem.mechanism, front.dimensions).values.shape[1] >= pieces


def test_a_robust_formula_is_kept_by_the_share_of_machines() -> None:
    tables = job(constraints={"offset - crank": {"min": "-15 mm"}}) | {
        "robust": {"kind": "worst case", "quantities": ["offset-crank"]}
    }
    problem = parse_job(tables)
    of = problem.quantity("offset_minus_crank_robust")
    worst = of.evaluate(problem.mechanism, DESIGNS).values
    np.testing.assert_allclose(worst, DESIGNS[:, 2] - DESIGNS[:, 0] - 0.07e-3, rtol=1e-12)
