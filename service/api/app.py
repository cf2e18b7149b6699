"""ASGI application that serves the API; it shares nothing but a store and settings."""

import asyncio
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import replace
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from anyio.to_thread import current_default_thread_limiter
from fastapi import APIRouter, Depends, FastAPI, Request
from starlette.middleware import Middleware
from starlette.routing import BaseRoute

from ..page import api_reference
from ..page import router as page
from ..store import Store
from ..workers.heartbeat import EXHAUSTED, end_process_tree
from ..workers.logs import Format, set_up_logs
from . import front_files
from .computing import Computing, RateLimit
from .events import Feed
from .health import Metrics, Timed
from .job_requests import EXAMPLE, JSON, TOML, Submission
from .problem_documents import Problem, handle_expected_errors, problem_responses
from .security import Guard
from .settings import DEFAULT, Settings
from .stored_fronts import StoredFronts
from .strict_input import StrictInput

PREFIX = "/api/v1"
_PARTS = (
    *(
        "jobs",
        "submissions",
        "job_parsing_and_checks",
        "preview",
        "events",
        "fronts",
        "active_limits",
        "what_if",
        "analysis",
    ),
    *("design_questions", "front_questions", "wish", "bookmarks", "design_files", "figures", "front_files"),
    *("quantities", "health"),
)
"""Modules with the endpoints, in the order of the API description."""
MODULES = (
    __name__,
    *(f"{__package__}.{part}" for part in _PARTS),
    "numba",
    "scipy.optimize",
    "slidercrank.optimise.job",
)
"""Modules that `computing_app` and most answers need."""
THREADS = 8
"""Requests that may read the store simultaneously. With more threads, which take turns in the interpreter, the slowest
of 100 simultaneous requests waits twice as long."""
_COMMON = problem_responses(400, 401, 403, 404, 413, 422, 503)
_SCHEMAS = "#/components/schemas/"
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
_FIRST = {"design": 1, "kept": 1}


def create_app(store: Store, settings: Settings = DEFAULT, computing: Computing | None = None) -> FastAPI:
    """Return the application for a store that the caller opens and closes.

    computing: processes that answer computing requests; None computes in this process.
    """
    app = FastAPI(
        title="slidercrank",
        version=_version(),
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # its pages load from other sites: see api_reference
        redoc_url=None,
        routes=_all_routes(),
        lifespan=_limited_threads,
        middleware=[
            Middleware(Timed),
            Middleware(Guard, settings=settings),
            Middleware(StrictInput, most_body=settings.most_body, most_depth=settings.most_depth),
        ],
    )
    app.state.store = store
    app.state.settings = settings
    app.state.fault_times = {}  # times of the logged faults
    app.state.reading = asyncio.Lock()
    app.state.computing = computing
    app.state.turn_here = asyncio.Lock()
    app.state.submissions = RateLimit(settings.submissions_per_minute)
    app.state.feed = Feed(store)
    app.state.fronts = StoredFronts(store, allowed=settings.allowed_quantities)
    app.state.metrics = Metrics(store)
    handle_expected_errors(app)
    make_schema = app.openapi

    def openapi_schema() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = _complete_openapi_schema(make_schema(), secured=settings.token is not None)
        return app.openapi_schema

    app.openapi = openapi_schema  # type: ignore[method-assign]
    return app


@asynccontextmanager
async def _limited_threads(_: FastAPI) -> AsyncIterator[None]:
    current_default_thread_limiter().total_tokens = THREADS
    yield


@contextmanager
def computing_app(address: str, settings: Settings, *, most_queued: int, log_format: Format) -> Iterator[FastAPI]:
    """Yield the application that runs in a process of `Computing`; its requests have passed the access checks."""
    set_up_logs(log_format)
    trusted = replace(settings, token=None, hosts=("*",), submissions_per_minute=0)
    with Store(address, most_queued=most_queued) as store:
        app = create_app(store, trusted)
        app.add_exception_handler(MemoryError, lambda *_: end_process_tree(EXHAUSTED))
        yield app


async def _start_computing_process(request: Request) -> None:
    """Start a process early, to have it ready when a user of the page needs a computation."""
    if request.app.state.computing is not None:
        request.app.state.computing.start_first_process()


@cache
def _all_routes() -> list[BaseRoute]:
    """Return the endpoints for all applications of a process; cached because FastAPI is slow to inspect signatures."""
    root = APIRouter(generate_unique_id_function=lambda route: route.name)
    for part in _PARTS:
        root.include_router(import_module(f"{__package__}.{part}").router, prefix=PREFIX, responses=_COMMON)
    root.include_router(api_reference.router, prefix=PREFIX)
    root.include_router(page.router, dependencies=[Depends(_start_computing_process)])
    return root.routes


def _version() -> str:
    try:
        return version("slidercrank")
    except PackageNotFoundError:
        return "0"


def _complete_openapi_schema(schema: dict[str, Any], *, secured: bool) -> dict[str, Any]:
    """Return the OpenAPI 3.1 description of the API, with the facts that FastAPI cannot infer."""
    if "parquet" not in front_files.export_formats():
        schema["paths"].pop(f"{_NUMBER}/export.parquet")  # the endpoint reports what to install
    parts = schema.setdefault("components", {})
    shapes = parts.setdefault("schemas", {})
    shapes["Problem"] = Problem.model_json_schema()
    submission = Submission.model_json_schema(ref_template=f"{_SCHEMAS}{{model}}")
    shapes |= submission.pop("$defs", {})
    shapes["Submission"] = submission
    content = {
        JSON: {
            "schema": {"$ref": f"{_SCHEMAS}Submission"},
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
        created["links"] = _openapi_links(schema["paths"])
        created["headers"] = {"Location": {"schema": {"type": "string"}, "description": "the address of the job"}}
    if secured:
        parts["securitySchemes"] = {"token": {"type": "http", "scheme": "bearer"}}
        schema["security"] = [{"token": []}]
    return schema


def _openapi_links(paths: dict[str, Any]) -> dict[str, Any]:
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
