"""The application that serves the API: store and settings in, one ASGI application out, nothing else shared."""

from __future__ import annotations

import asyncio
from importlib.metadata import PackageNotFoundError, version

from fastapi import FastAPI
from starlette.middleware import Middleware

from ..page import router as page
from ..store import Store
from . import (
    analysis,
    design_files,
    events,
    exports,
    figures,
    fronts,
    health,
    job_files,
    jobs,
    preview,
    quantities,
    schema,
    what_if,
)
from .events import Feed
from .health import Metrics, Timed
from .openapi import describe
from .problems import answer_problems, problem_responses
from .security import Guard
from .settings import DEFAULT, Settings
from .stored_fronts import StoredFronts
from .strict_input import StrictInput
from .throttle import RateLimit

PREFIX = "/api/v1"
_PARTS = (
    jobs,
    job_files,
    preview,
    events,
    fronts,
    analysis,
    what_if,
    design_files,
    figures,
    exports,
    schema,
    quantities,
    health,
)
_COMMON = problem_responses(400, 401, 403, 404, 413, 422, 503)


def create_app(store: Store, settings: Settings = DEFAULT) -> FastAPI:
    """Return the application of a store, which whoever serves it opens and closes."""
    app = FastAPI(
        title="slidercrank",
        version=_version(),
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,  # its pages come from other sites
        redoc_url=None,
        generate_unique_id_function=lambda route: route.name,
        middleware=[
            Middleware(Timed),
            Middleware(Guard, settings=settings),
            Middleware(StrictInput, most_body=settings.most_body, most_depth=settings.most_depth),
        ],
    )
    app.state.store = store
    app.state.settings = settings
    app.state.told = {}  # faults that were logged, and when
    app.state.reading = asyncio.Lock()
    app.state.submissions = RateLimit(settings.submissions_per_minute)
    app.state.feed = Feed(store)
    app.state.fronts = StoredFronts(store, allowed=settings.allowed_quantities)
    app.state.metrics = Metrics(store)
    answer_problems(app)
    for part in _PARTS:
        app.include_router(part.router, prefix=PREFIX, responses=_COMMON)
    app.include_router(page.router)
    describe(app)
    return app


def _version() -> str:
    try:
        return version("slidercrank")
    except PackageNotFoundError:
        return "0"
