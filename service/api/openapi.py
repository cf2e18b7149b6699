"""The description of the API (OpenAPI 3.1): what FastAPI finds out, and what only its author knows."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from .exports import formats
from .job_requests import EXAMPLE, JSON, TOML, Submission
from .problems import Problem

_PREFIX = "#/components/schemas/"
_EXAMPLE_TOML = """\
name = "Feeder"
[mechanism]
speed = "60 rpm"
slider = { mass = "2 kg" }
[variables]
crank = ["20 mm", "200 mm"]
rod = ["60 mm", "600 mm"]
offset = ["0 mm", "100 mm"]
[constraints]
stroke = { equals = "280 mm" }
[objectives]
time_ratio = "maximise"
transmission_angle = "maximise"
"""
_NUMBER = "/api/v1/jobs/{number}"
_FIRST = {"design": 1}


def describe(app: FastAPI) -> None:
    """Have an application give the whole description."""
    found = app.openapi

    def described() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = _completed(found(), secured=app.state.settings.token is not None)
        return app.openapi_schema

    app.openapi = described  # type: ignore[method-assign]


def _completed(schema: dict[str, Any], *, secured: bool) -> dict[str, Any]:
    if "parquet" not in formats():
        schema["paths"].pop(f"{_NUMBER}/export.parquet")  # it says what to install
    parts = schema.setdefault("components", {})
    shapes = parts.setdefault("schemas", {})
    shapes["Problem"] = Problem.model_json_schema()
    submission = Submission.model_json_schema(ref_template=f"{_PREFIX}{{model}}")
    shapes |= submission.pop("$defs", {})
    shapes["Submission"] = submission
    content = {
        JSON: {
            "schema": {"$ref": f"{_PREFIX}Submission"},
            "examples": {"feeder": {"summary": "A feeder", "value": {"job": EXAMPLE, "priority": 1}}},
        },
        TOML: {
            "schema": {"type": "string", "description": "a job file"},
            "examples": {"feeder": {"summary": "A feeder", "value": _EXAMPLE_TOML}},
        },
    }
    for path in ("/api/v1/jobs", "/api/v1/check"):
        schema["paths"][path]["post"]["requestBody"] = {"required": True, "content": content}
    for path in ("/api/v1/jobs", "/api/v1/jobs/{number}/clone"):
        created = schema["paths"][path]["post"]["responses"]["201"]
        created["links"] = _links(schema["paths"])
        created["headers"] = {"Location": {"schema": {"type": "string"}, "description": "the address of the job"}}
    if secured:
        parts["securitySchemes"] = {"token": {"type": "http", "scheme": "bearer"}}
        schema["security"] = [{"token": []}]
    return schema


def _links(paths: dict[str, Any]) -> dict[str, Any]:
    """Return the OpenAPI links from a submitted job to the requests that may follow."""
    links = {}
    for path, methods in paths.items():
        rest = path.removeprefix(_NUMBER)
        if rest == path or "{name}" in rest:
            continue
        parameters = {"number": "$response.body#/id"} | {key: _FIRST[key] for key in _FIRST if f"{{{key}}}" in rest}
        for operation in methods.values():
            name = operation["operationId"]
            links[name] = {"operationId": name, "parameters": parameters}
    return links
