"""Files of a job, sent with it: read like files beside a job file, in every interface for submissions."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path
from typing import Any

import httpx

from slidercrank.optimise.job import read_job
from slidercrank.service.api.job_requests import EXAMPLE
from tests.service.api.serving import refusal_sentence
from tests.service.conftest import Command

TRACE = "Kurbelwinkel [°];Kraft [N]\n0;-20\n90;-1.000,5\n"
SAID = (
    "load #1, trace.csv: 2 rows of Kurbelwinkel [°], Kraft [N]; first 0, -20; last 90, -1000.5; separated by "
    "semicolons; decimal comma"
)


def body(content: str) -> dict[str, Any]:
    return {"job": {**EXAMPLE, "load": [{"file": "trace.csv"}]}, "files": {"trace.csv": content}}


def test_files_are_sent_as_texts_or_bytes_and_read_as_those_beside_a_job(
    shared: httpx.Client, tmp_path: Path, command: Command
) -> None:
    (tmp_path / "trace.csv").write_bytes(TRACE.encode("latin-1"))
    (tmp_path / "job.json").write_text(json.dumps(body("")["job"]), encoding="utf-8")
    expected = read_job(tmp_path / "job.json")
    for content in (
        TRACE,
        *(f"data:text/csv;base64,{b64encode(TRACE.encode(code)).decode()}" for code in ("utf-16", "latin-1", "utf-8")),
    ):
        assert shared.post("/parse", json=body(content)).json()["job"] == expected
        assert shared.post("/check", json=body(content)).json()["files"] == [SAID]
    checked = json.loads(command("check", tmp_path / "job.json", "--json").stdout)
    assert checked["files"] == [SAID]
    assert f"files         {SAID}" in command("check", tmp_path / "job.json").stdout


def test_a_file_that_is_missing_or_broken_is_refused_in_a_sentence(shared: httpx.Client) -> None:
    asked = body(TRACE)
    for files, words in (
        ({"other.csv": TRACE}, 'load #1.file: "trace.csv" not found among the files sent with the job (other.csv)'),
        ({"trace.csv": "data:text/csv;base64,?"}, "files.trace.csv: must be text or base64; got neither"),
        ({"trace.csv": "a;b\n1;2\n"}, 'the columns have no units; got "a", "b"'),
    ):
        assert words in refusal_sentence(shared.post("/check", json={**asked, "files": files}), 422)
    sentence = refusal_sentence(shared.post("/check", json={"job": asked["job"]}), 422)
    assert "load #1: a file must be in the folder of the job file, or be sent with the job (API: files)" in sentence
