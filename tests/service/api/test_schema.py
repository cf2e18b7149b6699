"""No answer outside what the description of the API promises, and no fault of the service, whatever is asked."""

from __future__ import annotations

from pathlib import Path

import httpx
import pytest

from slidercrank.optimise.job import job_schema
from tests.case_count import case_count
from tests.schema_words import KNOWN, OF_OPENAPI, schemas_within, unknown_words
from tests.service.api import schema_cases


@pytest.mark.slow
def test_every_answer_is_as_described(tmp_path: Path) -> None:
    outcome = schema_cases.run(tmp_path, case_count(5, 50), "examples,fuzzing,stateful")
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


def test_every_schema_of_the_description_has_words_of_json_schema_alone(shared: httpx.Client) -> None:
    """Whole numbers had their limits as "ge" and "le", which no reader knows."""
    described = shared.get("/openapi.json").json()
    found = dict(schemas_within(described))
    assert len(found) > 300
    words = [word for place, schema in found.items() for word in unknown_words(schema, KNOWN | OF_OPENAPI, place)]
    assert words == []
    limits = {each["name"]: each["schema"] for each in described["paths"]["/api/v1/jobs"]["get"]["parameters"]}
    assert limits["limit"] == {**limits["limit"], "type": "integer", "minimum": 1, "maximum": 1000}
    assert limits["before"]["anyOf"][0] == {"type": "integer", "minimum": 1, "maximum": 2**53 - 1}


def test_schemas_follow_the_rules_of_json_schema_itself(shared: httpx.Client) -> None:
    judge = pytest.importorskip("jsonschema_rs")
    for place, schema in schemas_within(shared.get("/openapi.json").json()):
        assert judge.meta.is_valid(schema), place
    judge.meta.validate(job_schema())
    assert list(unknown_words(job_schema())) == []


@pytest.mark.parametrize("text", ["6.0", "1_0", " 6", "0x1", "+6", "06"])
def test_a_whole_number_of_an_address_has_digits_alone(text: str, shared: httpx.Client) -> None:
    for path in ("/jobs", "/jobs?before=1"):
        assert shared.get(path, params={"limit": text}).status_code == 422
    assert shared.get("/jobs", params={"before": text}).status_code == 422
    assert shared.get(f"/jobs/{text}").status_code == 422
    assert shared.get("/front-points", params={"job": text}).status_code == 422
