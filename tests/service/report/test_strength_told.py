"""The report lists what the strength of a design depends on: material, pins, and limits of the choices."""

from __future__ import annotations

import tomllib
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.report.design_report import design_report
from slidercrank.service.report.document import Facts, Report, Table
from slidercrank.service.report.subject import Subject
from slidercrank.service.runs.result import result_of
from slidercrank.service.text.job_in_words import problem_in_words

PRESS = tomllib.loads((Path(__file__).parents[3] / "runs" / "press.toml").read_text(encoding="utf-8"))
OPTIONS = {"small": ("400 N m", "250 N m"), "large": ("500 N m", "300 N m")}


def option(name: str, peak: str, mean: str) -> dict[str, Any]:
    return {"name": name, "constraints": {"peak_torque": {"max": peak}, "rms_torque": {"max": mean}}}


def press() -> dict[str, Any]:
    options = [option(name, peak, mean) for name, (peak, mean) in OPTIONS.items()]
    search = {"method": "sobol", "evaluations": 300, "designs": 3, "seed": 1}
    return {**deepcopy(PRESS), "choice": [{"name": "motor", "option": options}], "constraints": {}, "optimiser": search}


@cache
def told() -> list[tuple[Subject, Report]]:
    problem = parse_job(press())
    result = result_of(solve(problem), "kept")
    assert result.designs
    subjects = [
        Subject(problem, result, number, run="kept", versions={}) for number in range(1, len(result.designs) + 1)
    ]
    return [(subject, design_report(subject, created=0.0)) for subject in subjects]


def test_a_job_says_material_pins_and_how_stresses_are_judged() -> None:
    random = np.random.default_rng(3)
    for criterion in ("goodman", "soderberg"):
        endurance, yielding, ultimate = np.round(np.sort(random.uniform(100.0, 900.0, 3)), 1).tolist()
        job = press()
        material = {"endurance": endurance, "yield_strength": yielding, "ultimate_strength": ultimate}
        concentration = round(float(random.uniform(1.0, 4.0)), 2)
        job["sections"] = {
            **PRESS["sections"],
            "criterion": criterion,
            "eye_concentration": concentration,
            "material": {**PRESS["sections"]["material"], **{name: f"{value} MPa" for name, value in material.items()}},
        }
        given = problem_in_words(parse_job(job))["given"]
        for name, value in material.items():
            assert f"{name.replace('_', ' ')} of the material: {value:.6g} MPa" in given
        assert "elasticity of the material: 205 GPa" in given
        assert "pins: crank pivot 35 mm, crank pin 15 to 60 mm, slider pin 25 mm" in given
        assert f"stress concentration of the eyes: {concentration:.6g}" in given
        assert f"mean stresses in fatigue: by {criterion.capitalize()}" in given
    del job["sections"], job["variables"]["sections"]
    job["objectives"] = {"peak_torque": "minimise"}
    assert not any("material" in line or "pins" in line for line in problem_in_words(parse_job(job))["given"])


def test_a_job_says_the_limits_of_each_option_and_only_counts_them_where_they_are_many() -> None:
    rules = problem_in_words(parse_job(press()))["rules"]
    for name, (peak, mean) in OPTIONS.items():
        assert f"with {name}: peak torque at most {peak}" in rules
        assert f"with {name}: RMS torque over time at most {mean}" in rules
    job = press()
    job["choice"][0]["option"] = [option(f"motor {n}", f"{400 + n} N m", f"{250 - n} N m") for n in range(13)]
    rules = problem_in_words(parse_job(job))["rules"]
    assert "limits set by 13 combinations of choices" in rules
    assert not any("motor 1" in rule for rule in rules)


def test_the_summary_of_a_report_has_the_pin_that_varies() -> None:
    for subject, report in told():
        (facts,) = (block for block in report.sections[0].blocks if isinstance(block, Facts))
        pin = subject.row["sections_pins_crank_pin_mm"]
        assert f"pins: crank pivot 35 mm, crank pin {pin:.6g} mm, slider pin 25 mm" in facts.rows["Machine"]


def test_requirements_of_a_report_have_their_bounds_those_of_the_chosen_option_among_them() -> None:
    for subject, report in told():
        tables = [block for section in report.sections for block in section.blocks if isinstance(block, Table)]
        (table,) = (table for table in tables if table.title.startswith("Requirements"))
        place = table.heads.index("asked")
        asked = {row[0]: row[place] for row in table.rows}
        peak, mean = OPTIONS[str(subject.row["choice_motor"])]
        assert asked["peak torque"] == f"at most {peak.removesuffix(' N m')}"
        assert asked["RMS torque over time"] == f"at most {mean.removesuffix(' N m')}"
        assert asked["least transmission angle"] == "at least 10"
        assert all(asked.values())


def test_bounds_of_a_report_are_in_its_units() -> None:
    subject, _ = told()[0]
    inch = Subject(subject.problem, subject.metric, 1, run="kept", versions={}, system="inch")
    tables = [
        b for section in design_report(inch, created=0.0).sections for b in section.blocks if isinstance(b, Table)
    ]
    (table,) = (table for table in tables if table.title.startswith("Requirements"))
    row = next(row for row in table.rows if row[0] == "peak torque")
    peak = float(OPTIONS[str(subject.row["choice_motor"])][0].removesuffix(" N m"))
    assert float(row[1].removeprefix("at most ")) == pytest.approx(peak / 0.1129848290276167, rel=1e-5)


def test_dimensions_have_the_digits_of_their_tolerances_wherever_the_report_has_them() -> None:
    decimals = {"crank": 2, "rod": 2, "offset": 2}  # 0.03, 0.05 and 0.05 mm
    for subject, report in told():
        summary = next(part for part in report.sections if part.title == "Summary")
        (facts,) = (block for block in summary.blocks if isinstance(block, Facts))
        for name, places in decimals.items():
            assert f"{name} {subject.row[f'{name}_mm']:.{places}f} mm" in facts.rows["Lengths"][0]
        front = next(part for part in report.sections if part.title == "The front")
        marked = next(block for block in front.blocks if isinstance(block, Table) and block.title == "Marked designs")
        for row in marked.rows:
            design = subject.result.designs[int(row[0]) - 1]
            shown = [f"{design[f'{name}_mm']:.{places}f}" for name, places in decimals.items()]
            assert list(row[2:5]) == shown
