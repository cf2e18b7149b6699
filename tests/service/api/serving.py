"""The API behind a real server on a free port, in a thread of this process."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator
from typing import Any

import httpx
import uvicorn
from fastapi import FastAPI

from slidercrank.service.api.app import create_app
from slidercrank.service.api.server import config_of, listening_socket
from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store

TOKEN = "a-long-random-text"


@contextlib.contextmanager
def serving(app: FastAPI, *, port: int = 0) -> Iterator[str]:
    """Serve an application while entered; gives its address. port: any free one unless given."""
    with listening_socket("127.0.0.1", port) as listening:
        server = uvicorn.Server(config_of(app))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]}, daemon=True)
        thread.start()
        while not server.started:
            assert thread.is_alive(), "the server did not start"
            time.sleep(0.005)
        try:
            yield f"http://127.0.0.1:{listening.getsockname()[1]}"
        finally:
            server.should_exit = True
            thread.join()


@contextlib.contextmanager
def client_of(store: Store, **settings: Any) -> Iterator[httpx.Client]:
    """Serve a store with some settings while entered; gives a client of it."""
    with (
        serving(create_app(store, Settings(**settings))) as address,
        httpx.Client(base_url=f"{address}/api/v1", timeout=30.0, trust_env=False, verify=False) as client,
    ):
        yield client


def refusal_sentence(response: httpx.Response, status: int) -> str:
    """Return the sentence of a refusal, which is a whole problem document."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
    found = response.json()
    assert set(found) == {"type", "title", "status", "detail"}
    assert found["status"] == status
    assert "Traceback" not in response.text
    detail: str = found["detail"]
    return detail
