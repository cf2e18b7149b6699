"""Columns of a catalogue: limits are what [constraints] takes, and what is neither limit nor number says why."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.catalogue import read_catalogue
from slidercrank.optimise.job.catalogue_columns import columns_of_header
from tests import random_formulas

TABLES: dict[str, Any] = {
    "name": "geared",
    "mechanism": {
        "speed": "10 rad/s",
        "crank": {"mass": 0.2},
        "rod": {"mass": 0.5},
        "slider": {"mass": 0.8},
        "gravity": 9.81,
    },
    "load": [{"force": "200 N", "opposes": "outward stroke"}],
    "variables": {
        "crank": [0.02, 0.06],
        "rod": [0.15, 0.3],
        "offset": [-0.05, 0.08],
        "mechanism.slider.mass": [0.5, 2],
    },
    "objectives": {"peak_torque": "minimise", "stroke": "maximise"},
}


def text_of(*rows: list[str]) -> str:
    """Return a catalogue's text, cells in quotes where they have commas."""
    file = io.StringIO()
    csv.writer(file).writerows(rows)
    return file.getvalue()


def outcome(option: Any) -> Any:
    """Return the variants of the job with one option of a choice, or why it is refused."""
    try:
        return parse_job({**TABLES, "choice": [{"name": "motor", "option": option, "rows": 1}]}).variants
    except JobError as error:
        return str(error)


def test_limits_on_random_formulas_are_those_of_constraints() -> None:
    random = np.random.default_rng(9)
    formulas, taken = random_formulas.formulas(), 0
    while taken < 40:
        text = random_formulas.random_formula(random, depth=2)[0]
        try:
            of = formulas.quantity_of_text(text, "key")
        except JobError:  # the same for every design
            continue
        word, value = random.choice(["min", "max", "equals"]), f"{random.uniform(-100.0, 300.0):.4g}"
        behind = random.choice([" ({})", "({})", " [{}]"]).format(of.unit.symbol) if of.unit.symbol else ""
        options = read_catalogue(text_of(["name", f"{text} {word}{behind}"], ["A", value]), "file").options
        limit = f"{value} {of.unit.symbol}" if of.unit.symbol else float(value)
        assert outcome(options) == outcome([{"name": "A", "constraints": {of.name: {word: limit}}}])
        taken += 1


@pytest.mark.parametrize("name", ["crank", "min(crank, offset)", "2 * (crank + rod)", "transmission_angle", "stroke"])
def test_a_word_in_a_wrong_place_or_missing_is_told_with_the_header_that_helps(name: str) -> None:
    unit = "deg" if name == "transmission_angle" else "mm"
    right = f"{name} max ({unit})"
    assert [column.word for column in columns_of_header(["name", right], "file", frozenset())] == ["max"]
    for wrong in (
        f"{name} Max ({unit})",
        f"max {name} ({unit})",
        f"MAXIMUM {name} ({unit})",
        f"{name} maximum ({unit})",
    ):
        with pytest.raises(JobError) as told:
            columns_of_header(["name", wrong], "file", frozenset())
        assert f'file, column "{wrong}": ' in str(told.value)
        assert str(told.value).endswith(f"in lower case; write {right}")
    if name == "transmission_angle":  # one that says its good side
        assert [column.header_text for column in columns_of_header(["name", f"{name} (deg)"], "file", frozenset())] == [
            "transmission_angle min (deg)"
        ]
    elif name != "crank":  # a number of the job
        for wrong in (f"{name} ({unit})", name):
            with pytest.raises(JobError, match=re.escape(f"needs min, max or equals; got none; write {name} max")):
                columns_of_header(["name", wrong], "file", frozenset())


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("crank + peak_torque max (mm)", "adds mm and N m; only values of one kind can be combined"),
        ("crank + rud max (mm)", 'is called "rud"; did you mean rod?'),
        ("crank + rod max (N)", 'must have a unit of a length; got "N"; write it like (mm)'),
        ("crank + rod max", 'the heading has no unit; write, for example, "crank + rod max (mm)"'),
        ("rod / crank max (mm)", 'must have a unit of a ratio; got "mm"; leave it out'),
        ("crank == rod max (mm)", "'=' has no meaning in a formula"),
        ("min(crank max (mm)", "got the formula"),
        ("1. price (EUR)", "got neither; rename it, or let it begin with # to skip it"),
        ("peak torqe (N m)", "did you mean peak_torque? rename it"),
        (
            "variables.crank (mm)",
            "a number of the job must be named by its path; got variables.crank; write crank (mm)",
        ),
        (
            "crank+rod max (mm),crank + rod max (cm)",
            'got it and "crank+rod max (mm)", which are both read as crank + rod max; leave out or rename one',
        ),
        ("price (EUR),price (USD)", 'got it and "price (EUR)", which are both read as price; leave out or rename one'),
        ("max torque (N m)", "did you mean peak_torque? rename it"),
        ("torque max. (N m)", "did you mean peak_torque? rename it"),
        ("max. peak torque (N m)", "must follow the quantity, in lower case; write peak_torque max (N m)"),
        (
            "price max (EUR)",
            'got "price", which is not one; name the column "price (EUR)" and bound price in [constraints]',
        ),
    ],
)
def test_what_is_wrong_with_a_header_is_told_with_its_column_and_remedy(header: str, words: str) -> None:
    with pytest.raises(JobError, match=re.escape(words)) as told:
        columns_of_header(["name", *header.split(",")], "file", frozenset())
    assert f'file, column "{header.split(",")[-1]}": ' in str(told.value)


def test_files_of_a_problem_in_python_lie_in_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "c.csv").write_text("name,crank max (mm)\nA,40\n")
    (tmp_path / "speeds.csv").write_text("crank_angle_deg,speed_rpm\n0,95\n90,100\n180,105\n270,100\n")
    tables = {
        **TABLES,
        "mechanism": {**TABLES["mechanism"], "speed": "100 rpm", "speed_profile": {"file": "speeds.csv"}},
        "choice": [{"name": "motor", "file": "c.csv"}],
    }
    found = sc.problem(tables, folder=tmp_path)
    assert [limit.upper for variant in found.variants for limit in variant.limits] == [0.04]
    assert found.mechanism.speed_profile is not None
    with pytest.raises(JobError, match=r'"c\.csv" not found'):
        sc.problem(tables | {"mechanism": TABLES["mechanism"]}, folder=tmp_path / "none")
    monkeypatch.chdir(tmp_path)
    assert sc.problem(tables) == found
