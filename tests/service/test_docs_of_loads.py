"""docs/loads.md: every example is a job, `check` reports what the page says, and no kind of load is missing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from benchmarks.load_pictures import DOCS, Example, examples, names, whole_job
from slidercrank.optimise.job.loads import PARTS
from tests.service.conftest import Command

EXAMPLES = list(examples())
SWINGS = {"torque_per_angle"}
"""Loads of a crank that swings, which docs/jobs.md explains."""


def job_of(example: Example) -> dict[str, Any]:
    """Return the whole job with an example; tables that both have are merged, except for a swing."""
    whole = whole_job()
    job = {**whole, **example.tables}
    for name, table in example.tables.items():
        if isinstance(whole.get(name), dict) and "motion" not in example.tables:
            job[name] = {**whole[name], **table}
    if "motion" in example.tables:
        job["constraints"] = example.tables["constraints"]
    if {"cycle_time", "strokes_per_minute"} & set(job["mechanism"]):
        del job["mechanism"]["speed"]
    return job


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.picture or "-".join(example.tables))
def test_check_reports_of_an_example_what_the_page_says(example: Example, command: Command, tmp_path: Path) -> None:
    for name, text in example.file.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "job.json").write_text(json.dumps(job_of(example)), encoding="utf-8")
    done = command("check", tmp_path / "job.json")
    assert done.exit_code == 0, done.stderr
    for line in example.reported:
        assert line in done.stdout + done.stderr
    assert example.reported or "load" not in example.tables
    warned = "loads do more work on the machine than they absorb" in done.stdout + done.stderr
    assert warned == any("loads do more work" in line for line in example.reported)


def test_the_page_has_every_kind_of_load() -> None:
    shown = {key for example in EXAMPLES for load in example.tables.get("load", []) for key in load}
    kinds = {key for key in PARTS if key not in SWINGS}
    assert {key for key in kinds if key not in shown} <= {"pressure_angles", "pressure_positions"}  # docs/jobs.md


def test_every_force_on_the_slider_has_its_picture() -> None:
    assert len(set(names())) == len(names()) == 13
    assert [name for name in names() if not (DOCS / name).is_file()] == []
