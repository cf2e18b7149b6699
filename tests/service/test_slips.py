"""The likeliest slips in stating a job: what `check`, the page and Python answer to each (slips.toml)."""

from __future__ import annotations

import re
import tomllib
import warnings
from pathlib import Path
from typing import Any

import pytest

import slidercrank as sc
from slidercrank.model.errors import InfeasibleError, InputWarning, JobError
from slidercrank.optimise.job import with_file_contents
from slidercrank.optimise.job.job_file import toml_tables
from slidercrank.service.api.job_parsing_and_checks import Understood
from slidercrank.service.api.preview import Draft, preview_job
from slidercrank.service.api.settings import Settings
from tests.service.conftest import Command

GIVEN = tomllib.loads((Path(__file__).parent / "slips.toml").read_text(encoding="utf-8"))
REFUSALS = {2: JobError, 3: InfeasibleError}


@pytest.fixture(params=GIVEN["slip"], ids=[slip["title"].replace(" ", "-") for slip in GIVEN["slip"]])
def slip(request: pytest.FixtureRequest) -> dict[str, Any]:
    text: str = GIVEN["job"]
    for old, new in request.param["change"]:
        assert text.count(old) == 1
        text = text.replace(old, new)
    found: dict[str, Any] = {"exit": 0, "notes": [], "files": {}, "text": text, **request.param}
    return found


@pytest.fixture
def file(slip: dict[str, Any], tmp_path: Path) -> Path:
    for name, content in slip["files"].items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    (tmp_path / "job.toml").write_text(slip["text"], encoding="utf-8")
    return tmp_path / "job.toml"


def test_check_answers_a_slip(slip: dict[str, Any], file: Path, command: Command) -> None:
    done = command("check", file)
    assert done.exit_code == slip["exit"]
    if done.exit_code:
        assert [done.stderr] == [f"slidercrank: {file}: {sentence}\n" for sentence in slip["check"]]
        return
    lines = [line.strip() for line in done.stdout.splitlines()]
    assert [line[len("warning") :].strip() for line in lines if line.startswith("warning")] == slip["check"]
    assert set(slip["notes"]) <= {" ".join(line.split()) for line in lines}


def test_python_answers_a_slip(slip: dict[str, Any], file: Path) -> None:
    expected = slip.get("python", slip["check"])
    if slip["exit"]:
        with pytest.raises(REFUSALS[slip["exit"]]) as refused:
            sc.problem(toml_tables(slip["text"]), folder=file.parent)
        assert [unplaced(str(refused.value))] == [unplaced(sentence) for sentence in expected]
        return
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sc.problem(toml_tables(slip["text"]), folder=file.parent)
    assert [(one.category, str(one.message)) for one in caught] == [(InputWarning, one) for one in expected]


def test_the_page_answers_a_slip(slip: dict[str, Any]) -> None:
    wrong, infeasible, understood = page_findings(slip["text"], slip["files"])
    if slip["exit"]:
        assert [unplaced(one) for one in wrong] == [unplaced(one) for one in slip.get("page", slip["check"])]
        assert infeasible == (slip["exit"] == 3)
        return
    assert wrong == []
    assert understood is not None
    assert understood.warnings == slip.get("page", slip["check"])
    told = [*(f"note {one}" for one in understood.notes), *(f"files {one}" for one in understood.files)]
    assert set(slip["notes"]) <= set(told)


def unplaced(sentence: str) -> str:
    """Return a refusal without its lines in the file, which tables that are given do not have."""
    return re.sub(r"(?m)^( *)line \d+(?:, |: )", r"\1", sentence)


def page_findings(text: str, files: dict[str, str]) -> tuple[list[str], bool, Understood | None]:
    """Return the page's findings on a job file: mistakes, whether the job is infeasible, and the job in words.

    files: sent beside it, but for those of catalogues, which are pasted into the form.
    """
    try:
        job = toml_tables(text)
        for choice in job.get("choice", ()):
            if choice["file"] in files:
                choice["table"] = files[choice.pop("file")]
        job = with_file_contents(job, {name: content.encode() for name, content in files.items()})
    except JobError as error:
        return [str(error)], False, None
    found = preview_job(Draft(job=job), Settings())
    wrong = [f"{one.path}: {one.sentence}" if one.path else one.sentence for one in found.wrong]
    return wrong, any(one.infeasible for one in found.wrong), found.understood
