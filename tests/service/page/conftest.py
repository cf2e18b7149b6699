"""The page in a browser: headless Chromium, on a service behind a real server."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Callable, Collection, Iterator
from functools import partial
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser, Page, expect

from slidercrank.service.api.settings import Settings
from slidercrank.service.store import Store
from tests.service.api.fixed_front import served
from tests.service.page.browser import BROWSERS, browser_path, chromium

Open = Callable[..., Page]
PATIENCE = 30_000.0
"""ms, for what a page is to show: a busy machine takes many times as long as an idle one."""


@pytest.fixture(scope="session")
def launched() -> Iterator[tuple[Browser, asyncio.AbstractEventLoop]]:
    """Return one browser for all files, and the event loop that its driver has running."""
    if browser_path() is None:
        pytest.skip(f"no browser: the page is not tested; install one of {', '.join(BROWSERS)}")
    expect.set_options(timeout=PATIENCE)
    with chromium() as opened:
        loop = asyncio.get_running_loop()
        with _set_running(None):
            yield opened, loop


@pytest.fixture(scope="module")
def browser(launched: tuple[Browser, asyncio.AbstractEventLoop]) -> Iterator[Browser]:
    """Return a browser for the tests of a file. Tests of others must not meet the event loop of its driver."""
    opened, loop = launched
    with _set_running(loop):
        yield opened


@contextlib.contextmanager
def _set_running(loop: asyncio.AbstractEventLoop | None) -> Iterator[None]:
    """Say which event loop runs in this thread, while entered: as the driver does between its calls."""
    before = asyncio._get_running_loop()
    asyncio._set_running_loop(loop)
    try:
        yield
    finally:
        asyncio._set_running_loop(before)


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Open]:
    """Return a function that opens a view of a store's service in a new browser, as `open_page(store, "#/jobs/1")`.

    At the end nothing may have gone wrong on any page: no exception, no error in the console, no request to elsewhere.
    A page that has to meet a refusal says so: `open_page(store, view, expected=("404",))`, parts of what is said.
    """
    with contextlib.ExitStack() as stack:
        wrong: list[str] = []

        def opened(
            store: Store,
            view: str = "",
            *,
            expected: tuple[str, ...] = (),
            settings: Settings | None = None,
            **context: Any,
        ) -> Page:
            address = stack.enter_context(served(store, settings or Settings()))
            page = stack.enter_context(contextlib.closing(browser.new_context(**context))).new_page()
            watch(page, address, wrong, expected)
            page.goto(f"{address}/{view}")
            return page

        yield opened
    assert wrong == []


@pytest.fixture
def form(open_page: Open) -> Open:
    """Return a function that opens the form with reduced motion: the sketch stands still, which saves time."""
    return partial(open_page, reduced_motion="reduce")


def ready(page: Page) -> None:
    """Wait until the form of a new run says that its job can start."""
    status = page.get_by_role("complementary").get_by_role("status")
    expect(status).to_have_text("Ready to start.", timeout=30_000)


def text_of(page: Page) -> dict[str, Any]:
    """Return the tables of the job in the form."""
    found: dict[str, Any] = json.loads(page.locator("#job-text").input_value())
    return found


@contextlib.contextmanager
def watched(browser: Browser, store: Store, expected: Collection[str] = ()) -> Iterator[tuple[Page, str]]:
    """Open a page on a store's service, and give both; nothing may go wrong, as with `open_page`."""
    wrong: list[str] = []
    context = browser.new_context(reduced_motion="reduce", viewport={"width": 1280, "height": 900})
    with served(store) as address, contextlib.closing(context):
        page = context.new_page()
        watch(page, address, wrong, expected)
        yield page, address
    assert wrong == []


def watch(page: Page, address: str, wrong: list[str], expected: Collection[str] = ()) -> None:
    """Write down what goes wrong on a page."""
    origin = urlsplit(address).netloc

    def said(text: str) -> None:
        if not any(part in text for part in expected):
            wrong.append(text)

    def asked(url: str) -> None:
        if urlsplit(url).scheme in ("http", "https", "ws", "wss") and urlsplit(url).netloc != origin:
            wrong.append(f"a request left the origin: {url}")

    page.on("pageerror", lambda error: said(f"{error.name}: {error.message}"))
    page.on("console", lambda message: said(message.text) if message.type in ("error", "warning") else None)
    page.on("request", lambda request: asked(request.url))
