"""An application whose requests take what they name, and its front in this process."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import httpx
import numpy as np
from fastapi import FastAPI
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route

from slidercrank.service.api.computing import Computing, LongRoute, QuickRoute
from slidercrank.service.api.problem_documents import handle_expected_errors
from slidercrank.service.store import Limits
from slidercrank.service.workers.heartbeat import EXHAUSTED, end_process_tree
from tests.service.api.serving import serving

_ROUTES = {"quick": QuickRoute, "long": LongRoute}
_KEPT: list[np.ndarray] = []
MOST = Limits(seconds=0.5, memory=400_000_000)


def _process(_: Request) -> Response:
    return PlainTextResponse(str(os.getpid()))


def _memory(request: Request) -> Response:
    return PlainTextResponse(str(len(_bytes(request))))


def _keep_request(request: Request) -> Response:
    _KEPT.append(_bytes(request))
    return PlainTextResponse("kept")


def _bytes(request: Request) -> np.ndarray:
    """Return memory that counts and is never touched: to fill it takes long on a busy machine."""
    return np.zeros(int(request.query_params["bytes"]), np.uint8)


def _time(request: Request) -> Response:
    end = time.process_time() + float(request.query_params["seconds"])
    while time.process_time() < end:
        pass
    return PlainTextResponse("done")


def _killed(_: Request) -> Response:
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


async def _endless_response(_: Request) -> Response:
    async def parts() -> AsyncIterator[bytes]:
        yield str(os.getpid()).encode()
        while True:
            signal.pause()

    return StreamingResponse(parts())


@contextlib.contextmanager
def demanding() -> Iterator[Starlette]:
    """Give the application, as each process makes it."""
    endpoints = {
        "process": _process,
        "memory": _memory,
        "kept": _keep_request,
        "time": _time,
        "killed": _killed,
        "endless": _endless_response,
    }
    routes = [Route(f"/{kind}/{name}", of) for kind in _ROUTES for name, of in endpoints.items()]
    yield Starlette(routes=routes, exception_handlers={MemoryError: lambda *_: end_process_tree(EXHAUSTED)})


@contextlib.contextmanager
def noting_application(folder: Path) -> Iterator[Starlette]:
    """Give the application, and leave a file for each process that makes it."""
    (folder / str(os.getpid())).touch()
    with demanding() as app:
        yield app


def _answered_elsewhere() -> None:
    raise AssertionError


@contextlib.contextmanager
def client_of(computing: Computing) -> Iterator[httpx.Client]:
    """Serve the application by processes while entered; gives a client of it."""
    app = FastAPI(routes=[kind(f"/{name}/{{what}}", _answered_elsewhere) for name, kind in _ROUTES.items()])
    app.state.computing = computing
    handle_expected_errors(app)
    with (
        contextlib.closing(computing),
        serving(app) as address,
        httpx.Client(base_url=address, timeout=30.0, trust_env=False) as client,
    ):
        yield client
