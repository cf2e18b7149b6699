"""Designs as people give them: arrays of any kind, tables with named columns, and what is none."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest

import slidercrank as sc

MACHINE = sc.Mechanism(speed=30.0, slider_mass=0.8)
DESIGN = [0.04, 0.1, 0.02]
NAMES = ["time_ratio", "peak_torque"]
PROBLEM = sc.problem(
    {
        "name": "Feeder",
        "mechanism": {"speed": "30 rad/s", "slider": {"mass": 0.8}},
        "variables": {"crank": [0.02, 0.06], "rod": [0.05, 0.25], "offset": [0.0, 0.08]},
        "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
    }
)
FORM = sc.standard_form(PROBLEM)
TAKERS: dict[str, Callable[[Any], object]] = {
    "evaluate": lambda given: sc.evaluate(MACHINE, given, NAMES),
    "analyse": lambda given: sc.analyse(MACHINE, given),
    "problem.evaluate": lambda given: PROBLEM.evaluate(given),
    "problem.analyse": lambda given: PROBLEM.analyse(given),
    "arrays": lambda given: FORM.arrays(given),
    "designs": lambda given: FORM.designs(given),
    "fun": lambda given: FORM.scipy("peak_torque").fun(given),
}
NO_DESIGNS: dict[str, object] = {
    "numbers as text": [["0.04", "0.1", "0.02"]],
    "one as text among numbers": np.array([[0.04, "0.1", 0.02]], object),
    "text": ["40 mm", "100 mm", "20 mm"],
    "a dict": {"crank": 0.04, "rod": 0.1, "offset": 0.02},
    "ragged": [[0.04, 0.1], [0.04, 0.1, 0.02]],
    "too few": [0.04, 0.1],
    "one number": 0.04,
    "nothing": None,
    "complex": [0.04 + 1e-30j, 0.1, 0.02],
    "columns in mm": pd.DataFrame([[40.0, 100.0, 20.0]], columns=["crank_mm", "rod_mm", "offset_mm"]),
    "a row in mm": pd.Series({"crank_mm": 40.0, "rod_mm": 100.0, "offset_mm": 20.0, "stroke_mm": 82.0}),
}


@pytest.mark.parametrize("taker", TAKERS.values(), ids=TAKERS)
@pytest.mark.parametrize("given", NO_DESIGNS.values(), ids=NO_DESIGNS)
def test_what_is_no_design_is_refused_in_a_sentence(taker: Callable[[Any], object], given: Any) -> None:
    with pytest.raises(sc.InputError, match=r"^(a design|designs|a table of designs) [^\n]*\(?crank, rod, offset"):
        taker(given)


def test_columns_of_a_table_are_found_by_their_names() -> None:
    table = pd.DataFrame({"offset": [0.02, 0.01], "note": ["a", "b"], "crank": [0.04, 0.05], "rod": [0.1, 0.15]})
    expected = sc.evaluate(MACHINE, [[0.04, 0.1, 0.02], [0.05, 0.15, 0.01]], NAMES)
    np.testing.assert_array_equal(sc.evaluate(MACHINE, table, NAMES), expected)
    assert sc.analyse(MACHINE, table.iloc[0])["peak_torque"] == sc.analyse(MACHINE, DESIGN)["peak_torque"]
    unnamed = pd.DataFrame([DESIGN])
    np.testing.assert_array_equal(sc.evaluate(MACHINE, unnamed, NAMES), expected[:1])


def test_a_front_as_a_table_is_refused_with_what_serves() -> None:
    columns = ["crank_mm", "rod_mm", "offset_mm"]
    front = sc.solve(PROBLEM)
    with pytest.raises(sc.InputError, match=r"got crank_mm, rod_mm, offset_mm; .* `front.dimensions`"):
        PROBLEM.evaluate(front.designs[columns])
    with pytest.raises(sc.InputError, match=r"got crank_mm, rod_mm, offset_mm, \.\.\.; .* `front.dimensions`"):
        PROBLEM.analyse(front.designs.iloc[0])
    values = PROBLEM.evaluate(front.dimensions, ["crank", "rod", "offset"])
    np.testing.assert_allclose(1e3 * values, front.designs[columns], rtol=1e-12)


@pytest.mark.parametrize("given", [PROBLEM, {"speed": 30.0}, None], ids=["a problem", "tables", "nothing"])
def test_what_is_no_machine_is_refused_with_what_serves(given: Any) -> None:
    for call in (lambda: sc.evaluate(given, DESIGN, NAMES), lambda: sc.analyse(given, DESIGN)):
        with pytest.raises(sc.InputError, match=r"a machine is needed; got .* `problem` or `load_job`"):
            call()


def test_names_may_come_one_by_one() -> None:
    names: Any = (name for name in NAMES)
    found = sc.evaluate(MACHINE, DESIGN, names)
    np.testing.assert_array_equal(found, sc.evaluate(MACHINE, DESIGN, NAMES))


def test_a_rod_of_no_length_fails_without_bound_and_without_warning() -> None:
    found = FORM.arrays([0.04, 0.0, 0.0], gradients=True)
    assert (found.G[:2] == np.inf).all()


def test_standard_forms_and_fronts_are_compared_without_a_question_of_truth() -> None:
    assert FORM == FORM
    assert sc.standard_form(PROBLEM) != FORM


@pytest.mark.filterwarnings("ignore:lengths of designs must be in m")
@pytest.mark.parametrize("size", [1e-300, 1e-160, 1e160, 1e300])
def test_lengths_whose_powers_are_no_numbers_give_none(size: float) -> None:
    design = [size, 3.0 * size, 0.5 * size]
    assert np.isnan(sc.evaluate(MACHINE, design, [*NAMES, "peak_slider_speed"])).all()
    with pytest.raises(sc.InputError, match="a design must be 3 finite numbers"):
        sc.analyse(MACHINE, design)
    near = sc.evaluate(MACHINE, [1e-40, 3e-40, 5e-41], NAMES)
    np.testing.assert_allclose(near[0], sc.evaluate(MACHINE, [1.0, 3.0, 0.5], NAMES)[0], rtol=1e-12)


def test_what_is_masked_is_not_there() -> None:
    given = np.ma.masked_array([DESIGN, DESIGN], mask=[[False, True, False], [False, False, False]])
    found = sc.evaluate(MACHINE, given, NAMES)
    assert np.isnan(found[0]).all()
    np.testing.assert_array_equal(found[1], sc.evaluate(MACHINE, DESIGN, NAMES))
    with pytest.raises(sc.InputError, match="a design must be 3 finite numbers"):
        sc.analyse(MACHINE, given[0])
