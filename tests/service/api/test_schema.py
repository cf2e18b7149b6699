"""No answer outside what the description of the API promises, and no fault of the service, whatever is asked."""

from __future__ import annotations

import os
from pathlib import Path

import httpx
import pytest

from tests.service.api import schema_cases

CASES = "SLIDERCRANK_CASES"
"""Variable with the number of cases of every operation; by hand, `python -m tests.service.api.schema_cases 10000 1`."""


@pytest.mark.slow
def test_every_answer_is_as_described(tmp_path: Path) -> None:
    each = int(os.environ.get(CASES, "5"))
    outcome = schema_cases.run(tmp_path, each, "examples,fuzzing,stateful")
    assert outcome.code == 0, outcome.text
    assert outcome.cases >= 200
    assert max(outcome.statuses) < 500
    assert {200, 201, 404, 409, 422} <= set(outcome.statuses)


def test_the_description_names_what_every_operation_may_answer(shared: httpx.Client) -> None:
    described = shared.get("/openapi.json").json()
    assert described["openapi"].startswith("3.1")
    for path, methods in described["paths"].items():
        for method, operation in methods.items():
            assert operation["responses"].keys() >= {"401", "403", "422", "503"}, f"{method} {path}"
    submission = described["paths"]["/api/v1/jobs"]["post"]
    assert set(submission["requestBody"]["content"]) == {"application/json", "application/toml"}
    assert submission["responses"]["201"]["links"]["show_job"]["parameters"] == {"number": "$response.body#/id"}
