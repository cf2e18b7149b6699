"""The change beside a warning: once applied to the job, the warning is gone, also on the command line."""

from __future__ import annotations

import copy
import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.question_registry import Change, Remark
from slidercrank.service.cli import app
from slidercrank.service.text.job_in_words import problem_in_words

Job = dict[str, Any]
CONSTANT = [{"force": "300 N", "direction": "outward", "during": "outward stroke"}]
JOBS: dict[str, tuple[Job, str]] = {
    "a fast loaded stroke": ({"variables": {"offset": ["15 mm", "80 mm"]}}, "is the faster one"),
    "offsets left out": (
        {"variables": {"offset": ["-10 mm", "80 mm"]}, "constraints": {"slow_stroke": "outward"}},
        "leaves only offsets",
    ),
    "a number without a unit": ({"mechanism": {"speed": 251}}, "has no unit and is read as"),
    "a list with and without units": ({"variables": {"crank": ["20 mm", 60]}}, "mixes numbers"),
    "torques in each other's place": (
        {"drive": {"rated_torque": "15 N m", "greatest_torque": "5 N m"}},
        "a motor gives it continuously",
    ),
    "a load that drives": ({"load": CONSTANT}, "do more work on the machine than they absorb"),
}


def changed(job: Job, tables: Job) -> Job:
    return {
        **job,
        **{name: {**job.get(name, {}), **part} if isinstance(part, dict) else part for name, part in tables.items()},
    }


@pytest.fixture
def feeder(pytestconfig: pytest.Config) -> Job:
    job = tomllib.loads((pytestconfig.rootpath / "runs" / "feeder.toml").read_text())
    job["mechanism"]["speed"] = "300 rpm"
    job["constraints"].pop("rod_to_offset", None)
    job["constraints"].pop("slow_stroke", None)
    return job


@pytest.mark.filterwarnings("ignore::slidercrank.model.errors.InputWarning")
@pytest.mark.parametrize("name", JOBS)
def test_a_warning_is_gone_once_its_change_is_made(name: str, feeder: Job, tmp_path: Path) -> None:
    tables, words = JOBS[name]
    job = changed(feeder, tables)
    summary = problem_in_words(parse_job(job))
    (change,) = (one for one in summary["changes"] if words in one["sentence"])
    assert change["sentence"] in summary["warnings"]
    table, _, key = change["path"].partition(".")
    settled = problem_in_words(parse_job(changed(job, {table: {key: change["value"]} if key else change["value"]})))
    assert not any(words in sentence for sentence in settled["warnings"])

    file = tmp_path / "job.json"
    file.write_text(json.dumps(job))
    shown = CliRunner().invoke(app, ["check", str(file)])
    assert f"{change['label']}: {change['path']} = " in shown.output


def test_a_remark_is_its_sentence_and_keeps_its_change_in_other_processes() -> None:
    remark = Remark("too short", Change("variables.rod", ["1 mm", "2 mm"], "Allow rods up to 2 mm"))
    for other in (copy.deepcopy(remark), pickle.loads(pickle.dumps(remark))):
        assert (other, other.change) == ("too short", remark.change)
    assert json.dumps([remark]) == '["too short"]'
