"""Formulas in the place of names: the same values and slopes as Python's own arithmetic on the quantities."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError
from slidercrank.objectives.formula.expression import Call, Name
from slidercrank.objectives.formula.ranges import FormulaBounds, Interval
from slidercrank.objectives.tables.sensitivity import Axis, sweep
from tests import random_formulas
from tests.random_formulas import MACHINE, designs

NAMES = sorted({name for kind in random_formulas.NAMES.values() for name in kind})
PROBLEM = sc.problem(
    {
        "name": "named",
        "mechanism": {"speed": "10 rad/s", "rod": {"mass": 0.5}, "slider": {"mass": 0.8}},
        "load": [{"force": "200 N", "opposes": "outward stroke"}],
        "variables": {"crank": [0.02, 0.06], "rod": [0.15, 0.3], "offset": [-0.05, 0.08]},
        "objectives": {"peak_torque": "minimise", "stroke": "maximise"},
    }
)


def test_random_formulas_have_the_values_and_slopes_of_the_quantities_that_they_name() -> None:
    random, rows = np.random.default_rng(16), designs(12, seed=16)
    leaves = dict(zip(NAMES, sc.evaluate(MACHINE, rows, NAMES).T, strict=True))
    taken = 0
    while taken < 40:
        text, source, names = random_formulas.random_formula(random, depth=2)
        if not names:
            with pytest.raises(InputError, match="is the same for every design; leave it out"):
                sc.evaluate(MACHINE, rows, [text])
            continue
        values, slopes = sc.evaluate(MACHINE, rows, [text, "crank"], gradients=True)
        known = vars(math) | {"min": min, "max": max}
        for place, row in enumerate(rows):
            of = {name.replace(".", "_"): float(leaves[name][place]) for name in names}
            assert values[place, 0] == pytest.approx(eval(source, known | of), rel=1e-9, abs=1e-12)
            assert values[place, 1] == row[0]
        if not any(word in text for word in ("min", "max", "abs", "sqrt")):  # no kinks
            step = 1e-6 * rows[:, 1]
            ahead, behind = (sc.evaluate(MACHINE, rows + np.outer(s * step, [0, 1, 0, 0]), [text]) for s in (1, -1))
            numeric = (ahead - behind)[:, 0] / (2.0 * step)
            scale = np.abs(slopes[:, 0]).max() + np.abs(values[:, 0]).max()
            np.testing.assert_allclose(slopes[:, 0, 1], numeric, atol=2e-5 * scale)
        taken += 1


def test_names_and_formulas_stand_side_by_side_in_problems_analyses_and_sweeps() -> None:
    random = np.random.default_rng(17)
    formula = "peak_torque / crank + min(mean_torque, 3 N m) / rod"
    for design in designs(6, seed=17)[:, :3]:
        peak, mean = PROBLEM.evaluate(design, ["peak_torque", "mean_torque"])
        expected = peak / design[0] + min(mean, 3.0) / design[1]
        assert PROBLEM.evaluate(design, ["stroke", formula])[1] == pytest.approx(expected, rel=1e-12)
        analysis = PROBLEM.analyse(design)
        assert analysis[formula] == pytest.approx(expected, rel=1e-12)
        assert analysis["rod"] == design[1]
        speeds = tuple(random.uniform(5.0, 20.0, 3))
        table = sweep(PROBLEM.mechanism, design, [Axis("speed", speeds)], ["peak_torque", "peak_torque * crank"])
        product = next(name for name in table.columns if "times" in name)
        np.testing.assert_allclose(table[product], design[0] * table["peak_torque_Nm"], rtol=1e-12)


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("crank + rud", 'is called "rud"; did you mean rod?'),
        ("CRANK + rod", 'is called "CRANK"; did you mean crank?'),
        ("crank\u00a0+ peak_torque", "crank + peak_torque adds mm and N m"),
        ("crank +", "is missing at its end"),
        (
            "crank +\nrod )",
            "the formula crank + rod ): one of + - * / ** is missing before ); got the formula 'crank + rod )'",
        ),
        ("2 * efficiency", "efficiency is not defined here: "),
        ("3 mm", "the same for every design"),
        ("xyzzy", " more, all in `slidercrank quantities` and slidercrank.quantities()"),
    ],
)
def test_wrong_formulas_are_sentences_and_no_list_of_all_names(formula: str, words: str) -> None:
    design = [0.04, 0.2, 0.02]
    with pytest.raises(InputError, match=re.escape(words)) as told:
        PROBLEM.evaluate(design, [formula])
    assert len(str(told.value)) < 450
    with pytest.raises(InputError, match=re.escape(words)):
        PROBLEM.analyse(design)[formula]


def test_a_formula_that_divides_by_zero_has_no_value_there_and_one_elsewhere() -> None:
    found = PROBLEM.evaluate([[0.04, 0.2, 0.0], [0.04, 0.2, 0.02]], ["crank / offset - crank / offset"])[:, 0]
    assert np.isnan(found[0])
    assert found[1] == 0.0


@pytest.mark.parametrize(
    "formula",
    ["crank / offset", "min(crank / offset, 3)", "atan(crank / offset)", "(offset / crank)**-1", "1 / (rod / offset)"],
)
def test_no_function_makes_a_number_of_a_division_by_zero(formula: str) -> None:
    designs = [[0.04, 0.2, 0.0], [0.04, 0.2, 0.02]]
    found = PROBLEM.evaluate(designs, [formula])[:, 0]
    assert np.isfinite(found).tolist() == [False, True]
    assert np.isnan(PROBLEM.analyse(designs[0])[formula])


def test_sine_cosine_and_tangent_divide_where_their_angles_keep_them_off_zero() -> None:
    random = np.random.default_rng(7)
    for _ in range(400):
        low, high = np.sort(random.uniform(-9.0, 9.0, 2))
        inside = np.linspace(low, high, 4001)
        for function in ("sin", "cos", "tan"):
            node = Call(function, (Name("angle"),))
            found = FormulaBounds({"angle": Interval(low, high)}, {}, {}).bounds_of_formula(node)
            values = getattr(np, function)(inside)
            assert found.lower <= values.min() + 1e-12
            assert values.max() <= found.upper + 1e-12
            if function != "tan" or math.isfinite(found.upper):
                assert found.lower >= values.min() - 1e-4
                assert found.upper <= values.max() + 1e-4 * max(1.0, found.upper**2)
    for divisor in ("sin(transmission_angle)", "tan(transmission_angle)", "cos(crank / rod * 1 rad)"):
        replace(PROBLEM, constraints=(sc.Constraint(quantity=f"1 / {divisor}", upper=9.0),))
    with pytest.raises(InputError, match="may be zero within the ranges"):
        replace(PROBLEM, constraints=(sc.Constraint(quantity="1 / sin(offset / rod * 1 rad)", upper=9.0),))


def test_constraints_and_objectives_of_python_may_be_formulas() -> None:
    limit = sc.Constraint(quantity="2 * crank + rod", upper=0.25)
    asked = replace(
        PROBLEM,
        constraints=(limit,),
        objectives=(*PROBLEM.objectives, sc.Objective(quantity="crank", sense="minimise")),
    )
    assert [of.name for of in asked.own] == ["crank", "2 * crank + rod"]
    assert asked.evaluate([0.04, 0.2, 0.02])[2] == 0.04
    with pytest.raises(InputError, match="write '2 \\* crank'"):
        replace(PROBLEM, constraints=(sc.Constraint(quantity="2 * (crank)", upper=0.17),))
    with pytest.raises(InputError, match="write 'rod / crank'"):
        replace(PROBLEM, constraints=(sc.Constraint(quantity="rod/crank", upper=9.0),))
    with pytest.raises(InputError, match="may be zero within the ranges"):
        replace(PROBLEM, constraints=(sc.Constraint(quantity="rod / offset", upper=0.17),))
