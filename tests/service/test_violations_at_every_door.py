"""Allowable values that a design goes beyond: in the answer of command line, API, Python, front and report."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.optimise.job import parse_job
from slidercrank.service.designs.judged_requirements import front_violations_in_words, violations_in_words
from slidercrank.service.designs.selection import result_with_rows
from slidercrank.service.designs.stored_designs import front_of_result
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Paragraph
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import Result
from slidercrank.service.runs.run_folder import RunFolder
from slidercrank.service.runs.runs_on_disk import read_run
from slidercrank.service.store import Store
from tests.service.api.fixed_front import client_of, store_result
from tests.service.conftest import Command
from tests.service.weak_pins import MATERIAL, TABLES, result

SHEAR, PRESSURE = "pin_shear_crank_pin", "pin_pressure_crank_pin"
ALLOWED = {SHEAR: 350.0 / 3.0**0.5, PRESSURE: 20.0}
SIZE = {"crank": "50 mm", "rod": "200 mm", "offset": "20 mm"}
DESIGN = [0.05, 0.2, 0.02]
PSI = 6894.757293168


@pytest.fixture
def job(tmp_path: Path) -> Path:
    path = tmp_path / "weak.json"
    path.write_text(json.dumps(TABLES))
    return path


@pytest.fixture
def kept(runs: Path) -> Result:
    """Return the result of a run that is kept."""
    with RunFolder(runs, "Weak pins") as run:
        run.keep_result(result(), {})
        path = run.path
    return read_run(path)


def expected_excess(row: Any) -> dict[str, float]:
    """Return by how much a row of a table goes beyond what is allowed."""
    return {f"{name}_MPa": row[f"{name}_MPa"] - allowed for name, allowed in ALLOWED.items()}


def test_analyse_says_what_is_violated_and_by_how_much(job: Path, command: Command) -> None:
    size = [part for name, value in SIZE.items() for part in (f"--{name}", value)]
    found = json.loads(command("analyse", job, *size, "--json").stdout)
    assert found["violated"] == pytest.approx(expected_excess(found), rel=1e-12)
    inch = json.loads(command("analyse", job, *size, "--json", "--units", "inch").stdout)["violated"]
    factor = 1e6 / PSI
    assert inch == pytest.approx({k.replace("MPa", "psi"): factor * v for k, v in found["violated"].items()}, rel=1e-9)
    shown = command("analyse", job, *size).stdout
    by = found["violated"][f"{SHEAR}_MPa"]
    assert (
        f"Beyond the allowable value: shear of the crank pin is {found[f'{SHEAR}_MPa']:.4g} MPa, {by:.4g} MPa" in shown
    )
    assert "more than the allowed 202.1 MPa (shear yield strength of the material)." in shown


def test_python_says_what_is_violated_of_a_design_and_of_a_front() -> None:
    problem = parse_job(TABLES)
    found = problem.analyse(DESIGN)
    assert found.violated == pytest.approx({name: found[name] - 1e6 * by for name, by in ALLOWED.items()}, rel=1e-12)
    assert "beyond the allowable value: pressure at the crank pin, shear of the crank pin" in repr(found)
    assert "beyond the allowable value" in found._repr_html_()
    front = sc.solve(problem)
    assert front.violated.keys() == ALLOWED.keys()
    for row, design in enumerate(front.dimensions):
        own = {name: by[row] for name, by in front.violated.items()}
        assert own == pytest.approx(problem.analyse(design).violated, rel=1e-9)


def test_a_front_says_it_of_each_design_and_only_of_those_beyond() -> None:
    whole = result()
    assert len(whole.designs) > 2
    for key, beyond in whole.violated.items():
        assert beyond == pytest.approx([expected_excess(row)[key] for row in whole.designs], rel=1e-9)
    stresses = np.array([row[f"{SHEAR}_MPa"] for row in whole.designs], dtype=np.float64)
    allowed = float(np.sort(stresses)[1:3].mean())
    material = {**MATERIAL, "yield_strength": f"{3.0**0.5 * allowed!r} MPa"}
    other = parse_job({**TABLES, "sections": {**TABLES["sections"], "material": material}})
    front = replace(front_of_result(parse_job(TABLES), whole), problem=other)
    found = front.violated[SHEAR]
    assert 0 < np.count_nonzero(found) < len(front)
    assert found == pytest.approx(1e6 * np.maximum(stresses - allowed, 0.0), rel=1e-9)


def test_a_run_keeps_and_shows_it(kept: Result, command: Command) -> None:
    assert kept.violated == result().violated
    assert json.loads(command("front", "latest", "--json").stdout)["violated"] == kept.violated
    one = json.loads(command("front", "latest", "--design", 2, "--json").stdout)
    assert (
        one["violated"] == {key: [by[1]] for key, by in kept.violated.items()} == result_with_rows(kept, [1]).violated
    )
    count = len(kept.designs)
    whole = command("front", "latest").stdout
    assert f"Beyond the allowable value: shear of the crank pin in {count} of {count} designs, at worst" in whole
    assert "Warning: " not in whole
    assert "Beyond the allowable value: shear of the crank pin is" in command("front", "latest", "--design", 2).stdout


def test_the_api_says_it_of_any_design_and_of_those_of_a_front(store: Store) -> None:
    number = store_result(store, result(), TABLES)
    with client_of(store) as client:
        found = client.post("/api/v1/analyse", json={"job": TABLES, **SIZE}).json()["analysis"]
        assert found["violated"] == pytest.approx(expected_excess(found), rel=1e-12)
        path = f"/api/v1/jobs/{number}"
        front = client.get(f"{path}/front").json()
        assert front["violated"] == result().violated
        listed = client.get(f"{path}/designs", params={"limit": 2, "offset": 1}).json()["violated"]
        assert listed == {key: by[1:3] for key, by in front["violated"].items()}
        of_one = {key: by[1] for key, by in front["violated"].items()}
        assert client.get(f"{path}/designs/2").json()["violated"] == pytest.approx(of_one, rel=1e-9)
        assert client.get(f"{path}/designs/2/analysis").json()["analysis"]["violated"] == pytest.approx(of_one)
        topic = client.get(f"{path}/designs/2/analysis", params={"show": "strength"}).json()["analysis"]["strength"]
        assert topic["violated"] == pytest.approx(of_one)
        lengths = {"crank_mm": 50.0, "rod_mm": 200.0, "offset_mm": 20.0, "angles": 0}
        changed = client.post(f"{path}/designs/2/what-if", json=lengths).json()
        assert changed["violated"] == pytest.approx(expected_excess(changed["design"]), rel=1e-12)
        metric, own = result(), client.get(f"{path}/designs/2").json()
        assert front["violations"] == front_violations_in_words(metric)
        assert own["violations"] == violations_in_words(own["violated"], own["design"])
        assert changed["violations"] == violations_in_words(changed["violated"], changed["design"])
        assert {len(each["violations"]) for each in (front, own, changed)} == {len(ALLOWED)}
        known = {of["name"]: of for of in client.get("/api/v1/quantities").json()["quantities"]}
    assert known[SHEAR]["allowed_by"] == "shear yield strength of the material"
    assert known["stroke"]["allowed_by"] == ""
    assert (known["static_safety"]["better"], known[SHEAR]["better"]) == ("high", "low")
    assert known["stroke"]["better"] == sc.quantities().loc["stroke", "better"] == ""


def test_a_safety_below_zero_comes_with_its_cause() -> None:
    said = [violations_in_words({"static_safety": 1.0 - safety}, {"static_safety": safety}) for safety in (-0.1, 0.9)]
    assert [line.endswith("a pin as wide as its bar, or wider, leaves no material in the bar") for (line,) in said] == [
        True,
        False,
    ]


def test_a_report_says_it_in_its_summary_beside_the_requirements_and_of_the_front() -> None:
    report = design_report(Subject(parse_job(TABLES), result(), 2, run="weak", versions={}), created=0.0)
    summary = repr(report.sections[0])
    assert "Beyond the allowable values" in summary
    assert "shear of the crank pin is" in summary
    said = [block.text for part in report.sections for block in part.blocks if isinstance(block, Paragraph)]
    assert sum(text.startswith("Beyond the allowable value: ") for text in said) == 4
    assert (
        sum(bool(re.match(r"Beyond the allowable value: .* in \d+ of \d+ designs, at worst", one)) for one in said) == 2
    )
