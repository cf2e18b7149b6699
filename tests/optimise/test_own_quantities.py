"""Functions of your own in jobs: the page of the documentation, equality with what is built in, broken ones."""

from __future__ import annotations

import contextlib
import importlib.metadata
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.objectives.kinds import DisplayUnit, kind_displayed_in
from slidercrank.objectives.own import quantity as own_module
from slidercrank.objectives.own.designs import magnitude
from slidercrank.objectives.own.quantity import OwnQuantity
from slidercrank.optimise.decisions.similar_design import like
from slidercrank.optimise.job import load_job, needed_files, parse_job
from slidercrank.optimise.job.custom_quantities import FormulaPart, require_usable_names
from slidercrank.optimise.problem.requirements import Constraint, Objective
from slidercrank.optimise.solve import solve

PAGE = Path(__file__).parents[2] / "docs" / "own-quantities.md"


def job(quantity: dict[str, Any] | None = None, **parts: Any) -> dict[str, Any]:
    data: dict[str, Any] = {
        "name": "Own",
        "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["80 mm", "300 mm"], "offset": ["5 mm", "60 mm"]},
        "objectives": {"mine": "minimise", "time_ratio": "maximise"},
        "constraints": {"stroke": {"equals": "80 mm"}},
        "optimiser": {"designs": 6, "samples": 200},
        **parts,
    }
    return data if quantity is None else {**data, "quantity": {"mine": quantity}}


def module(folder: Path, text: str) -> dict[str, Any]:
    """Write a module with a function `judge`; return its declaration."""
    (folder / "judges.py").write_text(text)
    return {"function": "judges:judge", "unit": "m/s^2", "limit": "2 s"}


ACCELERATION = """
from slidercrank.objectives.own.designs import magnitude

def judge(designs):
    print("the screen is not the place for answers")
    return designs.peaks(lambda angle: magnitude(designs.acceleration(angle)))
"""


def test_page_of_the_documentation_runs_as_it_is_written(tmp_path: Path) -> None:
    blocks = dict(re.findall(r"```(python|toml)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL))
    (tmp_path / "mymodule.py").write_text(blocks["python"])
    (tmp_path / "job.toml").write_text(blocks["toml"])
    front = solve(load_job(tmp_path / "job.toml"))
    assert front.status == "done"
    assert len(front) >= 4
    assert front.designs["pin_pressure_MPa"].max() <= 10.0 * (1.0 + 1e-8)
    assert (front.designs["status"] == "stationary").mean() > 0.5
    np.testing.assert_allclose(front.designs["stroke_mm"], 80.0, rtol=1e-9)
    # The pressure is a force that the table has too, over the area that the page gives.
    area = 0.012 * 0.020
    forces = front.designs["peak_slider_pin_force_N"]
    np.testing.assert_allclose(front.designs["pin_pressure_MPa"], forces / area / 1e6, rtol=1e-7)
    assert needed_files(tmp_path / "job.toml") == [tmp_path / "mymodule.py"]


@pytest.mark.slow
def test_function_equal_to_a_quantity_gives_its_front(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    own = solve(parse_job(job(module(tmp_path, ACCELERATION)), folder=tmp_path))
    assert capfd.readouterr().out == ""
    known = job(objectives={"time_ratio": "maximise", "peak_slider_acceleration": "minimise"})
    built_in = solve(parse_job(known))
    assert len(own) == len(built_in) == 6
    np.testing.assert_allclose(own.designs["mine_m_s2"], own.designs["peak_slider_acceleration_m_s2"], rtol=1e-9)
    order = np.argsort(own.designs["time_ratio"]), np.argsort(built_in.designs["time_ratio"])
    for column in ("time_ratio", "peak_slider_acceleration_m_s2"):
        ends = [front.designs[column].to_numpy()[rows] for front, rows in zip((own, built_in), order, strict=True)]
        np.testing.assert_allclose(ends[0][[0, -1]], ends[1][[0, -1]], rtol=1e-6)
    # Greedy choice among ties of rounding may deliver other designs of the same front.
    assert own.hypervolume == pytest.approx(built_in.hypervolume, rel=2e-3)


def test_function_in_python_needs_no_job() -> None:
    quantity = OwnQuantity(
        name="mine",
        function=lambda d: d.peaks(lambda angle: magnitude(d.acceleration(angle))),
        title="mine",
        kind=kind_displayed_in("m/s^2", 1.0),
    )
    base = parse_job(job(objectives={"peak_slider_acceleration": "minimise"}))
    wanted = (Objective(quantity="mine", sense="minimise"),)
    own = solve(type(base)(**{**vars(base), "own": (quantity,), "objectives": wanted}))
    np.testing.assert_allclose(own.dimensions, solve(base).dimensions, rtol=1e-6)


BROKEN = {
    "raises": ("def judge(d):\n    x = 1\n    return d.crank / len([])[0]\n", r"TypeError: .* \(judges.py:3\)"),
    "endless": (
        "def judge(d):\n    while True:\n        pass\n",
        r"within 0.2 s; it was still running \(judges.py:[23]\)",
    ),
    "deaf": (
        "def judge(d):\n    while True:\n        try:\n            sum(range(99))\n        except BaseException:\n"
        "            pass\n",
        "within 0.2 s",
    ),
    "ends": ("import os\ndef judge(d):\n    os._exit(7)\n", "not end the process; it ended with code 7"),
    "exits": ("import sys\ndef judge(d):\n    sys.exit(0)\n", r"SystemExit: 0 \(judges.py:3\)"),
    "nan": ("def judge(d):\n    return d.crank * float('nan')\n", "got nan for crank"),
    "not there": ("def other(d):\n    return d.crank\n", "a module in the folder of the job file .* AttributeError"),
    "no function": ("judge = 3\n", "be a function; got int"),
    "syntax": ("def judge(d:\n", "SyntaxError"),
}


@pytest.mark.parametrize(("text", "said"), BROKEN.values(), ids=BROKEN)
def test_a_broken_function_fails_the_run_and_nothing_else(text: str, said: str, tmp_path: Path) -> None:
    limit = "0.2 s" if "while True" in text else "2 s"
    problem = parse_job(job({**module(tmp_path, text), "limit": limit}), folder=tmp_path)
    with pytest.raises(InputError, match=r"the quantity mine \(judges:judge\) must .*" + said):
        solve(problem)


def test_a_missing_module_is_named(tmp_path: Path) -> None:
    problem = parse_job(job({"function": "nowhere:judge"}), folder=tmp_path)
    with pytest.raises(InputError, match="module in the folder of the job file or installed; got ModuleNotFoundError"):
        solve(problem)


@pytest.mark.parametrize(
    ("quantity", "said"),
    [
        ({"function": "judges"}, 'quantity.mine.function: must name a module and a function .* write it like "mymod'),
        (
            {"function": "a:b", "unit": "furlong"},
            'quantity.mine.unit: must be a unit; got "furlong": "furlong" is not a known unit',
        ),
        ({"function": "a:b", "gradient": "exact"}, 'quantity.mine.gradient: must be "complex step", "finite'),
        ({"function": "a:b", "limit": "5 mm"}, "quantity.mine.limit: must be a time; .* which is a length"),
        ({"unit": "m"}, "quantity.mine: must be one of function = .* or formula = .*; got unit"),
        ({"function": "a:b", "colour": 1}, "quantity.mine.colour: unknown key"),
    ],
)
def test_a_wrong_declaration_is_refused(quantity: dict[str, Any], said: str) -> None:
    with pytest.raises(JobError, match=said):
        parse_job(job(quantity))


def test_bounds_are_read_in_the_unit_that_is_declared() -> None:
    declared = {"function": "a:b", "unit": "MPa"}
    problem = parse_job(job(declared, constraints={"mine": {"max": "10 N/m^2"}}))
    assert problem.constraints[0].upper == 10.0
    assert problem.own[0].unit == DisplayUnit("MPa", "_MPa", 1e-6)
    with pytest.raises(JobError, match=r"constraints.mine.max: must be a pressure; got \"10 mm\", which is a length"):
        parse_job(job(declared, constraints={"mine": {"max": "10 mm"}}))
    jerk = parse_job(job({"function": "a:b", "unit": "mm/s^3"}, constraints={"mine": {"min": "5 mm/s^3"}}))
    assert jerk.constraints[0].lower == 0.005


def test_names_are_those_that_are_declared_and_no_others() -> None:
    with pytest.raises(JobError, match=r"objectives.mine: unknown key"):
        parse_job(job())
    with pytest.raises(JobError, match=r"objectives.mein: unknown key.* did you mean mine\?"):
        parse_job(job({"function": "a:b"}, objectives={"mein": "minimise"}))
    taken = {"stroke": {"function": "a:b"}}
    with pytest.raises(JobError, match=r"must be new; got .stroke., which exists already"):
        parse_job(job(objectives={"stroke": "minimise"}, constraints={}) | {"quantity": taken})
    with pytest.raises(JobError, match="lower-case letters, digits and underscores"):
        parse_job(job(objectives={"stroke": "minimise"}, constraints={}) | {"quantity": {"My": {"function": "a:b"}}})


def test_code_of_others_can_be_refused(tmp_path: Path) -> None:
    with pytest.raises(JobError, match="custom functions are not run here"):
        parse_job(job({"function": "a:b"}), allow_user_code=False)
    assert parse_job(job(objectives={"stroke": "minimise"}, constraints={}), allow_user_code=False).own == ()


def test_reading_a_job_runs_nothing(tmp_path: Path) -> None:
    parse_job(job(module(tmp_path, "raise SystemExit(9)\n")), folder=tmp_path)


def test_installed_packages_offer_quantities_by_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    offered = OwnQuantity(name="mine", function=lambda d: d.crank, title="the crank", kind=kind_displayed_in("mm", 1e3))
    entry = importlib.metadata.EntryPoint("mine", "ourcompany:MINE", own_module.GROUP)
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda group: [entry] if group == own_module.GROUP else [])
    monkeypatch.setattr(importlib.metadata.EntryPoint, "load", lambda _: offered)
    problem = parse_job(job(constraints={"mine": {"min": "30 mm"}}), allow_user_code=False)
    assert problem.own == (offered,)
    assert problem.constraints[0].lower == 0.03
    monkeypatch.setattr(importlib.metadata.EntryPoint, "load", lambda _: len)
    with pytest.raises(InputError, match="must be an OwnQuantity of that name; got <built-in"):
        parse_job(job())


def test_a_method_that_needs_gradients_refuses_a_quantity_without() -> None:
    problem = parse_job(job({"function": "a:b", "gradient": "none"}))
    with pytest.raises(InputError, match=r"auto needs the gradient .* got mine .* use one of nsga2, .* or set"):
        solve(problem)


ROUNDED = OwnQuantity(
    name="mine",
    function=lambda d: np.round(1e3 * d.rod.real),
    title="mine",
    kind=kind_displayed_in("mm", 1.0),
    gradient="none",
)


@pytest.mark.parametrize("method", ["nsga2", "nsga3", "tpe", "cmaes", "random", "sobol"])
def test_a_quantity_without_gradient_is_taken_by_every_method_that_uses_values_only(method: str) -> None:
    several = {"peak_slider_acceleration": "minimise", "stroke": "minimise"}
    base = parse_job(
        job(
            objectives=several if method != "cmaes" else {"peak_slider_acceleration": "minimise"},
            constraints={"stroke": {"min": "70 mm", "max": "90 mm"}},
            optimiser={"method": method, "evaluations": 60 if method == "tpe" else 300, "designs": 4},
        )
    )
    limit = Constraint(quantity="mine", upper=200.0)
    wanted = (Objective(quantity="mine", sense="minimise"), *base.objectives[: 0 if method == "cmaes" else 1])
    asked = replace(base, own=(ROUNDED,), objectives=wanted, constraints=(*base.constraints, limit))
    front = solve(asked)
    assert front.status == "done"
    assert set(front.designs["status"]) == {"best found"}
    assert (front.designs["mine_mm"] == np.round(front.designs["rod_mm"])).all()
    assert front.designs["mine_mm"].max() <= 200.0
    assert solve(asked).dimensions.tolist() == front.dimensions.tolist()


def test_a_quantity_without_gradient_is_refused_where_one_is_needed_with_what_can_be_done() -> None:
    declared = {"function": "a:b", "gradient": "none"}
    for method in ("auto", "epsilon_constraint", "chebyshev", "nbi"):
        with pytest.raises(InputError, match=r"use one of nsga2, nsga3, tpe, random, sobol, or set gradient ="):
            solve(parse_job(job(declared, optimiser={"method": method})))
    for method in ("auto", "slsqp", "minimax"):
        with pytest.raises(InputError, match=r"use one of nsga2, cmaes, tpe, random, sobol, or set gradient ="):
            solve(parse_job(job(declared, objectives={"mine": "minimise"}, optimiser={"method": method})))
    held = parse_job(
        job(declared, constraints={"mine": {"equals": 3.0}}, optimiser={"method": "nsga2"})
        | {"objectives": {"stroke": "minimise", "time_ratio": "maximise"}}
    )
    with pytest.raises(InputError, match=r"mine needs a gradient to be kept at one value; .* a min and a max"):
        solve(held)


def test_a_limit_without_gradient_that_comes_with_a_choice_needs_values_only_too() -> None:
    options = [{"name": "a", "constraints": {"mine": {"max": 3.0}}}, {"name": "b"}]
    chosen = job({"function": "a:b", "gradient": "none"}, objectives={"stroke": "minimise"}, constraints={})
    with pytest.raises(InputError, match="auto needs the gradient of every quantity; got mine"):
        solve(parse_job(chosen | {"choice": [{"name": "motor", "option": options}]}))


def test_a_limit_of_a_choice_may_name_a_quantity_of_the_job(tmp_path: Path) -> None:
    options = [{"name": "a", "constraints": {"mine": {"max": "300 m/s^2"}}}, {"name": "b"}]
    chosen = job(module(tmp_path, ACCELERATION), choice=[{"name": "motor", "option": options}])
    problem = parse_job(chosen, folder=tmp_path)
    assert problem.variants[0].limits == (Constraint(quantity="mine", upper=300.0),)
    with pytest.raises(JobError, match=r"choice #1.option #1.constraints.mein: unknown key .* did you mean mine"):
        parse_job(
            job(
                chosen["quantity"]["mine"],
                choice=[{"name": "m", "option": [{"name": "a", "constraints": {"mein": {"max": 1}}}, {"name": "b"}]}],
            )
        )


def test_nothing_is_said_of_what_contradicts_where_that_takes_gradients() -> None:
    base = parse_job(job(optimiser={"method": "random", "evaluations": 200}, objectives={"time_ratio": "maximise"}))
    limit = Constraint(quantity="mine", upper=1.0)
    front = solve(replace(base, own=(ROUNDED,), constraints=(*base.constraints, limit)))
    assert front.status == "infeasible"
    assert "random found no design" in front.message
    assert "is possible" not in front.message


def test_a_design_like_another_needs_gradients() -> None:
    base = parse_job(
        job(optimiser={"method": "random", "evaluations": 200}, objectives={"stroke": "minimise"}, constraints={})
    )
    front = solve(
        replace(base, own=(ROUNDED,), objectives=(Objective(quantity="mine", sense="minimise"), *base.objectives))
    )
    with pytest.raises(InputError, match=r"a design like another needs the gradient .* got mine .*; set gradient ="):
        like(front, 0, ranges={"crank": (0.055, None)})


def test_no_quantity_takes_the_column_of_another_number() -> None:
    """Every column of a front as the name of a ratio, an angle and a length."""
    units = {"": "rod / crank", "deg": "2 * transmission_angle", "mm": "crank + offset"}
    asked = {"stroke": {"min": "30 mm"}, "crank - offset": {"min": "0 mm"}}
    tables = job(constraints=asked, objectives={"time_ratio": "maximise"})
    columns = [*solve(parse_job(tables)).columns, "design"]
    assert {"status", "residual", "slow_stroke", "slack_stroke_mm", "crank_minus_offset_mm"} <= set(columns)
    problems = {
        unit: parse_job(tables | {"quantity": {"mine": {"formula": formula}}}) for unit, formula in units.items()
    }
    refused = 0
    for column in columns:
        name, _, unit = column.rpartition("_")
        for stem, problem in ((column, problems[""]), *([(name, problems[unit])] if name and unit in units else [])):
            own = tuple(replace(of, name=stem) if of.name == "mine" else of for of in problem.own)
            with contextlib.suppress(InputError):
                require_usable_names({stem: FormulaPart(formula="rod / crank")})
                fields = {of.name: of.field for of in replace(problem, own=own).own}
                assert fields[stem] not in columns
                continue
            refused += 1
    assert refused >= len(columns) // 2
