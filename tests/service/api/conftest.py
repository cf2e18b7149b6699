"""A store, and the API on it behind a real server."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import httpx
import pytest

from slidercrank.service.store import Artefact, Store
from tests.service.api.serving import TOKEN, client_of
from tests.service.store.contents import add

Serve = Callable[..., httpx.Client]


@pytest.fixture
def serve(store: Store) -> Iterator[Serve]:
    """Return a function that serves the store with some settings and gives a client of it."""
    with contextlib.ExitStack() as stack:

        def served(**settings: Any) -> httpx.Client:
            return stack.enter_context(client_of(store, **settings))

        yield served


@pytest.fixture
def client(serve: Serve) -> httpx.Client:
    """Return a client of the API as it is without settings."""
    return serve()


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Return a client that a file's tests share: of a store with one job, which they leave unchanged."""
    with Store(tmp_path_factory.mktemp("shared") / "store.db") as store:
        add(store, files=[Artefact(name="job.toml", media_type="application/toml", content=b"secret = 1")])
        with client_of(store) as client:
            yield client
            assert store.count_by_state() == {"queued": 1}


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """Return a client of a service with a token, `TOKEN`, which it does not send."""
    with Store(tmp_path_factory.mktemp("guarded") / "store.db") as store, client_of(store, token=TOKEN) as client:
        yield client


@pytest.fixture(autouse=True)
def _forget_cookies(request: pytest.FixtureRequest) -> None:
    if "guarded" in request.fixturenames:
        request.getfixturevalue("guarded").cookies.clear()
